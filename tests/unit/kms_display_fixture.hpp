// A display on a card that exists only in memory, with a clock that tests turn: for the kms_display tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "kiosk/display/output/drm_fake.hpp"
#include "kiosk/display/output/kms_display.hpp"

namespace lackwerk::kiosk {

using Call = FakeKmsDevice::Call;

class KmsDisplayTest : public testing::Test {
 protected:
  explicit KmsDisplayTest(bool atomic = true) : device(2, atomic) {
    device.add_connector("HDMI-A-1");
    device.add_connector("DP-1");
  }
  void start(const WantedPipe& wanted = {}) {
    display.emplace(device, wanted, OutputMode{"", {1280, 720}, 0.0, Rotation::quarter}, log);
    const auto started = display->start(now);
    ASSERT_TRUE(started.has_value()) << started.error().line();
  }
  void plug_usual() { device.plug("HDMI-A-1", {simple_mode(1920, 1080, 60.0, true), simple_mode(1280, 720)}); }
  DrmId framebuffer() {
    const auto made = device.add_framebuffer({display->mode().panel_px, 1, 8192, 0});
    EXPECT_TRUE(made.has_value());
    return made.value_or(0);
  }
  Presented show(DrmId what) {
    const auto shown = display->show(what, now);
    EXPECT_TRUE(shown.has_value()) << (shown ? "" : shown.error().line());
    return shown.value_or(Presented::refused);
  }
  Presented show() { return show(framebuffer()); }
  void pass(double ms) {
    now += ms;
    const auto done = display->dispatch(now);
    ASSERT_TRUE(done.has_value()) << done.error().line();
  }
  void hotplug() {
    display->rescan(now);
    pass(300.0);
  }
  [[nodiscard]] bool said(const std::string& text) const {
    const auto lines = log.lines();
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
  }
  /// From nothing to a picture that is shown.
  void start_lit() {
    plug_usual();
    start();
    show();
    pass(17.0);
    ASSERT_NE(display->shown(), 0u);
  }

  FakeKmsDevice device;
  Log log{nullptr};
  std::optional<KmsDisplay> display;
  double now = 1000.0;
};

class LegacyKmsDisplayTest : public KmsDisplayTest {
 protected:
  LegacyKmsDisplayTest() : KmsDisplayTest(false) {}
};

}  // namespace lackwerk::kiosk
