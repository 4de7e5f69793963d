// Behaviour, painter and overlay together: what is touched is what is seen, a comparison shows two paints at once, and
// what is not shown costs nothing.
#include "kiosk/display/interface.hpp"

#include <gtest/gtest.h>

#include "kiosk/display/picture.hpp"
#include "kiosk/display/test_pattern.hpp"
#include "tests/render/kiosk_stage.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using input::ControlKind;
using kiosk::Rotation;
using kiosk::ui::Screen;

class InterfaceTest : public OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (!context_) return;
    stage_ = synthetic_stage(*context_, 480, 270);
    ASSERT_TRUE(stage_);
    settings_.dpi = 40.0;  // a large panel with few pixels: there is room for everything
    settings_.experience.tour = false;
    settings_.experience.reduced_motion = true;
    make();
  }
  void TearDown() override {
    picture_.reset();
    interface_.reset();
    stage_.reset();
  }
  void make() {
    picture_.reset();
    interface_.reset();
    auto made = kiosk::Interface::create(*stage_, settings_, log_);
    ASSERT_TRUE(made) << made.error().line();
    interface_ = std::move(*made);
    picture_.emplace(*stage_, kiosk::PictureSettings{"best", 62, 0});
    ASSERT_TRUE(picture_->prepare(interface_->shown()));
  }
  /// One frame as the kiosk draws it; what was composed.
  gles::Image frame() {
    now_ms_ += 33.0;
    weights_ |= interface_->advance(now_ms_, 720).weights;
    weights_ |= interface_->compare(!weights_ && !picture_->differs(interface_->shown()));
    EXPECT_TRUE(picture_->step(interface_->shown(), weights_));
    weights_ = false;
    const auto composed = interface_->compose(stage_->framebuffer());
    EXPECT_TRUE(composed);
    return composed ? (*composed)->read() : gles::Image(1, 1);
  }
  void take(ControlKind kind, const std::string& target) {
    weights_ |= interface_->take({kind, {1.0}, target, 0, 0}, now_ms_).weights;
    EXPECT_FALSE(interface_->take_complaint()) << target;
  }
  void tap(const std::string& target) {
    take(ControlKind::touch_down, target);
    now_ms_ += 80.0;
    take(ControlKind::touch_up, "script");
    for (int k = 0; k < 20; ++k) (void)frame();  // what glides has arrived
  }

  std::unique_ptr<kiosk::Stage> stage_;
  kiosk::InterfaceSettings settings_;
  kiosk::Log log_{nullptr};
  std::unique_ptr<kiosk::Interface> interface_;
  std::optional<kiosk::Picture> picture_;
  bool weights_ = true;
  double now_ms_ = 1000.0;
};

TEST_P(InterfaceTest, ATapOnASwatchShowsThatPaintExactly) {
  tap("@picture:0.4,0.3");
  ASSERT_EQ(interface_->model().screen, Screen::show);
  tap("@swatch:1");
  EXPECT_EQ(interface_->shown().weights().base[1], 1.0);
  EXPECT_FALSE(interface_->stale());
  tap("@swatch:0");
  EXPECT_EQ(interface_->shown().weights().base[0], 1.0);
}

TEST_P(InterfaceTest, ControlsAreWhereTheirTouchesGo) {
  for (const Rotation rotation : {Rotation::none, Rotation::quarter, Rotation::half}) {
    make();
    const std::array<int, 2> panel =
        rotation == Rotation::quarter ? std::array<int, 2>{270, 480} : std::array<int, 2>{480, 270};
    interface_->set_surface(rotation, panel);
    (void)interface_->begin_visit(now_ms_);
    bool found = false;
    for (const kiosk::ControlStatus& control : interface_->controls()) {
      if (control.widget != "swatch" || control.index != 1) continue;
      found = true;
      // As a device would say it.
      weights_ |= interface_->take({ControlKind::touch_down, {control.x, control.y}, {}, 5, 0}, now_ms_).weights;
      weights_ |= interface_->take({ControlKind::touch_up, {}, {}, 5, 0}, now_ms_ + 50.0).weights;
    }
    EXPECT_TRUE(found);
    for (int k = 0; k < 20; ++k) (void)frame();
    EXPECT_EQ(interface_->shown().weights().base[1], 1.0) << kiosk::degrees_of(rotation);
  }
}

