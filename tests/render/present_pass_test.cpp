// The last pass: exact copies at every turn, the panel's colours within a step, no bands, hatching, the test pattern.
#include "kiosk/display/output/present_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/colour.hpp"
#include "kiosk/display/output/panel_target.hpp"
#include "kiosk/display/test_pattern.hpp"
#include "render_gles/display_model.hpp"
#include "render_gles/overlay.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Framebuffer;
using gles::Image;
using kiosk::ChannelOrder;
using kiosk::DisplayProfile;
using kiosk::PresentPass;
using kiosk::Rotation;

constexpr std::array rotations = {Rotation::none, Rotation::quarter, Rotation::half, Rotation::three_quarters};

class Present : public OnDriver {
 protected:
  [[nodiscard]] Framebuffer picture(const Image& image) const { return framebuffer_of(*context_, image); }

  /// The panel as somebody sees it: drawn for reading, rows from above.
  [[nodiscard]] Image shown(PresentPass& pass, const Framebuffer& from, std::array<int, 2> panel_px,
                            ChannelOrder order = ChannelOrder::rgb) const {
    const auto to = kiosk::PanelTarget::create(*context_, panel_px);
    if (!to) std::abort();
    pass.draw(from, panel_px, to->framebuffer(), true, order);
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(panel_px[0]) * static_cast<std::size_t>(panel_px[1]) * 4);
    to->read(rgba.data());
    Image image(panel_px[0], panel_px[1]);
    for (std::size_t k = 0; k < rgba.size() / 4; ++k) {
      std::copy_n(&rgba[k * 4], 3, &image.rgb[k * 3]);
      if (rgba[k * 4 + 3] != 255) ADD_FAILURE() << "alpha at " << k;
    }
    return image;
  }
};

/// What the panel must show of a picture, by the one transform.
Image turned(const Image& picture, Rotation rotation, std::array<int, 2> panel_px) {
  Image out(panel_px[0], panel_px[1]);
  std::uint8_t* to = out.rgb.data();
  for (int y = 0; y < panel_px[1]; ++y)
    for (int x = 0; x < panel_px[0]; ++x) {
      const kiosk::Point p = kiosk::picture_point(rotation, {(x + 0.5) / panel_px[0], (y + 0.5) / panel_px[1]});
      const auto* from = picture.pixel(static_cast<int>(p[0] * picture.width), static_cast<int>(p[1] * picture.height));
      to = std::copy_n(from, 3, to);
    }
  return out;
}

/// Display P3 primaries with a power curve: red and green beyond sRGB's.
DisplayProfile wide(double exponent) {
  DisplayProfile p;
  p.red = {0.680, 0.320};
  p.green = {0.265, 0.690};
  for (auto& curve : p.curves) curve = kiosk::power_curve(exponent, 1024);
  return p;
}

/// Pixel values the panel should get, [0, 255], unrounded: the double-precision way.
std::array<double, 3> wanted(const DisplayProfile& profile, const std::uint8_t* rgb) {
  const auto m = kiosk::panel_from_srgb(profile);
  std::array<double, 3> out{};
  for (std::size_t row = 0; row < 3; ++row) {
    double light = 0.0;
    for (std::size_t k = 0; k < 3; ++k) light += m[3 * row + k] * core::srgb_decode(rgb[k] / 255.0);
    out[row] = 255.0 * kiosk::pixel_of_light(profile, static_cast<int>(row), std::clamp(light, 0.0, 1.0));
  }
  return out;
}

TEST_P(Present, CopiesByteForByteAtEveryTurn) {
  PresentPass pass(*context_);
  // Odd edges, and one as wide as fp16 can count in halves.
  for (const std::array<int, 2> panel : {std::array{37, 23}, std::array{1280, 720}, std::array{1920, 1080}})
    for (const Rotation rotation : rotations) {
      const auto size = kiosk::picture_size(rotation, panel);
      const Image image = random_image(size[0], size[1]);
      const Framebuffer from = picture(image);
      pass.set(rotation, {});
      const Image expected = turned(image, rotation, panel);
      EXPECT_EQ(different_bytes(shown(pass, from, panel), expected), 0u)
          << panel[0] << "x" << panel[1] << " turned by " << kiosk::degrees_of(rotation);
    }
}

