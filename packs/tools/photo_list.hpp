// photos.toml: which photographs of a panel there are, and how they were taken.
//
// Why it exists: reading what was typed by hand and working on pictures are two things. docs/import.md lists the keys.
// Values; any thread. Only the list is read here, no picture.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/tools/camera_picture.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// A photograph of the white reference.
struct WhitePhoto {
  std::string id, file, dark;  ///< dark empty: the list's own
  double exposure_s = 1.0;     ///< exposure time, or anything in proportion to the light that got in
  double reflectance = 1.0;    ///< radiance factor of the white in this geometry, (0, 1.2]
  double cos_light = 0.0;      ///< of the light's angle on the white; 0: as in the photograph it belongs to
};

/// A photograph of the panel.
struct PanelPhoto {
  std::string file, dark;
  std::string place;  ///< "photo 3", for errors
  double exposure_s = 1.0;
  std::size_t white = 0;                        ///< index
  double theta_h_deg = 0.0, theta_i_deg = 0.0;  ///< inside the coat
  double cos_light = 1.0, cos_camera = 1.0;     ///< outside the coat
  std::array<glm::dvec2, 4> corners_px{};       ///< of the panel's rectangle, clockwise from the top left
};

struct PhotoList {
  Capture capture;  ///< identity, coat, layout, texel_mm, edge_texels
  CameraResponse response;
  std::array<glm::dvec3, 3> to_srgb{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};  ///< rows
  glm::dvec2 panel_mm{1.0};
  std::string dark;
  double base_quantile = 0.02;  ///< of the texels: what lies under the flakes
  bool fill_missing = true;     ///< false: slices beyond the last photographed one of a row are left out
  std::vector<WhitePhoto> whites;
  std::vector<PanelPhoto> photos;
};

/// Errors name line and key: unknown or missing keys, numbers out of range, a white that is not listed, angles that no
/// light reaches below the coat, texels that do not fit the panel. At most 512 photographs.
[[nodiscard]] Result<PhotoList> read_photo_list(const std::filesystem::path& file);

}  // namespace lackwerk::packs
