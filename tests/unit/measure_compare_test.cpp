// Two captures at the standard angles.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/analysis/standard_angles.hpp"
#include "core/character.hpp"
#include "core/colour.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/capture_colours.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

Capture measured(const char* name) {
  const auto recipe = read_recipe(fs::path(LACKWERK_SOURCE_DIR) / "packs" / "recipes" / (std::string(name) + ".toml"));
  EXPECT_TRUE(recipe) << (recipe ? "" : recipe.error().line());
  GoniometerSettings settings;
  settings.edge_texels = 64;
  auto capture = measure(*recipe, settings);
  EXPECT_TRUE(capture) << (capture ? "" : capture.error().line());
  return capture ? *capture : Capture{};
}

Capture table(const std::vector<AngleReading>& readings) {
  Capture capture;
  capture.is_fitted = false;
  capture.angles = readings;
  return capture;
}

TEST(StandardAngles, AreSixAndSix) {
  const auto angles = core::standard_angles();
  ASSERT_EQ(angles.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(angles[k].light_deg, k < 6 ? 45.0 : 15.0);
    EXPECT_LT(std::abs(core::eye_deg(angles[k].light_deg, angles[k].aspecular_deg)), 90.0);
  }
  EXPECT_EQ(core::angle_name(angles[0]), "15as45");
  EXPECT_EQ(core::angle_name(angles[5]), "-15as45");
  EXPECT_EQ(core::angle_name({22.5, 7.5}), "7.5as22.5");
}

TEST(StandardAngles, AMirrorShinesAtTheMirrorDirection) {
  // Light and eye at 0 degrees from the mirror direction have the normal half way between them.
  glm::dvec3 half(0.0);
  const auto brdf = [&](const glm::dvec3& in, const glm::dvec3& out) {
    half = in + out;
    return std::optional(glm::dvec3(1.0 / std::numbers::pi));
  };
  const auto lab = core::colour_at(brdf, {45.0, 0.0});
  ASSERT_TRUE(lab);
  EXPECT_NEAR(half.x, 0.0, 1e-12);
  EXPECT_NEAR(lab->x, 100.0, 1e-9);
  EXPECT_NEAR(lab->y, 0.0, 1e-9);
  // Towards the light: positive.
  ASSERT_TRUE(core::colour_at(brdf, {45.0, 15.0}));
  EXPECT_GT(half.x, 0.0);
  EXPECT_FALSE(core::colour_at(brdf, {45.0, 140.0}));
}

TEST(MeasureCompare, TheModelIsWhatTheInterfaceShows) {
  // A paint without flakes and table: shop_colours() has no rounding then.
  Capture capture;
  capture.analytic.diffuse = {0.02, 0.1, 0.3};
  capture.analytic.lobes[0] = {{0.2, 0.3, 0.4}, 0.4, 0.9};
  capture.analytic.lobes[1] = capture.analytic.lobes[2] = {glm::dvec3(0.0), 0.4, 0.9};
  capture.analytic.coat_ior = capture.analytic.refraction_ior = 1.5;
  core::InterpolatablePaint alone;
  const auto shop = core::shop_colours(alone, capture.analytic, core::no_textures());
  std::vector<core::MeasuringAngle> angles;
  for (const double aspecular : core::shop_angles_deg) angles.push_back({45.0, aspecular});
  const auto colours = capture_colours(capture, ColourSource::model, angles, "");
  ASSERT_TRUE(colours);
  ASSERT_EQ(colours->colours.size(), shop.size());
  for (std::size_t k = 0; k < shop.size(); ++k)
    EXPECT_LT(core::ciede2000(colours->colours[k].lab, shop[k]), 1e-9) << core::angle_name(angles[k]);
}

TEST(MeasureCompare, ACaptureEqualsItselfAndFlops) {
  const Capture silver = measured("gu_polaris_silber_coated");
  const auto same = compare_captures(silver, ColourSource::automatic, "a", silver, ColourSource::automatic, "b");
  ASSERT_TRUE(same) << same.error().line();
  EXPECT_EQ(same->at.angles.size(), 12u);
  EXPECT_EQ(same->at.mean, 0.0);
  EXPECT_TRUE(same->left_out.empty());
  EXPECT_GT(same->at.angles[0].lab_a.x, same->at.angles[2].lab_a.x + 20.0);  // 15 degrees is far lighter than 45
  const auto other = compare_captures(silver, ColourSource::automatic, "a", measured("pearl_green_violet"),
                                      ColourSource::automatic, "b");
  ASSERT_TRUE(other);
  EXPECT_GT(other->at.mean, 5.0);
  EXPECT_GE(other->at.angles[other->at.worst].ciede2000, other->at.mean);
}

TEST(MeasureCompare, ATabulatedModelIsNearItsModel) {
  Capture silver = measured("gu_polaris_silber_coated");
  silver.measured = core::tabulate(capture_brdf(silver), {60, 45, 36});
  const auto compared = compare_captures(silver, ColourSource::brdf, "a", silver, ColourSource::model, "b");
  ASSERT_TRUE(compared) << compared.error().line();
  EXPECT_EQ(compared->a, ColourSource::brdf);
  EXPECT_EQ(compared->at.angles.size(), 12u);
  EXPECT_LT(compared->at.mean, 0.5);
  EXPECT_GT(compared->at.mean, 0.0);
}

TEST(MeasureCompare, OnlySharedAnglesOfTablesCount) {
  const Capture a = table({{45.0, 15.0, {50.0, 2.6772, -79.7751}}, {45.0, 25.0, {40.0, 0.0, 0.0}}});
  const Capture b = table({{45.0, 110.0, {10.0, 0.0, 0.0}}, {45.0, 15.02, {50.0, 0.0, -82.7485}}});
  const auto compared = compare_captures(a, ColourSource::automatic, "a", b, ColourSource::automatic, "b");
  ASSERT_TRUE(compared) << compared.error().line();
  ASSERT_EQ(compared->at.angles.size(), 1u);
  EXPECT_NEAR(compared->at.mean, 2.0425, 1e-4);  // Sharma, Wu & Dalal 2005, table 1, pair 1
  EXPECT_EQ(compared->left_out.size(), 2u);
  const Capture apart = table({{15.0, 15.0, {50.0, 0.0, 0.0}}});
  const auto none = compare_captures(a, ColourSource::automatic, "a", apart, ColourSource::automatic, "b");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().file, "b");
}

TEST(MeasureCompare, ATableIsMetAtItsOwnAngles) {
  Capture matt;
  matt.analytic.diffuse = glm::dvec3(0.18);
  const glm::dvec3 grey = core::lab_from_linear(glm::dvec3(0.18));
  const Capture odd = table({{60.0, 33.0, grey}, {45.0, 15.0, grey}});
  const auto compared = compare_captures(matt, ColourSource::automatic, "a", odd, ColourSource::automatic, "b");
  ASSERT_TRUE(compared) << compared.error().line();
  EXPECT_EQ(compared->at.angles.size(), 2u);
  EXPECT_LT(compared->at.mean, 1e-6);
}

TEST(MeasureCompare, WhatIsNotThereIsNamed) {
  const Capture readings = table({{45.0, 15.0, {50.0, 0.0, 0.0}}});
  const auto angles = core::standard_angles();
  const auto model = capture_colours(readings, ColourSource::model, angles, "x");
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().remedy.find("fit"), std::string::npos);
  EXPECT_FALSE(capture_colours(readings, ColourSource::brdf, angles, "x"));
  EXPECT_FALSE(capture_colours(Capture{}, ColourSource::angles, angles, "x"));
}

}  // namespace
}  // namespace lackwerk::packs
