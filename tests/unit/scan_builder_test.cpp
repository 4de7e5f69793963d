// A series of scans from files' points to a pack's contents.
#include "packs/tools/scan_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "packs/tools/scan_contents.hpp"

namespace lackwerk::packs {
namespace {

/// A stem of this height and a leaf (a disc) at its top, points about 1 apart.
core::PointCloud plant(double height, double leaf, unsigned seed) {
  std::mt19937 random(seed);
  const auto jitter = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  core::PointCloud cloud;
  for (double z = 0.0; z < height; z += 0.4) cloud.points.emplace_back(0.6 * jitter(), 0.6 * jitter(), z);
  for (double x = 1.0; x < 2.0 * leaf; x += 0.8)
    for (double y = -leaf; y < leaf; y += 0.8)
      if ((x - leaf) * (x - leaf) + y * y < leaf * leaf)
        cloud.points.emplace_back(x + 0.2 * jitter(), y + 0.2 * jitter(), height + 0.1 * jitter());
  return cloud;
}

std::vector<ScanSource> series() {
  return {{"one", 1.0, plant(40.0, 8.0, 1)}, {"two", 2.0, plant(50.0, 10.0, 2)}, {"four", 4.0, plant(70.0, 14.0, 3)}};
}

TEST(ScanBuilder, EveryScanIsReachedAndTheResultIsTheSameForAnyThreads) {
  const auto sources = series();
  ScanSettings settings;
  settings.align = false;
  settings.threads = 1;
  const auto one = morph_series(sources, settings);
  ASSERT_TRUE(one) << one.error().line();
  ASSERT_EQ(one->steps.size(), 2u);
  EXPECT_GT(one->spacing, 0.3);
  EXPECT_FALSE(one->labelled);
  for (std::size_t k = 0; k < 2; ++k) {
    std::set<std::uint32_t> left, reached;
    for (const core::CloudPath& path : one->steps[k].paths) {
      left.insert(path.from_point);
      EXPECT_EQ(one->scans[k].cloud.points.at(path.from_point), path.from);
      if (path.to_point == core::CloudPath::none) continue;
      reached.insert(path.to_point);
      EXPECT_EQ(one->scans[k + 1].cloud.points.at(path.to_point), path.to);
    }
    EXPECT_EQ(left.size(), one->scans[k].cloud.points.size());
    EXPECT_EQ(reached.size(), one->scans[k + 1].cloud.points.size());
  }
  settings.threads = 3;
  const auto three = morph_series(sources, settings);
  ASSERT_TRUE(three);
  const ScanNaming naming{"plant", 1, "Plant", "days"};
  const BuiltScan a = scan_contents(*one, naming, 2, false, 1), b = scan_contents(*three, naming, 2, false, 3);
  EXPECT_EQ(encode_scan_pack(a.contents()), encode_scan_pack(b.contents()));
}

TEST(ScanBuilder, ContentsKeepPlacesNormalsAndTimes) {
  const auto sources = series();
  ScanSettings settings;
  settings.align = false;
  const auto built = morph_series(sources, settings);
  ASSERT_TRUE(built);
  const BuiltScan pack = scan_contents(*built, {"plant", 1, "Plant", ""}, 2, false, 0);
  ASSERT_TRUE(check_scan(pack.contents(), "")) << check_scan(pack.contents(), "").error().line();
  ASSERT_EQ(pack.info.states.size(), 3u);
  EXPECT_EQ(pack.info.states[2].time, 4.0);
  // The same set of starts, to half a step of the grid.
  const double step = pack.info.edge / 65535.0;
  double lowest = 1e9, highest = -1e9, worst_sum = 0.0, sum = 0.0;
  for (const core::CloudPath& path : built->steps[0].paths) sum += path.from.x + 2.0 * path.from.z;
  for (const ScanPath& path : pack.paths[0]) {
    const double x = pack.info.low.x + path.from[0] * step, z = pack.info.low.z + path.from[2] * step;
    worst_sum += x + 2.0 * z;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  ASSERT_EQ(pack.paths[0].size(), built->steps[0].paths.size());
  EXPECT_NEAR(sum, worst_sum, 1.5 * step * static_cast<double>(pack.paths[0].size()));
  EXPECT_NEAR(lowest, 0.0, 1.0);
  EXPECT_NEAR(highest, 40.0, 1.0);
  // The leaf looks up and sees the sky; normals have unit length.
  int leaf = 0, up = 0;
  double sky = 0.0;
  for (const ScanPath& path : pack.paths[0]) {
    const glm::vec3 n = glm::vec3(path.from_normal[0], path.from_normal[1], path.from_normal[2]) / 127.0f;
    EXPECT_NEAR(glm::length(n), 1.0f, 0.02f);
    EXPECT_GE(n.z, 0.0f);
    if (pack.info.low.x + path.from[0] * step < 4.0) continue;
    ++leaf;
    up += n.z > 0.9f ? 1 : 0;
    sky += path.from_normal[3] / 127.0;
  }
  EXPECT_GT(leaf, 100);
  EXPECT_GT(up, leaf * 9 / 10);
  EXPECT_GT(sky / leaf, 0.9);
  // Any first part of the paths is an even sample: the first tenth has the mean height of all.
  const auto mean_z = [&](std::size_t count) {
    double z = 0.0;
    for (std::size_t k = 0; k < count; ++k) z += pack.paths[0][k].from[2] * step;
    return z / static_cast<double>(count);
  };
  EXPECT_NEAR(mean_z(pack.paths[0].size() / 10), mean_z(pack.paths[0].size()), 4.0);
}

TEST(ScanBuilder, WrongSeriesGetOneLine) {
  auto sources = series();
  ScanSettings settings;
  const auto alone = morph_series(std::span(sources).first(1), settings);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().field, "scans");
  sources[2].time = 2.0;
  const auto backwards = morph_series(sources, settings);
  ASSERT_FALSE(backwards);
  EXPECT_EQ(backwards.error().file, "four");
  sources = series();
  sources[1].cloud.points.clear();
  const auto empty = morph_series(sources, settings);
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().file, "two");
  sources = series();
  settings.spacing = 1e-12;
  const auto fine = morph_series(sources, settings);
  ASSERT_FALSE(fine);
  EXPECT_EQ(fine.error().file, "one");
}

TEST(ScanBuilder, AFadingPartShrinksAndAFallingOneReachesTheGround) {
  std::vector<ScanSource> sources{{"whole", 0.0, plant(40.0, 8.0, 4)}, {"bare", 1.0, {}}};
  for (const glm::dvec3& p : sources[0].cloud.points)
    if (p.x < 1.0) sources[1].cloud.points.push_back(p);
  for (ScanSource& source : sources)
    for (const glm::dvec3& p : source.cloud.points) source.cloud.labels.push_back(p.x < 1.0 ? 0 : 1);
  ScanSettings settings;
  settings.align = false;
  for (const bool fades : {true, false}) {
    settings.matching.fades = fades;
    const auto built = morph_series(sources, settings);
    ASSERT_TRUE(built) << built.error().line();
    EXPECT_TRUE(built->labelled);
    const BuiltScan pack = scan_contents(*built, {"plant", 1, "Plant", ""}, 2, fades, 0);
    EXPECT_EQ(pack.kinds[0], (std::array<std::uint32_t, 3>{1, 0, 1}));
    int gone = 0, grounded = 0;
    for (const ScanPath& path : pack.paths[0]) {
      gone += path.to[3] == 0 ? 1 : 0;
      grounded += path.from[0] > 20000 && path.to[2] < 1000 ? 1 : 0;
    }
    EXPECT_EQ(gone > 50, fades) << gone;
    EXPECT_EQ(grounded > 50, !fades) << grounded;
  }
}

}  // namespace
}  // namespace lackwerk::packs
