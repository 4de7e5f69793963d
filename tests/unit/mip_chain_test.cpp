// Mip levels: edges, exact means, exact area weights.
#include "core/analysis/mip_chain.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lackwerk::core {
namespace {

glm::dvec3 mean_of(const MipLevel& level) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& texel : level.texels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(level.texels.size());
}

TEST(MipChain, EdgesHalveDown) {
  const auto levels = mip_chain(std::vector<glm::vec3>(480 * 480, glm::vec3(0.25f)), 480);
  const std::vector<std::uint32_t> edges{480, 240, 120, 60, 30, 15, 7, 3, 1};
  ASSERT_EQ(levels.size(), edges.size());
  EXPECT_EQ(mip_level_count(480), 9);
  EXPECT_EQ(mip_level_count(1), 1);
  EXPECT_EQ(mip_level_count(0), 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_EQ(levels[i].edge, edges[i]);
    ASSERT_EQ(levels[i].texels.size(), std::size_t{edges[i]} * edges[i]);
    for (const glm::vec3& texel : levels[i].texels) EXPECT_NEAR(texel.x, 0.25f, 1e-7f);
  }
}

TEST(MipChain, KeepsTheMeanForAnyEdge) {
  std::mt19937 random(11);
  std::exponential_distribution<float> value(1.0f);
  for (const std::uint32_t edge : {1u, 2u, 3u, 5u, 7u, 15u, 31u, 97u, 100u, 255u}) {
    std::vector<glm::vec3> texels;
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
      const float v = value(random);
      texels.emplace_back(v * v * v, v, i % 50 == 0 ? 1e4f : 0.0f);
    }
    const auto levels = mip_chain(texels, edge);
    const glm::dvec3 mean = mean_of(levels.front());
    for (const MipLevel& level : levels)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean_of(level)[c], mean[c], 1e-6 * mean[c]) << edge << " " << level.edge;
  }
}

TEST(MipChain, WeighsCutTexelsByArea) {
  std::vector<glm::vec3> texels(25, glm::vec3(0.0f));
  texels[2] = glm::vec3(25.0f);  // first row, middle column: half in either texel of the 2 x 2 level
  const auto levels = mip_chain(texels, 5);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_NEAR(levels[1].texels[0].x, 25.0 * 0.5 / 6.25, 1e-6);
  EXPECT_NEAR(levels[1].texels[1].x, 25.0 * 0.5 / 6.25, 1e-6);
  EXPECT_EQ(levels[1].texels[2].x, 0.0f);
  EXPECT_NEAR(levels[2].texels[0].x, 1.0, 1e-6);
}

}  // namespace
}  // namespace lackwerk::core
