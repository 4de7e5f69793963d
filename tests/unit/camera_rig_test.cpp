// Where the eye may go: continuous from the room to the flakes, exact on the way back, never inside the car.
#include "kiosk/display/camera_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <random>

#include "packs/tools/car/body_field.hpp"
#include "packs/tools/car/cameras.hpp"

namespace lackwerk::kiosk {
namespace {

using packs::Camera;

const packs::car::BodyField& body() {
  static const packs::car::BodyField field{packs::car::BodyShape{}};
  return field;
}

CameraRig car_rig(Room room = {}) { return CameraRig(packs::car::car_cameras(body()), room); }

float apart(const Camera& a, const Camera& b) { return glm::length(a.eye_mm - b.eye_mm); }

/// A flake texel of the pack, mm, and a picture's height that a weak kiosk has.
constexpr double texel_mm = 0.1;
constexpr int least_height_px = 480;

TEST(CameraRig, StartsWithTheFirstCamera) {
  const CameraRig rig = car_rig();
  const Camera camera = rig.camera_at(rig.place());
  EXPECT_LT(apart(camera, rig.first()), 1e-2f);
  EXPECT_LT(glm::length(camera.target_mm - rig.first().target_mm), 1e-3f);
  EXPECT_TRUE(rig.is_usual());
}

TEST(CameraRig, ZoomingInEndsAtSingleFlakes) {
  CameraRig rig = car_rig();
  for (int k = 0; k < 100; ++k) rig.zoom(0.8);
  const Camera camera = rig.camera_at(rig.place());
  const double distance = glm::length(camera.eye_mm - camera.target_mm);
  const double pixel_mm = 2.0 * distance * std::tan(glm::radians(camera.vertical_fov_deg) / 2.0) / least_height_px;
  EXPECT_LE(pixel_mm, texel_mm / 2.0) << "at " << distance << " mm";
  EXPECT_GT(distance, 30.0);
}

TEST(CameraRig, ZoomingOutComesBackExactly) {
  CameraRig rig = car_rig();
  rig.orbit(97.0, 12.0);
  rig.zoom(0.9);
  const Camera before = rig.camera_at(rig.place());
  for (int k = 0; k < 12; ++k) rig.zoom(0.75);
  EXPECT_GT(apart(before, rig.camera_at(rig.place())), 1000.0f);
  for (int k = 0; k < 12; ++k) rig.zoom(1.0 / 0.75);
  const Camera after = rig.camera_at(rig.place());
  EXPECT_LT(apart(before, after), 0.01f);
  EXPECT_LT(glm::length(before.target_mm - after.target_mm), 0.01f);
}

TEST(CameraRig, NamedCamerasAreThemselves) {
  for (const Camera& named : packs::car::car_cameras(body())) {
    CameraRig rig = car_rig();
    const Camera* chosen = rig.choose(named.name);
    ASSERT_NE(chosen, nullptr);
    EXPECT_EQ(chosen->eye_mm, named.eye_mm);
    // And the place found for it is there, so that a finger moves it without a jump.
    const Camera camera = rig.camera_at(rig.place());
    EXPECT_LT(apart(camera, named), 0.05f) << named.name;
    EXPECT_LT(glm::length(camera.target_mm - named.target_mm), 0.5f) << named.name;
    EXPECT_NEAR(camera.vertical_fov_deg, named.vertical_fov_deg, 0.01) << named.name;
  }
  CameraRig rig = car_rig();
  EXPECT_EQ(rig.choose("nowhere"), nullptr);
  EXPECT_NE(rig.choose("rim"), nullptr);
  EXPECT_FALSE(rig.is_usual());
  EXPECT_NE(rig.choose("hero"), nullptr);
  EXPECT_TRUE(rig.is_usual());
}

TEST(CameraRig, NeverInsideTheCarUnderTheFloorOrFarAway) {
  const CameraRig rig = car_rig();
  const double home = glm::length(rig.first().eye_mm - rig.first().target_mm);
  std::mt19937 random(3);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int k = 0; k < 20000; ++k) {
    const double lo = CameraRig::farthest_closeness(), hi = rig.nearest_closeness();
    const RigPlace place{360.0 * unit(), -10.0 + 95.0 * unit(), lo + (hi - lo) * unit()};
    const Camera camera = rig.camera_at(place);
    const glm::dvec3 eye(camera.eye_mm);
    ASSERT_GT(body().value(eye), 0.0) << "azimuth " << place.azimuth_deg << ", elevation " << place.elevation_deg
                                      << ", closeness " << place.closeness;
    ASSERT_GE(eye.z, CameraRig::lowest_eye_mm - 0.01);
    ASSERT_LE(glm::length(eye), 3.2 * home);
    ASSERT_GT(glm::length(camera.eye_mm - camera.target_mm), 50.0f);
  }
}

// The eye's way in is sampled so finely that it cannot pass through a body panel unseen.
TEST(CameraRig, TheWayInIsContinuousFromEverySide) {
  const CameraRig rig = car_rig();
  for (int azimuth = 0; azimuth < 360; azimuth += 15)
    for (const double elevation : {-10.0, 4.0, 30.0, 85.0}) {
      constexpr int steps = 4000;
      const double whole = rig.nearest_closeness();
      Camera last = rig.camera_at({static_cast<double>(azimuth), elevation, 0.0});
      for (int k = 1; k <= steps; ++k) {
        const Camera now = rig.camera_at({static_cast<double>(azimuth), elevation, whole * k / steps});
        ASSERT_LT(apart(now, last), 16.0f) << azimuth << ", " << elevation << ", step " << k;
        ASSERT_LT(glm::length(now.target_mm - last.target_mm), 6.0f);
        ASSERT_LT(std::abs(now.vertical_fov_deg - last.vertical_fov_deg), 0.1f);
        ASSERT_GT(body().value(glm::dvec3(now.eye_mm)), 0.0);
        last = now;
      }
    }
}

TEST(CameraRig, OrbitingIsContinuousAtEveryDistance) {
  const CameraRig rig = car_rig();
  for (double part = 0.0; part <= 1.0; part += 0.05)
    for (const double elevation : {-5.0, 20.0, 60.0}) {
      const double closeness = part * rig.nearest_closeness();
      Camera last = rig.camera_at({0.0, elevation, closeness});
      for (int step = 1; step <= 3600; ++step) {
        const double azimuth = step / 10.0;
        const Camera now = rig.camera_at({azimuth, elevation, closeness});
        ASSERT_LT(apart(now, last), 0.01f * glm::length(glm::vec2(6000.0f, 6000.0f)))
            << azimuth << ", " << elevation << ", " << closeness;
        last = now;
      }
      EXPECT_LT(apart(last, rig.camera_at({0.0, elevation, closeness})), 1.0f) << "once round";
    }
}

TEST(CameraRig, AnOrbitGoesRoundTheHomeTarget) {
  CameraRig rig = car_rig();
  rig.orbit(90.0, 0.0);
  const Camera camera = rig.camera_at(rig.place());
  const glm::vec3 target = rig.first().target_mm;
  EXPECT_NEAR(glm::length(camera.eye_mm - target), glm::length(rig.first().eye_mm - target), 0.1f);
  rig.orbit(-90.0, 0.0);
  EXPECT_LT(apart(rig.camera_at(rig.place()), rig.first()), 0.1f);
  // The floor does not have to be turned back first.
  rig.orbit(0.0, -500.0);
  const float low = rig.camera_at(rig.place()).eye_mm.z;
  rig.orbit(0.0, 1.0);
  EXPECT_GT(rig.camera_at(rig.place()).eye_mm.z, low + 10.0f);
}

TEST(CameraRig, ARoomKeepsTheEyeIn) {
  const Room room{{0.0f, 0.0f, 1000.0f}, 7000.0f};
  CameraRig rig = car_rig(room);
  rig.zoom(100.0);
  for (int k = 0; k < 72; ++k) {
    rig.orbit(5.0, k < 36 ? 2.0 : -2.0);
    EXPECT_LT(glm::length(rig.camera_at(rig.place()).eye_mm - room.centre_mm), room.radius_mm);
  }
}

TEST(CameraRig, WithoutAMacroCameraTheShellIsTheNearest) {
  CameraRig rig({{"hero", {5000.0f, 0.0f, 1600.0f}, {0.0f, 0.0f, 600.0f}, 30.0f}});
  rig.zoom(1e-6);
  const Camera camera = rig.camera_at(rig.place());
  EXPECT_NEAR(glm::length(camera.eye_mm - camera.target_mm), CameraRig::shell_share * std::sqrt(26.0) * 1000.0, 1.0);
}

TEST(CameraRig, NonsenseIsBounded) {
  CameraRig rig = car_rig();
  rig.set_place({std::nan(""), 1e300, -1e300});
  EXPECT_EQ(rig.place().azimuth_deg, rig.home_place().azimuth_deg);
  EXPECT_EQ(rig.place().elevation_deg, CameraRig::highest_elevation_deg);
  EXPECT_EQ(rig.place().closeness, CameraRig::farthest_closeness());
}

}  // namespace
}  // namespace lackwerk::kiosk
