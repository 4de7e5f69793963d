#include "render_gles/light_shares.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace lackwerk::gles {

double effective_parts(std::span<const core::EnvironmentLight> lights) {
  if (lights.empty()) return 1.0;
  // Even points on the sphere (a Fibonacci spiral): some thirty for each of 64 lights.
  constexpr int points = 2048;
  constexpr double golden_angle = std::numbers::pi * (3.0 - 2.23606797749979);
  std::vector<int> nearest(lights.size(), 0);
  for (int k = 0; k < points; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / points, radius = std::sqrt(1.0 - z * z), turn = golden_angle * k;
    const glm::vec3 d(glm::dvec3(radius * std::cos(turn), radius * std::sin(turn), z));
    const auto closest = std::max_element(lights.begin(), lights.end(), [&](const auto& a, const auto& b) {
      return glm::dot(a.direction, d) < glm::dot(b.direction, d);
    });
    ++nearest[static_cast<std::size_t>(closest - lights.begin())];
  }
  double squares = 0.0;
  for (const int count : nearest) squares += static_cast<double>(count) * count;
  return static_cast<double>(points) * points / squares;
}

float light_share(double m, double parts) {
  const double octaves = std::log2(std::max(m, core::min_roughness)) - 0.5 * std::log2(share_border / parts);
  const double x = std::clamp(octaves + 0.5, 0.0, 1.0);
  return static_cast<float>(x * x * (3.0 - 2.0 * x));
}

LightShares light_shares(const core::AnalyticPaint& paint, double flake_m, double parts) {
  // Bending by the coat spreads directions by its index near the normal.
  const double spread = paint.refraction_ior;
  LightShares shares{};
  shares.front() = light_share(0.5, parts);
  for (std::size_t k = 0; k < core::max_lobes; ++k) shares[k + 1] = light_share(paint.lobes[k].m * spread, parts);
  shares.back() = light_share(flake_m * spread, parts);
  return shares;
}

}  // namespace lackwerk::gles
