// The live kiosk on twins: a panel that can be pulled out, devices that say what the test wants, a clock in numbers.
#include "kiosk/display/live.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/render/kiosk_stage.hpp"
#include "tests/render/live_twins.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using input::ControlKind;
using kiosk::OutputState;

class LiveTest : public testing::Test {
 protected:
  void SetUp() override {
    context_ = open_context(gles::Backend::egl_surfaceless, reason_);
    if (!context_) GTEST_SKIP() << reason_;
    folder_ = std::filesystem::temp_directory_path() / ("lackwerk_live_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    stage_ = synthetic_stage(*context_, 96, 54);
    ASSERT_TRUE(stage_);
    panel_ = std::make_unique<Panel>(*context_);
    // Nothing moves by itself, and nothing lies on the picture.
    kiosk::InterfaceSettings settings;
    settings.shown = false;
    settings.experience.tour = false;
    settings.experience.idle_s = 3600.0;
    settings.experience.reduced_motion = true;
    start(settings);
  }

  /// A kiosk that behaves like this, from its start.
  void start(const kiosk::InterfaceSettings& settings, std::optional<input::ScriptPlayer> script = std::nullopt) {
    live_.reset();
    auto interface = kiosk::Interface::create(*stage_, settings, log_);
    ASSERT_TRUE(interface) << interface.error().line();
    interface_ = std::move(*interface);
    picture_.emplace(*stage_, kiosk::PictureSettings{"best", 62, still_frames});
    const auto prepared = picture_->prepare(interface_->shown());
    ASSERT_TRUE(prepared) << prepared.error().line();
    kiosk::Devices devices;
    devices.sources.push_back(std::make_unique<HandSource>(hand_));
    kiosk::LiveSettings live;
    live.status_folder = folder_.string();
    live.pack_file = "p.lwp";
    live.minute_of_day = [this] { return minute_; };
    live_ = std::make_unique<kiosk::Live>(*panel_, *stage_, *picture_, *interface_, std::move(devices),
                                          std::move(script), log_, service_, std::move(live));
  }
  void TearDown() override {
    live_.reset();
    interface_.reset();
    picture_.reset();
    stage_.reset();
    panel_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// One step; flips whatever it handed over.
  void step() {
    now_ms_ += 20.0;
    const auto stepped = live_->step(now_ms_);
    ASSERT_TRUE(stepped) << stepped.error().line();
    if (!panel_->ready() && panel_->state() == OutputState::running)
      panel_->flip(static_cast<std::uint64_t>(now_ms_ * 1e3));
  }
  void settle() {
    for (int k = 0; k < still_frames + 3; ++k) step();
  }
  void turn(double detents) { hand_.next.push_back({ControlKind::turn, {detents}, "hand", 0, time_us()}); }
  [[nodiscard]] std::uint64_t time_us() const { return static_cast<std::uint64_t>(now_ms_ * 1e3); }
  [[nodiscard]] nlohmann::json status() const {
    return nlohmann::json::parse(std::ifstream(folder_ / kiosk::status_file_name));
  }

  static constexpr int still_frames = 4;
  std::string reason_;
  std::filesystem::path folder_;
  std::unique_ptr<gles::Context> context_;
  std::unique_ptr<kiosk::Stage> stage_;
  std::unique_ptr<Panel> panel_;
  std::unique_ptr<kiosk::Interface> interface_;
  std::optional<kiosk::Picture> picture_;
  kiosk::Log log_{nullptr};
  kiosk::Service service_;
  Hand hand_;
  std::unique_ptr<kiosk::Live> live_;
  double now_ms_ = 1e6;
  int minute_ = 720;
};

TEST_F(LiveTest, NothingChangesNothingIsDrawnAndNobodyIsWoken) {
  settle();
  const std::uint64_t drawn = picture_->drawn(), refined = picture_->refined(), taken = panel_->taken;
  EXPECT_EQ(drawn, 1u);
  EXPECT_EQ(refined, static_cast<std::uint64_t>(still_frames));
  EXPECT_EQ(taken, drawn + refined - still_frames / 4) << "a quarter of the frames is gathered unseen";
  now_ms_ += 60'000.0;
  for (int k = 0; k < 50; ++k) step();
  EXPECT_EQ(picture_->drawn(), drawn);
  EXPECT_EQ(picture_->refined(), refined);
  EXPECT_EQ(panel_->taken, taken);
  EXPECT_EQ(live_->wake_at_ms(now_ms_), input::never_ms) << "an idle kiosk sleeps until something happens";
}

TEST_F(LiveTest, ATurnShowsWithTheNextFlip) {
  settle();
  const auto before = interface_->shown().weights().base;
  turn(6.0);
  step();
  step();
  EXPECT_NE(interface_->shown().weights().base, before);
  EXPECT_EQ(picture_->drawn(), 2u);
  EXPECT_EQ(live_->status().latency.count, 1u);
  EXPECT_LE(live_->status().latency.p95_ms, 20.0 + 1e-9);
}

TEST_F(LiveTest, ABusyPanelKeepsTheDamageAndGetsThePictureLater) {
  settle();
  const std::uint64_t taken = panel_->taken;
  panel_->refuse(3);
  turn(6.0);
  step();
  EXPECT_EQ(panel_->taken, taken);
  EXPECT_LE(live_->wake_at_ms(now_ms_), now_ms_) << "it has something to show";
  for (int k = 0; k < 3; ++k) step();
  EXPECT_GT(panel_->taken, taken);
}

TEST_F(LiveTest, WithoutAPanelInputCountsAndNothingIsDrawn) {
  settle();
  panel_->unplug();
  const std::uint64_t drawn = picture_->drawn();
  turn(6.0);
  for (int k = 0; k < 30; ++k) step();
  EXPECT_EQ(picture_->drawn(), drawn);
  EXPECT_NE(interface_->shown().weights().base.front(), 1.0);
  EXPECT_EQ(status()["state"], "waiting_for_display");
  EXPECT_EQ(status()["weights"]["base"], nlohmann::json(interface_->shown().weights().base))
      << "what is turned is told";
  EXPECT_GT(live_->wake_at_ms(now_ms_), now_ms_ + 3.5e6) << "all it waits for is that the visitor does not come back";
  panel_->plug({54, 128}, kiosk::Rotation::quarter);
  step();
  EXPECT_EQ(panel_->size_px, (std::array<int, 2>{128, 54})) << "another panel, mounted sideways";
  for (int k = 0; k < 30; ++k) step();
  EXPECT_EQ(status()["state"], "running");
  EXPECT_EQ(status()["mode"]["rotation"], 90);
}

TEST_F(LiveTest, TheSamePanelAgainGetsItsPictureWithoutANewOne) {
  settle();
  const std::uint64_t drawn = picture_->drawn(), taken = panel_->taken;
  panel_->unplug();
  step();
  panel_->plug({96, 54});
  step();
  EXPECT_EQ(panel_->taken, taken + 1);
  EXPECT_EQ(picture_->drawn(), drawn) << "what is on the framebuffer is still right";
}

TEST_F(LiveTest, TenThousandEventsCostOneFrame) {
  settle();
  const std::uint64_t drawn = picture_->drawn();
  for (int k = 0; k < 10'000; ++k) turn(k % 2 == 0 ? 0.01 : -0.005);
  step();
  EXPECT_EQ(picture_->drawn(), drawn + 1);
}

TEST_F(LiveTest, StatusFollowsAtMostTwiceASecond) {
  step();
  const auto first = status();
  EXPECT_EQ(first["packs"][0]["id"], "live-test");
  EXPECT_EQ(first["devices"][0]["name"], "hand");
  turn(12.0);
  step();
  EXPECT_EQ(status(), first) << "20 ms later it is not written again";
  for (int k = 0; k < 30; ++k) step();
  EXPECT_NE(status()["weights"], first["weights"]);
  live_->stop();
  EXPECT_EQ(status()["state"], "stopped");
}

TEST_F(LiveTest, AVisitorWhoHasGoneIsCountedDownAndForgotten) {
  kiosk::InterfaceSettings settings;
  settings.shown = false;
  settings.experience.tour = false;
  settings.experience.idle_s = 30.0;
  settings.experience.countdown_s = 5.0;
  start(settings);
  settle();
  turn(6.0);
  step();
  EXPECT_NE(interface_->shown().weights().base.front(), 1.0);
  for (int k = 0; k < 50; ++k) step();  // nothing glides or blends any more
  EXPECT_NEAR(live_->wake_at_ms(now_ms_), now_ms_ + 29e3, 1e3);
  now_ms_ += 31e3;
  step();
  EXPECT_TRUE(interface_->model().countdown_s);
  now_ms_ += 6e3;
  step();
  EXPECT_EQ(interface_->model().screen, kiosk::ui::Screen::attract);
  EXPECT_EQ(interface_->shown().weights().base.front(), 1.0);
  for (int k = 0; k < 50; ++k) step();
  EXPECT_EQ(live_->wake_at_ms(now_ms_), input::never_ms);
}

TEST_F(LiveTest, AtNightThePanelIsOffUntilSomebodyComes) {
  kiosk::InterfaceSettings settings;
  settings.shown = false;
  settings.experience.tour = false;
  settings.experience.night = {22 * 60, 6 * 60};
  start(settings);
  settle();
  EXPECT_TRUE(panel_->powered);
  minute_ = 23 * 60;
  now_ms_ += 120e3;
  step();
  EXPECT_FALSE(panel_->powered);
  const std::uint64_t taken = panel_->taken;
  for (int k = 0; k < 20; ++k) step();
  EXPECT_EQ(panel_->taken, taken) << "nobody sees it";
  EXPECT_GT(live_->wake_at_ms(now_ms_), now_ms_ + 30e3);
  turn(6.0);
  step();
  step();
  EXPECT_TRUE(panel_->powered);
  EXPECT_GT(panel_->taken, taken);
}

TEST_F(LiveTest, ATourDrawsEveryFrameAndDoesNotSpinWithoutAPanel) {
  kiosk::InterfaceSettings settings;
  settings.shown = false;
  start(settings);
  for (int k = 0; k < 10; ++k) step();
  EXPECT_GE(picture_->drawn(), 8u);
  EXPECT_LE(live_->wake_at_ms(now_ms_), now_ms_ + 20.0);
  panel_->unplug();
  step();
  for (int k = 0; k < 30; ++k) step();
  EXPECT_GT(live_->wake_at_ms(now_ms_), now_ms_ + 100.0);
}

TEST_F(LiveTest, TheInterfaceIsOnThePanelAndCostsNothingWhileItRests) {
  kiosk::InterfaceSettings settings;
  settings.experience.tour = false;
  settings.experience.reduced_motion = true;
  settings.dpi = 10.0;  // the picture is small, not the panel
  start(settings);
  settle();
  // Longer than the pause before swatches are drawn.
  for (int k = 0; k < 60; ++k) step();
  EXPECT_FALSE(interface_->wants_swatch());
  const std::uint64_t sent = interface_->overlay()->sent_bytes(), taken = panel_->taken;
  EXPECT_GT(sent, 0u);
  for (int k = 0; k < 20; ++k) step();
  EXPECT_EQ(panel_->taken, taken);
  EXPECT_EQ(interface_->overlay()->sent_bytes(), sent);
  EXPECT_EQ(live_->wake_at_ms(now_ms_), input::never_ms);
  EXPECT_EQ(status()["screen"], "attract");
  turn(2.0);
  step();
  for (int k = 0; k < 30; ++k) step();
  EXPECT_EQ(status()["screen"], "show");
  bool swatch = false;
  const auto now = status();
  for (const auto& control : now["controls"]) swatch |= control["widget"] == "swatch" && control["index"] == 1;
  EXPECT_TRUE(swatch) << now["controls"];
}

TEST_F(LiveTest, AReportOfTheImporterIsToldAndKeptForTheDealer) {
  kiosk::InterfaceSettings settings;
  settings.experience.tour = false;
  settings.experience.reduced_motion = true;
  settings.dpi = 10.0;
  start(settings);
  for (int k = 0; k < 80; ++k) step();
  std::vector<int> descriptors;
  live_->add_descriptors(descriptors);
  EXPECT_EQ(descriptors.size(), 1u) << "the folder is watched";
  const std::uint64_t taken = panel_->taken, drawn = picture_->drawn();
  kiosk::ImportReport report;
  report.time_s = static_cast<std::int64_t>(kiosk::wall_clock_s());
  report.files.resize(1);
  report.files[0].outcome = kiosk::ImportedFile::Outcome::stored;
  report.files[0].id = "demo.spring";
  ASSERT_TRUE(kiosk::write_import(folder_, report));
  step();
  step();
  ASSERT_TRUE(interface_->model().toast);
  EXPECT_EQ(interface_->model().toast->stored, std::vector<std::string>{"demo.spring"});
  EXPECT_GT(panel_->taken, taken) << "it is on the panel";
  EXPECT_EQ(picture_->drawn(), drawn) << "and the car was not drawn again for it";
  now_ms_ += kiosk::toast_ms;
  step();
  step();
  EXPECT_FALSE(interface_->model().toast);

  std::ofstream(folder_ / "fresh") << "{";
  std::filesystem::rename(folder_ / "fresh", folder_ / kiosk::import_file_name);
  for (int k = 0; k < 5; ++k) step();
  ASSERT_EQ(log_.problems().size(), 1u) << "one line";
  EXPECT_NE(log_.problems()[0].text.find(kiosk::import_file_name), std::string::npos);
  EXPECT_FALSE(interface_->model().toast);
}

TEST_F(LiveTest, WhoeverHasAPassForItDimsThePicture) {
  kiosk::InterfaceSettings settings;
  settings.experience.tour = false;
  settings.experience.reduced_motion = true;
  settings.experience.brightness = 0.5;
  settings.dpi = 10.0;
  const auto sum = [&] {
    double all = 0.0;
    for (const std::uint8_t byte : panel_->last.rgb) all += byte;
    return all;
  };
  panel_->keeps = true;
  start(settings);
  settle();
  const double dark = sum();
  panel_->dims = true;
  start(settings);
  settle();
  EXPECT_EQ(panel_->brightness, 0.5f);
  EXPECT_NEAR(dark / sum(), 0.5, 0.02) << "not dimmed twice, and not by nobody";
}

TEST_F(LiveTest, ThePanelsOwnSizeCountsUnlessOneIsConfigured) {
  kiosk::InterfaceSettings settings;
  for (const double dpi : {0.0, 50.0}) {
    settings.dpi = dpi;
    start(settings);
    panel_->plug({96, 54}, kiosk::Rotation::none, {24, 14});
    step();
    EXPECT_NEAR(interface_->experience().surface().dpi, dpi > 0.0 ? dpi : 100.0, 2.0);
    panel_->plug({96, 54}, kiosk::Rotation::none, {160, 90});
    step();
    EXPECT_EQ(interface_->experience().surface().dpi, dpi > 0.0 ? dpi : 96.0) << "a shape, no size";
  }
}

TEST_F(LiveTest, ALostDeviceEndsTheLoopWithItsName) {
  settle();
  panel_->lose();
  turn(6.0);
  const auto stepped = live_->step(now_ms_ + 20.0);
  ASSERT_FALSE(stepped);
  EXPECT_NE(stepped.error().line().find("card9"), std::string::npos);
}

}  // namespace
}  // namespace lackwerk::test
