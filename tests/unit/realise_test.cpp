// Realisation: exact at the corners of the mix, continuous between and beyond them.
#include "core/realise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/colour.hpp"
#include "tests/unit/one_slice_paint.hpp"
#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

using testing::build_or_fail;
using testing::corner_weights;
using testing::random_paints;
using testing::small_frame;
using testing::uniform;

/// Calls visit(row, tuple index in row, tuple index overall).
template <class Visit>
void each_tuple(const InterpolatablePaint& paint, Visit visit) {
  for (std::size_t row = 0; row < static_cast<std::size_t>(paint.row_count()); ++row)
    for (std::size_t t = paint.tuple_begin[row]; t < paint.tuple_begin[row + 1]; ++t)
      visit(row, t - paint.tuple_begin[row], t);
}

const QuantisedCuboid& own_cluster(const InterpolatablePaint& paint, std::size_t k, std::size_t row,
                                   std::size_t tuple) {
  const auto& part = paint.paints[k];
  return part.clusters[part.cluster_begin[row] + part.tuple_cluster[tuple]];
}

std::vector<double> random_weights(std::mt19937& random, std::size_t paints, double lo, double hi) {
  std::vector<double> weights;
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < paints; ++k) sum += weights.emplace_back(uniform(random, lo, hi));
  weights.push_back(1.0 - sum);
  return weights;
}

TEST(Realise, CornerOfTheMixIsThePaintBitForBit) {
  std::mt19937 random(51);
  for (std::size_t paints = 1; paints <= 5; ++paints) {
    const auto input = random_paints(random, paints, small_frame(), 50);
    const InterpolatableData data = build_or_fail(input, small_frame());
    const InterpolatablePaint paint = data.view();
    RealisedPaint out;
    for (std::size_t k = 0; k < paints; ++k) {
      realise(paint, Weights::uniform(corner_weights(paints, k)), out);
      std::vector<std::uint64_t> mass(paint.paints[k].clusters.size(), 0);
      each_tuple(paint, [&](std::size_t row, std::size_t n, std::size_t t) {
        ASSERT_EQ(out.corners[row * static_cast<std::size_t>(out.width) + n], own_cluster(paint, k, row, t));
        mass[paint.paints[k].cluster_begin[row] + paint.paints[k].tuple_cluster[t]] += paint.mass[t];
      });
      // Equal totals (10000 texels everywhere): the masses are the counts.
      std::size_t n = 0;
      for (const auto& row : input[k].rows)
        for (const LabCuboid& cluster : row) ASSERT_EQ(mass.at(n++), cluster.count);
    }
  }
}

TEST(Realise, GroupsActOnTheirOwnAxes) {
  std::mt19937 random(52);
  const InterpolatableData data = build_or_fail(random_paints(random, 3, small_frame(), 30), small_frame());
  const InterpolatablePaint paint = data.view();
  RealisedPaint out;
  realise(paint, {corner_weights(3, 0), corner_weights(3, 1), corner_weights(3, 2)}, out);
  each_tuple(paint, [&](std::size_t row, std::size_t n, std::size_t t) {
    const auto& q = out.corners[row * static_cast<std::size_t>(out.width) + n].q;
    const auto& lightness = own_cluster(paint, 1, row, t).q;
    const auto& colour = own_cluster(paint, 2, row, t).q;
    for (std::size_t i = 0; i < 6; ++i) ASSERT_EQ(q[i], i < 2 ? lightness[i] : colour[i]);
  });
}

/// a and b of a grid number.
double lab_of(const InterpolatablePaint& paint, std::size_t axis, double q) {
  const auto c = static_cast<glm::length_t>(axis);
  return static_cast<double>(paint.range.lo[c]) +
         (static_cast<double>(paint.range.hi[c]) - static_cast<double>(paint.range.lo[c])) * q / 65535.0;
}

