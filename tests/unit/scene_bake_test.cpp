#include "packs/tools/scene_bake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "packs/tools/car/body_field.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/scene_detail.hpp"
#include "packs/tools/visibility_fit.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::uint32_t grid_edge = 5;

/// A grid of vertices from `corner` along two sides; the normal is their cross product.
MeshPart plate(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, SurfaceKind kind = SurfaceKind::trim,
               std::uint32_t edge = grid_edge) {
  MeshPart part;
  part.kind = kind;
  for (std::uint32_t k = 0; k < edge * edge; ++k) {
    const std::uint32_t column = k % edge, row = k / edge;
    const float s = static_cast<float>(column) / static_cast<float>(edge - 1);
    const float t = static_cast<float>(row) / static_cast<float>(edge - 1);
    part.positions_mm.push_back(corner + u * s + v * t);
    part.normals.push_back(glm::normalize(glm::cross(u, v)));
  }
  for (std::uint32_t y = 0; y + 1 < edge; ++y)
    for (std::uint32_t x = 0; x + 1 < edge; ++x) {
      const std::uint32_t k = y * edge + x;
      part.indices.insert(part.indices.end(), {k, k + 1, k + edge + 1, k, k + edge + 1, k + edge});
    }
  return part;
}

/// Two metres of level plate, one metre up.
MeshPart level_plate() { return plate({-1000, -1000, 1000}, {2000, 0, 0}, {0, 2000, 0}); }

/// A wall 20 m high and long at x = 5, facing -x: half of what the plate's middle sees.
MeshPart wall(SurfaceKind kind = SurfaceKind::trim) {
  return plate({5, 20000, -10000}, {0, -40000, 0}, {0, 0, 20000}, kind, 2);
}
constexpr std::size_t middle = grid_edge * grid_edge / 2;

double value_towards(const Visibility& visibility, const glm::dvec3& d) {
  const auto c = visibility_coefficients(visibility);
  const double v = c[0] + c[1] * d.x + c[2] * d.y + c[3] * d.z + c[4] * d.x * d.y + c[5] * d.y * d.z +
                   c[6] * d.z * d.x + c[7] * (d.x * d.x - d.y * d.y) + c[8] * (3.0 * d.z * d.z - 1.0);
  return std::clamp(v, 0.0, 1.0);
}

double irradiance_of(const Scene& scene, std::size_t part, std::size_t vertex, std::size_t channel) {
  const double root = scene.parts[part].irradiance[vertex][channel] / 65535.0;
  return root * root * static_cast<double>(scene.irradiance_range);
}

TEST(VisibilityFit, FramesAreOrthonormalAndTurnSmoothly) {
  for (int k = 0; k < 2000; ++k) {
    const double z = 1.0 - (k + 0.5) / 1000.0, angle = 2.4 * k, radius = std::sqrt(1.0 - z * z);
    const glm::dvec3 n(radius * std::cos(angle), radius * std::sin(angle), z);
    const NormalFrame frame = frame_around(n);
    EXPECT_NEAR(glm::length(glm::cross(frame.tangent, frame.bitangent) - n), 0.0, 1e-9);
    EXPECT_NEAR(glm::dot(frame.tangent, frame.bitangent), 0.0, 1e-9);
    if (z < -0.9) continue;
    const NormalFrame near = frame_around(glm::normalize(n + glm::dvec3(0.0, 0.0, 1e-6)));
    EXPECT_LT(glm::length(near.tangent - frame.tangent), 1e-4) << z;
  }
}

TEST(VisibilityFit, OpenIsExactAndQuadraticsComeBack) {
  const VisibilityFit fit(192);
  double share = 0.0;
  for (const auto& ray : fit.rays()) share += ray.share;
  EXPECT_NEAR(share, 1.0, 1e-12);
  const NormalFrame frame = frame_around(glm::normalize(glm::dvec3(0.3, -0.8, 0.2)));
  std::vector<float> seen(fit.rays().size(), 1.0f);
  EXPECT_EQ(fit.fit(seen, frame), open_visibility);
  // 0.5 + 0.2 x + 0.15 y z inside [0, 1]: only bytes and ridge stand between it and its fit.
  double worst = 0.0;
  const auto wanted = [](const glm::dvec3& d) { return 0.5 + 0.2 * d.x + 0.15 * d.y * d.z; };
  const auto in_scene = [&frame](const glm::dvec3& d) {
    return frame.tangent * d.x + frame.bitangent * d.y + frame.normal * d.z;
  };
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = static_cast<float>(wanted(in_scene(fit.rays()[i].direction)));
  const Visibility visibility = fit.fit(seen, frame);
  for (const auto& ray : fit.rays()) {
    const glm::dvec3 d = in_scene(ray.direction);
    worst = std::max(worst, std::abs(value_towards(visibility, d) - wanted(d)));
  }
  EXPECT_LT(worst, 0.04);
}

