// A growing tree of known truth, morphed both ways: with labels, with labels of other numbers, with segments found.
#include "packs/tools/growing_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "core/analysis/cloud_morph.hpp"
#include "packs/tools/scan_builder.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::int32_t cropped_bough = 2;
constexpr std::size_t early_points = 2000, late_points = 5000;

/// Two scans of a tree, at 0 and 1 or the other way round.
struct Pair {
  GrowingTree tree;
  std::vector<ScanSource> scans;
};

Pair pair_of(const GrowingTreeOptions& options, bool forward) {
  Pair out{growing_tree(options), {}};
  out.scans.push_back({"one", 0.0, tree_at(out.tree, forward ? 0.0 : 1.0, forward ? early_points : late_points, 0)});
  out.scans.push_back({"two", 1.0, tree_at(out.tree, forward ? 1.0 : 0.0, forward ? late_points : early_points, 1)});
  return out;
}

ScanSettings settings_of_tree() {
  ScanSettings settings;
  settings.clean = settings.align = false;
  settings.spacing = -1.0;
  settings.matching.fades = true;  // what falls is nowhere in the tree that was
  return settings;
}

std::set<std::int32_t> labels_of(const core::PointCloud& cloud) { return {cloud.labels.begin(), cloud.labels.end()}; }

