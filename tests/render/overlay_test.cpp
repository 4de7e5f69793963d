// The interface's way onto the picture: sprites pixel by pixel, drift, dimming, the held picture, and nothing for
// nothing.
#include "render_gles/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Framebuffer;
using gles::Image;
using gles::Overlay;
using gles::OverlayLook;
using gles::OverlaySprite;

/// Premultiplied B, G, R, A, rows with a gap behind them.
struct Bitmap {
  Bitmap(int w, int h, int gap_bytes = 0) : width(w), height(h), stride(4 * w + gap_bytes) {
    bgra.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(h), 0xee);
  }
  [[nodiscard]] unsigned char* pixel(int x, int y) {
    return &bgra[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x) * 4];
  }
  int width, height, stride;
  std::vector<unsigned char> bgra;
};

/// Noise in colour and alpha.
Bitmap random_bitmap(int width, int height, int gap_bytes = 0) {
  Bitmap out(width, height, gap_bytes);
  std::mt19937 random(9);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const unsigned alpha = random() % 256;
      for (int c = 0; c < 3; ++c) out.pixel(x, y)[c] = static_cast<unsigned char>(random() % (alpha + 1));
      out.pixel(x, y)[3] = static_cast<unsigned char>(alpha);
    }
  return out;
}

/// The picture moved and dimmed, then the tile over it: the rule, in double.
double expected(const Image& picture, const OverlayLook& look, Bitmap* tile, const OverlaySprite& at, int x, int y,
                int c) {
  const int from_x = std::clamp(x - look.drift_x_px, 0, picture.width - 1);
  const int from_y = std::clamp(y - look.drift_y_px, 0, picture.height - 1);
  const double under = look.brightness * picture.pixel(from_x, from_y)[c];
  const int u = x - look.drift_x_px - at.x_px, v = y - look.drift_y_px - at.y_px;
  if (tile == nullptr || u < 0 || v < 0 || u >= tile->width || v >= tile->height) return under;
  const unsigned char* over = tile->pixel(u, v);
  return at.opacity * look.brightness * over[2 - c] + under * (1.0 - at.opacity * over[3] / 255.0);
}

class OverlayTest : public OnDriver {
 protected:
  void SetUp() override {
    OnDriver::SetUp();
    if (!context_) return;
    auto made = Overlay::create(*context_);
    ASSERT_TRUE(made) << made.error().line();
    overlay_ = std::move(*made);
    picture_.emplace(framebuffer_of(*context_, image_));
  }
  void TearDown() override {
    picture_.reset();
    overlay_.reset();
  }

  void set(std::uint32_t tile, const Bitmap& bitmap) {
    overlay_->set_tile(tile, bitmap.width, bitmap.height, bitmap.stride, bitmap.bgra.data());
  }
  [[nodiscard]] Image composed(const std::vector<OverlaySprite>& sprites, const OverlayLook& look = {}) {
    const auto out = overlay_->compose(*picture_, sprites, look);
    EXPECT_TRUE(out);
    return out ? (*out)->read() : Image(1, 1);
  }
  /// `tolerance`, in steps of 8 bits: half a step for each value that is rounded on the way.
  void expect_as_the_rule_says(const Image& out, const OverlayLook& look, Bitmap* tile, const OverlaySprite& at,
                               double tolerance) const {
    double worst = 0.0;
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x)
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(out.pixel(x, y)[c] - expected(image_, look, tile, at, x, y, c)));
    EXPECT_LE(worst, tolerance);
  }

  Image image_ = random_image(96, 54);
  std::unique_ptr<Overlay> overlay_;
  std::optional<Framebuffer> picture_;
};

TEST_P(OverlayTest, NothingToDoIsThePictureItself) {
  const auto out = overlay_->compose(*picture_, {}, {});
  ASSERT_TRUE(out);
  EXPECT_EQ(*out, &*picture_);
}

TEST_P(OverlayTest, AnOpaqueTileIsThereByteForByteAndNothingElseHasChanged) {
  Bitmap tile = random_bitmap(17, 9, 12);
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x) tile.pixel(x, y)[3] = 255;
  set(3, tile);
  const OverlaySprite at{3, 20, 30, 17, 9, 1.0f};
  expect_as_the_rule_says(composed({at}), {}, &tile, at, 0.0);
  EXPECT_EQ(overlay_->sent_bytes(), 17u * 9u * 4u);
  EXPECT_EQ(different_bytes(picture_->read(), image_), 0u) << "the picture below goes on being refined";
}

TEST_P(OverlayTest, TranslucentTilesAreLaidOver) {
  Bitmap tile = random_bitmap(40, 30);
  set(1, tile);
  for (const float opacity : {1.0f, 0.5f, 0.0f}) {
    const OverlaySprite at{1, 5, 6, 40, 30, opacity};
    expect_as_the_rule_says(composed({at}), {}, &tile, at, 1.51);
  }
}

