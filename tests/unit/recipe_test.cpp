// Recipes: the published numbers, what a coat does to them, and answers to typing mistakes.
#include "packs/tools/recipe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "core/paint_model.hpp"
#include "packs/tools/node_geometry.hpp"

namespace lackwerk::packs {
namespace {

const std::filesystem::path recipe_folder = std::filesystem::path(LACKWERK_SOURCE_DIR) / "packs" / "recipes";
const std::vector<std::string> published = {"gu_ford_f8",     "gu_polaris_silber", "gu_opel_titan", "gu_bmw_339",
                                            "gu_2k_acrylack", "gu_white",          "gu_blue",       "gu_blue_matte"};

Recipe recipe(const std::string& name) {
  auto result = read_recipe(recipe_folder / (name + ".toml"));
  EXPECT_TRUE(result) << (result ? "" : result.error().line());
  return result ? *result : Recipe{};
}

/// Writes a recipe to a fresh file and returns the error it is answered with.
Error error_of(const std::string& text, const std::string& name = "bad.toml") {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lackwerk_recipe";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name) << text;
  const auto result = read_recipe(folder / name);
  EXPECT_FALSE(result);
  return result ? Error{} : result.error();
}

const std::string good =
    "name = \"x\"\nsource = \"y\"\nprovenance = \"simulated\"\ncoat_provenance = \"simulated\"\ncoat_ior = 1.0\n"
    "refraction_ior = 1.0\ndiffuse = [0.1, 0.1, 0.1]\n[[lobe]]\ns = [0.1, 0.1, 0.1]\nm = 0.3\nf0 = 1.0\n";

TEST(Recipe, EveryRecipeInTheFolderReads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(recipe_folder)) {
    const auto result = read_recipe(entry.path());
    ASSERT_TRUE(result) << result.error().line();
    ++count;
    double rougher = 1.0;
    for (const auto& lobe : result->analytic.lobes) {
      EXPECT_LE(lobe.m, rougher) << entry.path();
      rougher = lobe.m;
    }
  }
  EXPECT_GE(count, 18);
}

TEST(Recipe, MetallicPaintsHaveFlakesAndPlainOnesHaveNone) {
  for (std::size_t k = 0; k < published.size(); ++k) {
    const Recipe paint = recipe(published[k]);
    EXPECT_EQ(paint.flakes.has_value(), k < 4) << published[k];
    EXPECT_EQ(paint.identity.lobes, core::Provenance::published_fit);
    EXPECT_EQ(paint.identity.flakes, core::Provenance::simulated);
    EXPECT_EQ(paint.analytic.coat_ior, 1.0);
    EXPECT_EQ(paint.analytic.refraction_ior, 1.0);
    EXPECT_FALSE(paint.analytic.table);
  }
}

TEST(Recipe, NumbersAreThoseOfTheTable) {
  const auto polaris = recipe("gu_polaris_silber").analytic;
  EXPECT_EQ(polaris.diffuse, glm::dvec3(0.055, 0.063, 0.071));
  EXPECT_EQ(polaris.lobes[0], (core::Lobe{{0.065, 0.082, 0.088}, 0.38, 1.0}));
  EXPECT_EQ(polaris.lobes[1], (core::Lobe{{0.11, 0.13, 0.13}, 0.17, 0.92}));
  EXPECT_EQ(polaris.lobes[2], (core::Lobe{{0.008, 0.013, 0.015}, 0.013, 0.9}));
  const auto white = recipe("gu_white").analytic;
  EXPECT_EQ(white.lobes[0], (core::Lobe{{2.6e-6, 0.00031, 3.1e-8}, 1.0, 0.049}));
}

// Why the lobes are kept with pi and D without 1/pi or 1/4: with lobes as printed, a narrow lobe reflects 4 s F of the
// light it gets at normal incidence (dw_i = 4 (h.o) dw_h), and for lobe 3, the clear coat, that is a coat's 4 %.
TEST(Recipe, TheCoatLobesAlbedoFitsAnIndexOfOneAndAHalf) {
  for (const std::string& name : published) {
    const auto lobe = recipe(name).analytic.lobes[2];
    for (int channel = 0; channel < 3; ++channel) {
      const double albedo = 4.0 * lobe.s[channel] * lobe.f0;
      if (name == "gu_2k_acrylack") {
        EXPECT_LT(albedo, 0.012) << "the one exception";
      } else {
        EXPECT_GE(albedo, 0.023) << name;
        EXPECT_LE(albedo, 0.058) << name;
      }
    }
  }
}

TEST(Recipe, PolarisSilberAsPrintedStaysBelowOneAndLooksLikeSilver) {
  core::PaintModel<double> model;
  bind_lobes(recipe("gu_polaris_silber").analytic, model);
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  glm::dvec3 albedo(0.0);
  constexpr int steps = 100000;
  const double width = std::numbers::pi / 2.0 / steps;
  for (int k = 0; k < steps; ++k) {
    const double theta = (k + 0.5) * width;
    const auto g = model.paint_geometry(normal, {std::sin(theta), 0.0, std::cos(theta)}, normal);
    albedo += model.lobes_factor(g, 1.0) * (2.0 * std::cos(theta) * std::sin(theta) * width);
  }
  EXPECT_NEAR(albedo.x, 0.74, 0.01);
  EXPECT_NEAR(albedo.y, 0.91, 0.01);
  EXPECT_NEAR(albedo.z, 0.95, 0.01);
}

TEST(Recipe, ACoatReplacesTheThirdLobeAndRaisesTheRest) {
  for (const std::string& name : published) {
    const Recipe bare = recipe(name);
    const Recipe coated = recipe(name + "_coated");
    EXPECT_EQ(coated.analytic.coat_ior, 1.5);
    EXPECT_EQ(coated.analytic.refraction_ior, 1.0);
    EXPECT_EQ(coated.identity.coat, core::Provenance::simulated);
    EXPECT_EQ(coated.analytic.lobes[2].s, glm::dvec3(0.0));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(coated.analytic.diffuse[channel] * 0.9216, bare.analytic.diffuse[channel], 1e-12);
      EXPECT_NEAR(coated.analytic.lobes[0].s[channel] * 0.9216, bare.analytic.lobes[0].s[channel], 1e-12);
      EXPECT_NEAR(coated.analytic.lobes[1].s[channel] * 0.9216, bare.analytic.lobes[1].s[channel], 1e-12);
    }
    EXPECT_EQ(coated.flakes.has_value(), bare.flakes.has_value());
  }
}

