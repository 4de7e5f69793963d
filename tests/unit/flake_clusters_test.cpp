// Clusters of slices: partitions into tight disjoint boxes, whatever the colours.
#include "core/analysis/flake_clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/analysis/distribution_error.hpp"

namespace lackwerk::core {
namespace {

bool holds(const LabCuboid& box, const glm::vec3& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < box.lo[axis] || p[axis] > box.hi[axis]) return false;
  return true;
}

/// Clusters by both rules and checks: at most so many, counts add up, each texel in exactly one box, boxes tight.
void check_partition(const std::vector<glm::vec3>& texels, int max_clusters) {
  for (const PruneRule rule : {PruneRule::misfit, PruneRule::density}) {
    ClusterSettings settings;
    settings.max_clusters = max_clusters;
    settings.rule = rule;
    const auto clusters = cluster_texels(texels, settings);
    ASSERT_LE(clusters.size(), static_cast<std::size_t>(max_clusters));
    std::vector<std::uint32_t> count(clusters.size(), 0);
    std::vector<LabCuboid> tight(clusters.size());
    for (const glm::vec3& texel : texels) {
      int owners = 0;
      for (std::size_t c = 0; c < clusters.size(); ++c) {
        if (!holds(clusters[c], texel)) continue;
        ++owners;
        LabCuboid& box = tight[c];
        if (count[c]++ == 0) box.lo = box.hi = texel;
        for (int axis = 0; axis < 3; ++axis) {
          box.lo[axis] = std::min(box.lo[axis], texel[axis]);
          box.hi[axis] = std::max(box.hi[axis], texel[axis]);
        }
      }
      ASSERT_EQ(owners, 1);
    }
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      tight[c].count = count[c];
      EXPECT_EQ(tight[c], clusters[c]);
    }
  }
}

std::vector<glm::vec3> cloud(std::mt19937& random, std::size_t count, const glm::vec3& centre,
                             const glm::vec3& spread) {
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = normal(random), y = normal(random), z = normal(random);
    out.push_back(centre + spread * glm::vec3(x, y, z));
  }
  return out;
}

TEST(FlakeClusters, NoTexelOneTexelOneColour) {
  EXPECT_TRUE(cluster_texels({}, {}).empty());
  const std::vector<glm::vec3> one{{3.0f, -2.0f, 1.0f}};
  ASSERT_EQ(cluster_texels(one, {}).size(), 1u);
  EXPECT_EQ(cluster_texels(one, {})[0], (LabCuboid{one[0], one[0], 1}));
  const std::vector<glm::vec3> same(1000, one[0]);
  ASSERT_EQ(cluster_texels(same, {}).size(), 1u);
  EXPECT_EQ(cluster_texels(same, {})[0], (LabCuboid{one[0], one[0], 1000}));
}

TEST(FlakeClusters, TwoColoursStayTwo) {
  std::vector<glm::vec3> texels(700, glm::vec3(10.0f, 1.0f, 2.0f));
  texels.resize(1000, glm::vec3(10.0f, 1.0f, 2.001f));
  const auto clusters = cluster_texels(texels, {});
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].count, 700u);
  EXPECT_EQ(clusters[1].count, 300u);
  check_partition(texels, 50);
  check_partition(texels, 1);
}

TEST(FlakeClusters, FewColoursAreKeptExactly) {
  std::mt19937 random(21);
  const auto colours = cloud(random, 40, glm::vec3(50.0f), glm::vec3(20.0f));
  std::vector<glm::vec3> texels;
  texels.reserve(5000);
  for (int i = 0; i < 5000; ++i) texels.push_back(colours[random() % colours.size()]);
  const auto clusters = cluster_texels(texels, {});
  EXPECT_EQ(clusters.size(), 40u);
  for (const LabCuboid& cluster : clusters) EXPECT_EQ(cluster.lo, cluster.hi);
}

TEST(FlakeClusters, RandomClouds) {
  std::mt19937 random(22);
  check_partition(cloud(random, 3000, {40, 0, 0}, {20, 5, 5}), 50);
  check_partition(cloud(random, 3000, {40, 0, 0}, {20, 5, 5}), 7);
  check_partition(cloud(random, 300, {40, 0, 0}, {0.001f, 0.001f, 0.001f}), 50);
  check_partition(cloud(random, 30, {40, 0, 0}, {20, 5, 5}), 50);
}

TEST(FlakeClusters, FlatClouds) {
  std::mt19937 random(23);
  check_partition(cloud(random, 3000, {40, 0, 0}, {20, 0, 0}), 50);  // grey: on a line
  check_partition(cloud(random, 3000, {40, 0, 0}, {20, 5, 0}), 50);  // in a plane
  std::vector<glm::vec3> lattice;
  lattice.reserve(1000);
  for (int i = 0; i < 1000; ++i) lattice.emplace_back(i % 10, i / 10 % 10, i / 100);
  check_partition(lattice, 50);
}

TEST(FlakeClusters, OneOutlierDoesNotSwallowTheRest) {
  std::mt19937 random(24);
  auto texels = cloud(random, 20000, {40, 0, 0}, {20, 5, 5});
  const double before = wasserstein1_lab(texels, cluster_texels(texels, {}));
  texels.emplace_back(1e4f, 0.0f, 0.0f);
  check_partition(texels, 50);
  const auto clusters = cluster_texels(texels, {});
  EXPECT_GT(clusters.size(), 40u);
  EXPECT_EQ(clusters.back(), (LabCuboid{texels.back(), texels.back(), 1}));
  EXPECT_LT(wasserstein1_lab(texels, clusters), 1.3 * before);
}

TEST(FlakeClusters, TexelOrderDoesNotMatter) {
  std::mt19937 random(25);
  auto texels = cloud(random, 5000, {40, 0, 0}, {20, 5, 5});
  for (std::size_t i = 0; i < texels.size(); i += 3) texels[i] = glm::vec3(0.0f);
  const auto clusters = cluster_texels(texels, {});
  std::shuffle(texels.begin(), texels.end(), random);
  EXPECT_EQ(cluster_texels(texels, {}), clusters);
}

TEST(FlakeClusters, MoreClustersComeCloser) {
  std::mt19937 random(26);
  auto texels = cloud(random, 20000, {30, 0, 0}, {10, 3, 3});
  const auto bright = cloud(random, 2000, {120, 5, -5}, {40, 10, 10});
  texels.insert(texels.end(), bright.begin(), bright.end());
  double last = 1e9;
  for (const int most : {1, 10, 50, 200}) {
    ClusterSettings settings;
    settings.max_clusters = most;
    const double error = wasserstein1_lab(texels, cluster_texels(texels, settings));
    EXPECT_LT(error, 0.5 * last);
    last = error;
  }
}

}  // namespace
}  // namespace lackwerk::core