TEST(Realise, WhiteFlakesLoseTheirColourAndKeepTheirLight) {
  std::mt19937 random(56);
  const InterpolatableData data = build_or_fail(random_paints(random, 3, small_frame(), 30), small_frame());
  const InterpolatablePaint paint = data.view();
  for (const auto& w : {std::vector{0.0, 1.0, 0.0}, {0.2, 0.3, 0.5}, {1.4, -0.3, -0.1}}) {
    Weights weights = Weights::uniform(w);
    RealisedPaint coloured, white;
    realise(paint, weights, coloured);
    for (const double taken : {0.25, 0.5, 1.0}) {
      weights.flake_white = taken;
      realise(paint, weights, white);
      ASSERT_EQ(white.corners.size(), coloured.corners.size());
      each_tuple(paint, [&](std::size_t row, std::size_t n, std::size_t) {
        const std::size_t at = row * static_cast<std::size_t>(white.width) + n;
        const auto &now = white.corners[at].q, &before = coloured.corners[at].q;
        ASSERT_EQ(now[0], before[0]);
        ASSERT_EQ(now[1], before[1]);
        for (std::size_t i = 2; i < 6; ++i) {
          const std::size_t axis = i / 2;
          // What extrapolation had clamped is no measure of what it comes from.
          if (before[i] == 0 || before[i] == 65535) continue;
          const double step = lab_of(paint, axis, 1.0) - lab_of(paint, axis, 0.0);
          ASSERT_NEAR(lab_of(paint, axis, now[i]), (1.0 - taken) * lab_of(paint, axis, before[i]), 1.01 * step);
        }
      });
      if (taken < 1.0) continue;
      for (const glm::dvec3 mean : white.flake_mean)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], mean[1], 1e-3 * mean[1] + 1e-5);
    }
    weights.flake_white = 0.0;
    realise(paint, weights, white);
    EXPECT_EQ(white.corners, coloured.corners);
    EXPECT_EQ(white.flake_mean, coloured.flake_mean);
  }
}

TEST(Realise, AGridWithoutGreyGivesItsNearest) {
  testing::OneSlicePaint one({{{{0, 100, 40000, 50000, 40000, 50000}}}, {1}}, {{{{0, 100, 40000, 50000, 0, 1}}}, {1}},
                             1);
  one.paint.range = {{0.0f, 10.0f, -40.0f}, {100.0f, 60.0f, -5.0f}};
  Weights weights = Weights::uniform({1.0});
  weights.flake_white = 1.0;
  RealisedPaint out;
  realise(one.paint, weights, out);
  EXPECT_EQ(out.corners[0].q, (std::array<std::uint16_t, 6>{0, 100, 0, 0, 65535, 65535}));
}

TEST(Realise, NoCornerMovesFurtherThanTheWeights) {
  std::mt19937 random(53);
  const InterpolatableData data = build_or_fail(random_paints(random, 3, small_frame(), 40), small_frame());
  const InterpolatablePaint paint = data.view();
  RealisedPaint one, two;
  for (int round = 0; round < 50; ++round) {
    const bool beyond = round % 2 == 1;
    auto w = random_weights(random, 3, beyond ? -1.5 : 0.0, beyond ? 1.5 : 0.5);
    auto v = w;
    const double step = std::pow(10.0, uniform(random, -5.0, -1.0));
    v[0] += step;
    v[1] -= 0.3 * step;
    v[2] -= 0.7 * step;
    realise(paint, Weights::uniform(w), one);
    realise(paint, Weights::uniform(v), two);
    double moved = 0.0;
    for (std::size_t i = 0; i < one.corners.size(); ++i)
      for (std::size_t a = 0; a < 6; ++a)
        moved = std::max(moved, std::abs(static_cast<double>(one.corners[i].q[a]) - two.corners[i].q[a]));
    EXPECT_LE(moved, 65535.0 * 2.0 * step + 1.05) << "one grid step is rounding";
  }
}

TEST(Realise, ExtrapolationStaysFiniteAndUpright) {
  std::mt19937 random(54);
  const InterpolatableData data = build_or_fail(random_paints(random, 3, small_frame(), 40), small_frame());
  const InterpolatablePaint paint = data.view();
  RealisedPaint out;
  for (const auto& w : {std::vector{3.0, -1.0, -1.0}, {-1.0, 3.0, -1.0}, {1e300, -1e300, 1.0}, {-50.0, 50.0, 1.0}}) {
    ASSERT_TRUE(check_weights(paint, Weights::uniform(w)));
    realise(paint, Weights::uniform(w), out);
    for (const QuantisedCuboid& cuboid : out.corners)
      for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_LE(cuboid.q[2 * axis], cuboid.q[2 * axis + 1]);
    for (const glm::vec3& mean : out.flake_mean)
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(mean[c]));
        EXPECT_GE(mean[c], 0.0f);
      }
  }
}

