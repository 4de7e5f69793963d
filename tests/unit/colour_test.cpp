// The colour formulas against published values and their own inverses.
#include "core/colour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "kiosk/tools/report/ciede2000_pairs.hpp"

namespace lackwerk::core {
namespace {

TEST(Ciede2000, PublishedPairs) {
  int number = 0;
  for (const report::ColourPair& pair : report::ciede2000_pairs) {
    ++number;
    EXPECT_NEAR(ciede2000(pair.one, pair.two), pair.difference, 1e-4) << "pair " << number;
    EXPECT_NEAR(ciede2000(pair.two, pair.one), pair.difference, 1e-4) << "pair " << number << " swapped";
  }
  EXPECT_EQ(number, 34);
}

TEST(Ciede2000, IsZeroOnlyAtHomeAndFiniteForHdr) {
  EXPECT_EQ(ciede2000({50, 3, -7}, {50, 3, -7}), 0.0);
  EXPECT_EQ(ciede2000({0, 0, 0}, {0, 0, 0}), 0.0);
  const double far = ciede2000({1e4, 1e5, -1e5}, {10, -1e5, 1e5});
  EXPECT_TRUE(std::isfinite(far));
  EXPECT_GT(far, 10.0);
}

TEST(Lab, WhiteIsExactlyGrey) {
  for (const double level : {0.25, 1.0, 4.0}) {
    const glm::dvec3 lab = lab_from_linear(glm::dvec3(level));
    EXPECT_NEAR(lab.y, 0.0, 1e-13) << level;
    EXPECT_NEAR(lab.z, 0.0, 1e-13) << level;
  }
  const glm::dvec3 white = lab_from_linear(glm::dvec3(1.0));
  EXPECT_EQ(white.x, 100.0);
  EXPECT_EQ(white.y, 0.0);
  EXPECT_EQ(white.z, 0.0);
  EXPECT_NEAR(lab_from_linear(glm::dvec3(0.0)).x, 0.0, 1e-14);
}

TEST(Lab, RoundTripForAnySignAndSize) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-8.0, 6.0);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    glm::dvec3 rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = std::pow(10.0, exponent(random)) * (sign(random) < -0.5 ? -1.0 : 1.0);
    const glm::dvec3 back = linear_from_lab(lab_from_linear(rgb));
    const double size = std::max({std::abs(rgb.x), std::abs(rgb.y), std::abs(rgb.z)});
    // On the negative side Lab is linear with slope 116 / (3 delta^2): 1e6 gives 1e8 Lab, digits to spare.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 1e-11 * size + 1e-15);
  }
}

TEST(Lab, FloatRoundTripIsGoodEnoughForHdr) {
  for (const float level : {1e-4f, 0.5f, 30.0f, 1e4f}) {
    const glm::vec3 rgb(level, 0.7f * level, 0.2f * level);
    const glm::vec3 back = linear_from_lab(lab_from_linear(rgb));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 1e-5f * level);
  }
}

TEST(Lab, ToeIsContinuousInValueAndSlope) {
  const double toe = lab_delta * lab_delta * lab_delta;
  const double step = 1e-9;
  EXPECT_NEAR(lab_forward(toe - 1e-15), lab_forward(toe + 1e-15), 1e-12);
  const double below = (lab_forward(toe) - lab_forward(toe - step)) / step;
  const double above = (lab_forward(toe + step) - lab_forward(toe)) / step;
  EXPECT_NEAR(below, above, 1e-5);
  EXPECT_NEAR(lab_inverse(lab_delta - 1e-15), lab_inverse(lab_delta + 1e-15), 1e-14);
}

TEST(Matrices, AreInversesAndSumToWhite) {
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(rgb_to_xyz[row][0] + rgb_to_xyz[row][1] + rgb_to_xyz[row][2], white_xyz[row], 1e-15);
    for (int column = 0; column < 3; ++column) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) sum += rgb_to_xyz[row][k] * xyz_to_rgb[k][column];
      EXPECT_NEAR(sum, row == column ? 1.0 : 0.0, 1e-12);
    }
  }
}

TEST(Srgb, RoundTripAndKnownPoints) {
  for (int i = 0; i <= 1000; ++i) {
    const double x = i / 1000.0;
    EXPECT_NEAR(srgb_decode(srgb_encode(x)), x, 1e-7);
  }
  EXPECT_EQ(srgb_encode(0.0), 0.0);
  EXPECT_NEAR(srgb_encode(1.0), 1.0, 1e-15);
  EXPECT_NEAR(srgb_decode(128.0 / 255.0), 0.21586, 1e-5);  // the well-known middle grey of 8-bit sRGB
  EXPECT_EQ(srgb_encode(-3.0), 0.0);
  EXPECT_NEAR(srgb_encode(7.0), 1.0, 1e-15);
}

}  // namespace
}  // namespace lackwerk::core
