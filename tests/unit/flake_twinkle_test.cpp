// Flakes that twinkle: the random cells change which texel shines, and never how many shine how brightly.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/gaussian.hpp"
#include "core/paint_model.hpp"
#include "tests/unit/one_slice_paint.hpp"
#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

using Model = PaintModel<double>;

constexpr int edge = random_edge;
constexpr double texel_count = double(edge) * edge;

/// 200 flakes of one grey each, in one slice at (0, 0), so that every colour names its tuple; far away one black.
testing::OneSlicePaint greys() {
  testing::FlakeRow near, far;
  std::uint32_t sum = 0;
  for (std::uint16_t t = 0; t < 200; ++t) {
    const auto grey = static_cast<std::uint16_t>(300 * t);
    near.boxes.push_back({{grey, grey, 32768, 32768, 32768, 32768}});
    near.mass.push_back(t < 100 ? 150u : t < 190 ? 50u : 20u);  // rare ones are bright
    sum += near.mass.back();
  }
  far.boxes.push_back({{0, 0, 32768, 32768, 32768, 32768}});
  far.mass.push_back(sum);
  return {near, far, 11};
}

/// Random values of a whole texture's texels at these angles, sorted.
std::vector<double> gaussians(Model& model, double fh, double fi, double level = 0.0) {
  std::vector<double> out;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) out.push_back(model.flake_gaussian({x, y}, level, fh, fi));
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ab += a[k] * b[k];
    aa += a[k] * a[k];
    bb += b[k] * b[k];
  }
  return ab / std::sqrt(aa * bb);
}

TEST(FlakeTwinkle, QuantileInvertsTheNormalDistribution) {
  for (double p = 1e-7; p < 1.0; p += 1e-3) {
    const double z = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-z / std::numbers::sqrt2), p, 4e-8 * std::min(p, 1.0 - p)) << p;  // 1.2e-9 z^2
  }
  EXPECT_EQ(normal_quantile(0.5), 0.0);
}

// paint_model.glsl states these bounds; half of the error in the square root is all of it in what lies above.
TEST(FlakeTwinkle, DepthIsTheRootOfTheUpperTail) {
  Model model;
  PaintModel<float> quick;
  double worst = 0.0, worst_float = 0.0, worst_far = 0.0, last = 1.1;
  for (double g = -6.0; g <= 5.6; g += 1e-3) {
    const double above = 0.5 * std::erfc(g / std::numbers::sqrt2);
    const double depth = model.flake_depth(g);
    EXPECT_LE(depth, last) << "a brighter random value must not mean a darker flake, at " << g;
    last = depth;
    const double error = std::abs(depth * depth / above - 1.0);
    (g <= 5.0 ? worst : worst_far) = std::max(g <= 5.0 ? worst : worst_far, error);
    const auto single = static_cast<double>(quick.flake_depth(static_cast<float>(g)));
    if (g <= 5.0) worst_float = std::max(worst_float, std::abs(single * single / above - 1.0));
  }
  EXPECT_LT(worst, 5.5e-4);
  EXPECT_LT(worst_float, 5.6e-4);
  EXPECT_LT(worst_far, 4.5e-3);
}

TEST(FlakeTwinkle, TextureHoldsEveryQuantileOnce) {
  const testing::OneSlicePaint source = greys();
  std::vector<int> values;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const std::uint8_t* here = source.textures.random_texel(x, y);
      values.push_back(here[0] + 256 * here[1]);
    }
  std::sort(values.begin(), values.end());
  for (std::size_t k = 0; k < values.size(); k += 97) {
    const double g = normal_quantile((static_cast<double>(k) + 0.5) / texel_count);
    ASSERT_NEAR((values[k] / 65535.0 - 0.5) * 2.0 * random_reach, g, random_reach / 65535.0 * 1.001);
  }
}

// The text's steps: z w of a pair is what the next cell has in x y, and no two cells and levels look at one texel.
TEST(FlakeTwinkle, EveryCellAndLevelLooksElsewhere) {
  const testing::OneSlicePaint source = greys();
  Model model = source.model;
  for (int h = 0; h < 3; ++h) {
    const auto here = model.random_pair({5, 7}, 2, h, 1), next = model.random_pair({5, 7}, 2, h + 1, 1);
    EXPECT_EQ(here.z, next.x);
    EXPECT_EQ(here.w, next.y);
  }
  // Textures that say where they were asked: one for the column, one for the row.
  std::array<PaintTextures, 2> places_texture{source.textures, source.textures};
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x)
      for (std::size_t k = 0; k < 2; ++k) {
        const int asked = k == 0 ? x : y;
        std::uint8_t* t = &places_texture[k].random[static_cast<std::size_t>(y * edge + x) * 2];
        t[0] = static_cast<std::uint8_t>(asked & 255);
        t[1] = static_cast<std::uint8_t>(asked >> 8);
      }
  std::set<std::pair<long, long>> places;
  const auto place = [&](int level, int h, int i) {
    std::array<long, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
      model.textures = &places_texture[k];
      const auto t = model.random_value({3, 4}, level, h, i);
      at[k] = std::lround(t.x * 255 + t.y * 65280);
    }
    return std::pair{at[0], at[1]};
  };
  for (int level = 0; level < 13; ++level) {
    for (int h = 0; h <= 90; ++h)
      for (int i = 0; i < 16; ++i)
        ASSERT_TRUE(places.insert(place(level, h, i)).second) << level << ' ' << h << ' ' << i;
    for (const int step : {0, 1}) {
      const auto cuboid = std::pair{long{(3 + 203 * level + 229 + 129 * step) % edge},
                                    long{(4 + 311 * level + 257 + 187 * step) % edge}};
      ASSERT_TRUE(places.insert(cuboid).second) << "flake_random's place inside the cuboid";
    }
  }
}

