// A growing tree of known truth, morphed both ways; and what scans are at their worst.
#include "core/analysis/cloud_morph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>

#include "core/analysis/cloud_align.hpp"
#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/cloud_wasserstein.hpp"

namespace lackwerk::core {
namespace {

struct Branch {
  std::int32_t label = 0;
  glm::dvec3 base{0.0}, tip{0.0};
};

/// Points about 1 apart around each branch's axis, with jitter; labels are the branch.
PointCloud scanned(const std::vector<Branch>& branches, unsigned seed, double step = 0.5) {
  std::mt19937 random(seed);
  const auto jitter = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  PointCloud cloud;
  for (const Branch& b : branches) {
    const double length = glm::length(b.tip - b.base);
    const int count = static_cast<int>(length / step);
    for (int i = 0; i < count; ++i) {
      const glm::dvec3 place = b.base + (b.tip - b.base) * ((i + 0.5) / count);
      cloud.points.push_back(place + 0.8 * glm::dvec3(jitter(), jitter(), jitter()));
      cloud.labels.push_back(b.label);
    }
  }
  return cloud;
}

/// A stem with branches at 30, 50 and 70; the older tree is a tenth larger, has a new branch at 60 (label 9), and has
/// lost the branch at 50 (label 2).
std::vector<Branch> young() {
  return {{0, {0, 0, 0}, {0, 0, 100}},
          {1, {0, 0, 30}, {40, 0, 50}},
          {2, {0, 0, 50}, {-40, 0, 70}},
          {3, {0, 0, 70}, {0, 30, 85}}};
}
std::vector<Branch> older() {
  std::vector<Branch> tree = young();
  tree.erase(tree.begin() + 2);
  tree.push_back({9, {0, 0, 60}, {0, -36, 72}});
  for (Branch& b : tree) {
    b.base *= 1.05;
    b.tip *= 1.1;
  }
  return tree;
}

/// The label of most points.
std::int32_t main_label(const PointCloud& cloud, const std::vector<std::uint32_t>& points) {
  std::map<std::int32_t, int> votes;
  for (const std::uint32_t i : points) ++votes[cloud.labels[i]];
  std::int32_t best = -1;
  int most = 0;
  for (const auto& [label, count] : votes) {
    if (count > most) best = label;
    most = std::max(most, count);
  }
  return best;
}

void expect_all_leave_and_arrive(const CloudMorph& morph, const PointCloud& from, const PointCloud& to) {
  const auto key = [](const glm::dvec3& p) { return std::tuple(p.x, p.y, p.z); };
  std::set<std::tuple<double, double, double>> left, reached;
  for (const CloudPath& path : morph.paths) {
    left.insert(key(path.from));
    reached.insert(key(path.to));
  }
  for (const glm::dvec3& p : from.points) EXPECT_TRUE(left.count(key(p)));
  for (const glm::dvec3& p : to.points) EXPECT_TRUE(reached.count(key(p)));
}

void expect_truth(const PointCloud& from, const PointCloud& to, std::int32_t new_label, std::int32_t lost_label) {
  SegmentOptions cutting;
  cutting.shortest_branch = 12.0;
  cutting.skeleton_spacing = 2.0;
  const auto from_tree = segments_of(from.points, cutting);
  const auto to_tree = segments_of(to.points, cutting);
  ASSERT_TRUE(from_tree && to_tree);
  const auto morph = morph_scans(from.points, *from_tree, to.points, *to_tree, {}, {});
  ASSERT_TRUE(morph) << morph.error().line();
  std::size_t right = 0;
  std::set<std::int32_t> matched;
  for (const SegmentMatch& match : morph->matches) {
    const std::int32_t a = main_label(from, match.from_points);
    const std::int32_t b = main_label(to, match.to_points);
    if (match.kind == MatchKind::grown) {
      EXPECT_EQ(b, new_label);
    } else if (match.kind == MatchKind::decayed) {
      EXPECT_EQ(a, lost_label);
    } else {
      EXPECT_EQ(a, b) << match.from_points.size() << " points to " << match.to_points.size();
      matched.insert(a);
    }
    right += match.from_segments.size() + match.to_segments.size();
  }
  EXPECT_EQ(right, from_tree->segments.size() + to_tree->segments.size());
  EXPECT_EQ(matched, (std::set<std::int32_t>{0, 1, 3}));
  for (const auto kind : {MatchKind::grown, MatchKind::decayed})
    EXPECT_EQ(std::count_if(morph->matches.begin(), morph->matches.end(),
                            [&](const SegmentMatch& match) { return match.kind == kind; }),
              1);
  expect_all_leave_and_arrive(*morph, from, to);
  // Row and column maxima: at most one pair for each point that leaves or arrives, buds counted too.
  EXPECT_LE(morph->paths.size(), from.points.size() + to.points.size() + 100);
}

TEST(CloudMorph, GrowingTreeIsMatchedBothWays) {
  const PointCloud early = scanned(young(), 1);
  const PointCloud late = scanned(older(), 2);
  {
    SCOPED_TRACE("forward");
    expect_truth(early, late, 9, 2);
  }
  {
    SCOPED_TRACE("backward");
    expect_truth(late, early, 2, 9);
  }
}

/// A stem (label 0) of this height with broad round leaves on stalks (labels 1, 2, ...) at its top, a third of a turn
/// apart, each this wide and hanging down by `droop` of its length.
PointCloud broad_leaved(double height, double width, double droop, int leaves, unsigned seed) {
  std::mt19937 random(seed);
  const auto jitter = [&] { return 0.3 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  PointCloud cloud = scanned({{0, {0, 0, 0}, {0, 0, height}}}, seed, 0.1);
  for (int leaf = 0; leaf < leaves; ++leaf) {
    const double angle = 2.0943951023931953 * leaf;
    constexpr double stalk = 8.0;
    const Branch axis{
        leaf + 1, {0, 0, height}, {std::cos(angle) * stalk, std::sin(angle) * stalk, height - droop * stalk}};
    const PointCloud stalk_points = scanned({axis}, seed + 1, 0.1);
    cloud.points.insert(cloud.points.end(), stalk_points.points.begin(), stalk_points.points.end());
    cloud.labels.insert(cloud.labels.end(), stalk_points.labels.begin(), stalk_points.labels.end());
    const auto across = static_cast<int>(width / 0.5);
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j) {
        const double along = stalk + 0.5 * i;
        const double aside = 0.5 * j - 0.5 * width;
        if (std::hypot(along - stalk - 0.5 * width, aside) > 0.5 * width) continue;
        cloud.points.emplace_back(std::cos(angle) * along - std::sin(angle) * aside + jitter(),
                                  std::sin(angle) * along + std::cos(angle) * aside + jitter(),
                                  height - droop * along + jitter());
        cloud.labels.push_back(leaf + 1);
      }
  }
  return cloud;
}

TEST(CloudMorph, BroadLeavesAreWholeAndGrowAndDroopAsWholes) {
  const PointCloud early = broad_leaved(40.0, 20.0, 0.0, 2, 21);
  const PointCloud late = broad_leaved(44.0, 26.0, 0.4, 3, 22);  // a third leaf is new
  SegmentOptions cutting;
  cutting.skeleton_spacing = 1.5;
  const auto from = segments_of(early.points, cutting);
  const auto to = segments_of(late.points, cutting);
  ASSERT_TRUE(from && to);
  EXPECT_EQ(from->segments.size(), 3u);
  EXPECT_EQ(to->segments.size(), 4u);
  for (const bool forward : {true, false}) {
    const PointCloud& one = forward ? early : late;
    const PointCloud& two = forward ? late : early;
    const auto morph = forward ? morph_scans(one.points, *from, two.points, *to, {}, {})
                               : morph_scans(one.points, *to, two.points, *from, {}, {});
    ASSERT_TRUE(morph);
    int matched = 0;
    for (const SegmentMatch& match : morph->matches) {
      if (match.kind == MatchKind::grown) {
        EXPECT_TRUE(forward);
        EXPECT_EQ(main_label(two, match.to_points), 3);
      } else if (match.kind == MatchKind::decayed) {
        EXPECT_FALSE(forward);
        EXPECT_EQ(main_label(one, match.from_points), 3);
      } else {
        ++matched;
        EXPECT_EQ(main_label(one, match.from_points), main_label(two, match.to_points))
            << (forward ? "forward " : "backward ") << match.from_points.size() << " to " << match.to_points.size()
            << ", " << match.distance;
      }
    }
    EXPECT_EQ(matched, 3);
    EXPECT_EQ(morph->matches.size(), 4u);
    expect_all_leave_and_arrive(*morph, one, two);
  }
  // The spanning tree of the same leaves forks within them: what the levels are there for.
  cutting.by_levels = false;
  EXPECT_GT(segments_of(late.points, cutting)->segments.size(), 4u);
}

TEST(CloudMorph, LabelsMatchThemselves) {
  const PointCloud early = scanned(young(), 3);
  const PointCloud late = scanned(older(), 4);
  const CloudSegments from = labelled_segments(early, {});
  const CloudSegments to = labelled_segments(late, {});
  ASSERT_EQ(from.segments.size(), 4u);
  EXPECT_EQ(from.segments[0].label, 0);
  for (std::size_t s = 1; s < 4; ++s) EXPECT_EQ(from.segments[s].parent, 0u);
  MatchOptions matching;
  matching.by_label = true;
  const auto morph = morph_scans(early.points, from, late.points, to, matching, {});
  ASSERT_TRUE(morph);
  for (const SegmentMatch& match : morph->matches) {
    if (match.kind == MatchKind::grown) {
      EXPECT_EQ(main_label(late, match.to_points), 9);
      // It comes out of the stem near its base at 63.
      for (const std::uint32_t i : match.from_points) {
        EXPECT_EQ(early.labels[i], 0);
        EXPECT_NEAR(early.points[i].z, 63.0, 15.0);
      }
    } else if (match.kind == MatchKind::decayed) {
      EXPECT_EQ(main_label(early, match.from_points), 2);
      for (const glm::dvec3& place : match.to_places) EXPECT_NEAR(place.z, 0.0, 1.0);
    } else {
      EXPECT_EQ(main_label(early, match.from_points), main_label(late, match.to_points));
    }
  }
  expect_all_leave_and_arrive(*morph, early, late);
  SegmentOptions loose;
  loose.virtual_root = true;
  const CloudSegments hung = labelled_segments(early, loose);
  ASSERT_EQ(hung.segments.size(), 5u);
  EXPECT_TRUE(hung.segments[0].points.empty());
  EXPECT_EQ(hung.segments[0].children.size(), 4u);
}

TEST(CloudMorph, AStemStretchesEvenly) {
  // Twice as long: the middle must come to the middle, far beyond its nearest neighbours.
  const PointCloud early = scanned({{0, {0, 0, 0}, {0, 0, 50}}}, 5, 0.25);
  const PointCloud late = scanned({{0, {0, 0, 0}, {0, 0, 100}}}, 6, 0.25);
  const auto pairs = pair_points(early.points, late.points, {});
  ASSERT_TRUE(pairs);
  EXPECT_EQ(pairs->state, SinkhornState::converged) << pairs->marginal_violation;
  double off = 0.0;
  for (const CloudPair& pair : pairs->pairs)
    off = std::max(off, std::abs(late.points[pair.to].z - 2.0 * early.points[pair.from].z));
  EXPECT_LT(off, 8.0);
}

TEST(CloudMorph, ASupportOfNeighboursOnlyIsWidened) {
  // One dense end: its 15 neighbours cannot take it all.
  PointCloud early = scanned({{0, {0, 0, 0}, {0, 0, 50}}}, 7, 0.25);
  PointCloud late = scanned({{0, {0, 0, 0}, {0, 0, 50}}}, 8, 0.25);
  for (int i = 0; i < 2000; ++i) late.points.emplace_back(0.0, 0.001 * i, 50.0);
  CloudTransportOptions bare;
  bare.backbone = false;
  bare.neighbours = 2;
  bare.clusters = 1;
  const TransportSupport support = cloud_support(early.points, late.points, bare);
  SinkhornPlan named;
  const std::vector<double> leave(early.points.size(), 1.0 / static_cast<double>(early.points.size()));
  const std::vector<double> arrive(late.points.size(), 1.0 / static_cast<double>(late.points.size()));
  EXPECT_FALSE(support_is_feasible(support, leave, arrive, named));
  EXPECT_FALSE(named.stuck_rows.empty());
  EXPECT_FALSE(named.starved_columns.empty());
  const auto pairs = pair_points(early.points, late.points, bare);
  ASSERT_TRUE(pairs);
  EXPECT_NE(pairs->state, SinkhornState::infeasible);
  bare.backbone = true;
  EXPECT_TRUE(support_is_feasible(cloud_support(early.points, late.points, bare), leave, arrive, named));
}

TEST(CloudMorph, WorstScansGiveAResult) {
  const PointCloud stem = scanned({{0, {0, 0, 0}, {0, 0, 50}}}, 9);
  std::vector<glm::dvec3> line;
  for (int i = 0; i < 100; ++i) line.emplace_back(0.0, 0.0, 0.5 * i);
  const std::map<std::string, std::vector<glm::dvec3>> scans{
      {"a single point", {glm::dvec3(1.0, 2.0, 3.0)}},
      {"duplicates", std::vector<glm::dvec3>(200, glm::dvec3(1.0, 2.0, 3.0))},
      {"collinear", line},
      {"100 times denser", scanned({{0, {0, 0, 0}, {0, 0, 50}}}, 10, 0.005).points},
      {"apart", scanned({{0, {1e4, 0, 0}, {1e4, 0, 50}}}, 11).points}};
  for (const auto& [name, scan] : scans) {
    const auto tree = segments_of(scan, {});
    const auto stem_tree = segments_of(stem.points, {});
    ASSERT_TRUE(tree && stem_tree) << name;
    for (const bool forward : {true, false}) {
      const auto morph = forward ? morph_scans(stem.points, *stem_tree, scan, *tree, {}, {})
                                 : morph_scans(scan, *tree, stem.points, *stem_tree, {}, {});
      ASSERT_TRUE(morph) << name;
      expect_all_leave_and_arrive(*morph, forward ? stem : PointCloud{scan, {}}, forward ? PointCloud{scan, {}} : stem);
      for (const glm::dvec3& p : places_at(morph->paths, 0.5)) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << name;
    }
  }
  const auto none = morph_scans({}, *segments_of({}, {}), stem.points, *segments_of(stem.points, {}), {}, {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().field, "from");
}

TEST(CloudMatch, AssignmentIsTheLeast) {
  const std::vector<double> cost{4, 1, 3, 2, 0, 5};
  EXPECT_EQ(least_assignment(cost, 2, 3), (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(least_assignment(cost, 3, 2), (std::vector<std::uint32_t>{1, CloudSegment::none, 0}));
  EXPECT_TRUE(least_assignment({}, 0, 3).empty());
}

TEST(CloudAlign, FindsATurnedPlantAgain) {
  const PointCloud fixed = scanned(young(), 12);
  const double angle = 2.0;
  std::vector<glm::dvec3> moving;
  for (const glm::dvec3& p : fixed.points)
    moving.emplace_back(std::cos(angle) * p.x - std::sin(angle) * p.y + 30.0,
                        std::sin(angle) * p.x + std::cos(angle) * p.y - 20.0, p.z + 5.0);
  for (const bool stands : {false, true}) {
    AlignOptions options;
    options.stands = stands;
    const Alignment found = align(moving, fixed.points, options);
    EXPECT_LT(found.rms, 0.1);
    for (std::size_t i = 0; i < moving.size(); ++i)
      EXPECT_LT(glm::distance(found.motion(moving[i]), fixed.points[i]), 0.2);
    if (stands) {
      EXPECT_NEAR(found.motion.rotation[2].z, 1.0, 1e-12);
    }
  }
  EXPECT_TRUE(foot_of(fixed.points, 2));
  EXPECT_FALSE(foot_of(broad_leaved(0.5, 20.0, 0.5, 3, 16).points, 2));
}

TEST(PointCloud, StrayPointsGoAndDensityEvensOut) {
  PointCloud cloud = scanned(young(), 13);
  const std::size_t real = cloud.points.size();
  cloud.points.emplace_back(300.0, 300.0, 300.0);
  cloud.labels.push_back(7);
  const auto kept = inliers_of(cloud.points, {});
  EXPECT_LT(kept.back(), real);
  EXPECT_GT(kept.size(), real * 98 / 100);
  const auto even = resampled(picked(cloud, kept), 3.0);
  ASSERT_TRUE(even);
  EXPECT_LT(even->points.size(), real / 2);
  EXPECT_EQ(even->labels.size(), even->points.size());
  EXPECT_FALSE(resampled(cloud, 0.0));
  EXPECT_FALSE(resampled(cloud, 1e-9));
}

TEST(CloudNeighbours, AreThoseOfBruteForce) {
  PointCloud cloud = scanned(young(), 14);
  for (int i = 0; i < 40; ++i) cloud.points.push_back(cloud.points[3]);
  const CloudTree tree(cloud.points);
  std::vector<CloudNeighbour> near;
  for (std::size_t q = 0; q < cloud.points.size(); q += 7) {
    std::vector<std::pair<double, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
      const glm::dvec3 d = cloud.points[i] - cloud.points[q];
      all.emplace_back(d.x * d.x + d.y * d.y + d.z * d.z, i);
    }
    std::sort(all.begin(), all.end());
    tree.nearest(cloud.points[q], 9, near);
    ASSERT_EQ(near.size(), 9u);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(near[k].index, all[k].second);
  }
}

TEST(CloudWasserstein, IsTheLengthOfAShift) {
  const PointCloud cloud = scanned(young(), 15);
  std::vector<glm::dvec3> moved = cloud.points;
  for (glm::dvec3& p : moved) p += glm::dvec3(3.0, 4.0, 0.0);
  EXPECT_NEAR(wasserstein(clusters_of(cloud.points, 64), clusters_of(moved, 64)), 5.0, 1e-9);
}

}  // namespace
}  // namespace lackwerk::core
