#include "kiosk/display/framing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

namespace lackwerk::kiosk {
namespace {

const packs::Camera hero{"hero", {4200.0f, -3900.0f, 1300.0f}, {0.0f, 0.0f, 600.0f}, 28.0f};

/// Where a place comes to lie, in half widths and half heights from the middle, up and right positive.
glm::vec2 seen(const gles::View& view, int width, int height, glm::vec3 place) {
  const glm::mat4 clip = glm::perspective(glm::radians(view.vertical_fov_deg),
                                          static_cast<float>(width) / static_cast<float>(height), 10.0f, 1e5f) *
                         glm::lookAt(view.eye_mm, view.target_mm, {0.0f, 0.0f, 1.0f});
  const glm::vec4 at = clip * glm::vec4(place, 1.0f);
  return {at.x / at.w, at.y / at.w};
}

TEST(Framing, APictureOfItsOwnShapeIsTheCameras) {
  EXPECT_EQ(framed(hero, 1920, 1080, KeepFree::nothing), gles::View::from(hero));
  EXPECT_EQ(framed(hero, 2560, 1080, KeepFree::nothing), gles::View::from(hero));
}

TEST(Framing, AnUprightPanelShowsNearlyTheWholeWidth) {
  const glm::vec3 right = glm::normalize(glm::cross(hero.target_mm - hero.eye_mm, {0.0f, 0.0f, 1.0f}));
  const glm::vec3 beside = hero.target_mm + right * 1500.0f;
  const float wide = seen(framed(hero, 1920, 1080, KeepFree::nothing), 1920, 1080, beside).x;
  for (const auto& [width, height] : {std::array{1080, 1920}, {800, 1280}, {720, 1280}}) {
    const float upright = seen(framed(hero, width, height, KeepFree::nothing), width, height, beside).x;
    EXPECT_NEAR(upright, wide / 0.88f, 0.01f) << width;
  }
  const float square = seen(framed(hero, 1000, 1000, KeepFree::nothing), 1000, 1000, beside).x;
  EXPECT_NEAR(square, wide, 0.01f);
}

TEST(Framing, TheCarMakesRoomForTheInterface) {
  const glm::vec2 lying = seen(framed(hero, 1280, 720, KeepFree::interface), 1280, 720, hero.target_mm);
  EXPECT_NEAR(lying.x, -0.05f, 0.01f);
  EXPECT_NEAR(lying.y, 0.09f, 0.01f);
  const glm::vec2 upright = seen(framed(hero, 1080, 1920, KeepFree::interface), 1080, 1920, hero.target_mm);
  EXPECT_NEAR(upright.x, 0.0f, 0.01f);
  EXPECT_NEAR(upright.y, 0.2f, 0.04f);  // a wide view is turned, not shifted
}

TEST(Framing, NoPanelIsTooNarrow) {
  for (int width = 16; width <= 8192; width *= 2)
    for (int height = 16; height <= 8192; height *= 2) {
      const gles::View view = framed(hero, width, height, KeepFree::interface);
      EXPECT_GE(view.vertical_fov_deg, hero.vertical_fov_deg);
      EXPECT_LE(view.vertical_fov_deg, 100.0f);
      EXPECT_TRUE(std::isfinite(view.target_mm.x + view.target_mm.y + view.target_mm.z));
    }
}

TEST(Framing, WhatFitsASquareFitsEveryPanel) {
  const packs::Camera camera{"scans", {0.0f, -2000.0f, 400.0f}, {0.0f, 0.0f, 400.0f}, 30.0f};
  // A place at the rim of the square, to the right: it is within the picture, and as far out as the shorter edge is.
  const float rim = 0.95f * 2000.0f * std::tan(glm::radians(15.0f));
  for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}, {720, 720}, {720, 1280}, {1080, 1920}}) {
    const gles::View view = framed_square(camera, width, height, KeepFree::nothing);
    const glm::vec2 right = seen(view, width, height, glm::vec3(rim, 0.0f, 400.0f));
    const glm::vec2 middle = seen(view, width, height, glm::vec3(0.0f, 0.0f, 400.0f));
    const double shorter = std::min(width, height);
    EXPECT_NEAR((right.x - middle.x) * width, 0.95 * shorter, 2.0) << width << "x" << height;
    // For the interface it stands higher.
    const glm::vec2 raised =
        seen(framed_square(camera, width, height, KeepFree::interface), width, height, glm::vec3(0.0f, 0.0f, 400.0f));
    EXPECT_NEAR(std::abs(raised.y - middle.y), 0.08, 0.01);
  }
}

}  // namespace
}  // namespace lackwerk::kiosk
