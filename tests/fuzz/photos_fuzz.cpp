// Fuzz target: any text as photos.toml.
//
// Input: the text. It is read from a file in memory, as the importer reads it. Whatever comes: no sanitizer finding,
// every refusal with its field, and a list whose numbers lie in their ranges, whose photographs each have a white, and
// whose slices have a bounded size.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "packs/tools/photo_list.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

/// One file without a name in a folder.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("photos.toml", MFD_CLOEXEC)) { require(descriptor_ >= 0); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }
  void write(std::string_view text) const {
    require(ftruncate(descriptor_, 0) == 0);
    require(pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()));
  }
  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

bool in(double value, double least, double most) { return value >= least && value <= most; }

void check_photo(const packs::PanelPhoto& photo, const packs::PhotoList& list) {
  require(!photo.file.empty() && photo.file.find("..") == std::string::npos && photo.file.front() != '/');
  require(in(photo.exposure_s, 1e-6, 1e6) && photo.white < list.whites.size());
  require(in(photo.theta_h_deg, 0.0, 90.0) && in(photo.theta_i_deg, 0.0, 90.0));
  constexpr double lowest = 0.17;  // cos 80 degrees, and rounding
  require(in(photo.cos_light, lowest, 1.0) && in(photo.cos_camera, lowest, 1.0));
  constexpr double farthest_px = 32768.0;
  for (const glm::dvec2& corner : photo.corners_px)
    require(in(corner.x, -farthest_px, farthest_px) && in(corner.y, -farthest_px, farthest_px));
}

void check_list(const packs::PhotoList& list) {
  const packs::Capture& capture = list.capture;
  require(!capture.identity.name.empty() && !capture.identity.source.empty());
  require(in(capture.analytic.coat_ior, 1.0, 4.0) && in(capture.analytic.refraction_ior, 1.0, 4.0));
  const auto& layout = capture.layout;
  require(layout.slice_count() >= 1 && layout.slice_count() <= 256 && layout.lut.front() == 0);
  require(layout.num_theta >= 1 && layout.num_theta < 256 && layout.rows() <= layout.num_theta);
  require(capture.edge_texels >= 1 && capture.edge_texels <= 4096 && capture.texel_mm > 0.0f);
  require(std::uint64_t{capture.edge_texels} * capture.edge_texels * static_cast<std::uint64_t>(layout.slice_count()) <=
          1u << 27);
  require(list.panel_mm.x > 0.0 && list.panel_mm.y > 0.0 && std::isfinite(list.panel_mm.x + list.panel_mm.y));
  require(in(list.base_quantile, 0.0, 0.5) && in(list.response.saturation, 0.1, 1.0));
  require(list.photos.size() <= 512 && list.whites.size() <= 512);
  for (const glm::dvec3& row : list.to_srgb)
    for (int k = 0; k < 3; ++k) require(in(row[k], -10.0, 10.0));
  for (std::size_t k = 1; k < list.response.points.size(); ++k)
    require(list.response.points[k - 1].first < list.response.points[k].first);
  for (const packs::WhitePhoto& white : list.whites)
    require(!white.file.empty() && in(white.exposure_s, 1e-6, 1e6) && in(white.reflectance, 0.01, 1.2) &&
            in(white.cos_light, 0.0, 1.0));
  require(!list.photos.empty());
  for (const packs::PanelPhoto& photo : list.photos) check_photo(photo, list);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFile file;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  file.write(text);
  const auto list = packs::read_photo_list(file.path());
  if (list)
    check_list(*list);
  else
    require(list.error().file == file.path() && !list.error().field.empty() && !list.error().what.empty());
  return 0;
}
