// The virtual goniometer: flakes and lobes together are the recipe, and single flakes are mirrors.
#include "packs/tools/virtual_goniometer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "packs/tools/flake_population.hpp"
#include "packs/tools/node_geometry.hpp"

namespace lackwerk::packs {
namespace {

Recipe recipe(const std::string& name) {
  auto result = read_recipe(std::filesystem::path(LACKWERK_SOURCE_DIR) / "packs" / "recipes" / (name + ".toml"));
  EXPECT_TRUE(result) << (result ? "" : result.error().line());
  return result ? *result : Recipe{};
}

Capture measured(const Recipe& paint, GoniometerSettings settings) {
  auto result = measure(paint, settings);
  EXPECT_TRUE(result) << (result ? "" : result.error().line());
  return result ? *result : Capture{};
}

glm::dvec3 mean_of(const FlakeSlice& slice) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& texel : slice.texels) sum += glm::dvec3(texel);
  return sum / static_cast<double>(slice.texels.size());
}

GoniometerSettings small(std::uint32_t edge = 96) {
  GoniometerSettings settings;
  settings.edge_texels = edge;
  return settings;
}

TEST(Goniometer, LobesAndMeanFlakesAreTheRecipeAtEverySlice) {
  for (const char* name : {"gu_ford_f8", "gu_polaris_silber", "gu_opel_titan", "gu_bmw_339", "gu_polaris_silber_coated",
                           "gu_bmw_339_coated", "pearl_green_violet", "pearl_gold_green", "pearl_magenta_gold"}) {
    const Recipe paint = recipe(name);
    const Capture capture = measured(paint, small());
    ASSERT_EQ(capture.slices.size(), 67u);
    const double width = capture.layout.bin_width_rad();
    for (int slice = 0; slice < capture.layout.slice_count(); ++slice) {
      const auto node = capture.layout.node_of(slice);
      const double h = node.bin_h * width;
      const double i = node.bin_i * width;
      const glm::dvec3 chi = table_colour(paint.analytic, h, i);
      const glm::dvec3 wanted = chi * node_factor(paint.analytic, h, i);
      const glm::dvec3 got =
          chi * node_factor(capture.analytic, h, i) + mean_of(capture.slices[static_cast<std::size_t>(slice)]);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(got[k], wanted[k], 0.01 * wanted[k]) << name << " " << node.bin_h << " " << node.bin_i;
      }
    }
  }
}

// The physics without its safety net: no evening out, only where hundreds of flakes shine.
TEST(Goniometer, DrawnFlakesCarryTheirShareOfTheLobe) {
  const Recipe paint = recipe("gu_polaris_silber");
  GoniometerSettings settings = small(240);
  settings.even_out = false;
  const Capture capture = measured(paint, settings);
  const double width = capture.layout.bin_width_rad();
  core::AnalyticPaint lobe;
  lobe.lobes[0] = paint.analytic.lobes[0];
  for (int bin_i = 0; bin_i < 8; ++bin_i) {
    for (int bin_h = 0; bin_h < 4; ++bin_h) {
      const auto slice = static_cast<std::size_t>(*capture.layout.slice_at(bin_h, bin_i));
      const double wanted = paint.flakes->share * node_factor(lobe, bin_h * width, bin_i * width).y;
      EXPECT_NEAR(mean_of(capture.slices[slice]).y, wanted, 0.03 * wanted) << bin_h << " " << bin_i;
    }
  }
}

// A flake that fills a texel shows the source in its mirror: radiance factor R / (sin^2(alpha) i_z).
TEST(Goniometer, AWholeFlakeIsAMirror) {
  Recipe paint = recipe("gu_polaris_silber");
  paint.flakes->diameter_um = 200.0;
  paint.flakes->diameter_max_um = 200.0;
  paint.flakes->diameter_spread = 0.0;
  GoniometerSettings settings = small(240);
  settings.source_radius_rad = 0.02;  // small enough to leave the lobe unblurred
  settings.even_out = false;
  const Capture capture = measured(paint, settings);
  const double r =
      4.0 * paint.flakes->share * paint.analytic.lobes[0].s.y * paint.analytic.lobes[0].f0 / paint.flakes->coverage;
  EXPECT_LT(r, 1.0);
  const double one = r / (std::sin(0.02) * std::sin(0.02));
  float nearest = 0.0f;
  for (const glm::vec3& texel : capture.slices[0].texels) {
    if (std::abs(texel.y - one) < std::abs(nearest - one)) nearest = texel.y;
  }
  EXPECT_NEAR(nearest, one, 0.005 * one);
}

TEST(Goniometer, TheSameFlakesShineAlongThetaIAndOthersAlongThetaH) {
  const Capture capture = measured(recipe("gu_polaris_silber"), small());
  const auto both_lit = [&](int slice_a, int slice_b) {
    std::size_t both = 0;
    std::size_t one = 0;
    for (std::size_t k = 0; k < capture.slices[0].texels.size(); ++k) {
      const bool a = capture.slices[static_cast<std::size_t>(slice_a)].texels[k].y > 0.0f;
      const bool b = capture.slices[static_cast<std::size_t>(slice_b)].texels[k].y > 0.0f;
      both += a && b;
      one += a;
    }
    return static_cast<double>(both) / static_cast<double>(one);
  };
  EXPECT_GT(both_lit(*capture.layout.slice_at(1, 0), *capture.layout.slice_at(1, 1)), 0.95);
  EXPECT_LT(both_lit(*capture.layout.slice_at(1, 0), *capture.layout.slice_at(2, 0)), 0.3);  // 7.5 > 6.5 degrees
}

