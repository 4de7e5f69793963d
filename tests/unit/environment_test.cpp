#include "core/environment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <random>

#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

glm::dvec3 random_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double z = 2.0 * unit(random) - 1.0;
  const double a = 2.0 * pi * unit(random);
  const double s = std::sqrt(1.0 - z * z);
  return {s * std::cos(a), s * std::sin(a), z};
}

void paint_level(Environment& e, int level, const glm::dvec3& radiance) {
  const EnvironmentLevel& place = environment_levels[static_cast<std::size_t>(level)];
  for (int y = place.y - 1; y <= place.y + place.edge; ++y) {
    for (int x = place.x - 1; x <= place.x + place.edge; ++x)
      encode_radiance(radiance, static_cast<double>(e.range),
                      &e.atlas[4 * (static_cast<std::size_t>(y) * environment_width + static_cast<std::size_t>(x))]);
  }
}

TEST(Environment, OctahedralMapGoesThereAndBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 d = random_direction(random);
    const glm::dvec2 uv = octahedral_from_direction(d);
    EXPECT_GE(std::min(uv.x, uv.y), 0.0);
    EXPECT_LE(std::max(uv.x, uv.y), 1.0);
    EXPECT_LT(glm::length(direction_from_octahedral(uv) - d), 1e-12);
  }
  EXPECT_EQ(octahedral_from_direction({0.0, 0.0, 1.0}), glm::dvec2(0.5));
  EXPECT_EQ(octahedral_from_direction({1.0, 0.0, 0.0}), glm::dvec2(1.0, 0.5));
}

TEST(Environment, CodeKeepsOnePerCentOverFourDecades) {
  constexpr double range = 100.0;
  double worst = 0.0;
  for (int i = 0; i <= 4000; ++i) {
    const glm::dvec3 radiance = glm::dvec3(1.0, 0.8, 0.6) * (range * std::pow(10.0, -i / 1000.0));
    std::array<std::uint8_t, 4> code{};
    encode_radiance(radiance, range, code.data());
    const glm::dvec3 back = decode_radiance(glm::dvec4(code[0], code[1], code[2], code[3]) / 255.0, range);
    worst = std::max(worst, std::abs(back.x / radiance.x - 1.0));
  }
  EXPECT_LT(worst, 0.01);
  std::array<std::uint8_t, 4> code{};
  encode_radiance(glm::dvec3(200.0, 0.0, 100.0), range, code.data());
  EXPECT_EQ(code, (std::array<std::uint8_t, 4>{255, 0, 255, 255})) << "clipped to the range";
  encode_radiance(glm::dvec3(0.0), range, code.data());
  EXPECT_EQ(code[0] + code[1] + code[2], 0);
}

// A grey ramp, read between its texels: the product of two filtered numbers must not show the steps of alpha.
TEST(Environment, FilteredRampIsSmooth) {
  Environment e = uniform_environment(glm::vec3(1.0f));
  const auto ramp = [](double x) { return std::pow(10.0, -4.0 * (x - 1.0) / 512.0); };
  for (int x = 1; x <= 512; ++x) {
    for (int y = 1; y <= 2; ++y)
      encode_radiance(glm::dvec3(ramp(x + 0.5)), 1.0,
                      &e.atlas[4 * (static_cast<std::size_t>(y) * environment_width + static_cast<std::size_t>(x))]);
  }
  double worst = 0.0;
  for (double x = 1.5; x < 512.0; x += 0.0625) {
    const double shown = decode_radiance(filtered_texel(e, x, 2.0), 1.0).x;
    worst = std::max(worst, std::abs(shown / ramp(x) - 1.0));
  }
  EXPECT_LT(worst, 0.02) << "1 % of rounding and 1 % between texels";
}

