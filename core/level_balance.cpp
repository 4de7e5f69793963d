#include "core/level_balance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/colour.hpp"
#include "core/lanes.hpp"

namespace lackwerk::core {
namespace {

/// Share of other paints from which on a mix is fully corrected.
constexpr double full_share = 0.05;
/// Luminance that nobody sees beside a paint's own lobes: a hundred-thousandth of white.
constexpr double unseen = 1e-5;
constexpr double most_gain = 4.0;

/// Y of L's fraction (L + 16) / 116 (CIE 15:2004).
Four luminance(Four f) {
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
  constexpr std::size_t lanes = 4;
  FourDoubles sums{};
  std::uint64_t total = 0;
  const auto add = [&](const float* low, const float* high, const std::uint32_t* weight) {
    Four from, to;
    FourInts masses;
    std::memcpy(&from, low, sizeof from);
    std::memcpy(&to, high, sizeof to);
    std::memcpy(&masses, weight, sizeof masses);
    from = zero + step * from;
    to = zero + step * to;
    const Four simpson = luminance(from) + 4.0f * luminance(0.5f * (from + to)) + luminance(to);
    sums += __builtin_convertvector(masses, FourDoubles) * __builtin_convertvector(simpson, FourDoubles);
  };
  const std::size_t whole = lo.size() - lo.size() % lanes;
  for (std::size_t t = 0; t < whole; t += lanes) add(&lo[t], &hi[t], &mass[t]);
  if (whole < lo.size()) {
    // Lanes beyond the end have no mass.
    std::array<float, lanes> low{}, high{};
    std::array<std::uint32_t, lanes> weight{};
    for (std::size_t t = whole; t < lo.size(); ++t) {
      low[t - whole] = lo[t];
      high[t - whole] = hi[t];
      weight[t - whole] = mass[t];
    }
    add(low.data(), high.data(), weight.data());
  }
  for (const std::uint32_t one : mass) total += one;
  return total > 0 ? ((sums[0] + sums[1]) + (sums[2] + sums[3])) / (6.0 * static_cast<double>(total)) : 0.0;
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
  // Bounded before it is weighed: beside a row that is all but black the ratio is 1e5, and a strength of 1e-6, from
  // weights that sum to 1 + 1e-7, would be half of a gain.
  const double full =
      std::clamp((std::max(level0, 0.0) + unseen) / (std::max(row, 0.0) + unseen), 1.0 / most_gain, most_gain);
  return 1.0 + strength * (full - 1.0);
}

}  // namespace lackwerk::core
