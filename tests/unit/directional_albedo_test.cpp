// The albedo tables against plain quadrature, and what merging keeps.
#include "core/directional_albedo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/flake_contrast.hpp"
#include "core/paint_model.hpp"
#include "tests/unit/one_slice_paint.hpp"

namespace lackwerk::core {
namespace {

AnalyticPaint coated(double refraction) {
  AnalyticPaint paint;
  paint.diffuse = {0.1, 0.05, 0.02};
  paint.lobes[0] = {{0.2, 0.22, 0.25}, 0.45, 0.8};
  paint.lobes[1] = {{0.05, 0.06, 0.08}, 0.12, 0.6};
  paint.coat_ior = 1.5;
  paint.refraction_ior = refraction;
  return paint;
}

/// Light 1 from everywhere on the whole paint, by midpoints over the hemisphere.
glm::dvec3 shown_under_even_light(const AnalyticPaint& paint, double co) {
  const InterpolatablePaint nothing;
  PaintModel<double> model;
  bind_model(nothing, paint, no_textures(), model);
  const glm::dvec3 n(0, 0, 1), o(std::sqrt(1.0 - co * co), 0.0, co);
  constexpr int rings = 300, sectors = 300;
  glm::dvec3 sum(0.0);
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double z2 = (r + 0.5) / rings;  // even in cos^2: the density of cos / pi
      const double phi = 2.0 * std::numbers::pi * (s + 0.5) / sectors, sine = std::sqrt(1.0 - z2);
      const glm::dvec3 i(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(z2));
      sum += model.paint_factor(n, i, o, glm::dvec2(0.0), 0.0, 0.0);
    }
  return sum / static_cast<double>(rings * sectors);
}

TEST(DirectionalAlbedo, AllPartsTogetherAreTheIntegral) {
  for (const double refraction : {1.0, 1.5}) {
    const AnalyticPaint paint = coated(refraction);
    AlbedoTable table;
    directional_albedo(paint, table);
    for (const int column : {9, 16, 24, 31}) {
      const double root = (column + 0.5) / albedo_columns;
      glm::dvec3 sum(0.0);
      for (const AlbedoRow& row : table.rows) sum += glm::dvec3(row.albedo[static_cast<std::size_t>(column)]);
      const glm::dvec3 truth = shown_under_even_light(paint, root * root);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], truth[c], (refraction > 1.0 ? 0.02 : 0.01) * truth[c])
            << "index " << refraction << ", column " << column;
    }
  }
}

TEST(DirectionalAlbedo, AWideLobeLeansAndNarrowOnesStayOnTheirLevel) {
  AnalyticPaint paint;
  for (std::size_t k = 2; k < environment_levels.size(); ++k) {
    paint.lobes[0] = {glm::dvec3(0.25), environment_levels[k].m, 1.0};
    AlbedoTable table;
    directional_albedo(paint, table);
    EXPECT_NEAR(table[1].level[31], static_cast<double>(k), 0.35) << "normal view: the level's own roughness";
  }
  paint.lobes[0].m = 0.02;
  AlbedoTable narrow;
  directional_albedo(paint, narrow);
  EXPECT_GT(narrow[1].lean[16], 0.98f) << "a mirror looks along the mirror direction";
  paint.lobes[0].m = 0.6;
  AlbedoTable wide;
  directional_albedo(paint, wide);
  EXPECT_LT(wide[1].lean[16], narrow[1].lean[16] - 0.1f) << "a rough lobe looks more upwards";
}

TEST(DirectionalAlbedo, MergingKeepsTheEnergyAndStaysBetween) {
  AlbedoTable table;
  directional_albedo(coated(1.5), table);
  const AlbedoRow one = merged_lobes(table);
  for (std::size_t k = 0; k < albedo_columns; ++k) {
    const glm::vec3 sum = table[1].albedo[k] + table[2].albedo[k];
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(one.albedo[k][c], sum[c]);
    EXPECT_GE(one.level[k], std::min(table[1].level[k], table[2].level[k]) - 1e-3f);
    EXPECT_LE(one.level[k], std::max(table[1].level[k], table[2].level[k]) + 1e-3f);
  }
}

TEST(DirectionalAlbedo, ATableThatIsReusedEqualsAFreshOne) {
  const QuantisedCuboid dark{{0, 100, 32768, 32768, 32768, 32768}}, bright{{60000, 65535, 32000, 34000, 32000, 33000}};
  const testing::FlakeRow few{{dark, bright}, {990, 10}}, many{{dark, bright}, {700, 300}};
  const testing::OneSlicePaint a(few, few, 1), b(many, many, 1);
  AlbedoTable reused;
  const auto expect_fresh = [&](const testing::OneSlicePaint& flakes, const AnalyticPaint& analytic, const char* what) {
    AlbedoTable fresh;
    directional_albedo(flakes.paint, analytic, flakes.textures, fresh);
    directional_albedo(flakes.paint, analytic, flakes.textures, reused);
    for (std::size_t term = 0; term < fresh.rows.size(); ++term)
      EXPECT_TRUE(reused[term] == fresh[term]) << what << term;
    EXPECT_EQ(reused.source.flake_m, flake_roughness(flakes.paint, flakes.textures)) << what;
  };
  AnalyticPaint paint = coated(1.5);
  expect_fresh(a, paint, "first ");
  const AlbedoRow lobe = reused[1], flakes = reused[4];
  expect_fresh(b, paint, "other flakes ");
  EXPECT_TRUE(reused[1] == lobe);
  EXPECT_FALSE(reused[4] == flakes);
  paint.lobes[1].s *= 2.0;
  expect_fresh(b, paint, "stronger lobe ");
  paint.coat_ior = 1.3;
  expect_fresh(b, paint, "other coat ");
  paint.diffuse = glm::dvec3(0.0);
  expect_fresh(b, paint, "nothing diffuse ");
  directional_albedo(coated(1.5), reused);
  EXPECT_TRUE(reused[4] == AlbedoRow()) << "no flakes";
  expect_fresh(a, coated(1.5), "flakes again ");
}

TEST(FlakeContrast, CalmLevelLiesBetweenTheLevelsAround) {
  const std::vector<double> contrast = {2.0, 1.0, 0.5, 0.25, 0.0};
  EXPECT_DOUBLE_EQ(calm_level(contrast, 3.0), 0.0);
  EXPECT_NEAR(calm_level(contrast, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(calm_level(contrast, std::sqrt(0.5)), 1.5, 1e-12);
  EXPECT_GT(calm_level(contrast, 1e-3), 3.0);
  EXPECT_LE(calm_level(contrast, 1e-3), 4.0);
  EXPECT_DOUBLE_EQ(calm_level({1.0, 0.5}, 0.1), 2.0) << "never calm";
  EXPECT_DOUBLE_EQ(calm_level({}, 0.1), 0.0);
}

}  // namespace
}  // namespace lackwerk::core
