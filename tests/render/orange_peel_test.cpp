// Orange peel bends the coat's mirror image by what it says, and nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "render_gles/renderer.hpp"
#include "tests/render/golden_scenes.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;

constexpr int edge_px = 256;
constexpr float radius_mm = 100.0f, eye_mm = 400.0f, fov_deg = 4.0f;

/// 21 mm of a sphere, so near that a pixel is a thirtieth of the shortest wave.
const gles::View near_view{{0.0f, -eye_mm, 0.0f}, {0.0f, 0.0f, 0.0f}, fov_deg, {}};

class OrangePeelTest : public OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (!context_) return;
    target_ = std::make_unique<gles::Framebuffer>(gles::Framebuffer::create(*context_, edge_px, edge_px).value());
    renderer_ = std::make_unique<gles::Renderer>(*context_);
    packs::Scene scene;
    scene.parts = {sphere(radius_mm, 256)};
    scene.environment = golden_environment();
    renderer_->set_scene(scene);
    ASSERT_TRUE(renderer_->set_paint(paint_.get()));
    ASSERT_TRUE(renderer_->update(mix(0.4)));
    lighting_.dither = false;
    lighting_.quality.smooth_edges = false;
    lighting_.quality.flakes = gles::FlakeMode::mean;
  }
  void TearDown() override {
    renderer_.reset();
    target_.reset();
  }
  gles::Image picture(const gles::View& view, float mrad, int samples = 1) {
    lighting_.orange_peel_mrad = mrad;
    return renderer_->still(view, lighting_, *target_, samples);
  }

  const SyntheticPaint paint_{{.flakes = false}};
  gles::Lighting lighting_;
  std::unique_ptr<gles::Framebuffer> target_;
  std::unique_ptr<gles::Renderer> renderer_;
};

/// Rows from the middle to where the bright stripe ends, upwards (-1) or downwards (1).
double stripe_end(const gles::Image& image, int x, int direction) {
  constexpr double half = 128.0;
  constexpr int middle = edge_px / 2;
  double before = image.pixel(x, middle)[1];
  for (int k = 1; k < middle; ++k) {
    const double now = image.pixel(x, middle + direction * k)[1];
    if (now < half) return k - 1 + (before - half) / (before - now);
    before = now;
  }
  return middle;
}

TEST_P(OrangePeelTest, NoneIsNotCompiledInAndChangesNoByte) {
  gles::Features features;
  features.coat = true;
  EXPECT_EQ(gles::fragment_source(features, true).find("u_peel"), std::string::npos);
  const gles::Image plain = renderer_->still(near_view, lighting_, *target_, 1);
  EXPECT_EQ(picture(near_view, 0.0f), plain);
  const std::size_t programs = renderer_->program_count();
  EXPECT_NE(picture(near_view, 5.0f), plain);
  EXPECT_EQ(renderer_->program_count(), programs + 1);
  EXPECT_EQ(picture(near_view, 0.0f), plain);
  EXPECT_EQ(renderer_->program_count(), programs + 1);
}

// The stripe's edge stands where the mirrored direction has a certain angle. Along the sphere it turns by 2 / radius +
// 1 / distance per mm, and by twice the tilt of the normal, of which one axis has 1 / sqrt 2.
TEST_P(OrangePeelTest, StripesWobbleByTheTilt) {
  lighting_.stripes = true;
  const double distance = static_cast<double>(eye_mm - radius_mm);
  const double pixel_mm = static_cast<double>(gles::pixel_size_per_mm(near_view, edge_px)) * distance;
  const double mm_per_tilt = 2.0 / (2.0 / static_cast<double>(radius_mm) + 1.0 / distance);
  const gles::Image plain = picture(near_view, 0.0f);
  for (const float mrad : {1.0f, 3.0f, 6.0f}) {
    const gles::Image peeled = picture(near_view, mrad);
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (int x = 0; x < edge_px; ++x)
      for (const int direction : {-1, 1}) {
        const double moved = (stripe_end(peeled, x, direction) - stripe_end(plain, x, direction)) * pixel_mm;
        sum += moved;
        squares += moved * moved;
        ++count;
      }
    const double rms_mrad = 1e3 * std::sqrt(2.0 * squares / count) / mm_per_tilt;
    std::printf("  asked %.0f mrad, shown %.2f; edges move by %.3f mm on average\n", static_cast<double>(mrad),
                rms_mrad, sum / count);
    EXPECT_NEAR(rms_mrad / static_cast<double>(mrad), 1.0, 0.3);
    EXPECT_LT(std::abs(sum / count), 0.5 * std::sqrt(squares / count)) << "waves, not a tilted panel";
  }
}

TEST_P(OrangePeelTest, KeepsTheLight) {
  gles::View whole = near_view;
  whole.vertical_fov_deg = 16.0f;
  const double plain = mean_luminance(picture(whole, 0.0f), std::vector<std::uint8_t>(edge_px * edge_px, 1));
  const double peeled = mean_luminance(picture(whole, 5.0f), std::vector<std::uint8_t>(edge_px * edge_px, 1));
  std::printf("  mean light with 5 mrad over without: %.4f\n", peeled / plain);
  EXPECT_NEAR(peeled / plain, 1.0, 0.01);
}

TEST_P(OrangePeelTest, StillPicturesHaveTheSameWaves) {
  const auto waves = [&](int samples) {
    const gles::Image peeled = picture(near_view, 6.0f, samples), plain = picture(near_view, 0.0f, samples);
    // Means of blocks: waves are wider, the samples' grain is not.
    constexpr int block_px = 8, blocks = edge_px / block_px;
    std::vector<double> out(static_cast<std::size_t>(blocks) * blocks, 0.0);
    for (int y = 0; y < edge_px; ++y)
      for (int x = 0; x < edge_px; ++x)
        out[static_cast<std::size_t>(y / block_px * blocks + x / block_px)] +=
            peeled.pixel(x, y)[1] - plain.pixel(x, y)[1];
    return out;
  };
  const std::vector<double> moving = waves(1), still = waves(gles::sampled_still_frames);
  double both = 0.0, first = 0.0, second = 0.0;
  for (std::size_t k = 0; k < moving.size(); ++k) {
    both += moving[k] * still[k];
    first += moving[k] * moving[k];
    second += still[k] * still[k];
  }
  ASSERT_GT(first, 0.0);
  std::printf("  correlation of the waves in moving and still: %.3f\n", both / std::sqrt(first * second));
  EXPECT_GT(both / std::sqrt(first * second), 0.8);
}

// At 4 m and 30 degrees a pixel is 8 mm wide: no wave of 2.4 to 9 mm may show.
TEST_P(OrangePeelTest, FadesBeforeItCouldAlias) {
  gles::View far = near_view;
  far.eye_mm.y = -4000.0f;
  far.vertical_fov_deg = 30.0f;
  lighting_.stripes = true;
  const gles::Image peeled = picture(far, 6.0f), plain = picture(far, 0.0f);
  int largest = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); ++k)
    largest = std::max(largest, std::abs(peeled.rgb[k] - plain.rgb[k]));
  EXPECT_LE(largest, 2);
}

INSTANTIATE_TEST_SUITE_P(Backends, OrangePeelTest, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

}  // namespace
}  // namespace lackwerk::test
