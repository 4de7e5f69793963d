// Fingers on the car: orbit, pinch, flick, two taps.
#include "kiosk/display/car_fingers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "kiosk/display/state.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;

constexpr std::array<int, 2> picture_px{1600, 900};

/// Fingers by pixels.
class Hand {
 public:
  Hand() { fingers.set_picture(picture_px); }
  bool down(int contact, Point px) { return fingers.down(contact, px, now_us); }
  CarFingers::Controls move(int contact, Point px) {
    auto meant = fingers.move(contact, px, now_us);
    for (const Control& control : meant) {
      if (control.kind == ControlKind::zoom) factor *= control.values[0];
      if (control.kind == ControlKind::orbit) azimuth += control.values[0];
      if (control.kind == ControlKind::orbit) elevation += control.values[1];
    }
    return meant;
  }
  CarFingers::Left up(int contact) { return fingers.up(contact, now_us); }
  /// Whether it was the second of two.
  bool tap(Point px, std::uint64_t held_us = 80'000) {
    down(0, px);
    now_us += held_us;
    return up(0).frame;
  }
  /// To the right by `px_a_report`, a report every 10 ms.
  void swipe(double px_a_report, int reports = 12) {
    down(0, {400.0, 400.0});
    for (int k = 1; k <= reports; ++k) {
      now_us += 10'000;
      move(0, {400.0 + px_a_report * k, 400.0});
    }
  }

  CarFingers fingers;
  std::uint64_t now_us = 1'000'000;
  double factor = 1.0, azimuth = 0.0, elevation = 0.0;
};

constexpr double degrees_a_pixel = orbit_degrees_a_width / picture_px[0];

TEST(CarFingers, OneFingerOrbitsTheSameAngleAPixelBothWays) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {480.0, 360.0}));
  for (int k = 1; k <= 10; ++k) hand.move(0, {480.0 + 32.0 * k, 360.0 + 9.0 * k});
  const double way = std::hypot(320.0, 90.0), lost = rest_share * picture_px[1] / way;
  EXPECT_NEAR(hand.azimuth, -320.0 * degrees_a_pixel * (1.0 - lost), 1e-9) << "a little is lost while it rests";
  EXPECT_NEAR(hand.elevation, 90.0 * degrees_a_pixel * (1.0 - lost), 1e-9);
}

TEST(CarFingers, TwoFingersZoomByTheRatioOfTheirDistances) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {640.0, 360.0}));
  EXPECT_TRUE(hand.down(1, {960.0, 360.0}));
  for (int k = 1; k <= 20; ++k) {
    hand.move(0, {640.0 - 16.0 * k, 360.0});
    hand.move(1, {960.0 + 16.0 * k, 360.0});
  }
  EXPECT_NEAR(hand.factor, 1.0 / 3.0, 1e-9) << "three times as far apart: three times as near";
  EXPECT_NEAR(hand.azimuth, 0.0, 1e-9);
  // Both the same way: no zoom in the end, and the orbit of one finger that goes that way.
  hand.factor = 1.0;
  for (int k = 1; k <= 20; ++k) {
    hand.move(0, {320.0, 360.0 + 9.0 * k});
    hand.move(1, {1280.0, 360.0 + 9.0 * k});
  }
  EXPECT_NEAR(hand.factor, 1.0, 1e-9);
  EXPECT_NEAR(hand.elevation, 180.0 * degrees_a_pixel, 1e-9);
}

TEST(CarFingers, TwoTapsAreOneGesture) {
  Hand hand;
  EXPECT_FALSE(hand.tap({800.0, 400.0}));
  hand.now_us += 150'000;
  EXPECT_TRUE(hand.tap({810.0, 405.0}));
  hand.now_us += 150'000;
  EXPECT_FALSE(hand.tap({810.0, 405.0})) << "a third one is a first one again";
}

TEST(CarFingers, TapsThatAreNoDoubleTap) {
  const Point here{800.0, 400.0};
  {
    Hand hand;
    hand.tap(here);
    hand.now_us += double_tap_us + 1;
    EXPECT_FALSE(hand.tap(here)) << "too late";
  }
  {
    Hand hand;
    hand.tap(here);
    EXPECT_FALSE(hand.tap({here[0] + 200.0, here[1]})) << "elsewhere";
  }
  {
    Hand hand;
    hand.tap(here);
    EXPECT_FALSE(hand.tap(here, tap_us + 1)) << "held";
  }
  {
    Hand hand;
    hand.tap(here);
    hand.down(0, here);
    hand.fingers.cancel(0);
    EXPECT_FALSE(hand.up(0).frame) << "cancelled";
  }
  {
    Hand hand;
    hand.tap(here);
    hand.down(0, here);
    hand.move(0, {here[0] + 200.0, here[1]});
    EXPECT_FALSE(hand.up(0).frame) << "dragged";
  }
  {
    Hand hand;
    hand.tap(here);
    hand.down(0, here);
    hand.down(1, {here[0] + 300.0, here[1]});
    EXPECT_FALSE(hand.up(0).frame) << "one of two fingers";
    EXPECT_FALSE(hand.up(1).frame);
  }
}