TEST(Goniometer, SparklesAreRareAndBright) {
  const Capture capture = measured(recipe("gu_bmw_339_coated"), small(240));
  const auto& slice = capture.slices[static_cast<std::size_t>(*capture.layout.slice_at(2, 0))];
  std::size_t lit = 0;
  float brightest = 0.0f;
  for (const glm::vec3& texel : slice.texels) {
    lit += texel.y > 0.0f;
    brightest = std::max(brightest, texel.y);
  }
  const double fraction = static_cast<double>(lit) / static_cast<double>(slice.texels.size());
  EXPECT_GT(fraction, 0.02);
  EXPECT_LT(fraction, 0.3);
  EXPECT_GT(brightest, 50.0 * mean_of(slice).y);
}

TEST(Goniometer, ThreadsDoNotChangeASingleByte) {
  GoniometerSettings settings = small(64);
  settings.threads = 1;
  const Recipe paint = recipe("pearl_green_violet");
  const Capture one = measured(paint, settings);
  settings.threads = 3;
  const Capture three = measured(paint, settings);
  for (std::size_t k = 0; k < one.slices.size(); ++k) EXPECT_EQ(one.slices[k].texels, three.slices[k].texels) << k;
  settings.seed = 2;
  EXPECT_NE(measured(paint, settings).slices[0].texels, one.slices[0].texels);
}

TEST(Goniometer, PlainPaintsKeepTheirLobes) {
  const Recipe paint = recipe("gu_white");
  const Capture capture = measured(paint, small());
  EXPECT_EQ(capture.analytic, paint.analytic);
  EXPECT_TRUE(capture.slices.empty());
  EXPECT_EQ(capture.layout.slice_count(), 0);
}

TEST(Goniometer, ReportsEverySlice) {
  int calls = 0;
  int last = 0;
  const auto result = measure(recipe("gu_ford_f8"), small(16), [&](int done, int total) {
    EXPECT_EQ(total, 67);
    last = done;
    ++calls;
  });
  ASSERT_TRUE(result);
  EXPECT_EQ(calls, 67);
  EXPECT_EQ(last, 67);
}

TEST(Goniometer, RefusesMirrorsThatGiveMoreThanTheyGet) {
  Recipe paint = recipe("gu_polaris_silber");
  paint.flakes->coverage = 0.1;
  const auto result = measure(paint, small());
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().remedy.find("raise coverage to 0.2"), std::string::npos) << result.error().line();
}

TEST(Goniometer, RefusesSettingsOutOfRange) {
  const Recipe paint = recipe("gu_polaris_silber");
  EXPECT_FALSE(measure(paint, small(0)));
  EXPECT_FALSE(measure(paint, small(5000)));
  GoniometerSettings settings = small();
  settings.texel_mm = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(measure(paint, settings));
  settings = small();
  settings.threads = 0;
  EXPECT_FALSE(measure(paint, settings));
  settings = small(4096);
  settings.texel_mm = 1.0f;  // 17 square metres
  const auto result = measure(paint, settings);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("flakes"), std::string::npos);
}

TEST(Flakes, TiltDensityIsOneOverTheHemisphere) {
  for (const double m : {0.1, 0.38, 0.8}) {
    double sum = 0.0;
    constexpr int steps = 20000;
    for (int k = 0; k < steps; ++k) {
      const double theta = (k + 0.5) / steps * std::numbers::pi / 2.0;
      sum +=
          tilt_density(m, std::cos(theta)) * 2.0 * std::numbers::pi * std::sin(theta) * std::numbers::pi / 2.0 / steps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << m;
  }
}

TEST(Flakes, DrawnTiltsAndSizesFollowTheirLaws) {
  const FlakeRecipe law{0.5, 0.2, 10.0, 0.5, 60.0};
  const auto count = static_cast<std::size_t>(expected_flakes(law, 100.0));
  const FlakePopulation sample = draw_flakes(law, 0.38, count, 200, 0.05f, 1);
  EXPECT_NEAR(sample.coverage, 0.2, 0.002);
  std::size_t below = 0;
  std::size_t small_ones = 0;
  for (const Flake& flake : sample.flakes) {
    below += flake.normal.z > 1.0f / std::sqrt(1.0f + 0.1f * 0.1f);
    small_ones += flake.radius * 0.05f * 2.0f < 0.010f;
    EXPECT_NEAR(static_cast<double>(glm::dot(flake.normal, flake.normal)), 1.0, 1e-5);
  }
  const double expected = 1.0 - std::exp(-0.01 / (0.38 * 0.38));
  EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(count), expected, 1e-3);
  EXPECT_NEAR(static_cast<double>(small_ones) / static_cast<double>(count), 0.5, 2e-3);
  const auto range = sample.tilts_between(0.1, 0.2);
  for (std::size_t k = 0; k < count; ++k) {
    const double tilt = std::acos(static_cast<double>(sample.flakes[k].normal.z));
    if (tilt < 0.101 || tilt > 0.199) continue;
    EXPECT_TRUE(k >= range.begin && k < range.end) << k;
  }
}

TEST(Flakes, DiscCornerAreaMeetsCounting) {
  constexpr int steps = 400;
  const double radius = 1.3;
  for (const double x : {-1.4, -0.9, -0.2, 0.0, 0.6, 1.1, 1.5}) {
    for (const double y : {-1.4, -1.0, -0.3, 0.0, 0.5, 1.2, 1.5}) {
      double area = 0.0;
      const double cell = 2.0 * radius / steps;
      for (int row = 0; row < steps; ++row) {
        for (int column = 0; column < steps; ++column) {
          const double u = (column + 0.5) * cell - radius;
          const double v = (row + 0.5) * cell - radius;
          area += u * u + v * v < radius * radius && u <= x && v <= y ? cell * cell : 0.0;
        }
      }
      EXPECT_NEAR(disc_corner_area(radius, x, y), area, 0.01) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace lackwerk::packs
