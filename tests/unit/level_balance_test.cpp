// A mix of paints is as bright at every mip level as at level 0, and the paints themselves are left alone.
#include "core/level_balance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/colour.hpp"
#include "core/realise.hpp"

namespace lackwerk::core {
namespace {

const LabRange range{{-5.0f, -80.0f, -60.0f}, {400.0f, 70.0f, 90.0f}};

float on_grid(double value, int axis) {
  return static_cast<float>((value - range.lo[axis]) / (range.hi[axis] - range.lo[axis]) * 65535.0);
}
double off_grid(float q, int axis) { return range.lo[axis] + (range.hi[axis] - range.lo[axis]) * q / 65535.0; }

TEST(LevelBalance, GainMultipliesLightAndKeepsHue) {
  for (const double k : {0.4, 0.9, 1.0, 1.1, 2.5}) {
    const LabGain gain(k, range);
    for (const double lightness : {40.0, 100.0, 250.0}) {
      const glm::dvec3 lab(lightness, 0.2 * lightness, -0.1 * lightness);
      const glm::dvec3 scaled(off_grid(gain.lightness(on_grid(lab.x, 0)), 0),
                              off_grid(gain.colour(on_grid(lab.y, 1), 0), 1),
                              off_grid(gain.colour(on_grid(lab.z, 2), 1), 2));
      const glm::dvec3 before = linear_from_lab(lab), after = linear_from_lab(scaled);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], k * before[c], 1e-3 * before[c]) << k << " at L " << lightness;
    }
    EXPECT_NEAR(off_grid(gain.lightness(on_grid(0.0, 0)), 0), 0.0, 1e-2) << "black stays black";
    EXPECT_NEAR(off_grid(gain.lightness(on_grid(2.0, 0)), 0), 2.0 * k, 2e-2) << "in the toe L is light";
    float last = -1e9f;
    for (int q = 0; q < 65536; q += 64) {
      const float now = gain.lightness(static_cast<float>(q));
      ASSERT_GT(now, last);
      last = now;
    }
  }
}

TEST(LevelBalance, MeanLuminanceIsThatOfTheBoxes) {
  const std::array<float, 2> lo = {on_grid(50.0, 0), on_grid(0.0, 0)}, hi = {on_grid(150.0, 0), on_grid(0.0, 0)};
  const std::array<std::uint32_t, 2> mass = {3, 1};
  // E[f^3] over f in [66, 166] / 116 is the difference of fourth powers over 4 times the width.
  const double exact = (std::pow(166.0, 4) - std::pow(66.0, 4)) / (4.0 * 100.0 * std::pow(116.0, 3));
  EXPECT_NEAR(mean_luminance(lo, hi, mass, range), 0.75 * exact, 1e-4 * exact);
}

TEST(LevelBalance, StrengthIsNothingAtThePaintsAndAllInMixes) {
  EXPECT_EQ(balance_strength(std::array{1.0}), 0.0);
  EXPECT_EQ(balance_strength(std::array{0.0, 1.0, 0.0}), 0.0);
  EXPECT_NEAR(balance_strength(std::array{0.975, 0.025, 0.0}), 0.5, 1e-12);
  EXPECT_EQ(balance_strength(std::array{0.9, 0.05, 0.05}), 1.0);
  EXPECT_EQ(balance_strength(std::array{1.5, -0.5}), 1.0) << "extrapolation is a mix";
}

TEST(LevelBalance, GainIsBoundedAndLeavesTheUnseenAlone) {
  EXPECT_DOUBLE_EQ(row_gain(0.2, 0.4, 0.0), 1.0);
  EXPECT_NEAR(row_gain(0.2, 0.4, 1.0), 0.5, 1e-3);
  EXPECT_NEAR(row_gain(1e-8, 5e-8, 1.0), 1.0, 0.01);
  EXPECT_EQ(row_gain(1.0, 1e-3, 1.0), 4.0);
  EXPECT_EQ(row_gain(-1.0, 1.0, 1.0), 0.25);
}

TEST(LevelBalance, MixesAreAsBrightAtEveryLevel) {
  // Two paints: rare flakes on black, and even grey. Level 1 of each is one box of its level 0's mean.
  InterpolatablePaint paint;
  paint.layout = {2, {0, 1}};
  paint.level_count = 2;
  paint.range = range;
  paint.row_mass = 10;
  const std::vector<std::uint32_t> begin = {0, 2, 3}, mass = {9, 1, 10};
  const auto box = [](double lightness) {
    const auto q = static_cast<std::uint16_t>(std::lround(on_grid(lightness, 0)));
    const auto a = static_cast<std::uint16_t>(std::lround(on_grid(0.0, 1)));
    const auto b = static_cast<std::uint16_t>(std::lround(on_grid(0.0, 2)));
    return QuantisedCuboid{{q, q, a, a, b, b}};
  };
  const auto lightness_of = [](double y) { return lab_from_linear(glm::dvec3(y)).x; };
  const double flake = 3.0, dark = 0.02, grey = 0.1;
  const std::vector<QuantisedCuboid> sparkling = {box(lightness_of(dark)), box(lightness_of(flake)),
                                                  box(lightness_of(0.9 * dark + 0.1 * flake))};
  const std::vector<QuantisedCuboid> even(3, box(lightness_of(grey)));
  const std::vector<std::uint8_t> own = {0, 1, 0};
  for (const auto* clusters : {&sparkling, &even}) {
    InterpolatablePaint::PaintPart part;
    part.cluster_begin = begin;
    part.clusters = *clusters;
    part.tuple_cluster = own;
    paint.paints.push_back(part);
  }
  paint.tuple_begin = begin;
  paint.mass = mass;
  RealisedPaint out;
  const auto light = [&](std::size_t row) {
    double sum = 0.0;
    for (std::size_t t = begin[row]; t < begin[row + 1]; ++t) {
      const auto& q = out.corners[row * static_cast<std::size_t>(out.width) + t - begin[row]].q;
      sum += mass[t] / 10.0 * linear_from_lab(glm::dvec3(off_grid(q[0], 0), 0.0, 0.0)).y;
    }
    return sum;
  };
  realise(paint, Weights::uniform({1.0, 0.0}), out);
  EXPECT_EQ(out.corners[static_cast<std::size_t>(out.width)], sparkling[2]) << "a paint itself is left alone";
  for (const double t : {0.1, 0.5, 0.8, 1.2}) {
    realise(paint, Weights::uniform({t, 1.0 - t}), out);
    EXPECT_NEAR(light(1) / light(0), 1.0, 2e-3) << t;
  }
}

}  // namespace
}  // namespace lackwerk::core
