// Thin films against cases with a known answer.
#include "packs/tools/thin_film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/paint_model.hpp"

namespace lackwerk::packs {
namespace {

double mean(const Reflectance& r) { return 0.5 * (r.s + r.p); }

TEST(ThinFilm, OneInterfaceIsFresnel) {
  core::PaintModel<double> model;
  for (const double ior : {1.2, 1.5, 2.6}) {
    for (double theta = 0.0; theta < 1.5; theta += 0.1) {
      const double expected = model.fresnel_dielectric(std::cos(theta), ior);
      EXPECT_NEAR(mean(film_reflectance({}, 1.0, ior, 550.0, std::cos(theta))), expected, 2e-5) << ior << " " << theta;
    }
  }
}

TEST(ThinFilm, BrewsterAngleHasNoParallelPart) {
  const double theta = std::atan(1.5);
  EXPECT_NEAR(film_reflectance({}, 1.0, 1.5, 550.0, std::cos(theta)).p, 0.0, 1e-12);
}

TEST(ThinFilm, TotalReflectionGivesOne) {
  const auto r = film_reflectance({}, 1.5, 1.0, 550.0, std::cos(1.0));  // beyond 41.8 degrees
  EXPECT_NEAR(r.s, 1.0, 1e-12);
  EXPECT_NEAR(r.p, 1.0, 1e-12);
}

TEST(ThinFilm, QuarterWaveLayerMeetsItsFormula) {
  // R = ((n0 ns - n1^2) / (n0 ns + n1^2))^2 at normal incidence (Born & Wolf 1.6.4).
  const double n0 = 1.0, n1 = 2.3, ns = 1.52, nm = 550.0;
  const std::vector<OpticalLayer> layer = {{n1, nm / (4.0 * n1)}};
  const double root = (n0 * ns - n1 * n1) / (n0 * ns + n1 * n1);
  EXPECT_NEAR(film_reflectance(layer, n0, ns, nm, 1.0).s, root * root, 1e-12);
  EXPECT_NEAR(film_reflectance(layer, n0, ns, nm, 1.0).p, root * root, 1e-12);
}

TEST(ThinFilm, HalfWaveAndZeroLayersAreAbsent) {
  for (const double nm : {0.0, 550.0 / (2.0 * 2.3)}) {
    const std::vector<OpticalLayer> layer = {{2.3, nm}};
    EXPECT_NEAR(film_reflectance(layer, 1.0, 1.52, 550.0, 1.0).s, film_reflectance({}, 1.0, 1.52, 550.0, 1.0).s, 1e-12);
  }
  const std::vector<FilmLayer> nothing = {{FilmMaterial::titania, 0.0}, {FilmMaterial::silica, 0.0}};
  EXPECT_NEAR(film_colour(nothing, 1.5, 0.5).y, 0.0, 1e-12);
}

TEST(ThinFilm, NeverMirrorsMoreThanItGets) {
  for (double nm = 0.0; nm < 900.0; nm += 37.0) {
    const std::vector<OpticalLayer> stack = {{2.7, 60.0}, {1.46, nm}, {2.7, 0.3 * nm}};
    for (double theta = 0.0; theta < 1.57; theta += 0.13) {
      for (double wavelength = 380.0; wavelength <= 780.0; wavelength += 50.0) {
        const auto r = film_reflectance(stack, 1.5, 1.5, wavelength, std::cos(theta));
        EXPECT_GE(r.s, 0.0);
        EXPECT_LE(r.s, 1.0 + 1e-12);
        EXPECT_GE(r.p, 0.0);
        EXPECT_LE(r.p, 1.0 + 1e-12);
      }
    }
  }
}

TEST(ThinFilm, IndicesArePublishedOnes) {
  EXPECT_NEAR(film_index(FilmMaterial::silica, 589.3), 1.4584, 1e-4);  // Malitson 1965, table 1
  EXPECT_NEAR(film_index(FilmMaterial::titania, 589.3), 2.613, 5e-3);  // DeVore 1951, sodium D
}

TEST(ThinFilm, AThinLayerOfHighIndexIsNearlyGrey) {
  const std::vector<FilmLayer> sheet = {{FilmMaterial::titania, 5.0}};
  const glm::dvec3 rgb = film_colour(sheet, 1.5, 0.0);
  EXPECT_GT(rgb.z, rgb.x);  // Rayleigh-like: short waves see a thicker film
  EXPECT_LT(rgb.z, 0.1);
}

TEST(ThinFilm, ThickerStacksMoveTheColourAndTiltMovesItBack) {
  const auto stack = [](double nm) {
    return std::vector<FilmLayer>{
        {FilmMaterial::titania, 60.0}, {FilmMaterial::silica, nm}, {FilmMaterial::titania, 60.0}};
  };
  const glm::dvec3 green = film_colour(stack(237.5), 1.5, 0.0);
  EXPECT_GT(green.y, 1.5 * green.x);
  EXPECT_GT(green.y, 1.5 * green.z);
  const glm::dvec3 violet = film_colour(stack(237.5), 1.5, 40.0 * std::numbers::pi / 180.0);
  EXPECT_GT(violet.z, 3.0 * violet.y);
  EXPECT_GT(violet.x, 3.0 * violet.y);
  const glm::dvec3 gold = film_colour(stack(305.0), 1.5, 0.0);
  EXPECT_GT(gold.x, gold.y);
  EXPECT_GT(gold.y, 2.0 * gold.z);
}

}  // namespace
}  // namespace lackwerk::packs
