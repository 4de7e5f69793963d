// Whole devices, from descriptor and reports to controls.
#include "input/hid_knob.hpp"

#include <gtest/gtest.h>

#include "hid_samples.hpp"

namespace lackwerk::input {
namespace {

using samples::Bytes;

KnobTuning flat(KnobProfile profile = KnobProfile::automatic) {
  KnobTuning tuning;
  tuning.acceleration = 0.0;
  tuning.profile = profile;
  return tuning;
}

HidKnob make(const Bytes& descriptor, const KnobTuning& tuning = flat()) {
  auto knob = HidKnob::make(descriptor, "knob", tuning);
  if (!knob) throw std::runtime_error(knob.error().line());
  return std::move(*knob);
}

std::string refusal(const Bytes& descriptor, const KnobTuning& tuning = flat()) {
  const auto knob = HidKnob::make(descriptor, "knob", tuning);
  return knob ? "none" : knob.error().what;
}

std::vector<Control> take(HidKnob& knob, double now_ms = 0.0) {
  std::vector<Control> out;
  knob.knob().take(now_ms, max_controls_a_read, out);
  return out;
}

double detents(HidKnob& knob, double now_ms = 0.0) {
  double sum = 0.0;
  for (const auto& control : take(knob, now_ms))
    if (control.kind == ControlKind::turn) sum += control.values.at(0);
  return sum;
}

TEST(HidKnob, SurfaceDialTurnsAndPresses) {
  auto knob = make(samples::surface_dial(), flat(KnobProfile::surface_dial));
  ASSERT_EQ(knob.layout().axes.size(), 1u);
  EXPECT_EQ(knob.max_report_bytes(), 73u);  // its vendor reports are longer than the dial's nine bytes
  // A tenth of a revolution clockwise with the button down: 360 of 3600 counts.
  knob.report(Bytes{0x01, 0x01, 0x68, 0x01, 0, 0, 0, 0, 0x3a}, 10);
  knob.report(Bytes{0x01, 0x00, 0x00, 0x00, 0, 0, 0, 0, 0x3a}, 20);
  const auto out = take(knob);
  ASSERT_EQ(out.size(), 3u);
  EXPECT_NEAR(out[0].values.at(0), 2.4, 1e-9);
  EXPECT_EQ(out[1].kind, ControlKind::press);
  EXPECT_EQ(out[1].values, (std::vector<double>{0.0}));
  EXPECT_EQ(out[2].kind, ControlKind::release);
}

TEST(HidKnob, SurfaceDialSaysHowManyCountsARevolutionHas) {
  auto knob = make(samples::surface_dial(), flat(KnobProfile::surface_dial));
  const auto resolution = knob.resolution();
  ASSERT_TRUE(resolution);
  EXPECT_EQ(resolution->report_id, 1);
  ASSERT_EQ(resolution->payload_bytes, 7u);
  Bytes payload{72, 0, 9, 3, 5, 80, 0};  // 72 counts, and haptic settings that are not ours
  knob.use_resolution(payload);
  knob.report(Bytes{0x01, 0x00, 36, 0, 0, 0, 0, 0, 0x3a}, 10);
  EXPECT_NEAR(detents(knob), 12.0, 1e-9);
  knob.set_resolution(payload);
  EXPECT_EQ(payload, (Bytes{0x10, 0x0e, 9, 3, 5, 80, 0})) << "3600, and nothing else has changed";
  auto own = flat(KnobProfile::surface_dial);
  own.counts_per_turn = 100.0;
  EXPECT_FALSE(make(samples::surface_dial(), own).resolution());
}

TEST(HidKnob, AnglesNeedNoProfile) {
  auto knob = make(samples::radial_controller());
  EXPECT_NEAR(knob.layout().axes.at(0).counts_per_turn, 3600.0, 1e-9);
  knob.report(
      Bytes{0x01, static_cast<std::uint8_t>((-1800 & 0x7f) << 1), static_cast<std::uint8_t>((-1800 >> 7) & 0xff)}, 1);
  EXPECT_NEAR(detents(knob), -12.0, 1e-9);
}

TEST(HidKnob, SpaceNavigatorTurnsByItsTwist) {
  auto knob = make(samples::space_navigator(), flat(KnobProfile::spacemouse));
  ASSERT_EQ(knob.layout().axes.size(), 1u);
  EXPECT_EQ(knob.layout().axes[0].usage, (HidUsage{0x01, 0x35}));
  // Translation and tilt do nothing; the full twist for 0.1 s is a tenth of a revolution.
  knob.report(Bytes{0x01, 0x5e, 0x01, 0x5e, 0x01, 0x5e, 0x01}, 1'000'000);
  EXPECT_TRUE(take(knob, 1100.0).empty());
  knob.report(Bytes{0x02, 0x00, 0x00, 0x00, 0x00, 0x5e, 0x01}, 2'000'000);
  EXPECT_NEAR(detents(knob, 2100.0), 2.4, 1e-6);
  knob.report(Bytes{0x02, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, 2'100'000);
  EXPECT_NEAR(detents(knob, 3000.0), 0.0, 1e-9);
  knob.report(Bytes{0x03, 0x02, 0x00}, 3'000'000);
  const auto out = take(knob, 3000.0);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].values, (std::vector<double>{1.0}));
  // Another axis by configuration.
  auto tuning = flat(KnobProfile::spacemouse);
  tuning.axis = "x";
  EXPECT_EQ(make(samples::space_navigator(), tuning).layout().axes.at(0).usage, (HidUsage{0x01, 0x30}));
}

TEST(HidKnob, PowerMateByItsKnownReports) {
  // Its own descriptor is not looked at.
  auto knob = make(Bytes{}, flat(KnobProfile::powermate));
  for (int k = 0; k < 47; ++k) knob.report(Bytes{0x00, 0x01, 0x00, 0x4f, 0x10, 0x00}, 1000u * k);
  EXPECT_NEAR(detents(knob), 12.0, 1e-9);
  knob.report(Bytes{0x01, 0xff, 0x00, 0x4f, 0x10, 0x00}, 100'000);
  const auto out = take(knob);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(out[0].values.at(0), -24.0 / 94.0, 1e-9);
  EXPECT_EQ(out[1].kind, ControlKind::press);
}

TEST(HidKnob, VolumeKeysAreDetents) {
  auto knob = make(samples::volume_knob());
  for (int k = 0; k < 3; ++k) {
    knob.report(Bytes{0x01, 0x01}, 100'000u * k);
    knob.report(Bytes{0x01, 0x01}, 100'000u * k + 1);  // said twice, turned once
    knob.report(Bytes{0x01, 0x00}, 100'000u * k + 2);
  }
  knob.report(Bytes{0x01, 0x02}, 900'000);
  knob.report(Bytes{0x01, 0x04}, 900'001);
  const auto out = take(knob);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(out[0].values.at(0), 2.0, 1e-9);
  EXPECT_EQ(out[1].kind, ControlKind::press) << "mute is its button";
}

TEST(HidKnob, AKeyboardsWheelNeedsPermission) {
  EXPECT_EQ(refusal(samples::keyboard_with_wheel()), "it is a keyboard");
  auto knob = make(samples::keyboard_with_wheel(), flat(KnobProfile::generic));
  knob.report(Bytes{0x01, 0x02, 0x00, 0x04, 0x05, 0, 0, 0, 0}, 1);  // typing is not heard
  knob.report(Bytes{0x02, 0xe9, 0x00}, 2);
  knob.report(Bytes{0x02, 0x00, 0x00}, 3);
  knob.report(Bytes{0x02, 0xe9, 0x00}, 4);
  const auto out = take(knob);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].values.at(0), 2.0, 1e-9);
}

TEST(HidKnob, SomebodyElsesDevicesAreLeftAlone) {
  EXPECT_EQ(refusal(samples::mouse()), "it is a mouse");
  EXPECT_EQ(refusal(samples::mouse(), flat(KnobProfile::generic)), "nothing on it turns");
  for (const std::uint8_t application : {0x04, 0x05, 0x06, 0x07}) {
    auto bytes = samples::plain_wheel();
    bytes[3] = application;
    EXPECT_NE(refusal(bytes), "none") << int{application};
    EXPECT_EQ(refusal(bytes, flat(KnobProfile::generic)), "none");
  }
  auto touch = samples::plain_wheel();
  touch[1] = 0x0d;
  touch[3] = 0x04;
  EXPECT_EQ(refusal(touch), "it is a pen or touch device");
  EXPECT_EQ(refusal(samples::plain_wheel()), "none");
}

TEST(HidKnob, ACountIsADetentWhereNothingElseIsSaid) {
  auto knob = make(samples::plain_wheel());
  knob.report(Bytes{0x00, 0x05}, 1);
  knob.report(Bytes{0x00, 0xfe}, 2);
  EXPECT_NEAR(detents(knob), 3.0, 1e-9);
  auto tuning = flat();
  tuning.counts_per_turn = 12.0;
  auto coarse = make(samples::plain_wheel(), tuning);
  coarse.report(Bytes{0x00, 0x03}, 1);
  EXPECT_NEAR(detents(coarse), 6.0, 1e-9);
}

TEST(HidKnob, AbsoluteDialsGoRoundAndSlidersDoNot) {
  auto knob = make(samples::absolute_dial());
  ASSERT_EQ(knob.layout().axes.size(), 2u);
  const auto at = [&](unsigned dial, unsigned slider) {
    knob.report(Bytes{static_cast<std::uint8_t>(dial), static_cast<std::uint8_t>(slider),
                      static_cast<std::uint8_t>(slider >> 8)},
                1);
  };
  at(250, 1023);
  EXPECT_TRUE(take(knob).empty()) << "where it stands at first is no motion";
  at(4, 1023);
  auto out = take(knob);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].values.at(0), 10.0 / 256.0 * 24.0, 1e-9) << "across the top";
  at(252, 0);
  out = take(knob);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_NEAR(out[0].values.at(0), -8.0 / 256.0 * 24.0, 1e-9);
  EXPECT_NEAR(out[1].values.at(0), -24.0, 1e-9) << "from stop to stop";
  EXPECT_EQ(out[1].name, "knob 2");
  knob.reset(5);
  at(100, 500);
  EXPECT_TRUE(take(knob).empty()) << "opened anew: no jump";
}

TEST(HidKnob, MalformedReportsChangeNothing) {
  auto knob = make(samples::surface_dial(), flat(KnobProfile::surface_dial));
  knob.report(Bytes{}, 1);
  knob.report(Bytes{0x01}, 2);
  knob.report(Bytes{0x01, 0x01, 0xff, 0x7f}, 3);
  knob.report(Bytes(300, 0xff), 4);
  EXPECT_TRUE(take(knob).empty());
}

}  // namespace
}  // namespace lackwerk::input
