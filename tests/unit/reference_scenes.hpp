// Small scenes for the reference integrator, and what its tests ask of a picture.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "core/analysis/reference.hpp"
#include "packs/scene.hpp"

namespace lackwerk::core::testing {

/// Vertices and indices that outlive the spans of a ReferenceMesh.
struct Mesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint8_t> visibility;

  [[nodiscard]] ReferenceMesh spans(std::size_t material) const {
    return {positions, normals, visibility, indices, material};
  }
  void open_by(const packs::Visibility& bytes) {
    for (std::size_t k = 0; k < positions.size(); ++k) visibility.insert(visibility.end(), bytes.begin(), bytes.end());
  }
};

/// A square of edge 2 half_mm around `centre`, facing `normal`.
inline Mesh quad(const glm::vec3& centre, const glm::vec3& normal, float half_mm) {
  const glm::vec3 side = std::abs(normal.z) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  const glm::vec3 x = glm::normalize(glm::cross(side, normal)) * half_mm, y = glm::cross(normal, x);
  return {{centre - x - y, centre + x - y, centre + x + y, centre - x + y},
          std::vector<glm::vec3>(4, normal),
          {0, 1, 2, 0, 2, 3},
          {}};
}

inline Mesh sphere(const glm::vec3& centre, float radius_mm, int rings) {
  Mesh out;
  const int spokes = 2 * rings;
  for (int a = 0; a <= rings; ++a)
    for (int b = 0; b <= spokes; ++b) {
      const double t = std::numbers::pi * a / rings, p = 2.0 * std::numbers::pi * b / spokes;
      const glm::vec3 n(glm::dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
      out.positions.push_back(centre + n * radius_mm);
      out.normals.push_back(n);
    }
  const auto at = [&](int a, int b) { return static_cast<std::uint32_t>(a * (spokes + 1) + b); };
  for (int a = 0; a < rings; ++a)
    for (int b = 0; b < spokes; ++b) {
      const std::uint32_t i[] = {at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b), at(a + 1, b + 1), at(a, b + 1)};
      out.indices.insert(out.indices.end(), i, i + 6);
    }
  return out;
}

inline AnalyticPaint white() {
  AnalyticPaint out;
  out.diffuse = glm::dvec3(1.0);
  return out;
}

/// A dim room with a bright window and a faint floor; 4 m around a point 1 m above the floor.
inline Environment lit_room(float radius_mm = 4000.0f) {
  Environment out = uniform_environment(glm::vec3(1.0f));
  out.range = 16.0f;
  out.centre_mm = {0.0f, 0.0f, 1000.0f};
  out.room_radius_mm = radius_mm;
  const EnvironmentLevel& level = environment_levels[0];
  for (int y = -1; y <= level.edge; ++y)
    for (int x = -1; x <= level.edge; ++x) {
      const glm::dvec3 d = direction_from_octahedral({(std::clamp(x, 0, level.edge - 1) + 0.5) / level.edge,
                                                      (std::clamp(y, 0, level.edge - 1) + 0.5) / level.edge});
      glm::dvec3 radiance(0.15, 0.18, 0.22);
      if (d.z < -0.02) radiance = glm::dvec3(0.3, 0.28, 0.25) * -d.z;
      if (d.z > 0.35 && d.z < 0.7 && d.x > 0.2 && std::abs(d.y) < 0.4) radiance = glm::dvec3(12.0, 11.0, 9.0);
      encode_radiance(radiance, 16.0,
                      &out.atlas[4 * static_cast<std::size_t>((level.y + y) * environment_width + level.x + x)]);
    }
  return out;
}

inline ReferenceOptions options_of(int edge, int samples) {
  ReferenceOptions out;
  out.width = out.height = edge;
  out.samples = samples;
  out.threads = 1;
  return out;
}

inline ReferenceImage render(const ReferenceScene& scene, const ReferenceView& view, const ReferenceLighting& lighting,
                             const ReferenceOptions& options) {
  auto image = render_reference(scene, view, lighting, options);
  EXPECT_TRUE(image) << (image ? "" : image.error().line());
  return image ? std::move(*image) : ReferenceImage{};
}

/// The mean over the picture, and the standard error of that mean.
inline std::pair<glm::dvec3, glm::dvec3> overall(const ReferenceImage& image) {
  glm::dvec3 mean(0.0), variance(0.0);
  for (std::size_t k = 0; k < image.mean.size(); ++k) {
    mean += image.mean[k];
    variance += image.error[k] * image.error[k];
  }
  const auto n = static_cast<double>(image.mean.size());
  return {mean / n, glm::sqrt(variance) / n};
}

}  // namespace lackwerk::core::testing