TEST_P(OverlayTest, TilesHangOverTheEdges) {
  Bitmap tile = random_bitmap(40, 30);
  set(1, tile);
  for (const auto& [x, y] : {std::pair(-13, -7), std::pair(80, 40), std::pair(-500, 3), std::pair(3, 500)}) {
    const OverlaySprite at{1, x, y, 40, 30, 1.0f};
    expect_as_the_rule_says(composed({at}), {}, &tile, at, 1.01);
  }
}

TEST_P(OverlayTest, LaterSpritesLieHigher) {
  Bitmap red(8, 8), blue(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      std::copy_n(std::array<unsigned char, 4>{0, 0, 255, 255}.data(), 4, red.pixel(x, y));
      std::copy_n(std::array<unsigned char, 4>{255, 0, 0, 255}.data(), 4, blue.pixel(x, y));
    }
  set(1, red);
  set(2, blue);
  const Image out = composed({{1, 10, 10, 8, 8, 1.0f}, {2, 14, 10, 8, 8, 1.0f}});
  EXPECT_EQ(out.pixel(13, 12)[0], 255);
  EXPECT_EQ(out.pixel(14, 12)[0], 0);
  EXPECT_EQ(out.pixel(14, 12)[2], 255);
}

TEST_P(OverlayTest, DriftMovesEverythingAndRepeatsTheEdge) {
  Bitmap tile = random_bitmap(10, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) tile.pixel(x, y)[3] = 255;
  set(1, tile);
  const OverlaySprite at{1, 90, 2, 10, 10, 1.0f};
  for (const auto& [x, y] : {std::pair(5, 3), std::pair(-4, 0), std::pair(0, -6), std::pair(-24, 24)}) {
    OverlayLook look;
    look.drift_x_px = x;
    look.drift_y_px = y;
    expect_as_the_rule_says(composed({at}, look), look, &tile, at, 0.0);
    expect_as_the_rule_says(composed({}, look), look, nullptr, at, 0.0);
  }
}

TEST_P(OverlayTest, BrightnessDimsPictureAndTilesAlike) {
  Bitmap tile = random_bitmap(30, 20);
  set(1, tile);
  const OverlaySprite at{1, 5, 6, 30, 20, 1.0f};
  OverlayLook look;
  look.brightness = 0.4f;
  expect_as_the_rule_says(composed({at}, look), look, &tile, at, 1.6);  // rounded twice
}

TEST_P(OverlayTest, TheHeldPictureShowsLeftOfTheSplit) {
  ASSERT_TRUE(overlay_->hold(*picture_));
  Image other(96, 54);
  std::fill(other.rgb.begin(), other.rgb.end(), std::uint8_t{77});
  picture_.emplace(framebuffer_of(*context_, other));
  OverlayLook look;
  look.split = 0.5f;
  for (const int drift : {0, 3}) {
    look.drift_x_px = drift;
    const Image out = composed({}, look);
    for (int y = 0; y < 54; ++y)
      for (int x = 0; x < 96; ++x)
        ASSERT_EQ(out.pixel(x, y)[1], x < 48 + drift ? image_.pixel(std::max(x - drift, 0), y)[1] : 77)
            << x << " " << y;
  }
  overlay_->let_go();
  look.drift_x_px = 0;
  EXPECT_EQ(different_bytes(composed({}, look), other), 0u) << "nothing is held: the picture alone";
}

TEST_P(OverlayTest, TilesAreReplacedAndDropped) {
  Bitmap tile = random_bitmap(10, 10);
  set(1, tile);
  Bitmap larger = random_bitmap(12, 14);
  set(1, larger);
  const OverlaySprite at{1, 3, 4, 12, 14, 1.0f};
  expect_as_the_rule_says(composed({at}), {}, &larger, at, 1.01);
  overlay_->drop_tile(1);
  overlay_->drop_tile(2);
  EXPECT_EQ(different_bytes(composed({at}), image_), 0u) << "a tile that is not there is left out";
}

TEST_P(OverlayTest, AnotherPictureSizeGetsAnotherTarget) {
  Bitmap tile = random_bitmap(10, 10);
  set(1, tile);
  const std::vector<OverlaySprite> sprites{{1, 0, 0, 10, 10, 1.0f}};
  (void)composed(sprites);
  picture_.emplace(framebuffer_of(*context_, random_image(54, 128)));
  const Image out = composed(sprites);
  EXPECT_EQ(out.width, 54);
  EXPECT_EQ(out.height, 128);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, OverlayTest, testing::ValuesIn(all_drivers),
                         [](const auto& info) { return driver_name(info.param); });

}  // namespace
}  // namespace lackwerk::test