TEST(CarFingers, AFlickOfOneEventIsNotLostAndARestingFingerMovesNothing) {
  Hand hand;
  hand.down(0, {320.0, 400.0});
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(hand.move(0, {320.0 + 3.0 * (k % 3 - 1), 400.0 - 2.0 * (k % 2)}).empty());
  const auto meant = hand.move(0, {1120.0, 400.0});
  ASSERT_EQ(meant.size(), 1u);
  EXPECT_NEAR(meant[0].values[0], -(800.0 - rest_share * picture_px[1]) * degrees_a_pixel, 1e-9);
}

TEST(CarFingers, AThirdFingerIsNotTaken) {
  Hand hand;
  EXPECT_TRUE(hand.down(0, {400.0, 400.0}));
  EXPECT_TRUE(hand.down(1, {800.0, 400.0}));
  EXPECT_FALSE(hand.down(2, {600.0, 200.0}));
  EXPECT_EQ(hand.fingers.count(), 2u);
  EXPECT_TRUE(hand.move(2, {100.0, 100.0}).empty());
  EXPECT_FALSE(hand.up(2).flick);
  // The one that stays leaves no jump when the other goes.
  hand.up(0);
  hand.azimuth = 0.0;
  hand.move(1, {816.0, 400.0});
  EXPECT_NEAR(hand.azimuth, -16.0 * degrees_a_pixel, 1e-9);
}

TEST(CarFingers, AFlickHasTheFingersSpeed) {
  Hand hand;
  hand.swipe(10.0);
  hand.now_us += 5'000;
  const auto left = hand.up(0);
  ASSERT_TRUE(left.flick);
  EXPECT_LT(left.flick->azimuth_deg_s, -0.8 * 1000.0 * degrees_a_pixel) << "10 px in 10 ms, or nearly";
  EXPECT_GT(left.flick->azimuth_deg_s, -1.05 * 1000.0 * degrees_a_pixel);
  EXPECT_NEAR(left.flick->elevation_deg_s, 0.0, 1e-9);
}

TEST(CarFingers, NotEveryFingerThatLeavesIsAFlick) {
  {
    Hand hand;
    hand.swipe(10.0);
    hand.now_us += 200'000;
    EXPECT_FALSE(hand.up(0).flick) << "it rested first";
  }
  {
    Hand hand;
    hand.swipe(0.05, 60);
    EXPECT_FALSE(hand.up(0).flick) << "too slow";
  }
  {
    Hand hand;
    hand.swipe(10.0);
    hand.down(1, {1200.0, 300.0});
    hand.move(0, {530.0, 400.0});
    EXPECT_FALSE(hand.up(0).flick) << "one of two";
  }
  {
    Hand hand;
    hand.swipe(10.0);
    hand.fingers.cancel(0);
    EXPECT_FALSE(hand.up(0).flick) << "cancelled";
  }
  {
    Hand hand;
    hand.swipe(500.0);
    hand.now_us += 5'000;
    const auto left = hand.up(0);
    ASSERT_TRUE(left.flick);
    EXPECT_LE(std::hypot(left.flick->azimuth_deg_s, left.flick->elevation_deg_s), most_turn_deg_s + 1e-9) << "bounded";
  }
}

TEST(CarFingers, CoastingFallsByETheSameAtAnyFrames) {
  Coasting fine({100.0, -50.0}, 0.0), coarse({100.0, -50.0}, 0.0);
  double azimuth = 0.0, elevation = 0.0;
  for (int ms = 1; ms <= 2000; ++ms) {
    const auto turned = fine.turn(ms);
    azimuth += turned[0];
    elevation += turned[1];
    if (ms == static_cast<int>(inertia_ms)) {
      EXPECT_NEAR(azimuth, 100.0 * inertia_ms / 1e3 * (1.0 - std::exp(-1.0)), 1e-9);
    }
  }
  const auto whole = coarse.turn(2000.0);
  EXPECT_NEAR(azimuth, whole[0], 1e-9);
  EXPECT_NEAR(elevation, whole[1], 1e-9);
  EXPECT_FALSE(fine.ended(500.0));
  EXPECT_TRUE(fine.ended(2000.0));
}

// Through the state: the near side of the car follows the finger.
TEST(CarFingers, TheCarFollowsTheFinger) {
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
    return std::array<float, 2>{glm::dot(d, right) / glm::dot(d, forward), glm::dot(d, up) / glm::dot(d, forward)};
  };
  const auto before = seen();
  hand.down(0, {640.0, 360.0});
  for (const Control& c : hand.move(0, {720.0, 360.0})) state.apply(c);
  const auto moved = seen();
  EXPECT_GT(moved[0], before[0]) << "to the right";
  for (const Control& c : hand.move(0, {720.0, 405.0})) state.apply(c);
  EXPECT_LT(seen()[1], moved[1]) << "and down";
  const float far = glm::length(state.camera().eye_mm - state.camera().target_mm);
  hand.down(1, {800.0, 405.0});
  for (const Control& c : hand.move(1, {960.0, 405.0})) state.apply(c);
  EXPECT_LT(glm::length(state.camera().eye_mm - state.camera().target_mm), 0.6f * far) << "fingers apart: nearer";
}

}  // namespace
}  // namespace lackwerk::kiosk
