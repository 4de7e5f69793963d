#include "core/flake_contrast.hpp"

#include <algorithm>
#include <cmath>

#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

double luminance(double lightness) {
  const double f = (lightness + 16.0) / 116.0;
  return std::max(f > lab_delta ? f * f * f : 3.0 * lab_delta * lab_delta * (f - 4.0 / 29.0), 0.0);
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments row_moments(const InterpolatablePaint& paint, const InterpolatablePaint::PaintPart& part, std::size_t row) {
  double first = 0.0, second = 0.0;
  for (std::size_t k = paint.tuple_begin[row]; k < paint.tuple_begin[row + 1]; ++k) {
    const QuantisedCuboid& box = part.clusters[part.cluster_begin[row] + part.tuple_cluster[k]];
    const double span = static_cast<double>(paint.range.hi.x - paint.range.lo.x) / 65535.0;
    const double lo = static_cast<double>(paint.range.lo.x) + span * box.q[0];
    const double hi = static_cast<double>(paint.range.lo.x) + span * box.q[1];
    // Simpson's rule over the cuboid's lightness.
    const double y0 = luminance(lo), y1 = luminance(0.5 * (lo + hi)), y2 = luminance(hi);
    first += paint.mass[k] * (y0 + 4.0 * y1 + y2) / 6.0;
    second += paint.mass[k] * (y0 * y0 + 4.0 * y1 * y1 + y2 * y2) / 6.0;
  }
  first /= paint.row_mass;
  second /= paint.row_mass;
  return {first, std::sqrt(std::max(second - first * first, 0.0))};
}

}  // namespace

std::vector<double> flake_contrast(const InterpolatablePaint& paint) {
  std::vector<double> contrast(paint.row_count() > 0 ? paint.level_count : 0, 0.0);
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  for (const auto& part : paint.paints) {
    double brightest = 0.0;
    for (std::size_t slice = 0; slice < slices && !contrast.empty(); ++slice)
      brightest = std::max(brightest, row_moments(paint, part, slice).mean);
    if (brightest <= 0.0) continue;
    for (std::size_t level = 0; level < contrast.size(); ++level)
      for (std::size_t slice = 0; slice < slices; ++slice)
        contrast[level] =
            std::max(contrast[level], row_moments(paint, part, level * slices + slice).deviation / brightest);
  }
  return contrast;
}

double calm_level(const std::vector<double>& contrast, double threshold) {
  for (std::size_t level = 0; level < contrast.size(); ++level) {
    if (contrast[level] >= threshold) continue;
    if (level == 0) return 0.0;
    // Contrast halves from level to level: linear in its logarithm.
    const double above = contrast[level - 1], below = std::max(contrast[level], 1e-6);
    return static_cast<double>(level) - 1.0 + std::log(above / threshold) / std::log(above / below);
  }
  return static_cast<double>(contrast.size());
}

}  // namespace lackwerk::core