/// The label of most points; -1 of none.
std::int32_t main_label(const core::PointCloud& cloud, const std::vector<std::uint32_t>& points) {
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

void expect_all_leave_and_arrive(const ScanSeries& series) {
  std::set<std::uint32_t> left, reached;
  for (const core::CloudPath& path : series.steps[0].paths) {
    left.insert(path.from_point);
    if (path.to_point != core::CloudPath::none) reached.insert(path.to_point);
  }
  EXPECT_EQ(left.size(), series.scans[0].cloud.points.size());
  EXPECT_EQ(reached.size(), series.scans[1].cloud.points.size());
}

/// Both ways between the tree rebuilt at half time and the tree that stood there, in the unit cube.
double rebuilt_off(const ScanSeries& series, const GrowingTree& tree) {
  const core::PointCloud truth = tree_at(tree, 0.5, (early_points + late_points) / 2, 2);
  const double extent = core::extent_of(core::box_of(truth.points));
  const auto rebuilt = core::places_at(series.steps[0].paths, 0.5);
  return 0.5 * (core::distance_to(rebuilt, truth.points, extent).mean +
                core::distance_to(truth.points, rebuilt, extent).mean);
}

void expect_better_than_whole(const Pair& pair, const ScanSeries& series, ScanSettings settings) {
  settings.segment = false;
  const auto whole = morph_series(pair.scans, settings);
  ASSERT_TRUE(whole) << whole.error().line();
  EXPECT_LT(rebuilt_off(series, pair.tree), 0.8 * rebuilt_off(*whole, pair.tree));
}

/// Every match of given parts is true to the labels of the first numbering.
void expect_true_parts(const ScanSeries& series, const core::PointCloud& from, const core::PointCloud& to) {
  const std::set<std::int32_t> before = labels_of(from), after = labels_of(to);
  std::set<std::int32_t> matched;
  for (const core::SegmentMatch& match : series.steps[0].matches) {
    const std::int32_t a = main_label(from, match.from_points);
    const std::int32_t b = main_label(to, match.to_points);
    if (match.kind == core::MatchKind::matched) {
      EXPECT_EQ(a, b);
      matched.insert(a);
    } else if (match.kind == core::MatchKind::grown) {
      EXPECT_FALSE(before.count(b)) << "branch " << b << " was there";
    } else {
      EXPECT_FALSE(after.count(a)) << "branch " << a << " is still there";
    }
  }
  for (const std::int32_t label : before) EXPECT_EQ(matched.count(label), after.count(label)) << "branch " << label;
}

TEST(GrowingTree, IsTheSameTreeAtAllTimes) {
  const GrowingTree tree = growing_tree({});
  EXPECT_GT(tree.branches.size(), 300u);
  const core::PointCloud early = tree_at(tree, 0.0, 77448, 0);
  const core::PointCloud late = tree_at(tree, 1.0, 326032, 1);
  EXPECT_EQ(early.points.size(), 77448u);
  EXPECT_EQ(late.labels.size(), 326032u);
  const auto before = labels_of(early), after = labels_of(late);
  EXPECT_TRUE(before.count(cropped_bough));
  EXPECT_FALSE(after.count(cropped_bough));
  EXPECT_GT(after.size(), 5 * before.size());
  for (const std::int32_t label : before) {
    std::uint32_t bough = static_cast<std::uint32_t>(label);
    while (tree.branches[bough].level > 1) bough = tree.branches[bough].parent;
    EXPECT_EQ(after.count(label) == 0, bough == cropped_bough) << label;
  }
  const core::CloudBox small = core::box_of(early.points), large = core::box_of(late.points);
  EXPECT_NEAR(small.low.z, 0.0, 0.1);
  EXPECT_GT(large.high.z, 1.2 * small.high.z);
  EXPECT_EQ(tree_at(tree, 0.3, 1000, 5).points, tree_at(growing_tree({}), 0.3, 1000, 5).points);
}

TEST(GrowingTree, LabelledBranchesAreMatchedBothWays) {
  for (const bool forward : {true, false}) {
    SCOPED_TRACE(forward ? "growth" : "decay");
    GrowingTreeOptions small;
    small.levels = 3;
    small.boughs = 5;
    const Pair pair = pair_of(small, forward);
    const ScanSettings settings = settings_of_tree();
    const auto series = morph_series(pair.scans, settings);
    ASSERT_TRUE(series) << series.error().line();
    EXPECT_TRUE(series->labelled);
    expect_true_parts(*series, pair.scans[0].cloud, pair.scans[1].cloud);
    expect_all_leave_and_arrive(*series);
    expect_better_than_whole(pair, *series, settings);
  }
}

TEST(GrowingTree, LabelsOfOtherNumbersAreMatchedByDistance) {
  for (const bool forward : {true, false}) {
    SCOPED_TRACE(forward ? "growth" : "decay");
    GrowingTreeOptions small;
    small.levels = 3;
    small.boughs = 5;
    Pair pair = pair_of(small, forward);
    const std::vector<ScanSource> truth = pair.scans;
    const auto count = static_cast<std::int32_t>(pair.tree.branches.size());
    for (std::int32_t& label : pair.scans[1].cloud.labels) label = (label * 7 + 3) % count + 100;
    ScanSettings settings = settings_of_tree();
    settings.labels_agree = false;
    const auto series = morph_series(pair.scans, settings);
    ASSERT_TRUE(series) << series.error().line();
    EXPECT_TRUE(series->labelled);
    // What a new or cropped bough bears comes and goes with it: main labels are the boughs'.
    expect_true_parts(*series, truth[0].cloud, truth[1].cloud);
    expect_all_leave_and_arrive(*series);
    expect_better_than_whole(pair, *series, settings);
    settings.labels_agree = true;
    const auto believed = morph_series(pair.scans, settings);
    ASSERT_TRUE(believed);
    EXPECT_TRUE(std::none_of(believed->steps[0].matches.begin(), believed->steps[0].matches.end(),
                             [](const core::SegmentMatch& m) { return m.kind == core::MatchKind::matched; }))
        << "believed, no label of one scan is one of the other";
  }
}

TEST(GrowingTree, FoundSegmentsAreMatchedBothWays) {
  for (const bool forward : {true, false}) {
    SCOPED_TRACE(forward ? "growth" : "decay");
    GrowingTreeOptions sapling;
    sapling.levels = 2;
    sapling.boughs = 5;
    sapling.thickness = 0.008;
    const Pair pair = pair_of(sapling, forward);
    ScanSettings settings = settings_of_tree();
    settings.by_label = false;
    settings.segments.shortest_branch = 0.3;
    settings.segments.skeleton_spacing = 0.12;
    const auto series = morph_series(pair.scans, settings);
    ASSERT_TRUE(series) << series.error().line();
    EXPECT_FALSE(series->labelled);
    std::map<core::MatchKind, std::set<std::int32_t>> seen;
    for (const core::SegmentMatch& match : series->steps[0].matches) {
      const std::int32_t a = main_label(pair.scans[0].cloud, match.from_points);
      const std::int32_t b = main_label(pair.scans[1].cloud, match.to_points);
      if (match.kind == core::MatchKind::matched) {
        EXPECT_EQ(a, b);
      }
      seen[match.kind].insert(match.kind == core::MatchKind::decayed ? a : b);
    }
    // The trunk and the eldest bough go on; the cropped one goes (or comes, backwards), those that are buds at time 0
    // come (or go).
    const auto& fresh = seen[forward ? core::MatchKind::grown : core::MatchKind::decayed];
    const auto& lost = seen[forward ? core::MatchKind::decayed : core::MatchKind::grown];
    EXPECT_TRUE(seen[core::MatchKind::matched].count(0) && seen[core::MatchKind::matched].count(1));
    EXPECT_EQ(lost, std::set<std::int32_t>{cropped_bough});
    for (const std::int32_t bough : {3, 4}) EXPECT_TRUE(fresh.count(bough)) << bough;
    EXPECT_FALSE(fresh.count(cropped_bough) || fresh.count(1));
    expect_all_leave_and_arrive(*series);
    expect_better_than_whole(pair, *series, settings);
  }
}

}  // namespace
}  // namespace lackwerk::packs