TEST(Environment, FilterReadsTexelsAndClampsAtTheEdge) {
  Environment e = uniform_environment(glm::vec3(1.0f));
  const std::size_t k = 4 * (std::size_t{7} * environment_width + 5);
  e.atlas[k] = 51;
  EXPECT_DOUBLE_EQ(filtered_texel(e, 5.5, 7.5).x, 0.2);
  EXPECT_DOUBLE_EQ(filtered_texel(e, 6.0, 7.5).x, 0.6);
  EXPECT_DOUBLE_EQ(filtered_texel(e, 5.5, 8.25).x, 0.2 * 0.25 + 0.75);
  e.atlas[0] = 0;
  EXPECT_DOUBLE_EQ(filtered_texel(e, -3.0, -1e9).x, 0.0);
}

TEST(Environment, LevelsFollowRoughness) {
  for (int k = 0; k < environment_level_count; ++k)
    EXPECT_DOUBLE_EQ(environment_level_of(environment_levels[static_cast<std::size_t>(k)].m), k);
  EXPECT_DOUBLE_EQ(environment_level_of(0.18), 4.5);
  EXPECT_EQ(environment_level_of(-1.0), 0.0);
  EXPECT_EQ(environment_level_of(7.0), 9.0);
}

TEST(Environment, UniformIsUniformAndItsLightsKeepThePower) {
  const glm::vec3 radiance(0.5f, 0.25f, 1.0f);
  const Environment e = uniform_environment(radiance);
  PaintModel<double> model;
  model.environment = &e;
  model.u_environment_scale = static_cast<double>(e.range);
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 seen = model.environment_at(random_direction(random), 9.0 * i / 199.0);
    EXPECT_LT(glm::length(seen - glm::dvec3(radiance)), 0.005);
  }
  for (const int count : {1, 3, 4, 16, 64, 100}) {
    const auto lights = lights_of(e, count);
    EXPECT_EQ(lights.size(), count >= 64 ? 64u : count == 3 ? 1u : static_cast<std::size_t>(count));
    glm::dvec3 sum(0.0);
    for (const EnvironmentLight& light : lights) {
      sum += glm::dvec3(light.radiance);
      EXPECT_NEAR(glm::length(light.direction), 1.0f, 1e-6f);
    }
    EXPECT_LT(glm::length(sum - 4.0 * glm::dvec3(radiance)), 1e-5) << count;  // 4 pi / pi
  }
  EXPECT_EQ(uniform_environment(glm::vec3(0.0f)).range, 1.0f);
}

TEST(Environment, LightsAreSortedByLuminance) {
  Environment e = uniform_environment(glm::vec3(1.0f));
  e.lights[37].radiance = glm::vec3(5.0f);
  e.lights[37].direction = glm::vec3(0.0f, 1.0f, 0.0f);
  for (const int count : {4, 16, 64}) {
    const auto lights = lights_of(e, count);
    for (std::size_t k = 1; k < lights.size(); ++k) EXPECT_GE(lights[k - 1].radiance.y, lights[k].radiance.y);
    EXPECT_GT(lights[0].direction.y, 0.9f) << count;
  }
}

// The sizes written into environment.glsl are those of environment_levels: every level a colour of its own.
TEST(Environment, ShaderTextFindsEveryLevel) {
  Environment e = uniform_environment(glm::vec3(1.0f));
  std::fill(e.atlas.begin(), e.atlas.end(), std::uint8_t{0});
  e.range = 16.0f;
  const auto colour = [](int level) { return glm::dvec3(1.0 + level, 12.0 - level, level % 3 + 1.0); };
  for (int level = 0; level < environment_level_count; ++level) paint_level(e, level, colour(level));
  PaintModel<double> model;
  model.environment = &e;
  model.u_environment_scale = static_cast<double>(e.range);
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    const int level = i % environment_level_count;
    const glm::dvec3 d = random_direction(random);
    const glm::dvec3 seen = model.environment_at(d, level);
    EXPECT_LT(glm::length(seen / colour(level) - glm::dvec3(1.0)), 0.02) << level;
    if (level == 0) {
      EXPECT_LT(glm::length(model.environment_sharp(d) / colour(0) - glm::dvec3(1.0)), 0.02);
    }
    if (level == 9) continue;
    const glm::dvec3 between = model.environment_at(d, level + 0.5);
    const glm::dvec3 mean = 0.5 * (colour(level) + colour(level + 1));
    EXPECT_LT(glm::length(between / mean - glm::dvec3(1.0)), 0.02) << level;
  }
  const EnvironmentLevel& last = environment_levels[environment_level_count - 1];
  EXPECT_EQ(last.x + last.edge + 1, environment_width - 2) << "the atlas ends two texels after the border";
  EXPECT_EQ(last.y + last.edge + 1, environment_height);
  const glm::dvec3 d = random_direction(random);
  const glm::dvec2 uv = octahedral_from_direction(d);
  const glm::dvec2 text = model.octahedral_uv(d);
  EXPECT_NEAR(uv.x, text.x, 1e-15);
  EXPECT_NEAR(uv.y, text.y, 1e-15);
}

