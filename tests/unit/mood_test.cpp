// The light of the showroom: what a visitor changes, and what comes by itself.
#include "kiosk/display/mood.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "kiosk/display/state.hpp"

namespace lackwerk::kiosk {
namespace {

packs::Camera camera(const char* name, float distance_mm, float fov_deg) {
  return {name, {distance_mm, 0.0f, 0.0f}, {}, fov_deg};
}

TEST(Mood, ByDayInTheStudioTheUsualCamerasHaveTheirUsualLight) {
  const packs::Camera hero = camera("hero", 5300.0f, 28.0f), macro = camera("macro", 150.0f, 13.0f),
                      stripe = camera("stripe", 3100.0f, 30.0f);
  for (const packs::Camera& from : {hero, macro, stripe})
    EXPECT_EQ(lighting_of(from, light_alone(0), 0.0), lighting_of(usual_mood(from.name))) << from.name;
}

TEST(Mood, ClosenessRisesSteadilyFromTheCarToTheFlakes) {
  double last = 0.0;
  EXPECT_EQ(closeness(camera("", 2000.0f, 28.0f)), 0.0);
  for (float distance = 2000.0f; distance > 50.0f; distance *= 0.99f) {
    const double now = closeness(camera("", distance, 28.0f));
    EXPECT_GE(now, last);
    EXPECT_LT(now - last, 0.02) << distance;
    last = now;
  }
  EXPECT_EQ(last, 1.0);
}

TEST(Mood, NothingJumpsOnTheWayInAndWhileDimming) {
  const auto differ = [](const gles::Lighting& a, const gles::Lighting& b) {
    const glm::vec3 none(0.0f);
    const glm::vec3 light_a = a.lights.empty() ? none : a.lights[0].radiance;
    const glm::vec3 light_b = b.lights.empty() ? none : b.lights[0].radiance;
    return std::max({glm::length(light_a - light_b), std::abs(a.environment_gain - b.environment_gain),
                     glm::length(a.backdrop - b.backdrop), std::abs(a.lamp_glow - b.lamp_glow)});
  };
  for (int light = 0; light < 3; ++light) {
    gles::Lighting before = lighting_of(camera("", 2000.0f, 28.0f), light_alone(light), 0.0);
    for (float distance = 2000.0f; distance > 50.0f; distance *= 0.99f) {
      const gles::Lighting now = lighting_of(camera("", distance, 28.0f), light_alone(light), 0.0);
      EXPECT_LT(differ(before, now), 0.05f) << light << " at " << distance;
      before = now;
    }
    for (double dimmer = 0.0; dimmer <= 1.0; dimmer += 0.01) {
      const gles::Lighting now = lighting_of(camera("", 50.0f, 28.0f), light_alone(light), dimmer);
      EXPECT_LT(differ(before, now), 0.05f) << light << " at " << dimmer;
      EXPECT_LE(now.environment_gain, before.environment_gain);
      before = now;
    }
  }
}

TEST(Mood, SharesBlendWithoutAJumpAndOneAloneIsThatLight) {
  const auto apart = [](const gles::Lighting& a, const gles::Lighting& b) {
    const auto light = [](const gles::Lighting& of) {
      return of.lights.empty() ? glm::vec3(0.0f) : of.lights[0].radiance;
    };
    return std::max({glm::length(light(a) - light(b)), std::abs(a.environment_gain - b.environment_gain),
                     glm::length(a.backdrop - b.backdrop), std::abs(a.lamp_glow - b.lamp_glow)});
  };
  for (const float distance : {5300.0f, 60.0f}) {
    const packs::Camera from = camera("", distance, 28.0f);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        std::array<double, 3> shares{};
        shares[static_cast<std::size_t>(a)] = 1.0;
        EXPECT_EQ(lighting_of(from, shares, 0.3), lighting_of(from, light_alone(a), 0.3));
        gles::Lighting before = lighting_of(from, light_alone(a), 0.3);
        constexpr int steps = 200;
        for (int k = 1; k <= steps; ++k) {
          const double t = static_cast<double>(k) / steps;
          shares = {};
          shares[static_cast<std::size_t>(a)] += 1.0 - t;
          shares[static_cast<std::size_t>(b)] += t;
          const gles::Lighting now = lighting_of(from, shares, 0.3);
          EXPECT_LT(apart(before, now), 0.05f) << a << " to " << b << " at " << t;
          before = now;
        }
        EXPECT_EQ(before, lighting_of(from, light_alone(b), 0.3));
      }
  }
}

TEST(Mood, EachLightIsAnotherOneAndNumbersOutsideAreTheNearest) {
  const packs::Camera hero = camera("hero", 5300.0f, 28.0f);
  EXPECT_NE(lighting_of(hero, light_alone(0), 0.0), lighting_of(hero, light_alone(1), 0.0));
  EXPECT_NE(lighting_of(hero, light_alone(1), 0.0), lighting_of(hero, light_alone(2), 0.0));
  EXPECT_EQ(lighting_of(hero, light_alone(-4), -1.0), lighting_of(hero, light_alone(0), 0.0));
  EXPECT_EQ(lighting_of(hero, light_alone(9), 2.0), lighting_of(hero, light_alone(2), 1.0));
}

}  // namespace
}  // namespace lackwerk::kiosk