TEST(FlakeTwinkle, NoAngleChangesTheDistributionOfRanks) {
  testing::OneSlicePaint source = greys();
  source.model.u_flake_cells = {1.5, 0.75};
  // Corners, edges and middles of cells, at several levels.
  for (const auto& [ch, ci, level] : {std::array{0.0, 0.0, 0.0}, std::array{0.5, 0.0, 0.0}, std::array{2.5, 0.5, 1.0},
                                      std::array{0.25, 0.75, 3.0}, std::array{7.9, 1.1, 0.0}}) {
    std::vector<double> g = gaussians(source.model, ch / 1.5, ci / 0.75, level);
    std::sort(g.begin(), g.end());
    double mean = 0.0, square = 0.0, apart = 0.0;
    for (std::size_t k = 0; k < g.size(); ++k) {
      mean += g[k] / texel_count;
      square += g[k] * g[k] / texel_count;
      const double depth = source.model.flake_depth(g[k]);
      apart = std::max(apart, std::abs(1.0 - depth * depth - (static_cast<double>(k) + 0.5) / texel_count));
    }
    EXPECT_NEAR(mean, 0.0, 0.006) << ch << ' ' << ci;     // 3 sigma of 262,144 draws
    EXPECT_NEAR(square, 1.0, 0.0084) << ch << ' ' << ci;  // a linear mix would have 0.5 here
    EXPECT_LT(apart, 1.95 / std::sqrt(texel_count) + 2.5e-4) << "Kolmogorov-Smirnov, 0.1 %";
  }
}

TEST(FlakeTwinkle, CellsAreIndependentAndBlendedByTheirCosine) {
  testing::OneSlicePaint source = greys();
  source.model.u_flake_cells = {1.0, 1.0};
  const auto at = [&](double h, double i) { return gaussians(source.model, h, i); };
  const auto origin = at(3.0, 1.0);
  for (const double lag : {0.2, 0.5, 0.8})
    EXPECT_NEAR(correlation(origin, at(3.0 + lag, 1.0)), std::cos(0.5 * std::numbers::pi * lag), 0.006);
  for (const auto& [h, i] : {std::pair{4.0, 1.0}, std::pair{5.0, 1.0}, std::pair{3.0, 2.0}, std::pair{4.0, 2.0}})
    EXPECT_NEAR(correlation(origin, at(h, i)), 0.0, 0.006) << h << ' ' << i;
  // One cell for all theta_i: a flake stays where it is along it.
  source.model.u_flake_cells.y = 0.0;
  EXPECT_NEAR(correlation(at(3.3, 0.0), at(3.3, 8.0)), 1.0, 1e-12);
}

TEST(FlakeTwinkle, ColoursKeepTheSlicesDistributionBetweenCells) {
  testing::OneSlicePaint source = greys();
  source.model.u_flake_cells = {10.0, 3.0};  // so that one slice's reach holds several cells
  std::vector<double> share(200, 0.0);
  constexpr std::array<std::pair<double, double>, 6> angles{
      {{0.05, 0.0}, {0.15, 1.0 / 6.0}, {0.25, 1.0 / 6.0}, {0.35, 0.0}, {0.45, 1.0 / 6.0}, {0.3, 1.0 / 6.0}}};
  std::array<double, 200> grey{};
  for (std::size_t t = 0; t < 200; ++t)
    grey[t] = source.model.linear_from_lab_factor({200.0 * 300.0 * static_cast<double>(t) / 65535.0, 0.0, 0.0}).y;
  for (const auto& [fh, fi] : angles)
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) {
        const double colour = source.model.flake_nearest(fh, fi, {x + 0.5, y + 0.5}, 0.0).y;
        const auto found = std::lower_bound(grey.begin(), grey.end(), colour - 1e-6) - grey.begin();
        share[static_cast<std::size_t>(found)] += 1.0 / (texel_count * angles.size());
      }
  double wanted = 0.0, got = 0.0, apart = 0.0;
  for (std::size_t t = 0; t < 200; ++t) {
    wanted += static_cast<double>(source.paint.mass[t]) / source.paint.row_mass;
    got += share[t];
    apart = std::max(apart, std::abs(wanted - got));
  }
  EXPECT_LT(apart, 0.003) << "Kolmogorov-Smirnov distance of the colours";
  // The brightest ten: 200 of 19,700 texels, about 1 %. A linear mix of uniforms would leave 3 % of them.
  double bright = 0.0;
  for (std::size_t t = 190; t < 200; ++t) bright += share[t];
  EXPECT_NEAR(bright / (200.0 / source.paint.row_mass), 1.0, 0.03);
}

