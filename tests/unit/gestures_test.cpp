// What fingers and knobs mean, at every mounting of the panel.
#include "kiosk/display/gestures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "input/source.hpp"
#include "kiosk/display/morph_path.hpp"
#include "kiosk/display/state.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;
using Weights = std::vector<double>;

constexpr std::array<int, 2> panel_px{1600, 900};

/// Fingers by where they touch the picture as it is seen.
class Hand {
 public:
  explicit Hand(Rotation rotation = Rotation::none, std::size_t paints = 3)
      : gestures(paints, "hero"), rotation_(rotation) {
    gestures.set_rotation(rotation, panel_px);
  }

  std::vector<Control> down(int contact, Point picture) { return send(ControlKind::touch_down, contact, picture); }
  std::vector<Control> move(int contact, Point picture) { return send(ControlKind::touch_move, contact, picture); }
  std::vector<Control> up(int contact) { return gestures.take({ControlKind::touch_up, {}, {}, contact, now_us}); }
  std::vector<Control> cancel(int contact) {
    return gestures.take({ControlKind::touch_cancel, {}, {}, contact, now_us});
  }
  std::vector<Control> tap(Point picture, std::uint64_t held_us = 80'000) {
    auto meant = down(0, picture);
    now_us += held_us;
    for (Control& control : up(0)) meant.push_back(std::move(control));
    return meant;
  }
  std::vector<Control> turn(double detents) { return gestures.take({ControlKind::turn, {detents}, "dial", 0, now_us}); }
  std::vector<Control> button(ControlKind kind, double number = 0.0) {
    return gestures.take({kind, {number}, "dial", 0, now_us});
  }

  Gestures gestures;
  std::uint64_t now_us = 1'000'000;

 private:
  std::vector<Control> send(ControlKind kind, int contact, Point picture) {
    const Point at = panel_point(rotation_, picture);
    return gestures.take({kind, {at[0], at[1]}, {}, contact, now_us});
  }
  Rotation rotation_;
};

class GesturesAt : public testing::TestWithParam<Rotation> {
 protected:
  /// Width over height of the picture.
  [[nodiscard]] static double aspect() {
    const auto size = picture_size(GetParam(), panel_px);
    return static_cast<double>(size[0]) / size[1];
  }
};

INSTANTIATE_TEST_SUITE_P(Mountings, GesturesAt,
                         testing::Values(Rotation::none, Rotation::quarter, Rotation::half, Rotation::three_quarters),
                         [](const auto& info) { return std::to_string(degrees_of(info.param)); });

TEST_P(GesturesAt, TheSliderIsUnderTheFinger) {
  Hand hand(GetParam());
  auto meant = hand.down(0, {0.5, 0.9});
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::weights);
  ASSERT_EQ(meant[0].values.size(), 3u);
  EXPECT_NEAR(meant[0].values[1], 1.0, 1e-9) << "a tap is enough";
  EXPECT_EQ(meant[0].time_us, hand.now_us);
  meant = hand.move(0, {slider_margin + 0.75 * (1.0 - 2.0 * slider_margin), 0.9});
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_NEAR(meant[0].values[1], 0.5, 1e-9);
  EXPECT_NEAR(meant[0].values[2], 0.5, 1e-9);
  EXPECT_NEAR(hand.gestures.morph_position(), 1.5, 1e-9);
  // Its ends are reached before the frame is, and a finger that leaves the strip upwards still slides.
  EXPECT_EQ(hand.move(0, {0.01, 0.2})[0].values, (Weights{1, 0, 0}));
  EXPECT_EQ(hand.move(0, {0.99, 0.5})[0].values, (Weights{0, 0, 1}));
  EXPECT_TRUE(hand.up(0).empty());
}

TEST_P(GesturesAt, OneFingerOrbitsTheSameAngleAPixelBothWays) {
  Hand hand(GetParam());
  EXPECT_TRUE(hand.down(0, {0.3, 0.4}).empty());
  double azimuth = 0.0, elevation = 0.0;
  for (int k = 1; k <= 10; ++k)
    for (const Control& control : hand.move(0, {0.3 + 0.02 * k, 0.4 + 0.01 * k})) {
      ASSERT_EQ(control.kind, ControlKind::orbit);
      azimuth += control.values[0];
      elevation += control.values[1];
    }
  // A little is lost while the finger rests.
  const double way = std::hypot(0.2, 0.1 / aspect());
  const double lost = rest_share * std::min(1.0, 1.0 / aspect()) / way;
  EXPECT_NEAR(azimuth, -0.2 * orbit_degrees_a_width * (1.0 - lost), 1e-6);
  EXPECT_NEAR(elevation, 0.1 / aspect() * orbit_degrees_a_width * (1.0 - lost), 1e-6);
}

