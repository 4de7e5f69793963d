#include "packs/tools/car/cameras.hpp"

#include <glm/geometric.hpp>

namespace lackwerk::packs::car {

namespace {

/// About 60 mm of painted bonnet, seen from 150 mm along a slanted direction.
Camera macro_camera(const Field& body) {
  constexpr double eye_distance_mm = 150.0;
  constexpr float field_of_view_deg = 13.0f;
  const Vec3 spot = project_to_surface(body, {1560.0, 210.0, 890.0});
  const Vec3 eye = spot + glm::normalize(Vec3{0.58, 0.30, 0.75}) * eye_distance_mm;
  return {"macro", glm::vec3(eye), glm::vec3(spot), field_of_view_deg};
}

}  // namespace

std::vector<Camera> car_cameras(const Field& body) {
  // Eye heights of someone kneeling to photograph the car: a high eye makes any car look small.
  return {
      {"hero", {4620.0f, 3120.0f, 1020.0f}, {330.0f, -60.0f, 640.0f}, 28.0f},
      {"side", {0.0f, 6900.0f, 950.0f}, {0.0f, 0.0f, 690.0f}, 24.0f},
      {"rear", {-4650.0f, 3150.0f, 1200.0f}, {-380.0f, -60.0f, 640.0f}, 28.0f},
      {"front", {6900.0f, 0.0f, 880.0f}, {1000.0f, 0.0f, 660.0f}, 20.0f},
      {"rim", {2900.0f, 2500.0f, 800.0f}, {1080.0f, 880.0f, 560.0f}, 28.0f},
      macro_camera(body),
      {"stripe", {300.0f, 3900.0f, 1150.0f}, {-150.0f, 800.0f, 720.0f}, 30.0f},
  };
}

}  // namespace lackwerk::packs::car
