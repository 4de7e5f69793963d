#include "kiosk/display/output/kms_display.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "tests/unit/kms_display_fixture.hpp"

namespace lackwerk::kiosk {
namespace {

TEST_F(KmsDisplayTest, FirstPictureComesWithTheFullStateAndLaterOnesAreFlips) {
  plug_usual();
  device.set_value(device.crtcs()[0], "GAMMA_LUT", 77);  // left by another program
  device.set_value(device.plane_of(device.crtcs()[0], DrmPlaneType::cursor), "CRTC_ID", device.crtcs()[0]);
  device.set_value(device.plane_of(device.crtcs()[0], DrmPlaneType::cursor), "FB_ID", 5);
  start();
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(display->mode().connector, "HDMI-A-1");
  EXPECT_EQ(display->mode().panel_px, (std::array{1920, 1080}));
  EXPECT_EQ(display->mode().rotation, Rotation::quarter);
  ASSERT_TRUE(display->ready(now));
  const DrmId first = framebuffer(), second = framebuffer();
  EXPECT_EQ(show(first), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), 1);
  EXPECT_EQ(device.calls(Call::commit), 1);
  EXPECT_EQ(device.blobs(), 0u) << "the mode's blob is not kept";
  EXPECT_FALSE(display->ready(now));
  EXPECT_EQ(display->presented(), 0u);
  pass(17.0);
  EXPECT_TRUE(display->ready(now));
  EXPECT_EQ(display->shown(), first);
  EXPECT_EQ(display->presented(), 1u);
  EXPECT_GT(display->flipped_at_us(), 0u);

  auto panel = device.panel("HDMI-A-1");
  EXPECT_TRUE(panel.active);
  EXPECT_EQ(panel.framebuffer, first);
  EXPECT_EQ(panel.mode.size_px(), (std::array{1920, 1080}));
  EXPECT_EQ(device.value(device.crtcs()[0], "GAMMA_LUT"), 0u);
  EXPECT_EQ(device.value(device.plane_of(device.crtcs()[0], DrmPlaneType::cursor), "FB_ID"), 0u);

  EXPECT_EQ(show(second), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), 1) << "a flip needs no test";
  EXPECT_EQ(display->queued(), second);
  EXPECT_EQ(display->shown(), first) << "still read until the event";
  pass(17.0);
  EXPECT_EQ(display->shown(), second);
  EXPECT_EQ(display->presented(), 2u);
}

TEST_F(KmsDisplayTest, OnlyTheEventEndsAFlip) {
  start_lit();
  device.flips_come = false;
  EXPECT_EQ(show(), Presented::queued);
  pass(100.0);
  EXPECT_FALSE(display->ready(now));
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_EQ(display->presented(), 1u);
  device.report_held();
  pass(1.0);
  EXPECT_TRUE(display->ready(now));
  EXPECT_EQ(display->presented(), 2u);
}

TEST_F(KmsDisplayTest, ALostFlipIsSaidAndTheModeIsSetAgain) {
  start_lit();
  device.flips_come = false;
  EXPECT_EQ(show(), Presented::queued);
  EXPECT_LE(display->wake_at_ms(), now + present_wait_ms);
  const auto before = display->revision();
  pass(present_wait_ms - 1.0);
  EXPECT_FALSE(display->ready(now));
  pass(2.0);
  EXPECT_TRUE(display->ready(now));
  EXPECT_GT(display->revision(), before) << "the picture must be drawn again";
  EXPECT_TRUE(said("no word of a flip"));
  device.report_held();
  const int tests = device.calls(Call::test);
  const DrmId again = framebuffer();
  EXPECT_EQ(show(again), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), tests + 1) << "the full state";
  pass(1.0);  // the lost one comes after all
  EXPECT_EQ(display->queued(), again) << "it must not count for this one";
  device.report_held();
  pass(1.0);
  EXPECT_EQ(display->shown(), again);
  EXPECT_EQ(display->presented(), 2u);
}

TEST_F(KmsDisplayTest, BusyKeepsTheDamageAndIsTriedAgainWithoutSpinning) {
  start_lit();
  device.fail_next(Call::commit, EBUSY, 3);
  const DrmId picture = framebuffer();
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(show(picture), Presented::refused);
    EXPECT_FALSE(display->ready(now));
    const double wake = display->wake_at_ms();
    EXPECT_GT(wake, now + 1.0);
    EXPECT_LT(wake, now + 100.0);
    pass(wake - now);
    EXPECT_TRUE(display->ready(now));
  }
  EXPECT_EQ(show(picture), Presented::queued);
  pass(17.0);
  EXPECT_EQ(display->shown(), picture);
  EXPECT_EQ(display->presented(), 2u);
}

TEST_F(KmsDisplayTest, BusyForTooLongSetsTheModeAgain) {
  start_lit();
  device.fail_next(Call::commit, EBUSY, 80);
  const double began = now;
  while (now < began + 2.0 * present_wait_ms && show() == Presented::refused) pass(display->wake_at_ms() - now);
  EXPECT_TRUE(said("busy for"));
  EXPECT_LT(now, began + 2.0 * present_wait_ms);
  pass(17.0);
  EXPECT_EQ(display->presented(), 2u);
  EXPECT_GE(device.calls(Call::test), 2);
}