TEST_P(GesturesAt, TwoFingersZoomByTheRatioOfTheirDistances) {
  Hand hand(GetParam());
  EXPECT_TRUE(hand.down(0, {0.4, 0.4}).empty());
  EXPECT_TRUE(hand.down(1, {0.6, 0.4}).empty());
  double factor = 1.0, azimuth = 0.0, elevation = 0.0;
  const auto add = [&](const std::vector<Control>& meant) {
    for (const Control& control : meant) {
      if (control.kind == ControlKind::zoom) factor *= control.values[0];
      if (control.kind == ControlKind::orbit) azimuth += control.values[0];
      if (control.kind == ControlKind::orbit) elevation += control.values[1];
    }
  };
  for (int k = 1; k <= 20; ++k) {
    add(hand.move(0, {0.4 - 0.01 * k, 0.4}));
    add(hand.move(1, {0.6 + 0.01 * k, 0.4}));
  }
  EXPECT_NEAR(factor, 0.2 / 0.6, 1e-9) << "three times as far apart: three times as near";
  EXPECT_NEAR(azimuth, 0.0, 1e-9);
  EXPECT_NEAR(elevation, 0.0, 1e-9);
  // Both fingers the same way: no zoom in the end, and the orbit of one finger that goes that way.
  factor = 1.0;
  for (int k = 1; k <= 20; ++k) {
    add(hand.move(0, {0.2, 0.4 + 0.01 * k}));
    add(hand.move(1, {0.8, 0.4 + 0.01 * k}));
  }
  EXPECT_NEAR(factor, 1.0, 1e-9);
  EXPECT_NEAR(elevation, 0.2 / aspect() * orbit_degrees_a_width, 1e-6);
}

TEST_P(GesturesAt, TwoTapsGoHome) {
  Hand hand(GetParam());
  EXPECT_TRUE(hand.tap({0.5, 0.4}).empty());
  hand.now_us += 150'000;
  const auto meant = hand.tap({0.51, 0.41});
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::camera);
  EXPECT_EQ(meant[0].name, "hero");
  // A third tap is a first one again.
  hand.now_us += 150'000;
  EXPECT_TRUE(hand.tap({0.51, 0.41}).empty());
}

TEST(Gestures, TapsThatAreNoDoubleTap) {
  const Point here{0.5, 0.4};
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += double_tap_us + 1;
    EXPECT_TRUE(hand.tap(here).empty()) << "too late";
  }
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.tap({0.6, 0.4}).empty()) << "elsewhere";
  }
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.tap(here, tap_us + 1).empty()) << "held";
  }
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.down(0, here).empty());
    EXPECT_TRUE(hand.cancel(0).empty()) << "cancelled";
    EXPECT_TRUE(hand.up(0).empty());
  }
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.down(0, here).empty());
    for (const Control& control : hand.move(0, {0.6, 0.4})) EXPECT_EQ(control.kind, ControlKind::orbit);
    EXPECT_TRUE(hand.up(0).empty()) << "dragged";
  }
  {
    Hand hand;
    EXPECT_TRUE(hand.tap(here).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.down(0, here).empty());
    EXPECT_TRUE(hand.down(1, {0.7, 0.4}).empty());
    EXPECT_TRUE(hand.up(0).empty()) << "one of two fingers";
    EXPECT_TRUE(hand.up(1).empty());
  }
  {
    Hand hand;
    hand.now_us = 0;
    EXPECT_TRUE(hand.tap(here, 0).empty());
    EXPECT_TRUE(hand.tap(here, 0).empty()) << "no times, no taps";
  }
}

TEST(Gestures, AFlickOfOneEventIsNotLost) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.2, 0.4}).empty());
  const auto meant = hand.move(0, {0.7, 0.4});
  ASSERT_EQ(meant.size(), 1u);
  const double lost = rest_share * panel_px[1] / panel_px[0];
  EXPECT_NEAR(meant[0].values[0], -(0.5 - lost) * orbit_degrees_a_width, 1e-9);
  EXPECT_EQ(meant[0].values[1], 0.0);
}

TEST(Gestures, ARestingFingerMovesNothing) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.5, 0.4}).empty());
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(hand.move(0, {0.5 + 0.002 * (k % 3 - 1), 0.4 - 0.002 * (k % 2)}).empty());
}

TEST(Gestures, TheLiftedFingerOfTwoLeavesNoJump) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.4, 0.4}).empty());
  EXPECT_TRUE(hand.down(1, {0.6, 0.4}).empty());
  EXPECT_TRUE(hand.up(0).empty());
  const auto meant = hand.move(1, {0.61, 0.4});
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::orbit);
  EXPECT_NEAR(meant[0].values[0], -0.01 * orbit_degrees_a_width, 1e-9);
}