class Sampler : public ::testing::Test {
 protected:
  // A dim room, one lamp of 40 x 30 texels, one lamp across the fold.
  Sampler() : environment_(uniform_environment(glm::vec3(0.05f))) {
    environment_.range = 20.0f;
    paint_level(environment_, 0, glm::dvec3(0.05));
    for (int y = 100; y < 130; ++y) {
      for (int x = 300; x < 340; ++x) lamp(x, y);
      for (int x = 0; x < 12; ++x) lamp(x, y + 90);
    }
  }
  void lamp(int x, int y) {
    encode_radiance(
        glm::dvec3(20.0, 10.0, 5.0), 20.0,
        &environment_
             .atlas[4 * (static_cast<std::size_t>(y + 1) * environment_width + static_cast<std::size_t>(x + 1))]);
  }
  [[nodiscard]] double luminance(const glm::dvec3& d) const {
    const glm::dvec2 uv = octahedral_from_direction(d);
    return luminance_of(decode_radiance(filtered_texel(environment_, 1.0 + uv.x * 512.0, 1.0 + uv.y * 512.0), 20.0));
  }
  Environment environment_;
};

TEST_F(Sampler, DensityIntegratesToOne) {
  const EnvironmentSampler sampler(environment_);
  double sum = 0.0;
  constexpr int count = 2048;  // 4 x 4 points a texel
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) {
      const glm::dvec3 d = direction_from_octahedral({(x + 0.5) / count, (y + 0.5) / count});
      const double l1 = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
      sum += sampler.pdf(d) * 4.0 * l1 * l1 * l1 / (static_cast<double>(count) * count);
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-4);
}

TEST_F(Sampler, EstimatesTheSphereAndAgreesWithItsOwnDensity) {
  const EnvironmentSampler sampler(environment_);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double exact = 0.0;
  constexpr int side = 1024;
  for (int k = 0; k < side * side; ++k) {
    const int column = k % side, row = k / side;
    const glm::dvec3 d = direction_from_octahedral({(column + 0.5) / side, (row + 0.5) / side});
    const double l1 = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    exact += luminance(d) * 4.0 * l1 * l1 * l1 / (static_cast<double>(side) * side);
  }
  constexpr int count = 200000;
  double estimate = 0.0;
  for (int i = 0; i < count; ++i) {
    const auto s = sampler.sample({unit(random), unit(random)});
    ASSERT_GT(s.pdf, 0.0);
    ASSERT_NEAR(glm::length(s.direction), 1.0, 1e-12);
    ASSERT_NEAR(sampler.pdf(s.direction) / s.pdf, 1.0, 1e-6);
    estimate += luminance(s.direction) / s.pdf / count;
  }
  EXPECT_NEAR(estimate / exact, 1.0, 0.005);
}

TEST(EnvironmentSampler, BlackIsDrawnEvenly) {
  const Environment e = uniform_environment(glm::vec3(0.0f));
  const EnvironmentSampler sampler(e);
  for (const glm::dvec2 u : {glm::dvec2(0.0), glm::dvec2(0.999999), glm::dvec2(0.3, 0.7)})
    EXPECT_NEAR(sampler.sample(u).pdf * 4.0 * pi, 1.0, 0.02);
}

}  // namespace
}  // namespace lackwerk::core
