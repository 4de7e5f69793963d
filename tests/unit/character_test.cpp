// A mix in a paint shop's numbers: against formulas worked out by hand, and against the goniometer's own paint.
#include "core/character.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>

#include "core/colour.hpp"
#include "core/level0_paint.hpp"
#include "packs/tools/pack_builder.hpp"
#include "packs/tools/virtual_goniometer.hpp"
#include "tests/unit/one_slice_paint.hpp"

namespace lackwerk::core {
namespace {

constexpr double light = 45.0;

double cosine(double degrees) { return std::cos(glm::radians(degrees)); }

InterpolatablePaint alone(const AnalyticPaint& analytic) {
  InterpolatablePaint paint;
  paint.paints.emplace_back().analytic = analytic;
  return paint;
}

const Weights only = Weights::uniform({1.0});

void expect_colour(const glm::dvec3& lab, const glm::dvec3& factor, double tolerance) {
  EXPECT_LT(ciede2000(lab, lab_from_linear(factor)), tolerance) << lab.x << " " << lab.y << " " << lab.z;
}

TEST(ShopColours, ADiffuserIsTheSameFromEverywhere) {
  AnalyticPaint matt;
  matt.diffuse = {0.4, 0.2, 0.1};
  for (const glm::dvec3& lab : shop_colours(alone(matt), only)) expect_colour(lab, matt.diffuse, 1e-9);
}

/// Fresnel's equations as textbooks have them, unpolarised.
double fresnel(double degrees, double index) {
  const double ci = cosine(degrees);
  const double ct = std::sqrt(1.0 - (1.0 - ci * ci) / (index * index));
  const double rs = (ci - index * ct) / (ci + index * ct), rp = (index * ci - ct) / (index * ci + ct);
  return 0.5 * (rs * rs + rp * rp);
}

TEST(ShopColours, ACoatTakesItsShareOnTheWayInAndOut) {
  AnalyticPaint coated;
  coated.diffuse = {0.4, 0.2, 0.1};
  coated.coat_ior = 1.5;
  const auto colours = shop_colours(alone(coated), only);
  // Seen at 45 degrees minus the aspecular angle from the normal.
  const std::array<double, 3> seen{30.0, 0.0, 65.0};
  for (std::size_t k = 0; k < seen.size(); ++k)
    expect_colour(colours[k], coated.diffuse * ((1.0 - fresnel(light, 1.5)) * (1.0 - fresnel(seen[k], 1.5))), 1e-3);
}

TEST(ShopColours, ALobeIsWhatItsFormulaSays) {
  AnalyticPaint metallic;
  metallic.lobes[0] = {{0.2, 0.3, 0.5}, 0.4, 0.6};
  const auto colours = shop_colours(alone(metallic), only);
  for (std::size_t k = 0; k < shop_angles_deg.size(); ++k) {
    // In the plane of incidence the half vector lies half the aspecular angle from the normal.
    const double aspecular = shop_angles_deg[k], half = aspecular / 2.0;
    const double ho = cosine(light - half), nh = cosine(half), iz = cosine(light), oz = cosine(aspecular - light);
    const double m = 0.4, tangent = std::tan(glm::radians(half));
    const double d = std::exp(-tangent * tangent / (m * m)) / (m * m * std::pow(nh, 4.0));
    const double f = 0.6 + 0.4 * std::pow(1.0 - ho, 5.0);
    const double g = std::min({1.0, 2.0 * nh * iz / ho, 2.0 * nh * oz / ho});
    expect_colour(colours[k], metallic.lobes[0].s * (d * f * g / (iz * oz)), 1e-6);
  }
}

// The goniometer takes the flakes' light out of the lobes; colours must have both parts again.
TEST(ShopColours, LobesAndFlakesTogetherAreTheRecipe) {
  const auto file = std::filesystem::path(LACKWERK_SOURCE_DIR) / "packs" / "recipes" / "gu_polaris_silber_coated.toml";
  const auto recipe = packs::read_recipe(file);
  ASSERT_TRUE(recipe) << recipe.error().line();
  packs::GoniometerSettings settings;
  settings.edge_texels = 64;
  const auto capture = packs::measure(*recipe, settings);
  ASSERT_TRUE(capture) << capture.error().line();
  const auto built = packs::build_pack(std::span(&*capture, 1), {});
  ASSERT_TRUE(built) << built.error().line();
  const auto wanted = shop_colours(alone(recipe->analytic), only);
  const auto got = shop_colours(built->data.view(), only);
  const auto lobes = shop_colours(alone(capture->analytic), only);
  const auto differences = shop_differences(wanted, got);
  for (std::size_t k = 0; k < differences.size(); ++k) EXPECT_LT(differences[k], 0.5) << shop_angles_deg[k];
  EXPECT_GT(shop_differences(wanted, lobes)[0], 2.0) << "the lobes alone are another paint";
}

TEST(ShopDifferences, AreThoseOfEachAngle) {
  const std::array<glm::dvec3, 3> one{glm::dvec3(50, 2.6772, -79.7751), glm::dvec3(50, 0, 0), glm::dvec3(10, 1, 1)};
  const std::array<glm::dvec3, 3> two{glm::dvec3(50, 0, -82.7485), glm::dvec3(73, 25, -18), glm::dvec3(10, 1, 1)};
  const auto differences = shop_differences(one, two);
  // Sharma, Wu & Dalal 2005, Table 1: pairs 1 and (from 50, 2.5, 0) near 17.
  EXPECT_NEAR(differences[0], 2.0425, 1e-4);
  EXPECT_GT(differences[1], 20.0);
  EXPECT_EQ(differences[2], 0.0);
}

TEST(Liveliness, IsTheSpreadOfLightness) {
  // L = 200 q / 65535: flat boxes at 50 and 150, three to one.
  const auto q = [](double lightness) { return static_cast<std::uint16_t>(std::lround(lightness / 200.0 * 65535.0)); };
  const testing::FlakeRow far{{{{0, 65535, 0, 0, 0, 0}}}, {4}};
  const testing::OneSlicePaint flat({{{{q(50), q(50), 0, 9, 0, 9}}, {{q(150), q(150), 5, 9, 5, 9}}}, {3, 1}}, far, 1);
  EXPECT_NEAR(liveliness(flat.paint, only), 100.0 * std::sqrt(0.75 * 0.25), 0.01);
  const testing::OneSlicePaint wide({{{{q(40), q(100), 0, 9, 0, 9}}}, {4}}, far, 1);
  EXPECT_NEAR(liveliness(wide.paint, only), 60.0 / std::sqrt(12.0), 0.01);
  Weights white = only;
  white.flake_white = 1.0;
  EXPECT_EQ(liveliness(wide.paint, white), liveliness(wide.paint, only));
  EXPECT_EQ(liveliness(alone({}), only), 0.0) << "no flakes";
}

TEST(Level0Paint, HasTheNearestLevelAlone) {
  const testing::FlakeRow near{{{{1, 2, 3, 4, 5, 6}}, {{7, 8, 9, 10, 11, 12}}}, {3, 1}};
  const testing::OneSlicePaint one(near, {{{{0, 65535, 0, 0, 0, 0}}}, {4}}, 1);
  const InterpolatablePaint level0 = level0_of(one.paint);
  EXPECT_EQ(level0.row_count(), 1);
  EXPECT_EQ(level0.mass.size(), 2u);
  RealisedPaint all, first;
  realise(one.paint, only, all);
  realise(level0, only, first);
  EXPECT_EQ(first.flake_mean, all.flake_mean);
  ASSERT_EQ(first.corners.size(), 2u);
  EXPECT_EQ(first.corners[1].q, near.boxes[1].q);
}

}  // namespace
}  // namespace lackwerk::core