TEST(Recipe, PearlsFlip) {
  const auto at = [](const Recipe& paint, double degrees) {
    return table_colour(paint.analytic, 0.0, degrees * std::numbers::pi / 180.0);
  };
  const Recipe green = recipe("pearl_green_violet");
  ASSERT_TRUE(green.analytic.table);
  EXPECT_GT(at(green, 0.0).y, at(green, 0.0).z);
  EXPECT_GT(at(green, 40.0).z, 2.0 * at(green, 40.0).y);
  EXPECT_EQ(green.analytic.refraction_ior, 1.5);
  const Recipe gold = recipe("pearl_gold_green");
  EXPECT_GT(at(gold, 0.0).x, at(gold, 0.0).y);
  EXPECT_GT(at(gold, 32.0).y, at(gold, 32.0).x);
  // Luminance 1 at the mirror angle, apart from the base's small share.
  const glm::dvec3 c = at(green, 0.0);
  EXPECT_NEAR(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z, 1.0, 0.01);
  for (const glm::vec3& entry : green.analytic.table->linear) {
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(entry[k] >= 0.0f && entry[k] < 4.0f);
  }
}

TEST(Recipe, ColourTableClampsBeyondItsTriangle) {
  const auto paint = recipe("pearl_green_violet").analytic;
  const double h = 1.0;
  const glm::dvec3 edge = table_colour(paint, h, std::numbers::pi / 2.0 - h);
  EXPECT_EQ(table_colour(paint, h, 1.5), edge);
}

TEST(Recipe, MistakesAreAnsweredWithLineAndKey) {
  Error e = error_of(good + "rougness = 0.3\n");
  EXPECT_NE(e.field.find("line 12"), std::string::npos) << e.line();
  EXPECT_NE(e.field.find("lobe 1.rougness"), std::string::npos) << e.line();
  e = error_of("difuse = [1, 2, 3]\n" + good);
  EXPECT_NE(e.remedy.find("diffuse"), std::string::npos) << e.line();
  EXPECT_NE(e.field.find("line 1"), std::string::npos) << e.line();
  e = error_of("name = \"x\n");
  EXPECT_NE(e.field.find("line 1"), std::string::npos) << e.line();
  e = error_of(std::string(good).replace(good.find("0.3"), 3, "3.0"));
  EXPECT_NE(e.field.find("line 10, lobe 1.m"), std::string::npos) << e.line();
  EXPECT_NE(e.remedy.find("[0.001, 1]"), std::string::npos) << e.line();
  e = error_of(std::string(good).replace(good.find("0.3"), 3, "nan"));
  EXPECT_NE(e.field.find("lobe 1.m"), std::string::npos) << e.line();
  e = error_of(std::string(good).replace(good.find("simulated"), 9, "guessed"));
  EXPECT_NE(e.remedy.find("published-fit"), std::string::npos) << e.line();
  e = error_of(good.substr(good.find("source")));
  EXPECT_EQ(e.what, "is missing");
  e = error_of(good + "[flakes]\nprovenance = \"simulated\"\nshare = 0.5\n");
  EXPECT_NE(e.field.find("flakes.coverage"), std::string::npos) << e.line();
  e = error_of("replace_lobe = 3\n" + good);
  EXPECT_NE(e.field.find("replace_lobe"), std::string::npos) << e.line();
  EXPECT_FALSE(read_recipe("/nowhere/recipe.toml"));
  EXPECT_NE(read_recipe("/nowhere/recipe.toml").error().line().find("/nowhere/recipe.toml"), std::string::npos);
}

TEST(Recipe, ABaseMayNotHaveABase) {
  const std::string derived =
      "name = \"x\"\nsource = \"y\"\nreplace_lobe = 3\ncoat_ior = 1.5\nrefraction_ior = 1.0\n"
      "coat_provenance = \"simulated\"\nbase = ";
  EXPECT_FALSE(error_of(derived + "\"loop.toml\"\n", "loop.toml").what.empty());
  EXPECT_FALSE(error_of(derived + "\"missing.toml\"\n").what.empty());
}

TEST(Recipe, DamagedTextNeverThrows) {
  std::ifstream stream(recipe_folder / "pearl_green_violet.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "lackwerk_damaged.toml";
  for (std::size_t length = 0; length < text.size(); length += 41) {
    std::string damaged = text.substr(0, length);
    if (length > 0) damaged[length / 2] = static_cast<char>(length * 7);
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_FALSE(read_recipe(file)) << length;
  }
}

}  // namespace
}  // namespace lackwerk::packs