TEST_P(InterfaceTest, HeldCompareShowsMixAndNearestPaintBesideEachOther) {
  tap("@picture:0.4,0.3");
  tap("@pad:0.3,0.5");
  const auto mix = interface_->shown().weights();
  const gles::Image before = stage_->framebuffer().read();
  take(ControlKind::touch_down, "@compare");
  (void)frame();
  (void)frame();
  ASSERT_TRUE(interface_->model().nearest);
  const auto nearest = static_cast<std::size_t>(interface_->model().nearest->paint);
  EXPECT_EQ(interface_->shown().weights().base[nearest], 1.0);
  EXPECT_EQ(interface_->experience().state().weights(), mix) << "the visitor's mix is kept";
  const gles::Image both = frame();
  const gles::Image alone = stage_->framebuffer().read();
  EXPECT_GT(different_bytes(before, alone), 1000u) << "the two paints differ";
  // On the row through the sphere's middle, away from the divider and what lies on it.
  int held = 0, shown = 0;
  for (int x = 150; x < 230; ++x) held += std::equal(both.pixel(x, 190), both.pixel(x, 190) + 3, before.pixel(x, 190));
  for (int x = 250; x < 330; ++x) shown += std::equal(both.pixel(x, 190), both.pixel(x, 190) + 3, alone.pixel(x, 190));
  EXPECT_GT(held, 40);
  EXPECT_GT(shown, 40);
  take(ControlKind::touch_up, "script");
  (void)frame();
  EXPECT_EQ(interface_->shown().weights(), mix);
  EXPECT_EQ(different_bytes(stage_->framebuffer().read(), before), 0u);
}

TEST_P(InterfaceTest, NothingChangesNothingIsComposedOrSent) {
  (void)frame();
  const std::uint64_t sent = interface_->overlay()->sent_bytes(), tiles = interface_->painter()->tiles_drawn();
  for (int k = 0; k < 5; ++k) {
    EXPECT_FALSE(interface_->stale());
    (void)frame();
  }
  EXPECT_EQ(interface_->overlay()->sent_bytes(), sent);
  EXPECT_EQ(interface_->painter()->tiles_drawn(), tiles);
}

TEST_P(InterfaceTest, SwatchesComeOneByOneAndLeaveThePictureAlone) {
  (void)frame();
  const gles::Image before = stage_->framebuffer().read();
  int steps = 0;
  for (; interface_->wants_swatch(); ++steps) interface_->make_swatch();
  EXPECT_EQ(steps, 3) << "one to set up, one for each paint";
  EXPECT_TRUE(interface_->stale());
  EXPECT_EQ(different_bytes(stage_->framebuffer().read(), before), 0u);
  EXPECT_TRUE(log_.problems().empty());
  // The renderer goes on as if nothing had been.
  picture_->lost();
  (void)interface_->take({ControlKind::orbit, {5.0, 0.0}, {}, 0, 0}, now_ms_);
  (void)frame();
  (void)interface_->take({ControlKind::camera, {}, "hero", 0, 0}, now_ms_);
  (void)frame();
  EXPECT_EQ(different_bytes(stage_->framebuffer().read(), before), 0u);
}

TEST_P(InterfaceTest, HiddenItCostsNothingAndBehavesAlike) {
  settings_.shown = false;
  make();
  const auto composed = interface_->compose(stage_->framebuffer());
  ASSERT_TRUE(composed);
  EXPECT_EQ(*composed, &stage_->framebuffer());
  EXPECT_FALSE(interface_->stale());
  EXPECT_EQ(interface_->overlay(), nullptr);
  (void)interface_->begin_visit(now_ms_);
  tap("@swatch:1");
  EXPECT_EQ(interface_->shown().weights().base[1], 1.0);
}

TEST_P(InterfaceTest, AScriptThatTouchesWhatIsNotThereSaysSo) {
  (void)interface_->begin_visit(now_ms_);
  for (const char* target : {"@swatch:7", "@nothing", "@pin_key:1", "@swatch:0.5"}) {
    (void)interface_->take({ControlKind::touch_down, {1.0}, target, 0, 0}, now_ms_);
    const auto complaint = interface_->take_complaint();
    ASSERT_TRUE(complaint) << target;
    (void)interface_->take({ControlKind::touch_up, {}, "script", 0, 0}, now_ms_);
    EXPECT_FALSE(interface_->take_complaint()) << "said once";
  }
}

TEST_P(InterfaceTest, DriftAndDimmingAreSeenAndTouchesFollow) {
  settings_.drift_px = 8;
  settings_.attract_brightness = 0.5;
  make();
  const gles::Image bright = frame();
  double sum = 0.0, all = 0.0;
  for (const std::uint8_t byte : bright.rgb) sum += byte;
  const gles::Image plain = stage_->framebuffer().read();
  for (const std::uint8_t byte : plain.rgb) all += byte;
  EXPECT_LT(sum, 0.8 * all);
  now_ms_ += kiosk::drift_rest_ms + kiosk::drift_step_ms;
  (void)interface_->advance(now_ms_, 720);
  EXPECT_TRUE(interface_->stale());
  EXPECT_NE(different_bytes(frame(), bright), 0u);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, InterfaceTest,
                         testing::Values(gles::Backend::egl_surfaceless, gles::Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

}  // namespace
}  // namespace lackwerk::test
