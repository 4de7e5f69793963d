#include "core/analysis/brdf_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/analysis/reference_sampling.hpp"
#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

constexpr double deg = std::numbers::pi / 180.0;
constexpr double lamp_radius_deg = 4.0;
/// Rings of 6, 12, 18, 24 directions 1 degree apart: half vectors move by 0.5, less than the m of a clear coat (0.75).
constexpr int lamp_rings = 4;

glm::dvec3 direction(double from_eye_deg, double roll_deg) {
  const double s = std::sin(from_eye_deg * deg);
  return {s * std::cos(roll_deg * deg), s * std::sin(roll_deg * deg), std::cos(from_eye_deg * deg)};
}

void add_lamp(std::vector<SphereLight>& lights, const glm::dvec3& middle, double irradiance) {
  const ReferenceFrame frame(middle);
  const double each = irradiance / (1.0 + 3.0 * lamp_rings * (lamp_rings + 1.0));
  lights.push_back({middle, each});
  for (int ring = 1; ring <= lamp_rings; ++ring)
    for (int k = 0; k < 6 * ring; ++k)
      lights.push_back({frame.to_world(direction(lamp_radius_deg * ring / lamp_rings, 60.0 * k / ring)), each});
}

glm::dvec3 clipped(const glm::vec3& pixel) { return glm::clamp(glm::dvec3(pixel), 0.0, 1.0); }

/// 1 / the value that one counted pixel of a hundred exceeds in its largest channel.
float exposure_of(const SpherePicture& picture) {
  std::vector<float> largest;
  for (std::size_t k = 0; k < picture.pixels.size(); ++k)
    if (picture.mask[k] != 0) {
      const glm::vec3& p = picture.pixels[k];
      largest.push_back(std::max({p.x, p.y, p.z}));
    }
  const auto rank = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(largest.size() - 1));
  std::nth_element(largest.begin(), largest.begin() + rank, largest.end());
  const float white = largest[static_cast<std::size_t>(rank)];
  return white > 0.0f && std::isfinite(white) ? 1.0f / white : 1.0f;
}

}  // namespace

std::vector<SphereLight> sphere_lights() {
  std::vector<SphereLight> lights;
  add_lamp(lights, direction(40.0, 125.0), 0.6);
  add_lamp(lights, direction(60.0, -115.0), 0.25);
  add_lamp(lights, direction(115.0, -10.0), 0.15);
  return lights;
}

SpherePicture shade_brdf_sphere(const Brdf& brdf, int edge) {
  check_at_most(2, edge, "pixels of a sphere");
  check_at_most(edge, 4096, "pixels of a sphere");
  const std::vector<SphereLight> lights = sphere_lights();
  const std::size_t count = static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
  SpherePicture out{edge, std::vector<glm::vec3>(count, glm::vec3(0.0f)), std::vector<std::uint8_t>(count, 0)};
  for (int row = 0; row < edge; ++row) {
    for (int column = 0; column < edge; ++column) {
      const double x = (2.0 * column + 1.0) / edge - 1.0, y = 1.0 - (2.0 * row + 1.0) / edge;
      const double z2 = 1.0 - x * x - y * y;
      if (z2 <= 0.0) continue;
      const glm::dvec3 n(x, y, std::sqrt(z2));
      const ReferenceFrame frame(n);
      const auto to_local = [&](const glm::dvec3& v) {
        return glm::dvec3(glm::dot(frame.x, v), glm::dot(frame.y, v), glm::dot(n, v));
      };
      const glm::dvec3 eye = to_local({0.0, 0.0, 1.0});
      glm::dvec3 sum(0.0);
      for (const SphereLight& light : lights) {
        const glm::dvec3 in = to_local(light.direction);
        if (in.z > 0.0) sum += brdf(in, eye) * (in.z * light.irradiance * std::numbers::pi);
      }
      const std::size_t at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(edge) + static_cast<std::size_t>(column);
      out.pixels[at] = glm::vec3(sum);
      out.mask[at] = 1;
    }
  }
  return out;
}

SphereComparison compare_on_sphere(const Brdf& a, const Brdf& b, int edge) {
  SphereComparison out{shade_brdf_sphere(a, edge), shade_brdf_sphere(b, edge), {}, 0, 0.0, 0.0, 0.0};
  const float exposure = exposure_of(out.a);
  for (SpherePicture* picture : {&out.a, &out.b})
    for (glm::vec3& pixel : picture->pixels) pixel *= exposure;
  out.map.assign(out.a.pixels.size(), -1.0f);
  std::vector<float> differences;
  double sum = 0.0;
  for (std::size_t k = 0; k < out.map.size(); ++k) {
    if (out.a.mask[k] == 0) continue;
    const double d = ciede2000(lab_from_linear(clipped(out.a.pixels[k])), lab_from_linear(clipped(out.b.pixels[k])));
    out.map[k] = static_cast<float>(d);
    differences.push_back(out.map[k]);
    sum += d;
  }
  out.pixels = differences.size();
  std::sort(differences.begin(), differences.end());
  const double n = static_cast<double>(out.pixels);
  out.mean = sum / n;
  out.p95 = static_cast<double>(differences[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1]);
  out.max = static_cast<double>(differences.back());
  return out;
}

BrdfTable measured_like(const BrdfTable& table, const Brdf& brdf) {
  BrdfTable out(table.size());
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) {
    if (!table.value(cell)) continue;
    const DirectionPair pair = directions(table.middle(cell));
    if (pair.in.z > 0.0 && pair.out.z > 0.0) out.set(cell, glm::vec3(brdf(pair.in, pair.out)));
  }
  return out;
}

Brdf table_brdf(const BrdfTable& table, const Brdf& instead) {
  return [&table, &instead](const glm::dvec3& in, const glm::dvec3& out) {
    const auto value = table.at(in, out);
    return value ? *value : instead(in, out);
  };
}

}  // namespace lackwerk::core
