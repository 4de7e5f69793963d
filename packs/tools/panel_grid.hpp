// From a slanted photograph to square texels on the panel.
//
// Why it exists: all slices show the same flakes in the same place, and cameras see the panel foreshortened. Four
// points of the panel in the picture give the homography (the panel is flat); texels are averages over their own area.
// Pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "packs/tools/camera_picture.hpp"

namespace lackwerk::packs {

/// Panel millimetres to pixels. (0, 0) of pixels is the outer corner of the top left one, whose middle is (0.5, 0.5).
class PanelView {
 public:
  /// `corners_px`: where the rectangle's top left, top right, bottom right and bottom left are seen. Nothing where
  /// these do not run clockwise around a convex quadrilateral of at least 4 square pixels.
  [[nodiscard]] static std::optional<PanelView> of(const std::array<glm::dvec2, 4>& corners_px,
                                                   const glm::dvec2& panel_mm);
  [[nodiscard]] glm::dvec2 pixel(const glm::dvec2& mm) const;

 private:
  std::array<double, 8> h_{};  ///< Heckbert 1989, eq. 2.6 to 2.9: x = (h0 u + h1 v + h2) / (h6 u + h7 v + 1), y alike
  glm::dvec2 panel_mm_{1.0};
};

/// Square texels in the middle of the panel's rectangle.
struct PanelGrid {
  glm::dvec2 corner_mm{0.0};  ///< of the first texel
  double texel_mm = 0.05;
  std::uint32_t edge = 1;
};

/// A picture of the grid: rows from the top.
struct GridPicture {
  std::vector<glm::vec3> texels;
  std::vector<std::uint8_t> clipped;  ///< per texel: a clipped pixel has a part in it
  double coarsest_mm = 0.0;           ///< longest side of a pixel on the panel, at the grid's corners
};

/// Nothing where the grid leaves the picture. A texel is the average of the pixels over its area, four samples a pixel
/// along each axis. The same bytes for any number of threads.
[[nodiscard]] std::optional<GridPicture> resample(const CameraPicture& picture, const PanelView& view,
                                                  const PanelGrid& grid, int threads = 2);

}  // namespace lackwerk::packs
