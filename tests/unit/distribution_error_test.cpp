// The bounds of the 1-Wasserstein distance on cases whose answer is known.
#include "core/analysis/distribution_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lackwerk::core {
namespace {

std::vector<glm::vec3> uniform_texels(std::mt19937& random, std::size_t count, const glm::vec3& lo,
                                      const glm::vec3& hi) {
  std::vector<glm::vec3> out;
  const auto draw = [&](float a, float b) { return a + (b - a) * (static_cast<float>(random() >> 8) / 16777216.0f); };
  for (std::size_t i = 0; i < count; ++i) {
    const float x = draw(lo.x, hi.x), y = draw(lo.y, hi.y), z = draw(lo.z, hi.z);
    out.emplace_back(x, y, z);
  }
  return out;
}

LabCuboid box_around(const std::vector<glm::vec3>& texels) {
  LabCuboid box{texels[0], texels[0], static_cast<std::uint32_t>(texels.size())};
  for (const glm::vec3& texel : texels) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], texel[axis]);
      box.hi[axis] = std::max(box.hi[axis], texel[axis]);
    }
  }
  return box;
}

TEST(Wasserstein, UniformTexelsAreNearTheirBox) {
  std::mt19937 random(31);
  for (const std::size_t count : {1000u, 30000u}) {
    const auto texels = uniform_texels(random, count, glm::vec3(0.0f), glm::vec3(10.0f));
    const LabCuboid box = box_around(texels);
    const auto bounds = wasserstein1_bounds(texels, {&box, 1}, {}, count);
    EXPECT_LE(bounds.lower, bounds.upper);
    EXPECT_LT(bounds.lower, 3.0 * 10.0 / std::sqrt(static_cast<double>(count)));
    EXPECT_LT(bounds.upper, 1.1 * 10.0 / std::cbrt(static_cast<double>(count)));  // the grain of random points
  }
}

TEST(Wasserstein, PointAgainstLine) {
  // A point in the middle of a uniform interval of length s: s / 4, from both sides.
  const std::vector<glm::vec3> texels(4096, glm::vec3(5.0f, 0.0f, 0.0f));
  const LabCuboid tight{texels[0], texels[0], 4096};
  const LabCuboid line{{0, 0, 0}, {10, 0, 0}, 4096};
  const auto bounds = wasserstein1_bounds(texels, {&tight, 1}, {&line, 1});
  EXPECT_NEAR(bounds.upper, 2.5, 1e-3);
  EXPECT_NEAR(bounds.lower, 2.5, 1e-3);
}

TEST(Wasserstein, PointAgainstCube) {
  // Mean distance of a uniform point in a unit cube from its middle: 0.480296.
  const std::vector<glm::vec3> texels(4096, glm::vec3(5.0f));
  const LabCuboid tight{texels[0], texels[0], 4096};
  const LabCuboid cube{{0, 0, 0}, {10, 10, 10}, 4096};
  const auto bounds = wasserstein1_bounds(texels, {&tight, 1}, {&cube, 1});
  EXPECT_NEAR(bounds.upper, 4.80296, 0.01);
  EXPECT_NEAR(bounds.lower, 2.5, 1e-3);  // projections see one axis only
  // One texel pays the root mean square instead: 4 % more, and never less.
  const LabCuboid single{texels[0], texels[0], 1};
  EXPECT_NEAR(wasserstein1_lab({texels.data(), 1}, {&single, 1}, {&cube, 1}), 5.0, 1e-6);
}

TEST(Wasserstein, ShiftedBoxCostsItsShift) {
  std::mt19937 random(32);
  const auto texels = uniform_texels(random, 20000, glm::vec3(0.0f), glm::vec3(10.0f, 1.0f, 1.0f));
  const LabCuboid box = box_around(texels);
  LabCuboid moved = box;
  moved.lo.x += 7.0f;
  moved.hi.x += 7.0f;
  const auto bounds = wasserstein1_bounds(texels, {&box, 1}, {&moved, 1});
  EXPECT_NEAR(bounds.lower, 7.0, 0.1);
  EXPECT_NEAR(bounds.upper, 7.0, 0.2);
  EXPECT_LE(bounds.lower, bounds.upper);
}

TEST(Wasserstein, ExactColoursCostNothing) {
  std::vector<glm::vec3> texels(100, glm::vec3(1.0f));
  texels.resize(150, glm::vec3(9.0f));
  const std::vector<LabCuboid> clusters{{texels.front(), texels.front(), 100}, {texels.back(), texels.back(), 50}};
  const auto bounds = wasserstein1_bounds(texels, clusters);
  EXPECT_NEAR(bounds.lower, 0.0, 1e-9);
  EXPECT_NEAR(bounds.upper, 0.0, 1e-9);
  EXPECT_EQ(wasserstein1_lab({}, {}), 0.0);
}

TEST(Wasserstein, SelectionChangesLittle) {
  std::mt19937 random(33);
  auto texels = uniform_texels(random, 60000, glm::vec3(0.0f), glm::vec3(40.0f, 10.0f, 10.0f));
  for (auto& texel : texels) texel.x *= texel.x / 40.0f;
  const LabCuboid box = box_around(texels);
  const double all = wasserstein1_lab(texels, {&box, 1}, {}, texels.size());
  EXPECT_NEAR(wasserstein1_lab(texels, {&box, 1}), all, 0.05 * all);
}

}  // namespace
}  // namespace lackwerk::core
