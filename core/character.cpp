#include "core/character.hpp"

#include <cmath>

#include "core/colour.hpp"
#include "core/in_plane.hpp"
#include "core/level0_paint.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

constexpr double light_deg = 45.0;

}  // namespace

std::array<glm::dvec3, 3> shop_colours(const InterpolatablePaint& paint, const Weights& weights) {
  const InterpolatablePaint near = level0_of(paint);
  RealisedPaint realised;
  realise(near, weights, realised);
  const AnalyticPaint analytic = realised.analytic;
  return shop_colours(near, analytic, mean_textures(near, realised));
}

std::array<glm::dvec3, 3> shop_colours(const InterpolatablePaint& paint, const AnalyticPaint& analytic,
                                       const PaintTextures& textures) {
  PaintModel<double> model;
  bind_model(paint, analytic, textures, model);
  std::array<glm::dvec3, 3> out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    constexpr double no_single_flakes = 0.0, level = 0.0;
    const glm::dvec3 factor = model.paint_factor({0.0, 0.0, 1.0}, in_plane_direction(light_deg),
                                                 in_plane_direction(eye_deg(light_deg, shop_angles_deg[k])),
                                                 glm::dvec2(0.0), level, no_single_flakes);
    out[k] = lab_from_linear(factor);
  }
  return out;
}

std::array<double, 3> shop_differences(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b) {
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = ciede2000(a[k], b[k]);
  return out;
}

double liveliness(const InterpolatablePaint& paint, const Weights& weights) {
  const InterpolatablePaint near = level0_of(paint);
  if (near.row_count() == 0) return 0.0;
  RealisedPaint realised;
  realise(near, weights, realised);
  // Slices are in the order of their angles: the first is the nearest to the mirror direction.
  const double step = (static_cast<double>(near.range.hi.x) - static_cast<double>(near.range.lo.x)) / 65535.0;
  double mass = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t t = near.tuple_begin[0]; t < near.tuple_begin[1]; ++t) {
    const auto& q = realised.corners[t - near.tuple_begin[0]].q;
    const double middle = 0.5 * step * (q[0] + q[1]);
    const double width = step * (q[1] - q[0]);
    mass += near.mass[t];
    sum += near.mass[t] * middle;
    squares += near.mass[t] * (middle * middle + width * width / 12.0);  // evenly spread in its box
  }
  if (mass == 0.0) return 0.0;
  const double mean = sum / mass;
  return std::sqrt(std::max(squares / mass - mean * mean, 0.0));
}

}  // namespace lackwerk::core