TEST(Realise, ReusesItsBuffersAndClearsTheRest) {
  std::mt19937 random(55);
  const InterpolatableData wide = build_or_fail(random_paints(random, 3, small_frame(), 40), small_frame());
  const InterpolatableData narrow = build_or_fail(random_paints(random, 2, small_frame(), 10), small_frame());
  RealisedPaint out, fresh;
  realise(wide.view(), Weights::uniform({0.2, 0.3, 0.5}), out);
  const QuantisedCuboid* corners = out.corners.data();
  const glm::vec3* means = out.flake_mean.data();
  realise(wide.view(), Weights::uniform({0.5, 0.2, 0.3}), out);
  EXPECT_EQ(out.corners.data(), corners);
  EXPECT_EQ(out.flake_mean.data(), means);
  realise(narrow.view(), Weights::uniform({0.5, 0.5}), out);
  realise(narrow.view(), Weights::uniform({0.5, 0.5}), fresh);
  EXPECT_EQ(out.corners, fresh.corners);
  EXPECT_EQ(out.width, fresh.width);
  const InterpolatablePaint view = narrow.view();
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t t = view.tuple_begin[row + 1] - view.tuple_begin[row]; t < static_cast<std::size_t>(out.width);
         ++t)
      EXPECT_EQ(out.corners[row * static_cast<std::size_t>(out.width) + t], QuantisedCuboid{});
}

