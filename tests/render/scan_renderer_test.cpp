// Scans drawn: on both backends the same, in motion smooth, thinned where they must be, and swapped with paints.
#include "render_gles/scan_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "kiosk/display/interface.hpp"
#include "kiosk/display/picture.hpp"
#include "tests/render/kiosk_stage.hpp"
#include "tests/render/support.hpp"
#include "tests/unit/scan_samples.hpp"

namespace lackwerk::test {
namespace {

class ScanRendererTest : public OnDriver {
 protected:
  void SetUp() override {
    OnDriver::SetUp();
    if (!context_) return;
    renderer_ = std::make_unique<gles::ScanRenderer>(*context_);
    renderer_->set_pack(pack_);
    auto made = gles::Framebuffer::create(*context_, width, height);
    ASSERT_TRUE(made) << made.error().line();
    target_.emplace(std::move(*made));
    view_ = renderer_->view_from(30.0, 14.0, static_cast<double>(width) / height);
  }
  void TearDown() override {
    target_.reset();
    renderer_.reset();
  }
  gles::Image draw(double time, const gles::ScanLook& look = {}) {
    renderer_->draw(view_, look, time, *target_);
    return target_->read();
  }
  /// Mean difference of two pictures' bytes, of 255.
  static double apart(const gles::Image& a, const gles::Image& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) sum += std::abs(int{a.rgb[k]} - int{b.rgb[k]});
    return sum / static_cast<double>(a.rgb.size());
  }
  /// Pixels that are clearly green: of a plant, not of floor or backdrop.
  static int green(const gles::Image& image) {
    int count = 0;
    for (std::size_t k = 0; k + 2 < image.rgb.size(); k += 3)
      count += int{image.rgb[k + 1]} > int{image.rgb[k + 2]} + 20 ? 1 : 0;
    return count;
  }

  /// The highest row with anything of the plant.
  static int top(const gles::Image& image) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (int{image.pixel(x, y)[1]} > int{image.pixel(x, y)[2]} + 20) return y;
    return image.height;
  }

  static constexpr int width = 320, height = 180;
  packs::ScanPack pack_ = lackwerk::testing::SampleScans("render", 1, 6000).pack();
  std::unique_ptr<gles::ScanRenderer> renderer_;
  std::optional<gles::Framebuffer> target_;
  gles::View view_;
};

TEST_P(ScanRendererTest, ItGrows) {
  const gles::Image small = draw(5.0), middle = draw(6.0), tall = draw(8.0);
  for (const gles::Image* image : {&small, &middle, &tall}) EXPECT_GT(green(*image), 100);
  EXPECT_LT(top(middle), top(small) - height / 20);
  EXPECT_LT(top(tall), top(middle) - height / 10);
  EXPECT_EQ(context_->gl().GetError(), static_cast<GLenum>(GL_NO_ERROR));
  // Outside of its scans it stands still.
  EXPECT_EQ(apart(draw(-100.0), draw(5.0)), 0.0);
  EXPECT_EQ(apart(draw(1e9), draw(8.0)), 0.0);
}

TEST_P(ScanRendererTest, TimeHasNoSteps) {
  // Over the scan in the middle, where another step comes to the GPU: both sides of it are the same picture.
  EXPECT_LT(apart(draw(6.0 - 1e-7), draw(6.0 + 1e-7)), 0.05);
  gles::Image before = draw(5.0);
  double most = 0.0;
  for (int k = 1; k <= 60; ++k) {
    gles::Image now = draw(5.0 + 0.05 * k);
    most = std::max(most, apart(before, now));
    before = std::move(now);
  }
  EXPECT_LT(most, 5.0) << "a fiftieth of the way never changes much";
  EXPECT_GT(most, 0.1);
}

