// Mixable flakes: exact masses, all clusters kept, deterministic for any number of threads.
#include "core/analysis/interpolation.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

using testing::build_or_fail;
using testing::random_paints;
using testing::small_frame;

bool same(const InterpolatableData& one, const InterpolatableData& two) {
  if (one.tuple_begin != two.tuple_begin || one.mass != two.mass || one.row_mass != two.row_mass ||
      one.range.lo != two.range.lo || one.range.hi != two.range.hi || one.parts.size() != two.parts.size())
    return false;
  for (std::size_t k = 0; k < one.parts.size(); ++k)
    if (one.parts[k].cluster_begin != two.parts[k].cluster_begin || one.parts[k].clusters != two.parts[k].clusters ||
        one.parts[k].tuple_cluster != two.parts[k].tuple_cluster)
      return false;
  return true;
}

TEST(Interpolation, MassesAreExactAndNoClusterIsLost) {
  std::mt19937 random(41);
  for (std::size_t paints = 1; paints <= 5; ++paints) {
    auto input = random_paints(random, paints, small_frame(), 50, 5000);
    for (auto& row : input.back().rows) row = testing::random_clusters(random, 20, 777);  // another total
    const InterpolatableData data = build_or_fail(input, small_frame());
    EXPECT_EQ(data.row_mass, paints == 1 ? 777u : 5000u);
    for (std::size_t row = 0; row < input[0].rows.size(); ++row) {
      const std::size_t begin = data.tuple_begin[row], end = data.tuple_begin[row + 1];
      EXPECT_LE(end - begin, paints * 50 - (paints - 1));
      for (std::size_t k = 0; k < paints; ++k) {
        const auto& clusters = input[k].rows[row];
        std::vector<std::uint64_t> mass(clusters.size(), 0);
        for (std::size_t t = begin; t < end; ++t) mass.at(data.parts[k].tuple_cluster[t]) += data.mass[t];
        EXPECT_EQ(std::accumulate(mass.begin(), mass.end(), std::uint64_t{0}), data.row_mass);
        std::uint64_t total = 0;
        for (const LabCuboid& cluster : clusters) total += cluster.count;
        for (std::size_t c = 0; c < clusters.size(); ++c) {
          EXPECT_GE(mass[c], 1u);
          EXPECT_LT(std::abs(static_cast<double>(mass[c]) -
                             static_cast<double>(clusters[c].count) * data.row_mass / static_cast<double>(total)),
                    1.0);
        }
      }
    }
  }
}

TEST(Interpolation, CornersAreNearestOnTheGrid) {
  std::mt19937 random(42);
  const auto input = random_paints(random, 2, small_frame(), 30);
  const InterpolatableData data = build_or_fail(input, small_frame());
  std::size_t n = 0;
  for (const auto& row : input[1].rows) {
    for (const LabCuboid& cluster : row) {
      const QuantisedCuboid& cuboid = data.parts[1].clusters.at(n++);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        const double step = (static_cast<double>(data.range.hi[a]) - data.range.lo[a]) / 65535.0;
        EXPECT_NEAR(data.range.lo[a] + step * cuboid.q[2 * axis], cluster.lo[a], 0.501 * step);
        EXPECT_NEAR(data.range.lo[a] + step * cuboid.q[2 * axis + 1], cluster.hi[a], 0.501 * step);
        EXPECT_LE(cuboid.q[2 * axis], cuboid.q[2 * axis + 1]);
        EXPECT_GT(cluster.lo[a] + (axis == 0 ? 1.0f : 0.0f), data.range.lo[a]);
        EXPECT_LT(cluster.hi[a], data.range.hi[a]);
      }
    }
  }
  EXPECT_EQ(data.range.lo.x, 0.0f);
}

TEST(Interpolation, SameBytesForAnyNumberOfThreads) {
  std::mt19937 random(43);
  const auto input = random_paints(random, 3, small_frame(), 40);
  const InterpolatableData one = build_or_fail(input, small_frame(), 1);
  EXPECT_TRUE(same(one, build_or_fail(input, small_frame(), 2)));
  EXPECT_TRUE(same(one, build_or_fail(input, small_frame(), 3)));
  EXPECT_TRUE(same(one, build_or_fail(input, small_frame(), 64)));
}

TEST(Interpolation, IdenticalPaintsStayThemselves) {
  std::mt19937 random(44);
  auto input = random_paints(random, 1, small_frame(), 50);
  for (auto& row : input[0].rows) row[7] = row[30] = row[3];  // duplicate boxes too
  input.resize(4, input[0]);
  const InterpolatableData data = build_or_fail(input, small_frame());
  EXPECT_EQ(data.mass.size(), 50 * input[0].rows.size());
  for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(data.parts[k].tuple_cluster, data.parts[0].tuple_cluster);
}

