// The live kiosk on twins: a panel that can be pulled out, devices that say what the test wants, a clock in numbers.
#include "kiosk/display/live.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "packs/paint_pack.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using input::Control;
using input::ControlKind;
using kiosk::OutputState;
using kiosk::Presented;

/// A panel whose flips come when the test says so.
class Panel final : public kiosk::Output {
 public:
  explicit Panel(gles::Context& context) : context_(context) { mode_.panel_px = {96, 54}; }

  [[nodiscard]] kiosk::Platform platform() const override { return kiosk::Platform::kms; }
  [[nodiscard]] gles::Context& context() override { return context_; }
  [[nodiscard]] OutputState state() const override { return state_; }
  [[nodiscard]] const kiosk::OutputMode& mode() const override { return mode_; }
  [[nodiscard]] std::uint64_t revision() const override { return revision_; }
  [[nodiscard]] bool ready() const override { return state_ == OutputState::running && !pending_; }
  [[nodiscard]] Result<Presented> present(const gles::Framebuffer& picture) override {
    if (lost_) return fail("/dev/dri/card9", "", "device lost", "restart");
    if (busy_ > 0) {
      --busy_;
      return Presented::refused;
    }
    size_px = {picture.width(), picture.height()};
    pending_ = true;
    ++taken;
    return Presented::queued;
  }
  void add_descriptors(std::vector<int>& /*out*/) const override {}
  [[nodiscard]] Result<void> dispatch(double /*now_ms*/) override { return {}; }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  [[nodiscard]] std::uint64_t flipped_at_us() const override { return flipped_us_; }
  [[nodiscard]] std::uint64_t presented() const override { return taken; }
  void set_power(bool /*on*/) override {}
  void set_profile(const kiosk::DisplayProfile& /*profile*/) override {}

  void flip(std::uint64_t at_us) {
    pending_ = false;
    flipped_us_ = at_us;
  }
  void plug(std::array<int, 2> panel_px, kiosk::Rotation rotation = kiosk::Rotation::none) {
    mode_.panel_px = panel_px;
    mode_.rotation = rotation;
    set(OutputState::running);
  }
  void unplug() { set(OutputState::waiting_for_display); }
  void refuse(int times) { busy_ = times; }
  void lose() { lost_ = true; }

  std::uint64_t taken = 0;
  std::array<int, 2> size_px{};

 private:
  void set(OutputState state) {
    state_ = state;
    pending_ = false;
    ++revision_;
  }
  gles::Context& context_;
  OutputState state_ = OutputState::running;
  kiosk::OutputMode mode_;
  std::uint64_t revision_ = 1, flipped_us_ = 0;
  bool pending_ = false, lost_ = false;
  int busy_ = 0;
};

/// What the test wants to be turned and touched.
struct Hand {
  std::vector<Control> next;
};
class HandSource final : public input::Source {
 public:
  explicit HandSource(Hand& hand) : hand_(hand) {}
  void add_descriptors(std::vector<int>& /*out*/) const override {}
  void read(double /*now_ms*/, std::vector<Control>& out) override {
    out.insert(out.end(), hand_.next.begin(), hand_.next.end());
    hand_.next.clear();
  }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  void add_devices(std::vector<input::DeviceStatus>& out) const override {
    out.push_back({"hand", "knob", "ready", ""});
  }
  void take_notices(std::vector<input::Notice>& /*out*/) override {}

 private:
  Hand& hand_;
};

class LiveTest : public testing::Test {
 protected:
  void SetUp() override {
    context_ = open_context(gles::Backend::egl_surfaceless, reason_);
    if (!context_) GTEST_SKIP() << reason_;
    folder_ = std::filesystem::temp_directory_path() / ("lackwerk_live_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    const SyntheticPaint paint({.table = false, .lobes = 2});
    packs::PackContents contents;
    contents.info.id = "live-test";
    contents.info.serial = 7;
    contents.info.errors.resize(paint.get().paints.size());
    for (packs::PaintError& error : contents.info.errors)
      error.flake_w1_slice.resize(static_cast<std::size_t>(paint.get().layout.slice_count()));
    contents.paint = paint.get();
    const auto written = packs::write_paint_pack(folder_ / "p.lwp", contents);
    ASSERT_TRUE(written) << written.error().line();
    auto pack = packs::PaintPack::open(folder_ / "p.lwp", packs::Backing::copy);
    ASSERT_TRUE(pack) << pack.error().line();
    packs::Scene scene;
    scene.name = "sphere";
    scene.parts = {sphere(100.0f, 24)};
    scene.cameras = {{"hero", {0.0f, -400.0f, 150.0f}, {0.0f, 0.0f, 0.0f}, 40.0f}};
    auto stage = kiosk::Stage::create(*context_, 96, 54, std::move(*pack), std::move(scene));
    ASSERT_TRUE(stage) << stage.error().line();
    stage_ = std::move(*stage);
    panel_ = std::make_unique<Panel>(*context_);
    state_.emplace(static_cast<int>(stage_->pack().paint().paints.size()), stage_->scene().cameras);
    picture_.emplace(*stage_, kiosk::PictureSettings{"best", 62, still_frames});
    kiosk::Devices devices;
    devices.sources.push_back(std::make_unique<HandSource>(hand_));
    live_ = std::make_unique<kiosk::Live>(*panel_, *stage_, *picture_, *state_, std::move(devices), std::nullopt, log_,
                                          service_, kiosk::LiveSettings{folder_.string(), "p.lwp", {}});
  }
  void TearDown() override {
    live_.reset();
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
  std::optional<kiosk::State> state_;
  std::optional<kiosk::Picture> picture_;
  kiosk::Log log_{nullptr};
  kiosk::Service service_;
  Hand hand_;
  std::unique_ptr<kiosk::Live> live_;
  double now_ms_ = 1e6;
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
  const auto before = state_->weights().base;
  turn(6.0);
  step();
  step();
  EXPECT_NE(state_->weights().base, before);
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
  EXPECT_NE(state_->weights().base.front(), 1.0);
  EXPECT_EQ(status()["state"], "waiting_for_display");
  EXPECT_EQ(status()["weights"]["base"], nlohmann::json(state_->weights().base)) << "what is turned is told";
  EXPECT_EQ(live_->wake_at_ms(now_ms_), input::never_ms);
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
