// The feel of a knob: nothing lost, nothing flooded, bounded gain.
#include "input/knob.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace lackwerk::input {
namespace {

KnobTuning flat() {
  KnobTuning tuning;
  tuning.acceleration = 0.0;
  return tuning;
}

std::vector<Control> take(Knob& knob, double now_ms, std::size_t limit = max_controls_a_read) {
  std::vector<Control> out;
  knob.take(now_ms, limit, out);
  return out;
}

double detents(const std::vector<Control>& controls) {
  double sum = 0.0;
  for (const auto& control : controls)
    if (control.kind == ControlKind::turn) sum += control.values.at(0);
  return sum;
}

TEST(Knob, ARevolutionIsItsDetents) {
  Knob knob("dial", flat());
  for (int k = 0; k < 94; ++k) knob.turn(0, 1.0 / 94.0, 1000u * k);
  const auto out = take(knob, 100.0);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::turn);
  EXPECT_EQ(out[0].name, "dial");
  EXPECT_NEAR(out[0].values.at(0), 24.0, 1e-9);
  EXPECT_EQ(out[0].time_us, 0u) << "the earliest motion in it";
  EXPECT_TRUE(take(knob, 101.0).empty());
}

TEST(Knob, InvertTurnsAround) {
  auto tuning = flat();
  tuning.invert = true;
  Knob knob("dial", tuning);
  knob.step(0, 3.0, 1);
  EXPECT_NEAR(detents(take(knob, 1.0)), -3.0, 1e-12);
}

TEST(Knob, FurtherAxesHaveTheirOwnName) {
  Knob knob("pad", flat());
  knob.step(0, 1.0, 1);
  knob.step(2, 1.0, 2);
  const auto out = take(knob, 1.0);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].name, "pad");
  EXPECT_EQ(out[1].name, "pad 3");
}

TEST(Knob, SwitchesKeepTheirPlaceAmongTurns) {
  Knob knob("dial", flat());
  knob.step(0, 1.0, 1);
  knob.button(0, true, 2);
  knob.button(0, true, 3);  // says nothing new
  knob.step(0, 2.0, 4);
  knob.step(0, 2.0, 5);
  knob.button(0, false, 6);
  const auto out = take(knob, 1.0);
  ASSERT_EQ(out.size(), 4u);
  EXPECT_EQ(out[0].kind, ControlKind::turn);
  EXPECT_EQ(out[1].kind, ControlKind::press);
  EXPECT_NEAR(out[2].values.at(0), 4.0, 1e-12);
  EXPECT_EQ(out[3].kind, ControlKind::release);
  EXPECT_EQ(out[3].time_us, 6u);
}

