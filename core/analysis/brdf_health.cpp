#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/analysis/brdf_table.hpp"
#include "core/environment.hpp"

namespace lackwerk::core {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

namespace {

/// 85 and not 90: there a cosine is 0 and every error infinite.
constexpr std::array angles_deg{0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0};
/// Instruments see little beyond; what files hold there is mostly extrapolated.
constexpr double widest_pair_deg = 75.0;
constexpr std::size_t pair_count = 4096;

/// Over half vectors, theta_h = u^2 pi/2 as in the table: half of the samples within 22.5 degrees of the normal and one
/// in 64 within 0.02, so that a peak is met. d omega_out = 4 (in.h) d omega_h.
dvec3 albedo(const Brdf& brdf, double theta_in, std::uint32_t samples) {
  const auto steps = static_cast<std::uint32_t>(std::max(std::sqrt(static_cast<double>(samples)), 4.0));
  const dvec3 in(std::sin(theta_in), 0.0, std::cos(theta_in));
  dvec3 sum(0.0);
  for (std::uint32_t row = 0; row < steps; ++row) {
    const double u = (row + 0.5) / steps, theta = u * u * pi / 2.0;
    const double solid = std::sin(theta) * pi * u / steps * 2.0 * pi / steps;  // d theta = pi u du
    for (std::uint32_t column = 0; column < steps; ++column) {
      const double phi = (column + 0.5) / steps * 2.0 * pi;
      const dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double in_h = glm::dot(in, h);
      const dvec3 out = 2.0 * in_h * h - in;
      if (in_h <= 0.0 || out.z <= 0.0) continue;
      sum += brdf(in, out) * (out.z * 4.0 * in_h * solid);
    }
  }
  return sum;
}

/// Point k of a sequence that fills [0, 1)^4 evenly: multiples of the powers of 1/g, g the root of g^5 = g + 1 (Roberts
/// 2018, "The unreasonable effectiveness of quasirandom sequences").
std::array<double, 4> even_point(std::size_t k) {
  constexpr double g = 1.1673039782614187;
  std::array<double, 4> out{};
  double power = 1.0;
  for (double& x : out) {
    power /= g;
    x = std::fmod(0.5 + power * static_cast<double>(k), 1.0);
  }
  return out;
}

/// Even over the solid angle within widest_pair_deg.
dvec3 direction(double u, double v) {
  const double cosine = 1.0 - u * (1.0 - std::cos(widest_pair_deg * pi / 180.0)),
               sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(2.0 * pi * v), sine * std::sin(2.0 * pi * v), cosine};
}

/// Luminance of f(in, out) and of f(out, in).
dvec2 both_ways(const Brdf& brdf, const DirectionPair& pair) {
  return {luminance_of(brdf(pair.in, pair.out)), luminance_of(brdf(pair.out, pair.in))};
}

void reciprocity(const Brdf& brdf, BrdfHealth& out) {
  std::vector<dvec2> both;
  double mean = 0.0;
  for (std::size_t k = 0; k < pair_count; ++k) {
    const auto u = even_point(k);
    both.push_back(both_ways(brdf, {direction(u[0], u[1]), direction(u[2], u[3])}));
    mean += (both.back().x + both.back().y) / (2.0 * static_cast<double>(pair_count));
  }
  std::vector<double> differences;
  for (const dvec2& pair : both) {
    if (std::min(pair.x, pair.y) > 1e-3 * mean)
      differences.push_back(std::abs(pair.x - pair.y) / std::max(pair.x, pair.y));
  }
  out.pairs = differences.size();
  if (differences.empty()) return;
  std::sort(differences.begin(), differences.end());
  for (const double d : differences) out.mean_reciprocity += d / static_cast<double>(differences.size());
  out.p95_reciprocity = differences[differences.size() * 95 / 100];
  out.worst_reciprocity = differences.back();
}

double weighted_reciprocity(const Brdf& brdf) {
  double difference = 0.0, larger = 0.0;
  for (const DirectionPair& pair : grid_pairs(pair_count)) {
    const dvec2 both = both_ways(brdf, pair);
    difference += std::abs(both.x - both.y);
    larger += std::max({both.x, both.y, 0.0});
  }
  return larger > 0.0 ? difference / larger : 0.0;
}

}  // namespace

std::vector<DirectionPair> grid_pairs(std::size_t count) {
  const double lowest = std::cos(widest_pair_deg * pi / 180.0);
  std::vector<DirectionPair> out;
  for (std::size_t k = 0; out.size() < count; ++k) {
    const auto u = even_point(k);
    const DirectionPair pair = directions({u[0] * u[0] * pi / 2.0, u[1] * pi / 2.0, u[2] * pi});
    if (pair.in.z >= lowest && pair.out.z >= lowest) out.push_back(pair);
  }
  return out;
}

BrdfHealth health(const Brdf& brdf, std::uint32_t samples_per_angle) {
  BrdfHealth out;
  for (const double angle : angles_deg) {
    out.theta_in_deg.push_back(angle);
    out.albedo.push_back(albedo(brdf, angle * pi / 180.0, samples_per_angle));
  }
  reciprocity(brdf, out);
  out.weighted_reciprocity = weighted_reciprocity(brdf);
  return out;
}

}  // namespace lackwerk::core
