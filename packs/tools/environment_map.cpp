#include "packs/tools/environment_map.hpp"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

namespace lackwerk::packs {
namespace {

constexpr int max_width = 16384;

Result<void> check_spec(const OIIO::ImageSpec& spec, const std::string& file) {
  const std::string size = std::to_string(spec.width) + "x" + std::to_string(spec.height);
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1 || spec.width > max_width || spec.height > max_width / 2 + 1)
    return fail(file, "size", size + " is not supported", "use a lat-long map of at most 16384x8192 pixels");
  if (spec.nchannels < 1 || spec.nchannels > 4)
    return fail(file, "channels", std::to_string(spec.nchannels) + " channels", "save it as RGB");
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    return fail(file, "data window", "is not the whole picture", "save it uncropped");
  return {};
}

std::string extension_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::vector<std::string> describe(const core::MapRepairs& repairs) {
  std::vector<std::string> out;
  if (repairs.negative > 0) out.push_back(std::to_string(repairs.negative) + " negative pixels were set to 0");
  if (repairs.not_finite > 0)
    out.push_back(std::to_string(repairs.not_finite) +
                  " infinite or undefined pixels were filled from their neighbours");
  return out;
}

}  // namespace

Result<EnvironmentMap> read_environment_map(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string ending = extension_of(path);
  if (ending != ".hdr" && ending != ".exr")
    return fail(file, "format", "is no HDR map", "use a lat-long map in .hdr or .exr", ErrorKind::usage);
  const auto input = OIIO::ImageInput::open(file);
  if (!input) {
    const std::string reason = OIIO::geterror();
    return fail(file, "", "cannot be read" + (reason.empty() ? "" : ": " + reason), "check the path and the format");
  }
  const OIIO::ImageSpec spec = input->spec();
  if (auto ok = check_spec(spec, file); !ok) return tl::unexpected(ok.error());
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<float> values(count * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
    return fail(file, "pixels", "cannot be read: " + input->geterror(), "the file is damaged: fetch it again");

  EnvironmentMap out{{file, spec.width, spec.height, {}}, {}};
  out.map.pixels.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const float* v = &values[k * channels];
    out.map.pixels.push_back(channels < 3 ? glm::vec3(v[0]) : glm::vec3(v[0], v[1], v[2]));
  }
  const auto repairs = core::repair(out.map);  // its messages name the file
  if (!repairs) return tl::unexpected(repairs.error());
  out.repairs = describe(*repairs);
  out.map.name = path.stem().string();
  return out;
}

Result<LoadedEnvironment> load_environment(const std::filesystem::path& path, const core::EnvironmentRoom& room) {
  auto read = read_environment_map(path);
  if (!read) return tl::unexpected(read.error());
  return LoadedEnvironment{core::build_environment(read->map, room), std::move(read->repairs)};
}

}  // namespace lackwerk::packs