TEST(SceneBake, NothingAroundIsExactlyOpen) {
  Scene scene;
  scene.parts = {level_plate()};
  scene.environment = core::uniform_environment({0.5f, 1.0f, 2.0f});
  const BakeReport report = bake_scene(scene);
  EXPECT_EQ(report.vertices, scene.parts[0].positions_mm.size());
  EXPECT_EQ(report.fit_error_p95, 0.0);
  for (std::size_t v = 0; v < scene.parts[0].positions_mm.size(); ++v) {
    EXPECT_EQ(scene.parts[0].visibility[v], open_visibility);
    // The same radiance from everywhere is its own mean; the atlas holds it within its steps of 0.8 %.
    EXPECT_NEAR(irradiance_of(scene, 0, v, 0), 0.5, 0.01);
    EXPECT_NEAR(irradiance_of(scene, 0, v, 1), 1.0, 0.015);
    EXPECT_NEAR(irradiance_of(scene, 0, v, 2), 2.0, 0.03);
  }
}

TEST(SceneBake, AWallTakesItsHalf) {
  Scene scene;
  scene.parts = {level_plate(), wall()};
  bake_scene(scene);
  const Visibility& visibility = scene.parts[0].visibility[middle];
  for (const double height : {0.3, 0.8}) {
    EXPECT_LT(value_towards(visibility, glm::normalize(glm::dvec3(1.0, 0.0, height))), 0.2) << height;
    EXPECT_GT(value_towards(visibility, glm::normalize(glm::dvec3(-1.0, 0.0, height))), 0.8) << height;
  }
  EXPECT_NEAR(irradiance_of(scene, 0, middle, 1), 0.5, 0.05);
}

TEST(SceneBake, GlassFloorAndTheCoarseLevelBlockNothing) {
  Scene scene;
  scene.parts = {level_plate(), wall(SurfaceKind::glass), wall(SurfaceKind::floor), wall()};
  scene.parts[3].detail = detail_coarse;
  bake_scene(scene, {64});
  EXPECT_EQ(scene.parts[0].visibility[middle], open_visibility);
}

TEST(SceneBake, TheFloorIsDarkWhereTheCarStandsOnIt) {
  // The flank of a box that stands on the floor, looked at half a metre up.
  Scene scene;
  scene.parts = {plate({0, 1000, 0}, {0, -2000, 0}, {0, 0, 1000}), plate({0, -1000, 1000}, {2000, 0, 0}, {0, 2000, 0})};
  Scene with_floor = scene;
  with_floor.parts.push_back(plate({-3000, -3000, 0}, {6000, 0, 0}, {0, 6000, 0}, SurfaceKind::floor));
  bake_scene(scene);
  bake_scene(with_floor);
  EXPECT_EQ(scene.parts[0].visibility[middle], open_visibility);
  const Visibility& visibility = with_floor.parts[0].visibility[middle];
  const double steep = value_towards(visibility, glm::normalize(glm::dvec3(-0.3, 0.0, -1.0)));
  const double flat = value_towards(visibility, glm::normalize(glm::dvec3(-1.0, 0.0, -0.3)));
  EXPECT_LT(steep, 0.85);
  EXPECT_GT(flat, steep + 0.05);
  EXPECT_GT(value_towards(visibility, glm::dvec3(-1.0, 0.0, 0.0)), 0.85);
  // The floor itself sees the box; under it nothing.
  const MeshPart& floor = with_floor.parts[2];
  EXPECT_LT(value_towards(floor.visibility[middle + 1], glm::normalize(glm::dvec3(-0.2, 0.0, 1.0))), 1.0);
}

TEST(SceneBake, ThreadsDoNotChangeTheResult) {
  Scene one;
  one.parts = {plate({-1000, -1000, 500}, {2000, 0, 0}, {0, 2000, 0}, SurfaceKind::paint, 30), wall(),
               plate({-3000, -3000, 0}, {6000, 0, 0}, {0, 6000, 0}, SurfaceKind::floor)};
  Scene five = one;
  double last = 0.0;
  const BakeReport a = bake_scene(one, {48, 1}, [&last](double done) { last = done; });
  const BakeReport b = bake_scene(five, {48, 5});
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(a.fit_error_mean, b.fit_error_mean);
  EXPECT_EQ(one.irradiance_range, five.irradiance_range);
  for (std::size_t k = 0; k < one.parts.size(); ++k) {
    EXPECT_EQ(one.parts[k].visibility, five.parts[k].visibility);
    EXPECT_EQ(one.parts[k].irradiance, five.parts[k].irradiance);
  }
}

