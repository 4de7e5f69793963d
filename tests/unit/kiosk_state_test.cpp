// The kiosk's state machine: events in, weights and camera out, nothing else.
#include "kiosk/display/state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <random>

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;

State make_state() {
  return {3,
          {{"hero", {5000.0f, 3000.0f, 1200.0f}, {0.0f, 0.0f, 600.0f}, 30.0f},
           {"macro", {900.0f, 900.0f, 1100.0f}, {800.0f, 800.0f, 900.0f}, 20.0f}}};
}

TEST(KioskState, StartsOnTheFirstPaintAndCamera) {
  const State state = make_state();
  EXPECT_EQ(state.weights().base, (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(state.camera().name, "hero");
}

TEST(KioskState, TheSameAgainIsNoChange) {
  State state = make_state();
  EXPECT_TRUE(state.apply({ControlKind::weights, {0, 1, 0}, {}}).weights);
  EXPECT_FALSE(state.apply({ControlKind::weights, {0, 1, 0}, {}}).any());
  EXPECT_FALSE(state.apply({ControlKind::camera, {}, "hero"}).any());
  EXPECT_FALSE(state.apply({ControlKind::orbit, {0, 0}, {}}).weights);
}

TEST(KioskState, GroupsMoveApart) {
  State state = make_state();
  EXPECT_TRUE(state.apply({ControlKind::flake_lightness, {0, 0, 1}, {}}).weights);
  EXPECT_EQ(state.weights().flake_lightness, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(state.weights().base, (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(state.weights().flake_colour, (std::vector<double>{1, 0, 0}));
}

TEST(KioskState, LightAndDimmerAreTheView) {
  State state = make_state();
  EXPECT_EQ(state.light(), 0);
  EXPECT_EQ(state.dimmer(), 0.0);
  EXPECT_TRUE(state.apply({ControlKind::light, {2}, {}}).view);
  EXPECT_FALSE(state.apply({ControlKind::light, {2}, {}}).any());
  EXPECT_TRUE(state.apply({ControlKind::dimmer, {0.25}, {}}).view);
  EXPECT_FALSE(state.apply({ControlKind::dimmer, {0.25}, {}}).any());
  EXPECT_EQ(state.light(), 2);
  EXPECT_EQ(state.dimmer(), 0.25);
}

TEST(KioskState, WhiteFlakesAreAWeightOfTheirOwn) {
  State state = make_state();
  EXPECT_TRUE(state.apply({ControlKind::flake_white, {0.5}, {}}).weights);
  EXPECT_EQ(state.weights().flake_white, 0.5);
  EXPECT_EQ(state.weights().base, (std::vector<double>{1, 0, 0}));
  EXPECT_FALSE(state.apply({ControlKind::flake_white, {0.5}, {}}).any());
  // Weights for all groups are the mix as measured.
  EXPECT_TRUE(state.apply({ControlKind::weights, {1, 0, 0}, {}}).weights);
  EXPECT_EQ(state.weights().flake_white, 0.0);
}

TEST(KioskState, HomeIsTheFirstCameraToTheLastBit) {
  State state = make_state();
  state.apply({ControlKind::orbit, {33, 7}, {}});
  state.apply({ControlKind::zoom, {0.3}, {}});
  EXPECT_TRUE(state.go_home().view);
  EXPECT_EQ(state.camera().eye_mm, make_state().camera().eye_mm);
  EXPECT_EQ(state.camera().target_mm, make_state().camera().target_mm);
  EXPECT_FALSE(state.go_home().any());
  EXPECT_TRUE(state.apply({ControlKind::camera, {}, "macro"}).view);
  EXPECT_EQ(state.camera().eye_mm, glm::vec3(900.0f, 900.0f, 1100.0f));
}

TEST(KioskState, NonsenseIsIgnored) {
  State state = make_state();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Control& event :
       {Control{ControlKind::weights, {1, 0}, {}}, Control{ControlKind::weights, {0.5, 0, 0}, {}},
        Control{ControlKind::weights, {nan, 0, 1}, {}}, Control{ControlKind::camera, {}, "none"},
        Control{ControlKind::zoom, {-1}, {}}, Control{ControlKind::orbit, {nan, 0}, {}},
        Control{ControlKind::light, {3}, {}}, Control{ControlKind::light, {-1}, {}},
        Control{ControlKind::light, {nan}, {}}, Control{ControlKind::dimmer, {1.5}, {}},
        Control{ControlKind::dimmer, {}, {}}, Control{ControlKind::flake_white, {-0.1}, {}},
        Control{ControlKind::flake_white, {nan}, {}}})
    EXPECT_FALSE(state.apply(event).any());
}

TEST(KioskState, ARandomWalkKeepsItsPromises) {
  State state = make_state();
  std::mt19937 random(7);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int k = 0; k < 100000; ++k) {
    const double a = unit(), b = unit() * (1 - a);
    switch (random() % 5) {
      case 0:
        state.apply({ControlKind::weights, {a, b, 1 - a - b}, {}});
        break;
      case 1:
        state.apply({ControlKind::flake_lightness, {a, 1 - a, 0}, {}});
        break;
      case 2:
        state.apply({ControlKind::orbit, {720 * (a - 0.5), 90 * (b - 0.5)}, {}});
        break;
      case 3:
        state.apply({ControlKind::zoom, {0.2 + 3 * a}, {}});
        break;
      default:
        state.apply({ControlKind::camera, {}, a < 0.5 ? "hero" : "macro"});
        break;
    }
    const auto& w = state.weights().base;
    ASSERT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-6);
    ASSERT_GE(state.camera().eye_mm.z, 59.9f);
    const float distance = glm::length(state.camera().eye_mm - state.camera().target_mm);
    ASSERT_TRUE(std::isfinite(distance) && distance > 1.0f);
  }
}

}  // namespace
}  // namespace lackwerk::kiosk
