#include "core/analysis/angular_life.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "core/gaussian.hpp"

namespace lackwerk::core {
namespace {

/// Hermite terms looked at. The half width lies where r is below 0.9, where 0.9^160 = 5e-8 is left of the next one.
constexpr std::size_t hermite_terms = 160;
constexpr int phases = 64;

using Spectrum = std::array<double, hermite_terms>;  ///< a_n^2 / variance for n = 1, 2, ...

/// E[1{g > z} He_n(g)] = phi(z) He_(n-1)(z), with He_n / sqrt(n!) by their recursion. Texels of equal L share a step.
/// All zero where all texels are equal.
Spectrum spectrum_of(const std::vector<LabCuboid>& clusters) {
  std::vector<std::pair<double, std::uint64_t>> steps;  // L, count
  std::uint64_t total = 0;
  for (const LabCuboid& cluster : clusters) {
    steps.emplace_back(0.5 * (static_cast<double>(cluster.lo.x) + static_cast<double>(cluster.hi.x)), cluster.count);
    total += cluster.count;
  }
  std::sort(steps.begin(), steps.end());
  const auto luminance = [](double lightness) { return lab_inverse((lightness + 16.0) / 116.0); };
  std::array<double, hermite_terms> a{};
  double mean = 0.0, square = 0.0;
  std::uint64_t below = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double y = luminance(steps[k].first);
    const double p = static_cast<double>(steps[k].second) / static_cast<double>(total);
    mean += p * y;
    square += p * y * y;
    if (k > 0) {
      const double rise = y - luminance(steps[k - 1].first);
      const double z = normal_quantile(static_cast<double>(below) / static_cast<double>(total));
      const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
      double last = 0.0, here = 1.0;  // He_(n-2), He_(n-1), normalised
      for (std::size_t n = 1; n <= hermite_terms; ++n) {
        const double order = static_cast<double>(n);
        a[n - 1] += rise * density * here / std::sqrt(order);
        const double next = (z * here - std::sqrt(order - 1.0) * last) / std::sqrt(order);
        last = here;
        here = next;
      }
    }
    below += steps[k].second;
  }
  const double variance = square - mean * mean;
  Spectrum out{};
  if (!(variance > 1e-12 * square)) return out;
  for (std::size_t n = 0; n < hermite_terms; ++n) out[n] = a[n] * a[n] / variance;
  return out;
}

/// Correlation of flake_gaussian's values at `at` and `at + lag` cells, 0 <= at < 1.
double cell_correlation(double at, double lag) {
  const auto weight = [](double place, int cell) {  // of cell number `cell` at `place`
    const double away = std::abs(place - cell);
    return away < 1.0 ? std::cos(0.5 * std::numbers::pi * away) : 0.0;
  };
  return weight(at, 0) * weight(at + lag, 0) + weight(at, 1) * weight(at + lag, 1);
}

double mean_correlation(const Spectrum& spectrum, double lag) {
  double sum = 0.0;
  for (int k = 0; k < phases; ++k) {
    const double r = cell_correlation((k + 0.5) / phases, lag);
    double power = 1.0;
    for (const double part : spectrum) sum += part * (power *= r);
  }
  return sum / phases;
}

}  // namespace

double texel_correlation(std::span<const float> a, std::span<const float> b) {
  check_equal(a.size(), b.size(), "texels of two pictures");
  double sum_a = 0.0, sum_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto x = static_cast<double>(a[k]), y = static_cast<double>(b[k]);
    sum_a += x;
    sum_b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const double n = std::max(static_cast<double>(a.size()), 1.0);
  const double variance_a = aa / n - sum_a / n * (sum_a / n), variance_b = bb / n - sum_b / n * (sum_b / n);
  if (!(variance_a > 1e-12 * aa / n) || !(variance_b > 1e-12 * bb / n)) return 0.0;
  return std::clamp((ab / n - sum_a / n * (sum_b / n)) / std::sqrt(variance_a * variance_b), -1.0, 1.0);
}

LifeCurve life_curve(std::span<const std::vector<float>> pictures, double step_deg, std::size_t starts) {
  check_at_most(std::size_t{1}, starts, "starts of a life curve");
  check_at_most(starts + 1, pictures.size(), "pictures of a life curve");
  const auto flat = [](const std::vector<float>& picture) {
    return std::all_of(picture.begin(), picture.end(), [&](float v) { return v == picture.front(); });
  };
  LifeCurve out{step_deg, {1.0}};
  for (std::size_t lag = 1; starts + lag <= pictures.size(); ++lag) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t start = 0; start < starts; ++start) {
      if (flat(pictures[start]) || flat(pictures[start + lag])) continue;
      sum += texel_correlation(pictures[start], pictures[start + lag]);
      ++count;
    }
    if (count == 0) break;
    out.correlation.push_back(sum / count);
  }
  return out;
}

double half_width_deg(const LifeCurve& curve) {
  for (std::size_t k = 1; k < curve.correlation.size(); ++k) {
    if (curve.correlation[k] > 0.5) continue;
    const double before = curve.correlation[k - 1];
    return curve.step_deg * (static_cast<double>(k - 1) + (before - 0.5) / (before - curve.correlation[k]));
  }
  return double{widest_cell_deg};
}

double half_width_in_cells(std::span<const std::vector<LabCuboid>> slices) {
  Spectrum mean{};
  double contrast = 0.0;
  for (const std::vector<LabCuboid>& slice : slices) {
    const Spectrum one = spectrum_of(slice);
    for (std::size_t n = 0; n < hermite_terms; ++n) mean[n] += one[n] / static_cast<double>(slices.size());
  }
  for (const double part : mean) contrast += part;
  if (!(contrast > 0.0)) return 1.0;
  for (double& part : mean) part /= contrast;
  double low = 0.0, high = 2.0;  // the correlation is 1 at 0 and 0 from 2 on, and falls
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (mean_correlation(mean, middle) > 0.5 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

FlakeLife fit_life(double half_h_deg, double half_i_deg, std::span<const std::vector<LabCuboid>> slices,
                   LifeOrigin origin) {
  const double cells = half_width_in_cells(slices);
  const auto width = [&](double half_deg) {
    if (half_deg >= double{widest_cell_deg}) return widest_cell_deg;
    return std::clamp(static_cast<float>(std::round(16.0 * half_deg / cells) / 16.0), 1.0f, widest_cell_deg);
  };
  return {width(half_h_deg), width(half_i_deg), origin};
}

}  // namespace lackwerk::core