TEST(Gestures, AThirdFingerIsIgnoredForGood) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.4, 0.4}).empty());
  EXPECT_TRUE(hand.down(1, {0.6, 0.4}).empty());
  EXPECT_TRUE(hand.down(2, {0.5, 0.2}).empty());
  EXPECT_EQ(hand.gestures.fingers(), 2);
  EXPECT_TRUE(hand.move(2, {0.1, 0.1}).empty());
  EXPECT_TRUE(hand.up(0).empty());
  EXPECT_TRUE(hand.move(2, {0.9, 0.1}).empty());
  EXPECT_TRUE(hand.up(2).empty());
}

TEST(Gestures, SliderAndCarAtTheSameTime) {
  Hand hand;
  EXPECT_EQ(hand.down(0, {0.5, 0.9}).size(), 1u);
  EXPECT_TRUE(hand.down(1, {0.5, 0.4}).empty());
  EXPECT_TRUE(hand.down(2, {0.2, 0.95}).empty()) << "the slider has its finger";
  EXPECT_EQ(hand.move(1, {0.8, 0.4})[0].kind, ControlKind::orbit);
  EXPECT_EQ(hand.move(0, {0.7, 0.9})[0].kind, ControlKind::weights);
  EXPECT_TRUE(hand.move(2, {0.3, 0.95}).empty());
}

TEST(Gestures, ACancelEndsWithoutEffect) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.4, 0.4}).empty());
  EXPECT_FALSE(hand.move(0, {0.6, 0.4}).empty());
  EXPECT_TRUE(hand.cancel(0).empty());
  EXPECT_EQ(hand.gestures.fingers(), 0);
  EXPECT_TRUE(hand.move(0, {0.9, 0.4}).empty());
  EXPECT_TRUE(hand.up(0).empty());
}

TEST(Gestures, AnotherMountingForgetsFingers) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {0.4, 0.4}).empty());
  hand.gestures.set_rotation(Rotation::none, panel_px);
  EXPECT_EQ(hand.gestures.fingers(), 1) << "the same again";
  hand.gestures.set_rotation(Rotation::quarter, panel_px);
  EXPECT_EQ(hand.gestures.fingers(), 0);
}

TEST(Gestures, AKnobMorphsRoundAllPaints) {
  Hand hand;
  Weights last{1, 0, 0};
  for (int detent = 1; detent <= 3 * static_cast<int>(detents_a_paint); ++detent) {
    const auto meant = hand.turn(1.0);
    ASSERT_EQ(meant.size(), 1u);
    ASSERT_EQ(meant[0].kind, ControlKind::weights);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LE(std::abs(meant[0].values[k] - last[k]), 1.0 / detents_a_paint + 1e-12);
    last = meant[0].values;
  }
  EXPECT_NEAR(last[0], 1.0, 1e-12) << "three paints on, it is the first again";
  const auto back = hand.turn(-detents_a_paint / 2.0);
  EXPECT_NEAR(back[0].values[2], 0.5, 1e-12);
}

TEST(Gestures, AKnobGoesOnFromWhereTheSliderWas) {
  Hand hand;
  EXPECT_EQ(hand.down(0, {0.99, 0.9})[0].values, (Weights{0, 0, 1}));
  EXPECT_NEAR(hand.turn(-6.0)[0].values[2], 0.75, 1e-12);
  // Weights of a script pass through and are followed too.
  const Control script{ControlKind::weights, {0, 0.5, 0.5}, {}, 0, 0};
  const auto passed = hand.gestures.take(script);
  ASSERT_EQ(passed.size(), 1u);
  EXPECT_EQ(passed[0].values, script.values);
  EXPECT_NEAR(hand.gestures.morph_position(), 1.5, 1e-12);
}

TEST(Gestures, AShortPressGoesToTheNextFocus) {
  Hand hand;
  const auto press = [&] {
    EXPECT_TRUE(hand.button(ControlKind::press).empty());
    hand.now_us += 100'000;
    EXPECT_TRUE(hand.button(ControlKind::release).empty());
  };
  EXPECT_EQ(hand.gestures.focus(), Focus::morph);
  press();
  EXPECT_EQ(hand.gestures.focus(), Focus::orbit);
  auto meant = hand.turn(2.0);
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::orbit);
  EXPECT_EQ(meant[0].values, (Weights{2.0 * orbit_degrees_a_detent, 0.0}));
  press();
  meant = hand.turn(zoom_detents_a_halving);
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::zoom);
  EXPECT_DOUBLE_EQ(meant[0].values[0], 0.5);
  press();
  EXPECT_EQ(hand.gestures.focus(), Focus::morph);
  EXPECT_STREQ(focus_name(Focus::zoom), "zoom");
  // Side buttons mean nothing.
  EXPECT_TRUE(hand.button(ControlKind::press, 1.0).empty());
  EXPECT_TRUE(hand.button(ControlKind::release, 1.0).empty());
  EXPECT_TRUE(hand.button(ControlKind::release).empty()) << "never pressed";
  EXPECT_EQ(hand.gestures.focus(), Focus::morph);
}