/// Mean linear RGB of uniform Lab in a box by brute force, n^3 midpoints.
glm::dvec3 mean_by_grid(const glm::dvec3& lo, const glm::dvec3& hi, int n) {
  glm::dvec3 sum(0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        sum += linear_from_lab(lo + (hi - lo) * (glm::dvec3(i, j, k) + 0.5) / static_cast<double>(n));
  return sum / (static_cast<double>(n) * n * n);
}

TEST(Realise, FlakeMeanIsThatOfItsBoxes) {
  struct Case {
    glm::vec3 lo, hi;
  };
  const Case cases[] = {
      {{40, -10, -10}, {90, 10, 20}},  // above the toe
      {{0, 0, 0}, {0, 0, 0}},          // black
      {{1, 0, 0}, {5, 0.4f, 0.3f}},    // below
      {{0, 0, 0}, {30, 0, 0}},         // across, grey
      {{2, -20, -3}, {20, 30, 10}},    // across in X and Z by a and b
      {{0, 5, 5}, {400, 40, 30}},      // HDR
      {{0, 0, 0}, {0.02f, 90, 0}},     // thin
      {{7.9f, 1, 1}, {8.1f, 1, 1}},    // at the toe
  };
  for (const Case& box : cases) {
    ClusteredPaint paint;
    paint.rows = {{{box.lo, box.hi, 9}}};
    const InterpolatableData data = build_or_fail({paint}, {SliceLayout{1, {0, 1}}, 1, 0.02f, 3, 0});
    RealisedPaint out;
    realise(data.view(), Weights::uniform({1.0}), out);
    const glm::dvec3 lo = data.range.lo;
    const glm::dvec3 step = (glm::dvec3(data.range.hi) - lo) / 65535.0;
    const auto& q = out.corners.at(0).q;
    const glm::dvec3 expected =
        mean_by_grid(lo + step * glm::dvec3(q[0], q[2], q[4]), lo + step * glm::dvec3(q[1], q[3], q[5]), 96);
    const double size = std::max({expected.x, expected.y, expected.z, 1e-6});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(out.flake_mean.at(0)[c], std::max(expected[c], 0.0), 2e-4 * size + 1e-9);
  }
}

TEST(Realise, FlakeMeanFollowsTheMasses) {
  ClusteredPaint paint;
  paint.rows = {{{{0, 0, 0}, {0, 0, 0}, 3}, {{100, 0, 0}, {100, 0, 0}, 1}}};
  const InterpolatableData data = build_or_fail({paint}, {SliceLayout{1, {0, 1}}, 1, 0.02f, 2, 0});
  RealisedPaint out;
  realise(data.view(), Weights::uniform({1.0}), out);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(out.flake_mean.at(0)[c], 0.25f, 2e-4f);
}

TEST(CheckWeights, RefusesMistakes) {
  InterpolatablePaint paint;
  paint.paints.resize(2);
  EXPECT_TRUE(check_weights(paint, Weights::uniform({0.5, 0.5})));
  EXPECT_TRUE(check_weights(paint, Weights::uniform({1.5, -0.5000005})));
  const auto error = [&](const Weights& weights) { return check_weights(paint, weights).error(); };
  EXPECT_EQ(error(Weights::uniform({1.0})).field, "weights.base");
  EXPECT_EQ(error({{0.5, 0.5}, {0.5, 0.6}, {0.5, 0.5}}).field, "weights.flake_lightness");
  EXPECT_EQ(error({{0.5, 0.5}, {0.5, 0.5}, {0.5, std::nan("")}}).field, "weights.flake_colour");
  EXPECT_EQ(error(Weights::uniform({0.5, std::numeric_limits<double>::infinity()})).kind, ErrorKind::usage);
  Weights white = Weights::uniform({0.5, 0.5});
  for (const double inside : {0.0, 0.5, 1.0}) {
    white.flake_white = inside;
    EXPECT_TRUE(check_weights(paint, white));
  }
  for (const double outside : {-1e-9, 1.0 + 1e-9, std::nan("")}) {
    white.flake_white = outside;
    EXPECT_EQ(error(white).field, "weights.flake_white");
    EXPECT_EQ(error(white).kind, ErrorKind::usage);
  }
}

AnalyticPaint lobed(std::initializer_list<Lobe> lobes) {
  AnalyticPaint paint;
  std::copy(lobes.begin(), lobes.end(), paint.lobes.begin());
  return paint;
}

InterpolatablePaint analytic_mix(const std::vector<AnalyticPaint>& parts) {
  InterpolatablePaint paint;
  for (const AnalyticPaint& part : parts) paint.paints.push_back({{}, part, {}, {}, {}, {}});
  return paint;
}

TEST(RealiseAnalytic, CornersAreThePaints) {
  std::mt19937 random(56);
  std::vector<AnalyticPaint> parts;
  for (int k = 0; k < 4; ++k) {
    AnalyticPaint part = lobed({{glm::dvec3(0.3), 0.5, 0.1}, {glm::dvec3(0.2, 0.1, 0.7), 0.2 + 0.01 * k, 0.3}});
    part.diffuse = glm::dvec3(uniform(random, 0, 1));
    part.coat_ior = 1.0 + 0.1 * k;
    ColourTable table{5, {}};
    for (int i = 0; i < 25; ++i) table.linear.emplace_back(uniform(random, 0, 2), uniform(random, 0, 1), 0.3f);
    part.table = table;
    parts.push_back(part);
  }
  const InterpolatablePaint paint = analytic_mix(parts);
  for (std::size_t k = 0; k < 4; ++k) {
    const AnalyticPaint got = realise_analytic(paint, Weights::uniform(corner_weights(4, k)));
    EXPECT_EQ(got.diffuse, parts[k].diffuse);
    EXPECT_EQ(got.coat_ior, parts[k].coat_ior);
    EXPECT_EQ(got.table, parts[k].table);
    EXPECT_EQ(got.lobes[0], parts[k].lobes[0]);
    EXPECT_EQ(got.lobes[1], parts[k].lobes[1]);
    EXPECT_EQ(got.lobes[2].s, glm::dvec3(0.0));
  }
}

TEST(RealiseAnalytic, PairsLobesByRoughness) {
  // Given in another order, blended rough with rough.
  const auto paint = analytic_mix({lobed({{glm::dvec3(1), 0.5, 0.2}, {glm::dvec3(2), 0.1, 0.4}}),
                                   lobed({{glm::dvec3(4), 0.3, 0.8}, {glm::dvec3(3), 0.7, 0.6}})});
  const AnalyticPaint got = realise_analytic(paint, Weights::uniform({0.5, 0.5}));
  EXPECT_EQ(got.lobes[0], (Lobe{glm::dvec3(2.0), 0.6, 0.4}));
  EXPECT_EQ(got.lobes[1].s, glm::dvec3(3.0));
  EXPECT_NEAR(got.lobes[1].m, 0.2, 1e-15);
}

TEST(RealiseAnalytic, AbsentLobesDoNotDragTheShape) {
  const auto paint = analytic_mix({lobed({{glm::dvec3(1), 0.5, 0.2}, {glm::dvec3(2), 0.05, 0.4}}),
                                   lobed({{glm::dvec3(1), 0.5, 0.2}}), lobed({{glm::dvec3(1), 0.5, 0.2}})});
  for (const double w : {0.9, 0.5, 0.1, 0.001}) {
    const AnalyticPaint got = realise_analytic(paint, Weights::uniform({w, 0.7 * (1 - w), 0.3 * (1 - w)}));
    EXPECT_NEAR(got.lobes[1].m, 0.05, 1e-12);
    EXPECT_NEAR(got.lobes[1].f0, 0.4, 1e-12);
    EXPECT_NEAR(got.lobes[1].s.x, 2.0 * w, 1e-12);
  }
}

TEST(RealiseAnalytic, ClampsExtrapolation) {
  AnalyticPaint one = lobed({{glm::dvec3(1), 0.5, 0.9}});
  AnalyticPaint two = lobed({{glm::dvec3(3), 0.1, 0.2}});
  one.diffuse = glm::dvec3(0.1);
  two.diffuse = glm::dvec3(0.9);
  two.coat_ior = two.refraction_ior = 1.5;
  const auto paint = analytic_mix({one, two});
  const AnalyticPaint low = realise_analytic(paint, Weights::uniform({3.0, -2.0}));
  EXPECT_EQ(low.diffuse, glm::dvec3(0.0));
  EXPECT_EQ(low.lobes[0].s, glm::dvec3(0.0));
  EXPECT_EQ(low.coat_ior, 1.0);
  EXPECT_EQ(low.refraction_ior, 1.0);
  const AnalyticPaint high = realise_analytic(paint, Weights::uniform({-2.0, 3.0}));
  EXPECT_EQ(high.lobes[0].m, min_roughness);
  EXPECT_EQ(high.lobes[0].f0, 0.0);
  EXPECT_NEAR(high.coat_ior, 2.5, 1e-12);
}

TEST(RealiseAnalytic, TablesBlendInLab) {
  AnalyticPaint plain, small, large;
  small.table = ColourTable{2, std::vector<glm::vec3>(4, glm::vec3(0.25f))};
  large.table = ColourTable{5, std::vector<glm::vec3>(25, glm::vec3(0.09f, 0.5f, 1.7f))};
  const auto paint = analytic_mix({plain, small, large});
  const AnalyticPaint none = realise_analytic(paint, Weights::uniform({1, 0, 0}));
  ASSERT_TRUE(none.table);
  EXPECT_EQ(none.table->num_theta, 5);
  for (const glm::vec3& value : none.table->linear)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], 1.0f, 1e-5f);
  const AnalyticPaint mix = realise_analytic(paint, Weights::uniform({0.2, 0.3, 0.5}));
  const glm::vec3 lab = 0.2f * glm::vec3(100, 0, 0) + 0.3f * lab_from_linear(glm::vec3(0.25f)) +
                        0.5f * lab_from_linear(glm::vec3(0.09f, 0.5f, 1.7f));
  const glm::vec3 expected = linear_from_lab(lab);
  for (const glm::vec3& value : mix.table->linear)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-4f);
  EXPECT_FALSE(realise_analytic(analytic_mix({plain, plain}), Weights::uniform({0.5, 0.5})).table);
  const AnalyticPaint beyond = realise_analytic(paint, Weights::uniform({-3, 1, 3}));
  for (const glm::vec3& value : beyond.table->linear)
    for (int c = 0; c < 3; ++c) EXPECT_GE(value[c], 0.0f);
}

}  // namespace
}  // namespace lackwerk::core
