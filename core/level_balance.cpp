#include "core/level_balance.hpp"

#include <algorithm>
#include <cmath>

#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

/// Share of other paints from which on a mix is fully corrected.
constexpr double full_share = 0.05;
/// Luminance that nobody sees beside a paint's own lobes: a hundred-thousandth of white.
constexpr double unseen = 1e-5;
constexpr double most_gain = 4.0;

float luminance(float f) {
  constexpr auto toe = static_cast<float>(lab_delta);
  constexpr float slope = 3.0f * toe * toe, zero = 4.0f / 29.0f;
  return f > toe ? f * f * f : slope * (f - zero);
}

}  // namespace

double balance_strength(std::span<const double> lightness) {
  if (lightness.empty()) return 0.0;
  const auto most = std::max_element(lightness.begin(), lightness.end());
  double away = 0.0;
  for (auto w = lightness.begin(); w != lightness.end(); ++w) away += std::abs(*w - (w == most ? 1.0 : 0.0));
  return std::min(1.0, 0.5 * away / full_share);
}

double mean_luminance(std::span<const float> lo, std::span<const float> hi, std::span<const std::uint32_t> mass,
                      const LabRange& range) {
  const float step = (range.hi.x - range.lo.x) / (65535.0f * 116.0f);
  const float zero = (range.lo.x + 16.0f) / 116.0f;
  std::array<float, max_tuples_per_row> each;
  for (std::size_t t = 0; t < lo.size(); ++t) {
    const float from = zero + step * lo[t], to = zero + step * hi[t];
    each[t] = luminance(from) + 4.0f * luminance(0.5f * (from + to)) + luminance(to);
  }
  double sum = 0.0, total = 0.0;
  for (std::size_t t = 0; t < lo.size(); ++t) {
    sum += static_cast<double>(mass[t]) * static_cast<double>(each[t]);
    total += mass[t];
  }
  return total > 0.0 ? sum / (6.0 * total) : 0.0;
}

LabGain::LabGain(double gain, const LabRange& range) {
  const double root = std::cbrt(gain);
  const glm::dvec3 lo = range.lo, step = (glm::dvec3(range.hi) - lo) / 65535.0;
  // In units of the grid, v = lo + step q: what v -> r v + s is for q.
  const auto offset = [&](double r, double s, int axis) {
    // A grid without an extent holds one value, which nothing moves.
    return step[axis] > 0.0 ? static_cast<float>(((r - 1.0) * lo[axis] + s) / step[axis]) : 0.0f;
  };
  factor = static_cast<float>(root);
  lightness_offset = offset(root, 16.0 * (root - 1.0), 0);
  toe_factor = static_cast<float>(gain);
  toe_offset = offset(gain, 0.0, 0);
  brighter = gain > 1.0;
  colour_offset = {offset(root, 0.0, 1), offset(root, 0.0, 2)};
}

double row_gain(double level0, double row, double strength) {
  const double full = (std::max(level0, 0.0) + unseen) / (std::max(row, 0.0) + unseen);
  return std::clamp(1.0 + strength * (full - 1.0), 1.0 / most_gain, most_gain);
}

}  // namespace lackwerk::core