TEST(Interpolation, SwappedPaintsGiveTheSameTuples) {
  std::mt19937 random(45);
  auto input = random_paints(random, 2, small_frame(), 45);
  const InterpolatableData forth = build_or_fail(input, small_frame());
  std::swap(input[0], input[1]);
  const InterpolatableData back = build_or_fail(input, small_frame());
  ASSERT_EQ(forth.tuple_begin, back.tuple_begin);
  for (std::size_t row = 0; row + 1 < forth.tuple_begin.size(); ++row) {
    std::set<std::tuple<int, int, std::uint32_t>> one, two;
    for (std::size_t t = forth.tuple_begin[row]; t < forth.tuple_begin[row + 1]; ++t) {
      one.emplace(forth.parts[0].tuple_cluster[t], forth.parts[1].tuple_cluster[t], forth.mass[t]);
      two.emplace(back.parts[1].tuple_cluster[t], back.parts[0].tuple_cluster[t], back.mass[t]);
    }
    EXPECT_EQ(one, two);
  }
}

TEST(Interpolation, TuplesRiseInLightness) {
  std::mt19937 random(46);
  const InterpolatableData data = build_or_fail(random_paints(random, 3, small_frame(), 30), small_frame());
  for (std::size_t row = 0; row + 1 < data.tuple_begin.size(); ++row) {
    int last = -1;
    for (std::size_t t = data.tuple_begin[row]; t < data.tuple_begin[row + 1]; ++t) {
      int sum = 0;
      for (const auto& part : data.parts) {
        const auto& q = part.clusters[part.cluster_begin[row] + part.tuple_cluster[t]].q;
        sum += q[0] + q[1];
      }
      EXPECT_LE(last, sum);
      last = sum;
    }
  }
}

TEST(Interpolation, PlainPaintsAreBlackFlakes) {
  std::mt19937 random(47);
  auto input = random_paints(random, 2, small_frame(), 30);
  input[1].rows.clear();
  const InterpolatableData data = build_or_fail(input, small_frame());
  EXPECT_EQ(data.parts[1].clusters.size(), input[0].rows.size());
  for (const QuantisedCuboid& cuboid : data.parts[1].clusters) {
    EXPECT_EQ(cuboid.q[0], 0);  // L = 0 exactly
    EXPECT_EQ(cuboid.q[1], 0);
  }
  input[0].rows.clear();
  const InterpolatableData plain = build_or_fail(input, FlakeFrame{});
  EXPECT_EQ(plain.view().row_count(), 0);
  EXPECT_EQ(plain.parts.size(), 2u);
}

TEST(Interpolation, ProgressRisesToOne) {
  std::mt19937 random(48);
  std::vector<double> seen;
  const auto input = random_paints(random, 2, small_frame(), 10);
  ASSERT_TRUE(build_interpolatable(input, small_frame(), 2, [&](double p) { seen.push_back(p); }));
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
}

TEST(Interpolation, RefusesWhatItCannotBuild) {
  std::mt19937 random(49);
  const auto good = random_paints(random, 2, small_frame(), 10);
  const auto error = [](const std::vector<ClusteredPaint>& paints) {
    const auto result = build_interpolatable(paints, small_frame(), 1);
    return result ? std::string("accepted") : result.error().line();
  };
  auto bad = good;
  bad[1].rows[4].clear();
  EXPECT_EQ(error(bad), "paint 1: row 4 (level 1, slice 1): has no clusters");
  bad = good;
  bad[0].rows[2][3].count = 0;
  EXPECT_EQ(error(bad), "paint 0: row 2 (level 0, slice 2): a cluster stands for no texel");
  bad = good;
  bad[0].rows[2][3].lo.y = std::nanf("");
  EXPECT_EQ(error(bad), "paint 0: row 2 (level 0, slice 2): a cluster's box is inside out or not finite");
  bad = good;
  bad[1].rows.pop_back();
  EXPECT_NE(error(bad).find("5 rows of clusters"), std::string::npos);
  EXPECT_NE(error({}).find("0 paints"), std::string::npos);
  EXPECT_NE(error(std::vector<ClusteredPaint>(6, good[0])).find("6 paints"), std::string::npos);
  EXPECT_NE(error(random_paints(random, 1, small_frame(), 251)).find("250"), std::string::npos);
  bad = random_paints(random, 3, small_frame(), 10);
  for (auto& paint : bad) {
    paint.rows[5] = testing::random_clusters(random, 100, 10000);
    for (LabCuboid& cluster : paint.rows[5]) cluster.count = 1 + random() % 1000;
  }
  EXPECT_EQ(error(bad).substr(0, 25), "row 5 (level 1, slice 2):");
}

}  // namespace
}  // namespace lackwerk::core