TEST_P(Present, WindowsHaveTheirLowestRowFirst) {
  PresentPass pass(*context_);
  const std::array<int, 2> panel = {40, 22};
  for (const Rotation rotation : rotations) {
    const auto size = kiosk::picture_size(rotation, panel);
    const Image image = random_image(size[0], size[1]);
    const Framebuffer from = picture(image);
    const Framebuffer to = framebuffer_of(*context_, Image(panel[0], panel[1]));
    to.bind();
    GLint name = 0;
    context_->gl().GetIntegerv(GL_FRAMEBUFFER_BINDING, &name);
    pass.set(rotation, {});
    pass.draw(from, panel, static_cast<GLuint>(name), false);
    EXPECT_EQ(different_bytes(to.read(), turned(image, rotation, panel)), 0u) << kiosk::degrees_of(rotation);
  }
}

TEST_P(Present, BlueMayComeFirst) {
  PresentPass pass(*context_);
  for (const bool profiled : {false, true}) {
    pass.set(Rotation::none, profiled ? wide(2.4) : DisplayProfile());
    const Framebuffer from = picture(random_image(33, 9));
    const Image rgb = shown(pass, from, {33, 9});
    Image bgr = shown(pass, from, {33, 9}, ChannelOrder::bgr);
    for (std::size_t k = 0; k < bgr.rgb.size(); k += 3) std::swap(bgr.rgb[k], bgr.rgb[k + 2]);
    EXPECT_EQ(different_bytes(rgb, bgr), 0u);
  }
}

TEST_P(Present, DimsAsTheOverlayDoes) {
  PresentPass pass(*context_);
  auto overlay = gles::Overlay::create(*context_);
  ASSERT_TRUE(overlay);
  const Image image = random_image(64, 48);
  const Framebuffer from = picture(image);
  for (const bool profiled : {false, true}) {
    pass.set(Rotation::none, profiled ? wide(2.4) : DisplayProfile());
    for (const float brightness : {0.2f, 0.5f, 0.73f, 0.95f}) {
      gles::OverlayLook look;
      look.brightness = brightness;
      const auto dimmed = (*overlay)->compose(from, {}, look);
      ASSERT_TRUE(dimmed);
      pass.set_brightness(1.0f);
      const Image before = shown(pass, **dimmed, {64, 48});
      pass.set_brightness(brightness);
      const Image within = shown(pass, from, {64, 48});
      // Where a value is half way between two, each may round its own way: one step of the picture, which the panel's
      // curve may make two of (its noise is the same).
      int most = 0;
      for (std::size_t k = 0; k < before.rgb.size(); ++k)
        most = std::max(most, std::abs(int{before.rgb[k]} - int{within.rgb[k]}));
      EXPECT_LE(most, profiled ? 2 : 1) << brightness;
      if (!profiled) {
        double off = 0.0;
        for (std::size_t k = 0; k < within.rgb.size(); ++k)
          off = std::max(off, std::abs(within.rgb[k] - static_cast<double>(brightness) * image.rgb[k]));
        EXPECT_LE(off, 0.5 + 0.26) << brightness;
      }
    }
    pass.set_brightness(1.0f);
    if (profiled) continue;
    EXPECT_EQ(different_bytes(shown(pass, from, {64, 48}), image), 0u) << "1 is a copy again";
  }
  pass.set(Rotation::none, {}, true);
  const Image pattern = shown(pass, from, {64, 48});
  pass.set_brightness(0.5f);
  EXPECT_EQ(different_bytes(shown(pass, from, {64, 48}), pattern), 0u) << "the test pattern is what it is";
}

TEST_P(Present, OtherSizesAreStretched) {
  PresentPass pass(*context_);
  Image image(20, 10);
  std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{200});
  EXPECT_EQ(different_bytes(shown(pass, picture(image), {64, 48}),
                            [] {
                              Image all(64, 48);
                              std::fill(all.rgb.begin(), all.rgb.end(), std::uint8_t{200});
                              return all;
                            }()),
            0u);
}

