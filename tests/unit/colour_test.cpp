// The colour formulas against published values and their own inverses.
#include "core/colour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lackwerk::core {
namespace {

struct Pair {
  glm::dvec3 one, two;
  double difference;
};

// Sharma, Wu & Dalal 2005, Table 1, all 34 pairs. 9 to 16 sit at and around opposite hues.
constexpr Pair published_pairs[] = {
    {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
    {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
    {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
    {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
    {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
    {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
    {{50, 0, 0}, {50, -1, 2}, 2.3669},
    {{50, -1, 2}, {50, 0, 0}, 2.3669},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
    {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
    {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
    {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
    {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
    {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
    {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
    {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
    {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
    {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
    {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
    {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
    {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(Ciede2000, PublishedPairs) {
  int number = 0;
  for (const Pair& pair : published_pairs) {
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