TEST_P(ScanRendererTest, TheCpuDrawsWhatTheShadersDraw) {
  if (!context_->info().fragment_highp) return;  // nobody may choose it there
  gles::ScanLook shaders, cpu;
  shaders.way = gles::ScanWay::shaders;
  cpu.way = gles::ScanWay::cpu;
  const gles::View far = view_;
  for (const float nearer : {1.0f, 0.3f}) {  // squares, then discs
    view_.eye_mm = glm::mix(far.target_mm, far.eye_mm, nearer);
    for (const double time : {5.0, 5.3, 7.77, 8.0}) {
      const gles::Image shader = draw(time, shaders);
      const gles::Image splatted = draw(time, cpu);
      EXPECT_LT(apart(shader, splatted), 0.2) << time;
      EXPECT_GT(green(splatted), 100) << time;
    }
  }
  EXPECT_EQ(context_->gl().GetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_P(ScanRendererTest, NothingChangedNothingToDraw) {
  EXPECT_TRUE(renderer_->needs_draw(view_, {}, 6.5, *target_));
  (void)draw(6.5);
  EXPECT_FALSE(renderer_->needs_draw(view_, {}, 6.5, *target_));
  EXPECT_TRUE(renderer_->needs_draw(view_, {}, 6.6, *target_));
  gles::View turned = view_;
  turned.eye_mm.x += 1.0f;
  EXPECT_TRUE(renderer_->needs_draw(turned, {}, 6.5, *target_));
  gles::ScanLook fewer;
  fewer.most_points = 100;
  EXPECT_TRUE(renderer_->needs_draw(view_, fewer, 6.5, *target_));
}

TEST_P(ScanRendererTest, FewerPointsCoverAsMuch) {
  const int all = green(draw(8.0));
  gles::ScanLook fewer;
  fewer.most_points = 1500;
  const int few = green(draw(8.0, fewer));
  EXPECT_LE(renderer_->drawn_points(), 1500u);
  EXPECT_GT(few, all * 7 / 10);
  EXPECT_LT(few, all * 13 / 10);
  // From far away only as many as there are pixels for.
  view_.eye_mm = view_.target_mm + 12.0f * (view_.eye_mm - view_.target_mm);
  (void)draw(8.0);
  EXPECT_LT(renderer_->drawn_points(), 3000u) << "thinned";
}

INSTANTIATE_TEST_SUITE_P(Everywhere, ScanRendererTest, ::testing::ValuesIn(all_drivers),
                         [](const auto& info) { return driver_name(info.param); });

/// A stage that shows paints and then scans, as when a dealer adds a pack.
class ScanStage : public OnBackend {};

TEST_P(ScanStage, PaintsAndScansTakeTurns) {
  auto stage = synthetic_stage(*context_, 192, 108);
  ASSERT_TRUE(stage);
  EXPECT_FALSE(stage->shows_scans());
  kiosk::Log log(nullptr);
  kiosk::InterfaceSettings settings;
  settings.dpi = 20.0;
  settings.experience.tour = false;
  settings.experience.reduced_motion = true;
  auto interface = kiosk::Interface::create(*stage, settings, log);
  ASSERT_TRUE(interface) << interface.error().line();
  kiosk::Picture picture(*stage, kiosk::PictureSettings{"best", 62, 0});
  ASSERT_TRUE(picture.prepare((*interface)->shown()));
  double now_ms = 1000.0;
  const auto frame = [&](bool weights) {
    now_ms += 33.0;
    (void)(*interface)->advance(now_ms, 720);
    (void)(*interface)->compare(false);
    const auto stepped = picture.step((*interface)->shown(), weights);
    EXPECT_TRUE(stepped);
    const auto composed = (*interface)->compose(stage->framebuffer());
    EXPECT_TRUE(composed);
    return (*composed)->read();
  };
  for (int k = 0; k < 3; ++k) (void)frame(k == 0);
  const gles::Image paints = frame(false);

  ASSERT_TRUE(stage->set_pack(lackwerk::testing::SampleScans("swap", 2, 3000).pack()));
  (*interface)->content_changed(now_ms, true);
  EXPECT_TRUE(stage->shows_scans());
  EXPECT_EQ(stage->pack().id(), "swap");
  EXPECT_FALSE((*interface)->wants_swatch());
  const gles::Image first = frame(true);
  EXPECT_LT(different_bytes(first, paints), paints.rgb.size() / 2) << "it fades in from what was there";
  for (int k = 0; k < 40; ++k) (void)frame(false);
  const gles::Image scans = frame(false);
  EXPECT_GT(different_bytes(scans, paints), paints.rgb.size() / 10);
  EXPECT_TRUE(picture.resting());
  EXPECT_NE(picture.quality().find("points"), std::string::npos);
  const std::uint64_t drawn = picture.drawn();
  for (int k = 0; k < 5; ++k) (void)frame(false);
  EXPECT_EQ(picture.drawn(), drawn) << "nothing changes, nothing is drawn";
  // The slider moves them.
  (void)(*interface)->begin_visit(now_ms);
  (void)(*interface)->take({input::ControlKind::time, {0.1}, {}, 0, 0}, now_ms);
  const gles::Image small = frame(false);
  EXPECT_GT(picture.drawn(), drawn);
  EXPECT_GT(different_bytes(small, scans), 500u);

  auto again = synthetic_stage(*context_, 16, 16);
  ASSERT_TRUE(again);
  ASSERT_TRUE(stage->set_pack(lackwerk::testing::SampleScans("third", 1, 300).pack()));
  (*interface)->content_changed(now_ms, true);
  (void)frame(true);
  EXPECT_EQ(stage->cameras().size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, ScanStage,
                         ::testing::Values(gles::Backend::egl_surfaceless, gles::Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

}  // namespace
}  // namespace lackwerk::test