TEST(Gestures, ALongPressGoesHomeWhileHeld) {
  Hand hand;
  EXPECT_EQ(hand.gestures.wake_at_ms(), input::never_ms);
  EXPECT_TRUE(hand.button(ControlKind::press).empty());
  EXPECT_EQ(hand.gestures.wake_at_ms(), 2000.0);
  EXPECT_TRUE(hand.gestures.advance(1999.0).empty());
  const auto meant = hand.gestures.advance(2000.0);
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_EQ(meant[0].kind, ControlKind::camera);
  EXPECT_EQ(meant[0].name, "hero");
  EXPECT_TRUE(hand.gestures.advance(5000.0).empty());
  EXPECT_EQ(hand.gestures.wake_at_ms(), input::never_ms);
  hand.now_us += 3'000'000;
  EXPECT_TRUE(hand.button(ControlKind::release).empty());
  EXPECT_EQ(hand.gestures.focus(), Focus::morph) << "the release means nothing more";
  // The same if nobody asked in between.
  EXPECT_TRUE(hand.button(ControlKind::press).empty());
  hand.now_us += long_press_us;
  ASSERT_EQ(hand.button(ControlKind::release).size(), 1u);
}

TEST(Gestures, NonsenseIsIgnored) {
  Hand hand;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Control& event :
       {Control{ControlKind::touch_down, {nan, 0.5}, {}, 0, 1}, Control{ControlKind::touch_down, {0.5}, {}, 0, 1},
        Control{ControlKind::touch_move, {0.5, 0.5}, {}, 9, 1}, Control{ControlKind::touch_up, {}, {}, 9, 1},
        Control{ControlKind::turn, {nan}, {}, 0, 1}, Control{ControlKind::turn, {}, {}, 0, 1},
        Control{ControlKind::turn, {0.0}, {}, 0, 1}, Control{ControlKind::press, {}, {}, 0, 1}})
    EXPECT_TRUE(hand.gestures.take(event).empty());
  EXPECT_EQ(hand.gestures.fingers(), 0);
  EXPECT_EQ(hand.gestures.morph_position(), 0.0);
}

TEST(Gestures, OnePaintCanBeSlid) {
  Hand hand(Rotation::none, 1);
  EXPECT_EQ(hand.down(0, {0.5, 0.9})[0].values, (Weights{1}));
  EXPECT_EQ(hand.turn(5.0)[0].values, (Weights{1}));
}

// Through the state machine: the near side of the car follows the finger.
TEST(Gestures, TheCarFollowsTheFinger) {
  State state(3, {{"hero", {5000.0f, 0.0f, 1600.0f}, {0.0f, 0.0f, 600.0f}, 30.0f}});
  Hand hand;
  // A point on the near side, as the camera sees it: to the right is +y when looking along -x.
  const glm::vec3 point{900.0f, 0.0f, 600.0f};
  const auto seen = [&] {
    const packs::Camera& camera = state.camera();
    const glm::vec3 forward = glm::normalize(camera.target_mm - camera.eye_mm);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 0, 1)));
    const glm::vec3 up = glm::cross(right, forward);
    const glm::vec3 d = point - camera.eye_mm;
    return glm::vec2(glm::dot(d, right), glm::dot(d, up)) / glm::dot(d, forward);
  };
  const glm::vec2 before = seen();
  for (const Control& c : hand.down(0, {0.4, 0.4})) state.apply(c);
  for (const Control& c : hand.move(0, {0.45, 0.4})) state.apply(c);
  const glm::vec2 moved = seen();
  EXPECT_GT(moved.x, before.x) << "to the right";
  for (const Control& c : hand.move(0, {0.45, 0.45})) state.apply(c);
  EXPECT_LT(seen().y, moved.y) << "and down";
  const float far = glm::length(state.camera().eye_mm - state.camera().target_mm);
  for (const Control& c : hand.down(1, {0.5, 0.45})) state.apply(c);
  for (const Control& c : hand.move(1, {0.6, 0.45})) state.apply(c);
  EXPECT_LT(glm::length(state.camera().eye_mm - state.camera().target_mm), 0.5f * far) << "fingers apart: nearer";
}

}  // namespace
}  // namespace lackwerk::kiosk
