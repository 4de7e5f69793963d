#include "packs/tools/fit_picture.hpp"

#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <vector>

#include "core/colour.hpp"
#include "packs/tools/difference_picture.hpp"

namespace lackwerk::packs {
namespace {

constexpr int gap_px = 12;
constexpr glm::vec3 ground(0.13f);  // encoded, as in difference pictures

glm::vec3 shown(const glm::vec3& linear) {
  glm::vec3 out;
  for (int c = 0; c < 3; ++c)
    out[c] = static_cast<float>(core::srgb_encode(std::clamp(static_cast<double>(linear[c]), 0.0, 1.0)));
  return out;
}

}  // namespace

core::SphereComparison compare_fit(const core::BrdfTable& measured, const core::Brdf& fitted, int edge) {
  const core::BrdfTable like = core::measured_like(measured, fitted);
  return core::compare_on_sphere(core::table_brdf(measured, fitted), core::table_brdf(like, fitted), edge);
}

Result<void> write_fit_picture(const std::filesystem::path& path, const core::SphereComparison& comparison) {
  const int edge = comparison.a.edge;
  const int width = 3 * edge + 4 * gap_px, height = edge + 2 * gap_px;
  std::vector<glm::vec3> sheet(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), ground);
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const std::size_t from =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(edge) + static_cast<std::size_t>(x);
      if (comparison.a.mask[from] == 0) continue;
      glm::vec3* to = &sheet[static_cast<std::size_t>(y + gap_px) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x + gap_px)];
      to[0] = shown(comparison.a.pixels[from]);
      to[edge + gap_px] = shown(comparison.b.pixels[from]);
      to[2 * (edge + gap_px)] = map_colour(comparison.map[from]);
    }
  }
  OIIO::ImageBuf buffer(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT), sheet.data());
  buffer.set_write_format(OIIO::TypeDesc::UINT8);
  if (buffer.write(path.string())) return {};
  std::string reason = buffer.geterror();
  const std::string other = OIIO::geterror();  // read in any case: OpenImageIO prints unread errors at exit
  if (reason.empty()) reason = other.empty() ? "unknown format" : other;
  return fail(path.string(), "", "cannot be written: " + reason, "give a name that ends in .png, check the folder");
}

}  // namespace lackwerk::packs
