// The rank table: which distribution it yields, exactly integrated, against the exact masses.
#include "core/rank_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

using testing::uniform;

/// Probability of each tuple: du = 2 (1 - v) dv over the 255 parts of each step.
std::vector<double> distribution(const RankStep* row, std::size_t tuples) {
  std::vector<double> p(tuples, 0.0);
  int last = 0;
  for (int step = 0; step < rank_table_steps; ++step) {
    for (int part = 0; part < 255; ++part) {
      const double from = (step + part / 255.0) / rank_table_steps;
      const double to = (step + (part + 1) / 255.0) / rank_table_steps;
      const int tuple = tuple_of_rank(row, 0.5 * (from + to));
      EXPECT_GE(tuple, last) << "ranks must rise";
      last = tuple;
      p.at(static_cast<std::size_t>(tuple)) += (to - from) * (2.0 - from - to);
    }
  }
  return p;
}

struct Row {
  std::vector<std::uint32_t> mass;
  std::vector<double> exact, got;
  double variation = 0.0;  ///< total variation distance
  std::size_t lost = 0;
};

/// The table of one row of these masses.
Row fit(std::vector<std::uint32_t> mass) {
  const std::vector<std::uint32_t> begin{0, static_cast<std::uint32_t>(mass.size())};
  InterpolatablePaint paint;
  paint.layout = {1, {0, 1}};
  paint.level_count = 1;
  paint.tuple_begin = begin;
  paint.mass = mass;
  paint.row_mass = std::accumulate(mass.begin(), mass.end(), 0u);
  const auto table = build_rank_table(paint);
  Row row{mass, {}, distribution(table.data(), mass.size())};
  for (std::size_t t = 0; t < mass.size(); ++t) {
    row.exact.push_back(static_cast<double>(mass[t]) / paint.row_mass);
    row.variation += 0.5 * std::abs(row.exact[t] - row.got[t]);
    if (row.got[t] == 0.0) ++row.lost;
  }
  return row;
}

TEST(RankTable, FewTuplesAreExactToAPartOfAStep) {
  EXPECT_NEAR(fit({7}).variation, 0.0, 1e-12);
  std::mt19937 random(61);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::uint32_t> mass(2 + random() % 20);
    for (auto& m : mass) m = 1 + random() % 50000;
    const Row row = fit(mass);
    EXPECT_EQ(row.lost, 0u);
    // Each inner edge is off by half a part, at most 1.5e-5 of mass, unless steps were crowded.
    EXPECT_LE(row.variation, 2e-5 * static_cast<double>(mass.size()) + 0.004);
  }
}

TEST(RankTable, RareTuplesAreKept) {
  // One in 1e5, alone between common ones, dark, in the middle and brightest.
  for (const std::size_t place : {0u, 1u, 4u, 9u, 10u}) {
    std::vector<std::uint32_t> mass(10, 99999);
    mass.insert(mass.begin() + static_cast<std::ptrdiff_t>(place), 10);
    const Row row = fit(mass);
    EXPECT_EQ(row.lost, 0u) << place;
    EXPECT_GT(row.got[place], 0.2e-5) << place;
    EXPECT_LT(row.got[place], 5e-5) << place;
    EXPECT_LT(row.variation, 1e-4);
  }
}

TEST(RankTable, BrightRareTuplesAreAccurate) {
  // What sparkles: the brightest ten of 1,000,000 texels each. Eleven edges in the last 2.6 steps just fit.
  std::vector<std::uint32_t> mass{600000, 200000, 100000, 99900};
  mass.resize(14, 10);
  const Row row = fit(mass);
  EXPECT_EQ(row.lost, 0u);
  for (std::size_t t = 4; t < 14; ++t) EXPECT_LT(row.got[t], 3e-5) << t;
  EXPECT_LT(row.variation, 5e-5);
  const double sparkle = std::accumulate(row.got.begin() + 4, row.got.end(), 0.0);
  EXPECT_NEAR(sparkle, 1e-4, 5e-6);
}

TEST(RankTable, ManyTuplesStayClose) {
  std::mt19937 random(62);
  double worst = 0.0, mean = 0.0;
  for (int round = 0; round < 40; ++round) {
    std::vector<std::uint32_t> mass;
    mass.reserve(246);
    for (int t = 0; t < 246; ++t)  // the brighter the rarer, as in slices
      mass.push_back(1 +
                     static_cast<std::uint32_t>(-2000.0 * std::log(uniform(random, 1e-9, 1)) * std::exp(-0.02 * t)));
    const Row row = fit(mass);
    worst = std::max(worst, row.variation);
    mean += row.variation / 40.0;
    EXPECT_LE(row.lost, 12u);
  }
  EXPECT_LT(worst, 0.04);
  EXPECT_LT(mean, 0.025);
}

TEST(RankTable, ACrowdDoesNotGrow) {
  // 245 rare tuples share 0.1 %: too many for their steps. Those that stay carry the mass of those that go.
  std::vector<std::uint32_t> mass{9990000};
  mass.resize(246, 41);
  const Row row = fit(mass);
  EXPECT_NEAR(1.0 - row.got[0], 1e-3, 3e-4);
  EXPECT_LT(row.variation, 1.5e-3);
  std::size_t kept = 0;
  for (std::size_t t = 1; t < 246; ++t) kept += row.got[t] > 0.0 ? 1 : 0;
  EXPECT_GE(kept, 30u);
}

TEST(RankTable, EmptyRowsAndZeroMasses) {
  InterpolatablePaint paint;
  paint.layout = {1, {0, 1}};
  paint.level_count = 1;
  const std::vector<std::uint32_t> begin{0, 0};
  paint.tuple_begin = begin;
  paint.row_mass = 1;
  for (const RankStep& step : build_rank_table(paint)) EXPECT_EQ(step, RankStep{});
  // A jump by five tuples happens between steps only: half a step off at the most.
  const Row row = fit({0, 10, 0, 0, 0, 0, 30, 0});
  EXPECT_NEAR(row.got[1], 0.25, 0.004);
  EXPECT_NEAR(row.got[6], 0.75, 0.004);
  EXPECT_EQ(row.got[0] + row.got[2] + row.got[7], 0.0);
}

TEST(RankTable, WholePaint) {
  std::mt19937 random(63);
  const InterpolatableData data =
      testing::build_or_fail(testing::random_paints(random, 3, testing::small_frame(), 50), testing::small_frame());
  const InterpolatablePaint paint = data.view();
  const auto table = build_rank_table(paint);
  ASSERT_EQ(table.size(), static_cast<std::size_t>(paint.row_count()) * rank_table_steps);
  for (std::size_t row = 0; row < static_cast<std::size_t>(paint.row_count()); ++row) {
    const std::size_t tuples = paint.tuple_begin[row + 1] - paint.tuple_begin[row];
    const auto got = distribution(table.data() + row * rank_table_steps, tuples);
    double variation = 0.0;
    for (std::size_t t = 0; t < tuples; ++t)
      variation +=
          0.5 * std::abs(got[t] - paint.mass[paint.tuple_begin[row] + t] / static_cast<double>(paint.row_mass));
    EXPECT_LT(variation, 0.05);
  }
}

}  // namespace
}  // namespace lackwerk::core