TEST(FlakeTwinkle, MeanOverTexelsIsTheMeanAtEveryPhase) {
  testing::OneSlicePaint source = greys();
  const auto table = source.model.flake_mean(0.0, 0.0);
  for (const double fh : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    double sum = 0.0;
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) sum += source.model.flake_nearest(fh, 0.0, {x + 0.5, y + 0.5}, 0.0).y;
    EXPECT_NEAR(sum / texel_count / table.y, 1.0, 0.01) << fh;
  }
}

// Cells do not depend on the weights, so that a random value means the same flake at all of them: no texel's colour
// moves faster than its box's corners.
TEST(FlakeTwinkle, AMorphMovesNoTexelFasterThanItsCorners) {
  std::mt19937 random(83);
  FlakeFrame frame = testing::small_frame();
  InterpolatableData data = testing::build_or_fail(testing::random_paints(random, 3, frame, 30), frame);
  data.parts[0].life = {3.0f, 90.0f, LifeOrigin::fine};
  data.parts[1].life = {9.0f, 20.0f, LifeOrigin::fine};
  const InterpolatablePaint paint = data.view();
  // From corners to linear colours: |d XYZ| <= 3 f^2 (dL/116 + da/500 + db/200) <= 3 f^2 of the whole range times d.
  const glm::dvec3 lo(paint.range.lo), hi(paint.range.hi);
  const auto most = [&](int axis) { return std::max(std::abs(lo[axis]), std::abs(hi[axis])); };
  const double f = (most(0) + 16.0) / 116.0 + most(1) / 500.0 + most(2) / 200.0;
  const double slope = 3.0 * f * f * ((hi.x - lo.x) / 116.0 + (hi.y - lo.y) / 500.0 + (hi.z - lo.z) / 200.0);
  double gain = 0.0;
  for (const auto& row : xyz_to_rgb)
    gain = std::max(gain, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]) * white_xyz[2]);
  const double d = 1.0 / 512.0;
  const double bound = slope * gain * d;
  std::array<std::vector<glm::dvec3>, 2> seen;
  double fastest = 0.0;
  for (int step = 0; step <= 64; ++step) {
    RealisedPaint realised;
    realise(paint, Weights::uniform({1.0 - step * d, step * d, 0.0}), realised);
    PaintTextures textures = make_static_textures(paint);
    const AnalyticPaint analytic = realised.analytic;
    update_textures(paint, realised, textures);
    Model model;
    bind_model(paint, analytic, textures, model);
    auto& now = seen[static_cast<std::size_t>(step % 2)];
    now.clear();
    for (int k = 0; k < 300; ++k)
      now.push_back(model.flake_factor(0.003 * k, 0.001 * k, {k * 7 + 0.5, k * 3 + 0.5}, 0.0));
    if (step == 0) continue;
    const auto& before = seen[static_cast<std::size_t>((step + 1) % 2)];
    for (std::size_t k = 0; k < now.size(); ++k)
      for (int c = 0; c < 3; ++c) fastest = std::max(fastest, std::abs(now[k][c] - before[k][c]));
  }
  EXPECT_GT(fastest, 0.0);
  EXPECT_LT(fastest, bound);
}

TEST(FlakeTwinkle, MeasuredLivesDecideForThePack) {
  InterpolatablePaint paint;
  paint.layout = {12, {0, 1}};
  paint.paints.resize(3);
  EXPECT_NEAR(paint.flake_cells_per_bin()[0], 7.5 / default_cell_deg, 1e-12);
  EXPECT_EQ(paint.flake_cells_per_bin()[1], 0.0);
  paint.paints[0].life = {5.0f, 90.0f, LifeOrigin::fine};
  paint.paints[2].life = {7.5f, 30.0f, LifeOrigin::slices};
  EXPECT_NEAR(paint.flake_cells_per_bin()[0], 0.5 * (1.5 + 1.0), 1e-12);
  EXPECT_NEAR(paint.flake_cells_per_bin()[1], 0.5 * 0.25, 1e-12);
}

}  // namespace
}  // namespace lackwerk::core