TEST_F(KmsDisplayTest, WithoutAMonitorItWaitsAndShowsAsSoonAsThereIsOne) {
  start();
  EXPECT_EQ(display->state(), OutputState::waiting_for_display);
  EXPECT_FALSE(display->ready(now));
  EXPECT_EQ(display->mode().panel_px, (std::array{1280, 720}));
  EXPECT_TRUE(said("waiting for a monitor"));
  EXPECT_EQ(show(1), Presented::refused);
  const auto before = display->revision();
  plug_usual();
  hotplug();
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_GT(display->revision(), before);
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, AMonitorIsFoundWithoutAnyMessage) {
  start();
  plug_usual();
  const double wake = display->wake_at_ms();
  EXPECT_LT(wake, now + 10'000.0);
  pass(wake - now);
  EXPECT_EQ(display->state(), OutputState::running);
}

TEST_F(KmsDisplayTest, UnplugDisablesThePipeAndReplugSetsEverythingAgain) {
  start_lit();
  for (int k = 0; k < 3; ++k) {
    device.unplug("HDMI-A-1");
    hotplug();
    EXPECT_EQ(display->state(), OutputState::waiting_for_display);
    EXPECT_EQ(display->shown(), 0u) << "all buffers are free";
    EXPECT_FALSE(device.panel("HDMI-A-1").active);
    EXPECT_EQ(device.value(device.crtcs()[0], "ACTIVE"), 0u);
    EXPECT_EQ(device.value(device.plane_of(device.crtcs()[0], DrmPlaneType::primary), "FB_ID"), 0u);
    plug_usual();
    hotplug();
    EXPECT_EQ(display->state(), OutputState::running);
    const DrmId picture = framebuffer();
    EXPECT_EQ(show(picture), Presented::queued);
    pass(17.0);
    EXPECT_TRUE(device.panel("HDMI-A-1").active);
    EXPECT_EQ(device.panel("HDMI-A-1").framebuffer, picture);
  }
}

TEST_F(KmsDisplayTest, UnplugInTheMiddleOfAFlip) {
  start_lit();
  device.flips_come = false;
  EXPECT_EQ(show(), Presented::queued);
  device.unplug("HDMI-A-1");
  hotplug();
  EXPECT_EQ(display->state(), OutputState::waiting_for_display);
  EXPECT_EQ(display->queued(), 0u);
  device.flips_come = true;
  device.report_held();
  pass(1.0);
  plug_usual();
  hotplug();
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, EveryConnectSetsTheFullStateEvenIfNothingSeemsToHaveChanged) {
  start_lit();
  const int tests = device.calls(Call::test);
  const auto before = display->revision();
  device.set_value(device.connector("HDMI-A-1").id, "link-status", 1);  // BAD: the link must be trained anew
  const int probes = device.calls(Call::probe);
  hotplug();
  EXPECT_EQ(device.calls(Call::probe), probes + 2) << "all connectors are read again";
  EXPECT_GT(display->revision(), before);
  EXPECT_EQ(show(), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), tests + 1);
  EXPECT_EQ(device.value(device.connector("HDMI-A-1").id, "link-status"), 0u);
}

TEST_F(KmsDisplayTest, AnotherMonitorWithAnotherMode) {
  start_lit();
  device.plug("HDMI-A-1", {simple_mode(2560, 1440, 60.0, true)});
  hotplug();
  EXPECT_EQ(display->mode().panel_px, (std::array{2560, 1440}));
  EXPECT_EQ(display->shown(), 0u) << "the old buffers may go";
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_EQ(device.panel("HDMI-A-1").mode.size_px(), (std::array{2560, 1440}));
}

TEST_F(KmsDisplayTest, ChatteringConnectorsAreNotProbedMoreOftenThanNeeded) {
  start_lit();
  const int before = device.calls(Call::resources);
  for (int k = 0; k < 1000; ++k) {
    display->rescan(now);
    pass(1.0);
  }
  EXPECT_LE(device.calls(Call::resources) - before, 5);
  EXPECT_GE(device.calls(Call::resources) - before, 3);
}

TEST_F(KmsDisplayTest, PowerOffKeepsTheModeAndPowerOnBringsThePictureBack) {
  start_lit();
  display->set_power(false, now);
  pass(1.0);
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
  EXPECT_FALSE(display->ready(now));
  EXPECT_EQ(show(), Presented::refused);
  const auto before = display->revision();
  display->set_power(true, now);
  EXPECT_GT(display->revision(), before);
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, PowerOffWaitsForTheFlipOnItsWay) {
  start_lit();
  device.flips_come = false;
  EXPECT_EQ(show(), Presented::queued);
  display->set_power(false, now);
  pass(1.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
  device.report_held();
  pass(1.0);
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, OffSurvivesAHotPlug) {
  start_lit();
  display->set_power(false, now);
  pass(1.0);
  hotplug();
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
  device.unplug("HDMI-A-1");
  hotplug();
  plug_usual();
  hotplug();
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_FALSE(display->ready(now));
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
  display->set_power(true, now);
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

}  // namespace
}  // namespace lackwerk::kiosk
