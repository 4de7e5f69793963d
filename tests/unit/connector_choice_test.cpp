#include "kiosk/display/output/connector_choice.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "kiosk/display/output/drm_fake.hpp"

namespace lackwerk::kiosk {
namespace {

std::vector<DrmMode> usual_modes() {
  return {simple_mode(1280, 720), simple_mode(1920, 1080, 60.0, true), simple_mode(1920, 1080, 50.0),
          simple_mode(1920, 1080, 59.94)};
}

DrmSnapshot snapshot_of(FakeKmsDevice& device) {
  auto snapshot = take_snapshot(device);
  EXPECT_TRUE(snapshot.has_value());
  return snapshot ? *snapshot : DrmSnapshot{};
}

TEST(ConnectorChoice, TakesTheFirstConnectedOneAndItsPreferredMode) {
  FakeKmsDevice device;
  device.add_connector("DP-1");
  device.add_connector("HDMI-A-1");
  device.plug("HDMI-A-1", usual_modes());
  const auto found = choose_pipe(snapshot_of(device), {}, nullptr, {});
  ASSERT_TRUE(found.pipe.has_value()) << found.why;
  EXPECT_EQ(found.pipe->connector.name, "HDMI-A-1");
  EXPECT_EQ(found.pipe->mode.size_px(), (std::array{1920, 1080}));
  EXPECT_NEAR(found.pipe->mode.refresh_hz(), 60.0, 0.01);
  EXPECT_NE(found.pipe->plane, 0u);
  EXPECT_NE(found.why.find("HDMI-A-1 (the first connected one), 1920x1080"), std::string::npos) << found.why;
  EXPECT_TRUE(found.warning.empty()) << found.warning;
}

TEST(ConnectorChoice, SaysWhyNothingCanBeShown) {
  FakeKmsDevice device;
  EXPECT_NE(choose_pipe(snapshot_of(device), {}, nullptr, {}).why.find("no connectors"), std::string::npos);
  device.add_connector("DP-1");
  device.add_connector("DP-2");
  const auto none = choose_pipe(snapshot_of(device), {}, nullptr, {});
  EXPECT_FALSE(none.pipe.has_value());
  EXPECT_EQ(none.why, "waiting for a monitor: DP-1 not connected, DP-2 not connected");
  device.plug("DP-1", {});
  device.plug("DP-2", usual_modes());
  device.connector("DP-2").desktop = false;  // a headset
  const auto useless = choose_pipe(snapshot_of(device), {}, nullptr, {});
  EXPECT_FALSE(useless.pipe.has_value());
  EXPECT_EQ(useless.why, "waiting for a monitor: DP-1 connected without a mode, DP-2 is no desktop display");
}

TEST(ConnectorChoice, WaitsForTheConfiguredConnectorAndNamesTheOthers) {
  FakeKmsDevice device;
  device.add_connector("DP-1");
  device.add_connector("HDMI-A-1");
  device.plug("DP-1", usual_modes());
  const auto waiting = choose_pipe(snapshot_of(device), {"HDMI-A-1", {0, 0}, 0}, nullptr, {});
  EXPECT_FALSE(waiting.pipe.has_value());
  EXPECT_EQ(waiting.why, "waiting for a monitor at HDMI-A-1: DP-1 connected, HDMI-A-1 not connected");
  const auto lacking = choose_pipe(snapshot_of(device), {"VGA-1", {0, 0}, 0}, nullptr, {});
  EXPECT_NE(lacking.why.find("which the card lacks"), std::string::npos) << lacking.why;
  device.plug("HDMI-A-1", usual_modes());
  const auto found = choose_pipe(snapshot_of(device), {"HDMI-A-1", {0, 0}, 0}, nullptr, {});
  ASSERT_TRUE(found.pipe.has_value());
  EXPECT_EQ(found.pipe->connector.name, "HDMI-A-1");
}

TEST(ConnectorChoice, KeepsItsChoiceWhileItStaysConnected) {
  FakeKmsDevice device;
  device.add_connector("DP-1");
  device.add_connector("HDMI-A-1");
  device.plug("HDMI-A-1", usual_modes());
  const auto first = choose_pipe(snapshot_of(device), {}, nullptr, {});
  ASSERT_TRUE(first.pipe.has_value());
  device.plug("DP-1", usual_modes());  // would be the first one now
  const auto second = choose_pipe(snapshot_of(device), {}, &*first.pipe, {});
  ASSERT_TRUE(second.pipe.has_value());
  EXPECT_EQ(second.pipe->connector.name, "HDMI-A-1");
  EXPECT_EQ(second.pipe->crtc, first.pipe->crtc);
  device.unplug("HDMI-A-1");
  const auto third = choose_pipe(snapshot_of(device), {}, &*first.pipe, {});
  ASSERT_TRUE(third.pipe.has_value());
  EXPECT_EQ(third.pipe->connector.name, "DP-1");
}

TEST(ConnectorChoice, TakesAPipeThatFeedsNoOtherMonitor) {
  FakeKmsDevice device;
  const DrmId other = device.add_connector("DP-1");
  device.add_connector("HDMI-A-1");
  device.plug("HDMI-A-1", usual_modes());
  device.set_value(other, "CRTC_ID", device.crtcs()[0]);
  const auto found = choose_pipe(snapshot_of(device), {}, nullptr, {});
  ASSERT_TRUE(found.pipe.has_value());
  EXPECT_EQ(found.pipe->crtc, device.crtcs()[1]);
  EXPECT_EQ(found.pipe->plane, device.plane_of(device.crtcs()[1], DrmPlaneType::primary));
}

TEST(ConnectorChoice, WithoutAPrimaryPlaneTheOlderInterfaceIsLeft) {
  FakeKmsDevice device;
  device.add_connector("DP-1");
  device.plug("DP-1", usual_modes());
  device.remove_primary_planes();
  const auto found = choose_pipe(snapshot_of(device), {}, nullptr, {});
  ASSERT_TRUE(found.pipe.has_value());
  EXPECT_EQ(found.pipe->plane, 0u);
}

TEST(ConnectorChoice, FindsTheWantedModeOrSaysThatItIsNotThere) {
  DrmConnector connector;
  connector.name = "DP-1";
  connector.modes = usual_modes();
  std::string warning;
  const auto smaller = choose_mode(connector, {"", {1280, 720}, 0}, {0, 0}, {}, warning);
  ASSERT_TRUE(smaller.has_value());
  EXPECT_EQ(smaller->size_px(), (std::array{1280, 720}));
  const auto slower = choose_mode(connector, {"", {0, 0}, 50}, {0, 0}, {}, warning);
  ASSERT_TRUE(slower.has_value());
  EXPECT_NEAR(slower->refresh_hz(), 50.0, 0.01);
  EXPECT_EQ(slower->size_px(), (std::array{1920, 1080}));
  EXPECT_TRUE(warning.empty()) << warning;
  const auto missing = choose_mode(connector, {"", {800, 600}, 75}, {0, 0}, {}, warning);
  ASSERT_TRUE(missing.has_value());
  EXPECT_EQ(missing->size_px(), (std::array{1920, 1080}));
  EXPECT_EQ(warning, "DP-1 has no mode 800x600 at 75 Hz: 1920x1080 at 60.00 Hz is used instead");
}

TEST(ConnectorChoice, LeavesOutModesThatAreTooLargeRefusedOrWithoutTimings) {
  DrmConnector connector;
  connector.name = "DP-1";
  connector.modes = usual_modes();
  connector.modes.insert(connector.modes.begin(), DrmMode{});
  std::string warning;
  const auto fits = choose_mode(connector, {}, {1600, 1200}, {}, warning);
  ASSERT_TRUE(fits.has_value());
  EXPECT_EQ(fits->size_px(), (std::array{1280, 720}));
  const auto next = choose_mode(connector, {}, {0, 0}, {simple_mode(1920, 1080, 60.0)}, warning);
  ASSERT_TRUE(next.has_value());
  EXPECT_FALSE(next->same_signal(simple_mode(1920, 1080, 60.0)));
  EXPECT_FALSE(choose_mode(connector, {}, {640, 480}, {}, warning).has_value());
}

TEST(ConnectorChoice, InterlacedOnlyIfThereIsNothingElse) {
  DrmConnector connector;
  connector.modes = {simple_mode(1920, 1080, 60.0, true), simple_mode(1280, 720)};
  connector.modes[0].flags = 1u << 4;  // DRM_MODE_FLAG_INTERLACE
  std::string warning;
  const auto whole = choose_mode(connector, {}, {0, 0}, {}, warning);
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ(whole->size_px(), (std::array{1280, 720}));
  connector.modes.pop_back();
  const auto half = choose_mode(connector, {}, {0, 0}, {}, warning);
  ASSERT_TRUE(half.has_value());
  EXPECT_TRUE(half->interlaced());
}

TEST(ConnectorChoice, AConnectorThatVanishesWhileItIsReadIsLeftOut) {
  FakeKmsDevice device;
  device.add_connector("DP-1");
  device.add_connector("DP-2");
  device.plug("DP-2", usual_modes());
  device.fail_next(FakeKmsDevice::Call::probe, ENOENT);
  const auto snapshot = snapshot_of(device);
  ASSERT_EQ(snapshot.connectors.size(), 1u);
  EXPECT_EQ(snapshot.connectors[0].name, "DP-2");
  device.fail_next(FakeKmsDevice::Call::probe, ENODEV);
  EXPECT_FALSE(take_snapshot(device).has_value());
}

CardFacts card(const std::string& node, const std::string& driver, bool connected) {
  DrmConnector one;
  one.name = "HDMI-A-1";
  one.connected = connected;
  one.possible_crtcs = 1;
  if (connected) one.modes = usual_modes();
  return {{node, node + "-link", driver}, {one}};
}

TEST(CardChoice, NeverByNumberButByTheMonitor) {
  const std::vector<CardFacts> cards = {card("/dev/dri/card0", "vgem", false), card("/dev/dri/card1", "i915", true)};
  const auto choice = choose_card(cards, "", "");
  ASSERT_TRUE(choice.has_value());
  EXPECT_EQ(choice->index, 1u);
  EXPECT_NE(choice->why.find("has a monitor"), std::string::npos);
  EXPECT_EQ(choose_card(cards, "vgem", "")->index, 0u);
  EXPECT_EQ(choose_card(cards, "/dev/dri/card1-link", "")->index, 1u);
  EXPECT_EQ(choose_card(cards, "", "DP-9")->index, 0u);
}

TEST(CardChoice, WithoutAnyMonitorTheFirstCardWaits) {
  const auto choice = choose_card({card("/dev/dri/card2", "i915", false), card("/dev/dri/card3", "x", false)}, "", "");
  ASSERT_TRUE(choice.has_value());
  EXPECT_EQ(choice->index, 0u);
  EXPECT_NE(choice->why.find("no card has a monitor yet"), std::string::npos);
}

TEST(CardChoice, SaysWhichCardsThereAre) {
  const auto choice = choose_card({card("/dev/dri/card2", "i915", false)}, "/dev/dri/card0", "");
  ASSERT_FALSE(choice.has_value());
  EXPECT_NE(choice.error().line().find("/dev/dri/card2"), std::string::npos) << choice.error().line();
  EXPECT_FALSE(choose_card({}, "", "").has_value());
}

}  // namespace
}  // namespace lackwerk::kiosk
