// Sphere and capsule: bodies on which a paint can be judged without any styling.
#include <cmath>
#include <vector>

#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int rings_per_quarter = 40;
constexpr int around = 160;

/// A standing capsule; with length 0 it is a sphere. It rests on z = 0. Normals are exact.
car::Patch capsule(double radius, double length) {
  std::vector<double> angles;
  std::vector<double> shifts;
  for (int i = 0; i <= 2 * rings_per_quarter; ++i) {
    const double angle = pi * i / (2.0 * rings_per_quarter);
    if (i == rings_per_quarter && length > 0.0) {
      constexpr int cylinder_rings = 24;
      for (int k = 0; k <= cylinder_rings; ++k) {
        angles.push_back(angle);
        shifts.push_back(length * (0.5 - static_cast<double>(k) / cylinder_rings));
      }
    } else {
      angles.push_back(angle);
      shifts.push_back(i < rings_per_quarter ? 0.5 * length : (i > rings_per_quarter ? -0.5 * length : 0.0));
    }
  }
  const int columns = static_cast<int>(angles.size());
  const auto direction = [&](int r, int c) {
    const double turn = 2.0 * pi * r / around;
    const double polar = angles[static_cast<std::size_t>(c)];
    return car::Vec3{std::sin(polar) * std::cos(turn), -std::sin(polar) * std::sin(turn), std::cos(polar)};
  };
  car::Patch patch = car::grid(around + 1, columns, [&](int r, int c) {
    return direction(r, c) * radius + car::Vec3{0.0, 0.0, radius + 0.5 * length + shifts[static_cast<std::size_t>(c)]};
  });
  for (int r = 0; r <= around; ++r) {
    for (int c = 0; c < columns; ++c) patch.normals.push_back(direction(r, c));
  }
  return patch;
}

Scene subject(const std::string& name, float radius_mm, float length_mm) {
  Scene scene;
  scene.name = name;
  car::add_parts(scene.parts, capsule(radius_mm, length_mm), name, SurfaceKind::paint);
  const glm::vec3 middle{0.0f, 0.0f, radius_mm + 0.5f * length_mm};
  const float reach = radius_mm + 0.5f * length_mm;
  constexpr float hero_fov_deg = 28.0f;
  // Far enough that the whole subject fits the frame's height with some air: tan(14 deg) * 4.6 = 1.15.
  const float distance = reach * 4.6f;
  scene.cameras.push_back({"hero", middle + glm::vec3{distance * 0.94f, 0.0f, distance * 0.34f}, middle, hero_fov_deg});
  // About 60 mm of the surface, seen from 150 mm along a slanted direction.
  const glm::vec3 outward{0.76f, 0.0f, 0.65f};
  const glm::vec3 spot = middle + outward * radius_mm;
  scene.cameras.push_back({"macro", spot + glm::vec3{0.64f, 0.42f, 0.64f} * 150.0f, spot, 13.0f});
  return scene;
}

}  // namespace

Scene build_sphere(float radius_mm) { return subject("sphere", radius_mm, 0.0f); }

Scene build_capsule(float radius_mm, float length_mm) { return subject("capsule", radius_mm, length_mm); }

}  // namespace lackwerk::packs
