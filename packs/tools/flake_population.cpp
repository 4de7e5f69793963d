#include "packs/tools/flake_population.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lackwerk::packs {
namespace {

/// Steele, Lea & Flood 2014, SplitMix64: a counter in, 64 well mixed bits out.
std::uint64_t mixed_bits(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Normal quantile for p in (0, 1), absolute error below 4.5e-4 (Abramowitz & Stegun 26.2.23): plenty for flake sizes.
double normal_quantile(double p) {
  const double tail = std::min(p, 1.0 - p);
  const double t = std::sqrt(-2.0 * std::log(tail));
  const double z =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return p < 0.5 ? -z : z;
}

/// Diameter in micrometres at a quantile of the cut log-normal law.
double diameter_at(const FlakeRecipe& recipe, double p) {
  return std::min(recipe.diameter_um * std::exp(recipe.diameter_spread * normal_quantile(p)), recipe.diameter_max_um);
}

double fraction(double x) { return x - std::floor(x); }

/// Area of the disc left of x.
double disc_half_plane_area(double radius, double x) {
  const double t = std::clamp(x / radius, -1.0, 1.0);
  return radius * radius * (std::numbers::pi / 2.0 + std::asin(t) + t * std::sqrt(1.0 - t * t));
}

}  // namespace

FlakePopulation::Range FlakePopulation::tilts_between(double lo, double hi) const {
  // Flake k has 1 - exp(-tan^2/m^2) = (k + 0.5) / count.
  const double count = static_cast<double>(flakes.size());
  const auto rank = [&](double tilt) {
    if (tilt <= 0.0) return 0.0;
    if (tilt >= std::numbers::pi / 2.0) return count;
    const double t = std::tan(tilt) / roughness;
    return -std::expm1(-t * t) * count;
  };
  const double begin = std::max(rank(lo) - 2.0, 0.0);
  const double end = std::min(rank(hi) + 2.0, count);
  return {static_cast<std::size_t>(begin), static_cast<std::size_t>(std::max(end, begin))};
}

double expected_flakes(const FlakeRecipe& recipe, double area_mm2) {
  double mean_mm2 = 0.0;
  constexpr int samples = 4096;
  for (int k = 0; k < samples; ++k) {
    const double mm = diameter_at(recipe, (k + 0.5) / samples) * 1e-3;
    mean_mm2 += std::numbers::pi / 4.0 * mm * mm / samples;
  }
  return recipe.coverage * area_mm2 / mean_mm2;
}

FlakePopulation draw_flakes(const FlakeRecipe& recipe, double roughness, std::size_t count, std::uint32_t edge,
                            float texel_mm, std::uint64_t seed) {
  // 1/g and 1/g^2 of the plastic number g = 1.3247..., the best known pair for two more dimensions beside the index.
  constexpr double step_azimuth = 0.7548776662466927;
  constexpr double step_size = 0.5698402909980532;
  constexpr double to_unit = 0x1p-32;
  FlakePopulation out;
  out.roughness = roughness;
  out.flakes.resize(count);
  double area = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double index = static_cast<double>(k);
    // Guenther et al. 2005, 5.2: tan(theta) = m sqrt(-ln(1 - r)), here with r rising.
    const double r = (index + 0.5) / static_cast<double>(count);
    const double tangent = roughness * std::sqrt(-std::log1p(-r));
    const double azimuth = 2.0 * std::numbers::pi * fraction(0.5 + index * step_azimuth);
    const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
    const double mm = 1e-3 * diameter_at(recipe, std::clamp(fraction(0.5 + index * step_size), 1e-9, 1.0 - 1e-9));
    const std::uint64_t bits = mixed_bits(seed * 0x100000001u + k + 1);
    Flake& flake = out.flakes[k];
    flake.normal = glm::vec3(tangent * cosine * std::cos(azimuth), tangent * cosine * std::sin(azimuth), cosine);
    flake.x = static_cast<float>(static_cast<double>(bits >> 32) * to_unit * edge);
    flake.y = static_cast<float>(static_cast<double>(bits & 0xffffffffu) * to_unit * edge);
    flake.radius = static_cast<float>(0.5 * mm / static_cast<double>(texel_mm));
    area += std::numbers::pi * static_cast<double>(flake.radius) * static_cast<double>(flake.radius);
  }
  out.coverage = area / (static_cast<double>(edge) * edge);
  return out;
}

double tilt_density(double roughness, double cos_tilt) {
  if (cos_tilt <= 1e-6) return 0.0;
  const double c2 = cos_tilt * cos_tilt;
  const double m2 = roughness * roughness;
  return std::exp(-(1.0 - c2) / (c2 * m2)) / (std::numbers::pi * m2 * c2 * cos_tilt);
}

double disc_corner_area(double radius, double x, double y) {
  const double r2 = radius * radius;
  if (x <= -radius || y <= -radius) return 0.0;
  if (x >= radius) return disc_half_plane_area(radius, y);
  if (y >= radius) return disc_half_plane_area(radius, x);
  if (x * x + y * y >= r2) {  // the corner lies outside the disc
    if (x <= 0.0 && y <= 0.0) return 0.0;
    if (x > 0.0 && y > 0.0) {
      return disc_half_plane_area(radius, x) + disc_half_plane_area(radius, y) - std::numbers::pi * r2;
    }
    return x < 0.0 ? disc_half_plane_area(radius, x) : disc_half_plane_area(radius, y);
  }
  // Inside: from the disc's left rim to x, the chord's lower half plus the strip up to y where that is shorter.
  const double a = std::asin(x / radius);
  const double b = std::asin(y / radius);
  return x * y + 0.5 * (r2 * (a + b) + x * std::sqrt(r2 - x * x) + y * std::sqrt(r2 - y * y)) +
         r2 * std::numbers::pi / 4.0;
}

}  // namespace lackwerk::packs
