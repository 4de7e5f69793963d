#include "packs/tools/picture_file.hpp"

#include <OpenImageIO/imageio.h>

#include <string>

namespace lackwerk::packs {
namespace {

Result<void> check_spec(const OIIO::ImageSpec& spec, const PictureLimits& limits, const std::string& file) {
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1 || spec.width > limits.width ||
      spec.height > limits.height ||
      static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) > limits.pixels)
    return fail(file, "size", std::to_string(spec.width) + "x" + std::to_string(spec.height) + " is not supported",
                limits.size_remedy);
  if (spec.nchannels < 1 || spec.nchannels > limits.channels)
    return fail(file, "channels", std::to_string(spec.nchannels) + " channels", "save it as RGB");
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    return fail(file, "data window", "is not the whole picture", "save it uncropped");
  return {};
}

}  // namespace

Result<PictureFile> read_picture(const std::filesystem::path& path, const PictureLimits& limits, bool unassociated) {
  const std::string file = path.string();
  OIIO::ImageSpec config;
  if (unassociated) config["oiio:UnassociatedAlpha"] = 1;
  const auto input = OIIO::ImageInput::open(file, &config);
  if (!input) {
    const std::string reason = OIIO::geterror();
    return fail(file, "", "cannot be read" + (reason.empty() ? "" : ": " + reason), "check the path and the format");
  }
  const OIIO::ImageSpec spec = input->spec();
  if (auto ok = check_spec(spec, limits, file); !ok) return tl::unexpected(ok.error());
  PictureFile out{
      spec.width, spec.height, spec.nchannels, spec.format.is_floating_point(), spec.format == OIIO::TypeDesc::UINT8,
      {}};
  out.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                    static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, out.values.data()))
    return fail(file, "pixels", "cannot be read: " + input->geterror(), limits.broken_remedy);
  return out;
}

}  // namespace lackwerk::packs