TEST(SceneDetail, CoarserKeepsVerticesBordersAndBakedValues) {
  MeshPart part = plate({0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, SurfaceKind::rim, 21);
  for (std::size_t v = 0; v < part.positions_mm.size(); ++v) {
    part.visibility.push_back(open_visibility);
    part.visibility.back()[8] = static_cast<std::uint8_t>(v % 250);
    part.irradiance.push_back({static_cast<std::uint16_t>(v), 1, 2});
  }
  const MeshPart coarse = coarser(part, {0, 0.1f});
  EXPECT_LT(coarse.indices.size(), part.indices.size() / 2);
  EXPECT_EQ(coarse.kind, SurfaceKind::rim);
  std::size_t on_border = 0;
  for (std::size_t v = 0; v < coarse.positions_mm.size(); ++v) {
    const auto found = std::find(part.positions_mm.begin(), part.positions_mm.end(), coarse.positions_mm[v]);
    ASSERT_NE(found, part.positions_mm.end());
    const auto original = static_cast<std::size_t>(found - part.positions_mm.begin());
    EXPECT_EQ(coarse.visibility[v], part.visibility[original]);
    EXPECT_EQ(coarse.irradiance[v], part.irradiance[original]);
    const glm::vec3& p = coarse.positions_mm[v];
    on_border += p.x == 0.0f || p.x == 1000.0f || p.y == 0.0f || p.y == 1000.0f ? 1 : 0;
  }
  EXPECT_EQ(on_border, 80u);
}

TEST(SceneDetail, SmallPartsServeBothLevels) {
  std::vector<MeshPart> parts;
  add_with_twin(parts, level_plate(), {0, 1.0f});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].detail, detail_full | detail_coarse);
  add_with_twin(parts, plate({0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, SurfaceKind::rim, 41), {0, 1.0f});
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[1].detail, detail_full);
  EXPECT_EQ(parts[2].detail, detail_coarse);
}

/// Degrees between interpolated normals of the paint and the body's own, the given share of the area being better.
double normal_error_deg(const Scene& scene, std::uint8_t level, double share) {
  const car::BodyShape shape;
  const car::BodyField body(shape);
  std::vector<std::pair<double, double>> errors;  // and areas
  double whole = 0.0;
  for (const MeshPart& part : scene.parts) {
    if (part.kind != SurfaceKind::paint || part.detail != level) continue;
    constexpr std::size_t every = 5;
    for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3 * every) {
      glm::dvec3 p[3], normal(0.0), at(0.0);
      bool on_body = true;  // mirrors and wheel lips are other shapes
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] = glm::dvec3(part.positions_mm[part.indices[k + c]]);
        const glm::dvec3 n(part.normals[part.indices[k + c]]);
        on_body = on_body && std::abs(body.value(p[c])) < 0.02 && glm::dot(car::unit_normal(body, p[c]), n) > 0.9999;
        normal += n;
        at += p[c] / 3.0;
      }
      if (!on_body) continue;
      const glm::dvec3 own = car::unit_normal(body, car::project_to_surface(body, at));
      const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
      errors.emplace_back(glm::degrees(glm::distance(glm::normalize(normal), own)), area);
      whole += area;
    }
  }
  std::sort(errors.begin(), errors.end());
  double run = 0.0;
  for (const auto& [error, area] : errors)
    if ((run += area) >= share * whole) return error;
  return 0.0;
}

TEST(SceneDetail, TheCarsCoarseLevelIsSmallAndStillMirrorsWell) {
  const Scene car = build_builtin_car();
  const std::size_t full = triangles_at(car, detail_full), coarse = triangles_at(car, detail_coarse);
  EXPECT_GT(full, 150'000u);
  EXPECT_GE(coarse, 50'000u);
  EXPECT_LE(coarse, 70'000u);
  const double fine_error = normal_error_deg(car, detail_full, 0.99);
  const double coarse_error = normal_error_deg(car, detail_coarse, 0.99);
  std::printf("%zu triangles, normals within %.2f degrees on 99 %% of the paint; coarse %zu, %.2f degrees\n", full,
              fine_error, coarse, coarse_error);
  EXPECT_LT(fine_error, 0.4);
  EXPECT_LT(coarse_error, 0.85);
  for (const MeshPart& part : car.parts) {
    if (part.kind != SurfaceKind::floor || part.detail != detail_full) continue;
    EXPECT_LE(part.indices.size() / 3, 12'000u);
    for (std::size_t k = 0; k < part.indices.size(); ++k) {  // edges along x and y under and round the car
      const glm::vec3& a = part.positions_mm[part.indices[k]];
      const glm::vec3& b = part.positions_mm[part.indices[k % 3 == 2 ? k - 2 : k + 1]];
      if (std::abs(a.x) < 2500.0f && std::abs(a.y) < 1120.0f && (a.x == b.x || a.y == b.y)) {
        ASSERT_LE(glm::distance(a, b), 60.01f);
      }
    }
  }
}

}  // namespace
}  // namespace lackwerk::packs