TEST(Knob, GainGrowsWithSpeedAndIsBounded) {
  KnobTuning tuning;  // as it is delivered
  const auto gain_at = [&](double revolutions_per_s) {
    Knob knob("dial", tuning);
    double turned = 0.0;
    for (int k = 0; k < 100; ++k) {
      knob.turn(0, revolutions_per_s / 100.0, 10'000u * k);
      if (k >= 50) turned += revolutions_per_s / 100.0 * tuning.detents_per_turn;
      if (k == 49) take(knob, 0.0);
    }
    return detents(take(knob, 1000.0)) / turned;
  };
  EXPECT_DOUBLE_EQ(gain_at(0.25), 1.0);
  EXPECT_NEAR(gain_at(3.0), 2.0, 0.2);
  double last = 0.0;
  for (const double speed : {0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 100.0}) {
    EXPECT_GE(gain_at(speed), last);
    last = gain_at(speed);
  }
  EXPECT_LE(last, 8.0);
}

TEST(Knob, OneClickIsOneDetentWhateverTheAcceleration) {
  for (const double acceleration : {0.0, 0.5, 2.0}) {
    KnobTuning tuning;
    tuning.acceleration = acceleration;
    Knob knob("dial", tuning);
    knob.step(0, 1.0, 5'000'000);
    knob.step(0, -1.0, 5'000'001);  // turning back is no speed
    knob.step(0, 1.0, 9'000'000);
    EXPECT_NEAR(detents(take(knob, 9000.0)), 1.0, 1e-12) << acceleration;
  }
}

TEST(Knob, TheSameMotionInOtherPortionsIsNearlyTheSame) {
  // Ten clicks 10 ms apart, or five double ones 20 ms apart: the hand did the same.
  double sums[2] = {};
  for (const int portion : {1, 2}) {
    Knob knob("dial", KnobTuning{});
    for (int k = portion; k <= 10; k += portion) knob.step(0, portion, 10'000u * k);
    sums[portion - 1] = detents(take(knob, 1000.0));
  }
  EXPECT_NEAR(sums[0] / sums[1], 1.0, 0.15);
}

TEST(Knob, AbsurdMotionIsCut) {
  Knob knob("dial", flat());
  knob.turn(0, 1e12, 1);
  EXPECT_DOUBLE_EQ(detents(take(knob, 1.0)), 240.0);
  knob.turn(0, std::numeric_limits<double>::quiet_NaN(), 2);
  knob.turn(99, 1.0, 3);
  knob.button(99, true, 4);
  knob.deflect(99, 1.0, false, 5);
  EXPECT_TRUE(take(knob, 1.0).empty());
}

TEST(Knob, AStickTurnsWhileItIsDeflected) {
  auto tuning = flat();
  tuning.dead_zone = 0.2;
  Knob knob("stick", tuning);
  knob.deflect(0, 0.19, false, 1'000'000);
  EXPECT_EQ(knob.wake_at_ms(), never_ms);
  knob.deflect(0, 1.0, false, 2'000'000);
  EXPECT_LT(knob.wake_at_ms(), never_ms);
  double sum = 0.0;
  for (int ms = 2016; ms <= 3000; ms += 16) sum += detents(take(knob, ms));
  sum += detents(take(knob, 3000.0));
  EXPECT_NEAR(sum, 24.0, 1e-9) << "one revolution a second at the stop";
  knob.deflect(0, -0.6, false, 3'000'000);  // half way beyond the dead zone
  EXPECT_NEAR(detents(take(knob, 4000.0)), -12.0, 1e-9);
  knob.deflect(0, 0.0, false, 4'000'000);
  EXPECT_TRUE(take(knob, 9000.0).empty());
  EXPECT_EQ(knob.wake_at_ms(), never_ms);
}

TEST(Knob, ASilentStickRests) {
  Knob knob("stick", flat());
  knob.deflect(0, 1.0, true, 1'000'000);
  EXPECT_NEAR(detents(take(knob, 60'000.0)), 24.0 * 0.2, 1e-9) << "0.2 s of silence, not 59 s";
  EXPECT_EQ(knob.wake_at_ms(), never_ms);
}

TEST(Knob, LettingGoReleasesAndRests) {
  Knob knob("dial", flat());
  knob.button(3, true, 1);
  knob.button(7, true, 2);
  knob.deflect(0, 1.0, false, 1'000'000);
  knob.let_go(2'000'000);
  std::map<int, int> held;
  double sum = 0.0;
  for (const auto& control : take(knob, 5000.0)) {
    if (control.kind == ControlKind::press) ++held[static_cast<int>(control.values[0])];
    if (control.kind == ControlKind::release) --held[static_cast<int>(control.values[0])];
    if (control.kind == ControlKind::turn) sum += control.values[0];
  }
  EXPECT_EQ(held, (std::map<int, int>{{3, 0}, {7, 0}}));
  EXPECT_NEAR(sum, 24.0, 1e-9);
}

TEST(Knob, TenThousandEventsASecondAreFewControlsAndNothingIsLost) {
  Knob knob("dial", flat());
  double sent = 0.0, got = 0.0;
  int now_held = 0, last_held = 0;
  std::size_t most = 0;
  for (int event = 0; event < 10'000; ++event) {
    const double step = event % 3 == 0 ? -1.0 : 2.0;
    knob.step(static_cast<std::size_t>(event % 4), step, 100u * event);
    sent += step;
    // The button chatters as fast as that, so that order cannot be kept within the bound.
    now_held = event % 2;
    knob.button(static_cast<std::size_t>(event % 5), now_held != 0, 100u * event);
    if (event % 1000 == 999) {  // the kiosk was away for 0.1 s
      const auto out = take(knob, 0.1 * event);
      most = std::max(most, out.size());
      got += detents(out);
    }
  }
  got += detents(take(knob, 1000.0));
  EXPECT_NEAR(got, sent, 1e-6);
  EXPECT_LE(most, max_controls_a_read);
  knob.let_go(2'000'000);
  for (const auto& control : take(knob, 2000.0)) last_held += control.kind == ControlKind::release ? 1 : 0;
  EXPECT_LE(last_held, 5);
}

TEST(Knob, PressesAndReleasesAlternateHoweverCrowded) {
  Knob knob("pad", flat());
  std::array<bool, max_knob_buttons> real{}, seen{};
  std::uint32_t state = 1;
  for (int event = 0; event < 5000; ++event) {
    state = state * 1664525u + 1013904223u;
    const std::size_t number = (state >> 16) % max_knob_buttons;
    real.at(number) = !real.at(number);
    knob.button(number, real.at(number), event);
    knob.step(0, 1.0, event);
    if (event % 300 != 299) continue;
    for (const auto& control : take(knob, event, 100)) {
      if (control.kind == ControlKind::turn) continue;
      const auto which = static_cast<std::size_t>(control.values[0]);
      EXPECT_NE(seen.at(which), control.kind == ControlKind::press);
      seen.at(which) = control.kind == ControlKind::press;
    }
  }
  while (knob.has_pending())
    for (const auto& control : take(knob, 1e4, 7))
      if (control.kind != ControlKind::turn)
        seen.at(static_cast<std::size_t>(control.values[0])) = control.kind == ControlKind::press;
  EXPECT_EQ(seen, real);
}

}  // namespace
}  // namespace lackwerk::input
