// The report's flake knobs: that every figure is there, and that bytes are counted as the textures are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "core/paint_textures.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"
#include "kiosk/tools/report/flake_memory.hpp"

namespace lackwerk::report {
namespace {

TEST(ReportFlakes, ErrorsAreSummedUpByNearestRank) {
  Setting setting;
  std::vector<double> errors;
  for (int k = 40; k >= 1; --k) errors.push_back(k);
  set_errors(setting, errors);
  EXPECT_DOUBLE_EQ(setting.error, 20.5);
  EXPECT_DOUBLE_EQ(setting.p95, 38.0);
  EXPECT_DOUBLE_EQ(setting.worst, 40.0);
  Setting nothing;
  set_errors(nothing, {});
  EXPECT_TRUE(std::isnan(nothing.error));
}

// 44 slices, 9 levels of which 8 have rows, 148 tuples: 1024 bytes of ranks and 12 a tuple; random numbers of 2 bytes.
TEST(ReportFlakes, TextureBytesAreCountedRowByRow) {
  constexpr std::uint64_t rows = 44 * 8;
  constexpr std::uint64_t random = 512 * 512 * 2;
  constexpr std::uint64_t grids = 2 * 16 * 16 * 4;
  EXPECT_EQ(flake_texture_bytes({44, 9, 148, 0}), rows * (1024 + 148 * 12) + random + grids);
  EXPECT_EQ(flake_texture_bytes({44, 9, 148, 64}), rows * (1024 + 148 * 12) + random + grids + 64 * 64 * 4);
  EXPECT_EQ(flake_texture_bytes({44, 1, 148, 0}), grids);  // one level is its own mean: no rows, nothing random
  EXPECT_EQ(flake_texture_bytes({0, 0, 0, 0}), grids);
  EXPECT_EQ(papers_texture_bytes(67, 9, 50, 500), std::uint64_t{67 * 9} * (500 + 50 * 12) + 512 * 512);
}

const Setting* find(const Knob& knob, const std::string& label) {
  const auto found =
      std::find_if(knob.settings.begin(), knob.settings.end(), [&](const Setting& one) { return one.label == label; });
  return found == knob.settings.end() ? nullptr : &*found;
}

/// Recipes are looked for around the working folder: the build folder need not lie in the source tree.
class ReportFlakeKnobs : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(LACKWERK_SOURCE_DIR);
  }
  void TearDown() override { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_;
};

// One quick run of all but the memory knob, which builds packs: what it must say, whatever the machine.
TEST_F(ReportFlakeKnobs, KnobsAreWholeAndTheirDefaultsAreAmongThem) {
  Workbench bench(true);
  Findings findings;
  for (const auto part : {add_flake_clusters, add_flake_ranks, add_flake_corners, add_flake_angles, add_flake_levels}) {
    const auto ok = part(bench, findings);
    ASSERT_TRUE(ok) << ok.error().line();
  }
  std::set<std::string> ids;
  for (const Knob& knob : findings.knobs) {
    EXPECT_TRUE(ids.insert(knob.id).second) << knob.id;
    const Setting* chosen = find(knob, knob.chosen);
    ASSERT_NE(chosen, nullptr) << knob.id;
    EXPECT_TRUE(chosen->eligible) << knob.id;
    EXPECT_FALSE(knob.why.empty());
    std::set<std::string> labels;
    for (const Setting& one : knob.settings) {
      EXPECT_TRUE(labels.insert(one.label).second) << knob.id << " " << one.label;
      EXPECT_GE(one.error, 0.0) << knob.id << " " << one.label;
      EXPECT_LE(one.error, one.worst) << knob.id << " " << one.label;
      EXPECT_TRUE(one.time.count > 0 || !one.eligible) << knob.id << " " << one.label;
    }
  }
  EXPECT_EQ(ids, (std::set<std::string>{"clusters", "octree_depth", "ranks", "corners", "cuboid_space", "angle_taps",
                                        "levels"}));
  // What shipped choices stand on; errors do not depend on the machine.
  const Knob& ranks = findings.knobs[2];
  ASSERT_EQ(ranks.id, "ranks");
  const Setting* even = find(ranks, "500 even");
  const Setting* alias = find(ranks, "alias");
  ASSERT_NE(even, nullptr);
  ASSERT_NE(alias, nullptr);
  EXPECT_LT(5.0 * find(ranks, ranks.chosen)->error, even->error);
  EXPECT_LT(alias->worst, 1e-6);  // floats of 24 bits
  EXPECT_FALSE(alias->eligible);
}

}  // namespace
}  // namespace lackwerk::report
