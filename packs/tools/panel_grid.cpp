#include "packs/tools/panel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "packs/tools/parallel.hpp"

namespace lackwerk::packs {
namespace {

/// Pixels are taken as squares of one colour, which blurs least; four samples along a pixel weigh its part of a texel
/// to an eighth of a pixel at either end.
constexpr double samples_per_pixel = 4.0;
constexpr int least_samples = 4, most_samples = 24;  ///< along one axis of a texel: 6 pixels a texel are plenty

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The four corners of the grid, in pixels, and how long a texel's sides are there.
struct Footprint {
  glm::dvec2 lowest{1e30}, highest{-1e30};
  double longest_px = 0.0, shortest_px = 1e30;
};
Footprint footprint(const PanelView& view, const PanelGrid& grid) {
  Footprint out;
  const double size = grid.texel_mm * grid.edge;
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) {
      const glm::dvec2 mm = grid.corner_mm + size * glm::dvec2(u, v);
      const glm::dvec2 p = view.pixel(mm);
      out.lowest = glm::min(out.lowest, p);
      out.highest = glm::max(out.highest, p);
      const double inward = grid.texel_mm;
      for (const glm::dvec2 step :
           {glm::dvec2(u > 0.0 ? -inward : inward, 0.0), glm::dvec2(0.0, v > 0.0 ? -inward : inward)}) {
        const double length = glm::distance(view.pixel(mm + step), p);
        out.longest_px = std::max(out.longest_px, length);
        out.shortest_px = std::min(out.shortest_px, length);
      }
    }
  }
  return out;
}

}  // namespace

std::optional<PanelView> PanelView::of(const std::array<glm::dvec2, 4>& c, const glm::dvec2& panel_mm) {
  constexpr double least_turn = 1.0;  // square pixels: no corner of a usable photograph is flatter
  for (std::size_t k = 0; k < 4; ++k)
    if (!(cross(c[(k + 1) % 4] - c[k], c[(k + 2) % 4] - c[(k + 1) % 4]) > least_turn)) return std::nullopt;
  const glm::dvec2 d1 = c[1] - c[2], d2 = c[3] - c[2], s = c[0] - c[1] + c[2] - c[3];
  const double det = cross(d1, d2);
  PanelView view;
  view.panel_mm_ = panel_mm;
  const double g = cross(s, d2) / det, h = cross(d1, s) / det;
  const glm::dvec2 u = c[1] - c[0] + g * c[1], v = c[3] - c[0] + h * c[3];
  view.h_ = {u.x, v.x, c[0].x, u.y, v.y, c[0].y, g, h};
  return view;
}

glm::dvec2 PanelView::pixel(const glm::dvec2& mm) const {
  const double u = mm.x / panel_mm_.x, v = mm.y / panel_mm_.y;
  const double w = h_[6] * u + h_[7] * v + 1.0;
  return {(h_[0] * u + h_[1] * v + h_[2]) / w, (h_[3] * u + h_[4] * v + h_[5]) / w};
}

std::optional<GridPicture> resample(const CameraPicture& picture, const PanelView& view, const PanelGrid& grid,
                                    int threads) {
  const Footprint seen = footprint(view, grid);
  if (!(seen.lowest.x >= 0.0 && seen.lowest.y >= 0.0 && seen.highest.x <= picture.width &&
        seen.highest.y <= picture.height))
    return std::nullopt;
  GridPicture out;
  const std::size_t edge = grid.edge;
  out.texels.resize(edge * edge);
  out.clipped.resize(edge * edge);
  out.coarsest_mm = grid.texel_mm / seen.shortest_px;
  const int samples =
      std::clamp(static_cast<int>(std::ceil(samples_per_pixel * seen.longest_px)), least_samples, most_samples);
  const auto pixel_at = [&](const glm::dvec2& mm) {
    const glm::dvec2 p = view.pixel(mm);
    const int x = std::clamp(static_cast<int>(p.x), 0, picture.width - 1);
    const int y = std::clamp(static_cast<int>(p.y), 0, picture.height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
  };
  for_each_index(edge, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < edge; ++column) {
      glm::dvec3 sum(0.0);
      bool clipped = false;
      for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
          const glm::dvec2 texel(static_cast<double>(column) + (i + 0.5) / samples,
                                 static_cast<double>(row) + (j + 0.5) / samples);
          const std::size_t k = pixel_at(grid.corner_mm + grid.texel_mm * texel);
          sum += glm::dvec3(picture.light[k]);
          clipped = clipped || picture.clipped[k] != 0;
        }
      }
      out.texels[row * edge + column] = glm::vec3(sum / static_cast<double>(samples * samples));
      out.clipped[row * edge + column] = clipped ? 1 : 0;
    }
  });
  return out;
}

}  // namespace lackwerk::packs
