// What a driver, another program or a killed cable may do to a display.
#include "kiosk/display/output/kms_display.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "tests/unit/kms_display_fixture.hpp"

namespace lackwerk::kiosk {
namespace {

TEST_F(KmsDisplayTest, AtomicRefusedFallsBackToTheOlderInterface) {
  plug_usual();
  start();
  device.fail_next(Call::test, EINVAL);
  const DrmId first = framebuffer(), second = framebuffer();
  EXPECT_EQ(show(first), Presented::shown);
  EXPECT_EQ(device.calls(Call::commit), 0);
  EXPECT_TRUE(said("refuses the atomic state"));
  EXPECT_EQ(device.panel("HDMI-A-1").framebuffer, first);
  EXPECT_EQ(show(second), Presented::queued);
  EXPECT_EQ(device.calls(Call::page_flip), 1);
  pass(17.0);
  EXPECT_EQ(display->shown(), second);
  EXPECT_EQ(display->presented(), 2u);
}

TEST_F(KmsDisplayTest, WithoutAPrimaryPlaneTheOlderInterfaceIsUsed) {
  plug_usual();
  device.remove_primary_planes();
  start();
  EXPECT_EQ(show(), Presented::shown);
  EXPECT_EQ(device.calls(Call::test), 0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, AModeThatIsRefusedEitherWayGivesWayToAnother) {
  plug_usual();
  start();
  device.fail_next(Call::test, EINVAL);
  device.fail_next(Call::set_crtc, EINVAL);
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(display->mode().panel_px, (std::array{1280, 720}));
  EXPECT_TRUE(said("refuses 1920x1080 at 60.00 Hz"));
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_EQ(device.panel("HDMI-A-1").mode.size_px(), (std::array{1280, 720}));
}

TEST_F(KmsDisplayTest, ARefusedModeIsTriedAgainAfterAHotPlug) {
  plug_usual();
  start();
  device.fail_next(Call::test, EINVAL);
  device.fail_next(Call::set_crtc, EINVAL);
  EXPECT_EQ(show(), Presented::refused);
  ASSERT_EQ(display->mode().panel_px, (std::array{1280, 720}));
  hotplug();
  EXPECT_EQ(display->mode().panel_px, (std::array{1920, 1080}));
}

TEST_F(KmsDisplayTest, AllModesRefusedIsAStateThatIsTriedAgain) {
  device.plug("HDMI-A-1", {simple_mode(1920, 1080, 60.0, true)});
  start();
  device.fail_next(Call::test, EINVAL);
  device.fail_next(Call::set_crtc, EINVAL);
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_EQ(display->state(), OutputState::waiting_for_display);
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(show(), Presented::queued);
}

TEST_F(KmsDisplayTest, UnplugBetweenProbeAndCommit) {
  plug_usual();
  start();
  bool done = false;
  device.before = [&](Call call) {
    if (call != Call::test || done) return;
    done = true;
    device.unplug("HDMI-A-1");
  };
  device.fail_next(Call::test, EINVAL);
  device.fail_next(Call::set_crtc, EINVAL);
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_EQ(display->state(), OutputState::waiting_for_display);
  plug_usual();
  hotplug();
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(display->mode().panel_px, (std::array{1920, 1080})) << "the mode was not to blame";
}

TEST_F(KmsDisplayTest, ARefusedFlipSetsTheModeAgain) {
  start_lit();
  device.fail_next(Call::commit, EINVAL);
  EXPECT_EQ(show(), Presented::refused);
  pass(300.0);
  const int tests = device.calls(Call::test);
  EXPECT_EQ(show(), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), tests + 1);
}

TEST_F(KmsDisplayTest, NoMemoryPasses) {
  plug_usual();
  start();
  device.fail_next(Call::blob, ENOMEM);
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_FALSE(display->ready(now));
  EXPECT_TRUE(said("ENOMEM"));
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(show(), Presented::queued);
}

TEST_F(KmsDisplayTest, MasterLostIsWaitedForAndEverythingSetAgain) {
  start_lit();
  device.take_master(true);
  EXPECT_EQ(show(), Presented::refused);
  EXPECT_EQ(display->state(), OutputState::suspended);
  EXPECT_EQ(display->shown(), 0u);
  for (int k = 0; k < 5; ++k) pass(display->wake_at_ms() - now);
  EXPECT_EQ(display->state(), OutputState::suspended);
  device.take_master(false);
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(display->state(), OutputState::running);
  const int tests = device.calls(Call::test);
  EXPECT_EQ(show(), Presented::queued);
  EXPECT_EQ(device.calls(Call::test), tests + 1);
}

TEST_F(KmsDisplayTest, TheSeatTakesTheScreenAndGivesItBack) {
  start_lit();
  display->suspend();
  EXPECT_EQ(display->state(), OutputState::suspended);
  EXPECT_FALSE(device.master());
  EXPECT_FALSE(display->ready(now));
  const int commits = device.calls(Call::commit);
  plug_usual();
  hotplug();
  pass(10'000.0);
  EXPECT_EQ(device.calls(Call::commit), commits) << "nothing is touched meanwhile";
  device.plug("HDMI-A-1", {simple_mode(1024, 768, 60.0, true)});  // another monitor meanwhile
  display->resume(now);
  pass(0.0);
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_TRUE(device.master());
  EXPECT_EQ(display->mode().panel_px, (std::array{1024, 768}));
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, ConnectorsThatCannotBeReadAfterAnotherSessionAreReadLater) {
  start_lit();
  display->suspend();
  device.fail_next(Call::resources, EIO);
  display->resume(now);
  pass(0.0);
  EXPECT_EQ(display->state(), OutputState::waiting_for_display);
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(show(), Presented::queued);
}

TEST_F(KmsDisplayTest, OffSurvivesAnotherSession) {
  start_lit();
  display->set_power(false, now);
  pass(1.0);
  display->suspend();
  device.set_value(device.crtcs()[0], "ACTIVE", 1);  // the other session woke the panel
  display->resume(now);
  pass(0.0);
  pass(1.0);
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
}

TEST_F(KmsDisplayTest, OnlyAVanishedCardIsAnError) {
  start_lit();
  device.fail_next(Call::commit, ENODEV);
  const auto shown = display->show(framebuffer(), now);
  ASSERT_FALSE(shown.has_value());
  EXPECT_NE(shown.error().line().find("the card is gone"), std::string::npos);
  device.fail_next(Call::read, ENODEV);
  EXPECT_FALSE(display->dispatch(now).has_value());
  device.fail_next(Call::resources, ENODEV);
  display->rescan(now);
  now += 1000.0;
  EXPECT_FALSE(display->dispatch(now).has_value());
}

TEST_F(KmsDisplayTest, ConnectorsThatCannotBeReadAreReadLater) {
  start_lit();
  device.fail_next(Call::resources, EIO);
  hotplug();
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_TRUE(said("cannot read the connectors"));
  device.fail_next(Call::properties, ENOENT, 1, 2);  // after the probes' own
  pass(display->wake_at_ms() - now);
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(display->state(), OutputState::running);
  EXPECT_EQ(show(), Presented::queued);
}

TEST_F(KmsDisplayTest, AnotherProgramOnTheCardIsSaidAtOnce) {
  device.take_master(true);
  KmsDisplay other(device, {}, {}, log);
  const auto started = other.start(now);
  ASSERT_FALSE(started.has_value());
  EXPECT_NE(started.error().line().find("another program has the display"), std::string::npos);
  EXPECT_EQ(started.error().field, master_field);
}

TEST_F(KmsDisplayTest, TheConsoleComesBackAtTheEnd) {
  plug_usual();
  device.show_console("HDMI-A-1", simple_mode(1280, 720));
  const DrmId console = device.panel("HDMI-A-1").framebuffer;
  start();
  show();
  pass(17.0);
  EXPECT_NE(device.panel("HDMI-A-1").framebuffer, console);
  display.reset();
  const auto panel = device.panel("HDMI-A-1");
  EXPECT_TRUE(panel.active);
  EXPECT_EQ(panel.framebuffer, console);
  EXPECT_EQ(panel.mode.size_px(), (std::array{1280, 720}));
}

TEST_F(KmsDisplayTest, WithoutAConsoleThePipeIsTurnedOffAtTheEnd) {
  start_lit();
  display.reset();
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
  EXPECT_EQ(device.value(device.crtcs()[0], "MODE_ID"), 0u);
}

TEST_F(KmsDisplayTest, AnotherSessionsScreenIsLeftAloneAtTheEnd) {
  start_lit();
  display->suspend();
  const auto touched = [&] {
    return device.calls(Call::test) + device.calls(Call::commit) + device.calls(Call::set_crtc);
  };
  const int before = touched();
  display.reset();
  EXPECT_EQ(touched(), before);
}

TEST_F(KmsDisplayTest, AThousandReplugsLeaveNothingBehind) {
  plug_usual();
  start();
  for (int k = 0; k < 1000; ++k) {
    const DrmId picture = framebuffer();
    ASSERT_EQ(show(picture), Presented::queued) << k;
    pass(17.0);
    ASSERT_TRUE(device.panel("HDMI-A-1").active) << k;
    device.unplug("HDMI-A-1");
    hotplug();
    ASSERT_EQ(display->state(), OutputState::waiting_for_display) << k;
    device.remove_framebuffer(picture);
    plug_usual();
    hotplug();
  }
  EXPECT_EQ(device.blobs(), 0u);
  EXPECT_EQ(device.framebuffers(), 0u);
}

TEST_F(LegacyKmsDisplayTest, ModeFlipsAndPower) {
  plug_usual();
  start();
  EXPECT_EQ(show(), Presented::shown);
  EXPECT_EQ(display->presented(), 1u);
  EXPECT_EQ(show(), Presented::queued);
  pass(17.0);
  EXPECT_EQ(display->presented(), 2u);
  display->set_power(false, now);
  pass(1.0);
  EXPECT_FALSE(device.panel("HDMI-A-1").dpms_on);
  EXPECT_FALSE(display->ready(now));
  hotplug();
  EXPECT_FALSE(device.panel("HDMI-A-1").dpms_on);
  display->set_power(true, now);
  EXPECT_EQ(show(), Presented::shown);
  EXPECT_TRUE(device.panel("HDMI-A-1").dpms_on);
  EXPECT_EQ(device.calls(Call::test), 0);
}

TEST_F(LegacyKmsDisplayTest, UnplugReplugBusyAndLostFlips) {
  plug_usual();
  start();
  EXPECT_EQ(show(), Presented::shown);
  device.fail_next(Call::page_flip, EBUSY, 2);
  EXPECT_EQ(show(), Presented::refused);
  pass(display->wake_at_ms() - now);
  EXPECT_EQ(show(), Presented::refused);
  pass(display->wake_at_ms() - now);
  device.flips_come = false;
  EXPECT_EQ(show(), Presented::queued);
  pass(present_wait_ms + 1.0);
  EXPECT_TRUE(said("no word of a flip"));
  device.flips_come = true;
  EXPECT_EQ(show(), Presented::shown) << "the mode is set again";
  device.unplug("HDMI-A-1");
  hotplug();
  EXPECT_FALSE(device.panel("HDMI-A-1").active);
  plug_usual();
  hotplug();
  EXPECT_EQ(show(), Presented::shown);
  EXPECT_TRUE(device.panel("HDMI-A-1").active);
}

}  // namespace
}  // namespace lackwerk::kiosk