TEST_P(Present, ProfileIsWithinAStep) {
  PresentPass pass(*context_);
  for (const double exponent : {1.8, 2.2, 2.4}) {
    const DisplayProfile profile = wide(exponent);
    pass.set(Rotation::none, profile);
    const Image image = random_image(256, 256);
    const Image out = shown(pass, picture(image), {256, 256});
    double worst = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < image.rgb.size(); k += 3) {
      const auto expected = wanted(profile, &image.rgb[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        const double off = std::abs(out.rgb[k + c] - expected[c]);
        worst = std::max(worst, off);
        sum += off;
      }
    }
    std::printf("  exponent %.1f: worst %.2f, mean %.3f 8-bit steps\n", exponent, worst,
                sum / static_cast<double>(image.rgb.size()));
    // Half a step of noise and half of rounding, and what 16-bit floats lose where a channel is a small difference.
    EXPECT_LT(worst, mediump() ? 2.0 : 1.2);
  }
}

TEST_P(Present, GreysKeepTheirMeanThroughTheCurve) {
  // A ramp as the renderer makes one: exact greys plus its own noise, rounded to 8 bits. Each field of 48 x 48 pixels
  // has one light; the panel's mean light there must be the picture's.
  PresentPass pass(*context_);
  const DisplayProfile profile = wide(2.4);
  pass.set(Rotation::none, profile);
  constexpr int edge = 48, fields = 24;
  double worst_with = 0.0;
  for (int row = 0; row < 8; ++row) {
    Image image(edge * fields, edge);
    const auto grey = [&](int field) { return 20.0 + 235.0 * (row * fields + field) / (8.0 * fields); };
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < image.width; ++x) {
        // gl_FragCoord of the picture, whose row 0 is the lowest
        const double noise = gles::DisplayModel<double>().dither_noise(x + 0.5, edge - 1 - y + 0.5) * 255.0;
        const auto value = static_cast<std::uint8_t>(std::clamp(std::floor(grey(x / edge) + noise + 0.5), 0.0, 255.0));
        std::fill_n(&image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                static_cast<std::size_t>(x)) *
                               3],
                    3, value);
      }
    const Image out = shown(pass, picture(image), {image.width, edge});
    for (int field = 0; field < fields; ++field) {
      double sum = 0.0;
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) sum += out.pixel(field * edge + x, y)[1];
      const double light = core::srgb_decode(std::min(1.0, grey(field) / 255.0));
      const double expected = 255.0 * kiosk::pixel_of_light(profile, 1, light);
      worst_with = std::max(worst_with, std::abs(sum / (edge * edge) - expected));
    }
  }
  std::printf("  mean of a field is at most %.3f 8-bit steps off\n", worst_with);
  EXPECT_LT(worst_with, mediump() ? 0.5 : 0.2);
}

TEST_P(Present, NoLevelsAreLostInASmoothRamp) {
  // 8-bit greys 0 to 255 with the renderer's noise, through gamma 2.4. Levels the panel never gets:
  PresentPass pass(*context_);
  pass.set(Rotation::none, [] {
    DisplayProfile p;
    for (auto& curve : p.curves) curve = kiosk::power_curve(2.4, 1024);
    return p;
  }());
  constexpr int width = 2048, height = 64;
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double noise = gles::DisplayModel<double>().dither_noise(x + 0.5, height - 1 - y + 0.5) * 255.0;
      const double value = std::floor(255.0 * x / (width - 1) + noise + 0.5);
      std::fill_n(&image.rgb[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 3], 3,
                  static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
    }
  const Image out = shown(pass, picture(image), {width, height});
  std::array<int, 256> count{};
  for (std::size_t k = 0; k < out.rgb.size(); k += 3) ++count[out.rgb[k]];
  std::string missing;
  int gaps = 0, bright_gaps = 0, run = 0, longest = 0;
  for (int level = 0; level < 256; ++level) {
    if (count[static_cast<std::size_t>(level)] > 0) {
      run = 0;
      continue;
    }
    missing += " " + std::to_string(level);
    ++gaps;
    if (level > 40) ++bright_gaps;
    longest = std::max(longest, ++run);
  }
  std::printf("  levels never shown:%s\n", gaps > 0 ? missing.c_str() : " none");
  // sRGB is steepest against a power near black: its first value already is 8.8 on this panel, so levels 1 to 7 have
  // no 8-bit picture value at all (together 1.9e-4 of white's light). None may be missing where one can see it.
  EXPECT_LE(longest, 8);
  EXPECT_EQ(bright_gaps, 0);
  EXPECT_EQ(out.pixel(0, 0)[0], 0);
  EXPECT_EQ(out.pixel(width - 1, 0)[0], 255);
}

TEST_P(Present, BlackAndWhiteStayClean) {
  PresentPass pass(*context_);
  pass.set(Rotation::none, wide(2.4));
  for (const int value : {0, 255}) {
    Image image(200, 100);
    std::fill(image.rgb.begin(), image.rgb.end(), static_cast<std::uint8_t>(value));
    EXPECT_EQ(different_bytes(shown(pass, picture(image), {200, 100}), image), 0u) << value;
  }
}

TEST_P(Present, GamutWarningHatchesWhatIsLost) {
  // A panel with less green than sRGB: full green is lost, greys and dull colours are not.
  DisplayProfile small;
  small.green = {0.32, 0.55};
  const std::array<std::array<std::uint8_t, 3>, 4> colours = {
      std::array<std::uint8_t, 3>{0, 255, 0}, {128, 128, 128}, {255, 255, 255}, {130, 120, 110}};
  PresentPass pass(*context_);
  for (const auto& colour : colours) {
    Image image(48, 48);
    for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = colour[k % 3];
    const Framebuffer from = picture(image);
    pass.set(Rotation::none, small, false, true);
    const Image warned = shown(pass, from, {48, 48});
    pass.set(Rotation::none, small);
    const Image plain = shown(pass, from, {48, 48});
    const std::array<double, 3> linear = {core::srgb_decode(colour[0] / 255.0), core::srgb_decode(colour[1] / 255.0),
                                          core::srgb_decode(colour[2] / 255.0)};
    const bool lost = kiosk::gamut_loss(small, {linear}).share > 0.0;
    EXPECT_EQ(lost, colour[0] == 0);
    const double changed = static_cast<double>(different_bytes(warned, plain)) / static_cast<double>(plain.rgb.size());
    if (lost)
      EXPECT_GT(changed, 0.2);  // half of the pixels, of which black and white each change a part of the bytes
    else
      EXPECT_EQ(changed, 0.0);
  }
  // A panel that is sRGB shows everything.
  Image green(48, 48);
  for (std::size_t k = 1; k < green.rgb.size(); k += 3) green.rgb[k] = 255;
  pass.set(Rotation::none, {}, false, true);
  EXPECT_EQ(different_bytes(shown(pass, picture(green), {48, 48}), green), 0u);
}

TEST_P(Present, TestPatternComesAtThePanelsResolution) {
  PresentPass pass(*context_);
  const Framebuffer from = picture(random_image(64, 64));  // has the wrong size: must not matter
  for (const Rotation rotation : rotations) {
    const std::array<int, 2> panel = {320, 200};
    pass.set(rotation, {}, true);
    const auto size = kiosk::picture_size(rotation, panel);
    const Image out = shown(pass, from, panel);
    EXPECT_EQ(different_bytes(out, turned(kiosk::test_pattern(size[0], size[1]), rotation, panel)), 0u);
  }
  // Off again: the picture.
  pass.set(Rotation::none, {});
  const Image image = random_image(64, 64);
  EXPECT_EQ(different_bytes(shown(pass, picture(image), {64, 64}), image), 0u);
  // To look at: LACKWERK_PRESENT_OUT names a folder.
  if (const char* folder = std::getenv("LACKWERK_PRESENT_OUT"); folder != nullptr) {
    DisplayProfile small = wide(2.4);
    small.red = {0.60, 0.34};
    small.green = {0.32, 0.55};
    pass.set(Rotation::quarter, small, true, true);
    ASSERT_TRUE(gles::write_png(shown(pass, from, {1280, 720}), std::string(folder) + "/present_pattern_90.png"));
    pass.set(Rotation::none, wide(2.4), true, true);
    ASSERT_TRUE(gles::write_png(shown(pass, from, {1280, 720}), std::string(folder) + "/present_pattern_p3.png"));
  }
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Present, testing::ValuesIn(all_drivers),
                         [](const auto& info) { return driver_name(info.param); });

}  // namespace
}  // namespace lackwerk::test
