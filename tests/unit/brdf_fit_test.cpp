#include "core/analysis/brdf_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>

#include "core/analysis/brdf_fit_model.hpp"
#include "core/analysis/brdf_sphere.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/fit_picture.hpp"
#include "packs/tools/recipe.hpp"
#include "packs/tools/rgl_file.hpp"

namespace lackwerk::core {
namespace {

constexpr double deg = std::numbers::pi / 180.0;

AnalyticPaint paint(const glm::dvec3& diffuse, const std::vector<Lobe>& lobes = {}) {
  AnalyticPaint out;
  out.diffuse = diffuse;
  for (std::size_t k = 0; k < lobes.size(); ++k) out.lobes[k] = lobes[k];
  return out;
}

AnalyticPaint recipe(const std::string& name) {
  const auto read = packs::read_recipe(LACKWERK_SOURCE_DIR "/packs/recipes/" + name + ".toml");
  EXPECT_TRUE(read) << read.error().line();
  return read->analytic;
}

/// A table with fewer cells along theta_d and phi_d than the usual 90 and 180: fits take the same number of them.
BrdfTable small_table(const AnalyticPaint& of) { return tabulate(analytic_brdf(of), {90, 24, 24}); }

void change(BrdfTable& table, const std::function<void(std::size_t, glm::vec3&)>& how) {
  for (std::size_t cell = 0; cell < table.size().cells(); ++cell) {
    auto value = table.value(cell);
    if (!value) continue;
    how(cell, *value);
    value->x >= 0.0f ? table.set(cell, *value) : table.clear(cell);
  }
}

void expect_sane(const BrdfFit& fit, const std::string& name) {
  const auto in = [](double x, double lo, double hi) { return x >= lo && x <= hi; };  // false for NaN
  double rougher = 1.0;
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(in(fit.paint.diffuse[c], 0.0, 1e3)) << name;
  for (const Lobe& lobe : fit.paint.lobes) {
    EXPECT_TRUE(in(lobe.m, min_roughness, rougher)) << name;
    EXPECT_TRUE(in(lobe.f0, 0.0, 1.0)) << name;
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(in(lobe.s[c], 0.0, 1e3)) << name;
    rougher = lobe.m;
  }
  EXPECT_GE(fit.condition.number, 1.0) << name;  // infinite is allowed, NaN is not
  for (const FitParameter& p : fit.condition.parameters) {
    EXPECT_TRUE(std::isfinite(p.value)) << name << ' ' << p.name;
    EXPECT_GE(p.slack, 0.0) << name << ' ' << p.name;
  }
  EXPECT_TRUE(std::isfinite(fit.errors.whole.rms)) << name;
}

std::vector<std::string> loose_parameters(const BrdfFit& fit) {
  std::vector<std::string> names;
  for (const FitParameter& p : fit.condition.parameters)
    if (p.standing == Standing::undetermined) names.push_back(p.name);
  return names;
}

// ---- the model

TEST(BrdfFitModel, IsThePaintModelOfThePacks) {
  // Against the formulas of Guenther et al. 2005, eq. 1, written out: D without 1/pi, no factor 4.
  const AnalyticPaint p = paint({0.1, 0.2, 0.3}, {{{0.5, 0.4, 0.3}, 0.3, 0.2}});
  const glm::dvec3 in = glm::normalize(glm::dvec3(0.5, 0.1, 0.8)), out = glm::normalize(glm::dvec3(-0.2, 0.3, 0.9));
  const glm::dvec3 h = glm::normalize(in + out);
  const double tan2 = (1.0 - h.z * h.z) / (h.z * h.z), ho = glm::dot(h, out);
  const double d = std::exp(-tan2 / 0.09) / (0.09 * std::pow(h.z, 4.0));
  const double f = 0.2 + 0.8 * std::pow(1.0 - ho, 5.0);
  const double g = std::min(1.0, 2.0 * h.z * std::min(in.z, out.z) / ho);
  const double expected = (0.3 + 0.3 * d * f * g / (in.z * out.z)) / std::numbers::pi;
  EXPECT_NEAR(analytic_brdf(p)(in, out).z, expected, 1e-12);
  EXPECT_EQ(analytic_brdf(p)({0.6, 0.0, -0.8}, out), glm::dvec3(0.0));
}

TEST(BrdfFitModel, DerivativesAreThoseOfDifferences) {
  for (const int channels : {1, 3}) {
    const FitLayout layout{3, channels};
    std::vector<double> at = parameters_of(layout, recipe("gu_blue"));
    FitPoint point = fit_point(in_plane_direction(50.0), in_plane_direction(-44.0));
    point.chi = {0.5, 1.5, 1.0};
    const int n = layout.count();
    std::vector<double> jacobian(static_cast<std::size_t>(3 * n));
    (void)model_at(layout, at.data(), point, jacobian.data());
    for (int k = 0; k < n; ++k) {
      double& x = at[static_cast<std::size_t>(k)];
      const double middle = x, step = 1e-6;
      x = middle + step;
      const glm::dvec3 up = model_at(layout, at.data(), point);
      x = middle - step;
      const glm::dvec3 down = model_at(layout, at.data(), point);
      x = middle;
      for (int c = 0; c < 3; ++c) {
        const double expected = (up[c] - down[c]) / (2.0 * step);
        EXPECT_NEAR(jacobian[static_cast<std::size_t>(c * n + k)], expected, 1e-6 * (1.0 + std::abs(expected)))
            << layout.name(k) << " of channel " << c;
      }
    }
  }
}

TEST(BrdfFitModel, TableTapsAreTheRecipesTableColour) {
  AnalyticPaint p = paint({0.5, 0.5, 0.5});
  p.table = ColourTable{7, std::vector<glm::vec3>(49)};
  std::mt19937 random(3);
  for (glm::vec3& entry : p.table->linear)
    for (int c = 0; c < 3; ++c) entry[c] = static_cast<float>(random() % 1000) / 500.0f;
  for (double h = 0.0; h <= 90.0; h += 4.7)
    for (double i = 0.0; i <= 90.0; i += 5.3) {
      const glm::dvec3 difference = chi_at(p, h * deg, i * deg) - packs::table_colour(p, h * deg, i * deg);
      EXPECT_LT(glm::length(difference), 1e-6) << h << ' ' << i;
    }
}

// ---- Guenther's own rows

/// What replacing one parameter of the fit by the truth changes: of the log error over the points, and of CIEDE2000 on
/// the sphere. Where neither is seen, the parameter does not matter.
struct Effect {
  double log_rms = 0.0, ciede2000_mean = 0.0;
};
Effect effect_of(const AnalyticPaint& fitted, const AnalyticPaint& replaced, std::span<const FitPoint> points) {
  std::vector<FitPoint> against(points.begin(), points.end());
  const FitLayout layout;
  const std::vector<double> parameters = parameters_of(layout, fitted);
  for (FitPoint& p : against) p.target = model_at(layout, parameters.data(), p);
  return {fit_errors(replaced, against).whole.rms,
          compare_on_sphere(analytic_brdf(fitted), analytic_brdf(replaced), 32).mean};
}

class GuentherRow : public ::testing::TestWithParam<const char*> {};

TEST_P(GuentherRow, ComesBackFromDataMadeWithIt) {
  const AnalyticPaint truth = recipe(GetParam());
  // One at full size, as the paper has it; the fit takes as many cells from a smaller one.
  const bool is_whole = std::string(GetParam()) == "gu_polaris_silber";
  const BrdfTable table = tabulate(analytic_brdf(truth), is_whole ? BrdfTableSize{} : BrdfTableSize{90, 45, 60});
  FitOptions options;
  options.samples = is_whole ? 6000 : 2000;
  const auto fit = fit_brdf(table, options);
  ASSERT_TRUE(fit) << fit.error().line();
  expect_sane(*fit, GetParam());
  EXPECT_TRUE(fit->has_converged);
  EXPECT_LT(fit->errors.whole.rms, 1e-5);
  const auto spheres = packs::compare_fit(table, analytic_brdf(fit->paint), 32);
  EXPECT_LT(spheres.max, 0.01);

  // Lobes of the truth that have no weight are left out by the fit: pair the others, in order.
  AnalyticPaint paired = truth;
  std::size_t used = 0;
  for (const Lobe& lobe : truth.lobes)
    if (lobe.s != glm::dvec3(0.0)) paired.lobes[used++] = lobe;
  ASSERT_EQ(fit->lobes, static_cast<int>(used));
  for (std::size_t k = used; k < max_lobes; ++k) paired.lobes[k] = fit->paint.lobes[k];
  const FitLayout layout;
  const std::vector<double> expected = parameters_of(layout, paired), found = parameters_of(layout, fit->paint);
  const std::vector<FitPoint> points = fit_points(table_samples(table, 1000)).points;
  for (int k = 0; k < layout.count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const bool is_ln_m = layout.name(k).ends_with(".m");
    const double off = is_ln_m ? std::abs(std::expm1(found[at] - expected[at]))
                               : std::abs(found[at] - expected[at]) / std::max(expected[at], 1e-12);
    if (off <= 0.02) continue;
    std::vector<double> mixed = found;
    mixed[at] = expected[at];
    const Effect effect = effect_of(fit->paint, paint_of(layout, mixed), points);
    EXPECT_LT(effect.log_rms, 1e-3) << layout.name(k) << ' ' << found[at] << " for " << expected[at];
    EXPECT_LT(effect.ciede2000_mean, 0.01) << layout.name(k) << ' ' << found[at] << " for " << expected[at];
  }
}

INSTANTIATE_TEST_SUITE_P(Table1, GuentherRow,
                         ::testing::Values("gu_2k_acrylack", "gu_blue", "gu_blue_matte", "gu_bmw_339", "gu_ford_f8",
                                           "gu_opel_titan", "gu_polaris_silber", "gu_white"),
                         [](const auto& test) { return std::string(test.param); });

// ---- extreme and stiff

struct Stiff {
  const char* name;
  BrdfTable table;
  int lobes;           ///< asked for
  int lobes_found;     ///< -1: any
  double largest_rms;  ///< of the log error over the whole table
  double least_condition;
  double most_condition;
};

std::vector<Stiff> stiff_cases() {
  std::vector<Stiff> out;
  out.push_back({"pure diffuse", small_table(paint({0.5, 0.2, 0.1})), 3, 0, 1e-6, 1.0, 2.0});
  out.push_back({"black", small_table(paint({0.0, 0.0, 0.0})), 3, 0, 1e-9, 1.0, 2.0});
  out.push_back(
      {"pure mirror", small_table(paint({0.0, 0.0, 0.0}, {{{0.1, 0.1, 0.1}, 1e-3, 0.04}})), 3, 1, 1e-5, 1.0, 1e3});
  for (const double m : {1e-3, 0.01, 0.1, 1.0})
    out.push_back(
        {"one roughness", small_table(paint({0.05, 0.05, 0.1}, {{{0.1, 0.09, 0.05}, m, 0.5}})), 3, 1, 1e-5, 1.0, 1e3});
  const Lobe half{{0.1, 0.09, 0.05}, 0.2, 0.5};
  out.push_back({"two equal lobes", small_table(paint({0.05, 0.05, 0.1}, {half, half})), 2, 1, 1e-5, 1.0, 1e3});
  Lobe near = half;
  near.m = 0.21;
  out.push_back({"two lobes 5 % apart", small_table(paint({0.05, 0.05, 0.1}, {near, half})), 2, -1, 1e-3, 1e6, 1e12});

  const BrdfTable silver = small_table(recipe("gu_polaris_silber"));
  for (const double sigma : {0.01, 0.1}) {
    BrdfTable noisy = silver;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    change(noisy, [&](std::size_t, glm::vec3& v) {
      for (int c = 0; c < 3; ++c) v[c] *= static_cast<float>(std::max(0.0, 1.0 + sigma * normal(random)));
    });
    out.push_back({sigma < 0.05 ? "1 % noise" : "10 % noise", noisy, 3, 3, 1.05 * sigma, 10.0, 1e5});
  }
  const auto without = [&](const char* name, const std::function<bool(std::size_t)>& is_missing, double least) {
    BrdfTable holes = silver;
    change(holes, [&](std::size_t cell, glm::vec3& v) {
      if (is_missing(cell)) v.x = -1.0f;
    });
    out.push_back({name, holes, 3, -1, 1e-5, least, 1e12});
  };
  std::mt19937_64 random(9);
  without(
      "every other cell missing", [&](std::size_t) { return (random() & 1u) != 0; }, 10.0);
  without(
      "light beyond 45 degrees missing", [&](std::size_t c) { return silver.middle(c).theta_d > 45.0 * deg; }, 1e6);
  without(
      "half the azimuths missing", [&](std::size_t c) { return silver.middle(c).phi_d > 90.0 * deg; }, 10.0);
  without(
      "peak missing", [&](std::size_t c) { return silver.middle(c).theta_h < 4.0 * deg; }, 10.0);
  return out;
}

TEST(BrdfFit, StaysSaneOnExtremeAndStiffTables) {
  for (const Stiff& stiff : stiff_cases()) {
    FitOptions options;
    options.lobes = stiff.lobes;
    options.samples = 1000;
    const auto fit = fit_brdf(stiff.table, options);
    ASSERT_TRUE(fit) << stiff.name << ": " << fit.error().line();
    expect_sane(*fit, stiff.name);
    if (stiff.lobes_found >= 0) {
      EXPECT_EQ(fit->lobes, stiff.lobes_found) << stiff.name;
    }
    EXPECT_LT(fit->errors.whole.rms, stiff.largest_rms) << stiff.name;
    EXPECT_GE(fit->condition.number, stiff.least_condition) << stiff.name;
    EXPECT_LE(fit->condition.number, stiff.most_condition) << stiff.name;
    // What the numbers say of themselves must hang together: stiff fits name what is loose.
    EXPECT_EQ(fit->condition.number > 1e6, !loose_parameters(*fit).empty()) << stiff.name;
  }
}

TEST(BrdfFit, NoiseMovesParametersNoFurtherThanTheirSlack) {
  // Slack is for an error of 1 % in every number at the worst; independent noise of 1 % does much less.
  const AnalyticPaint truth = recipe("gu_polaris_silber");
  BrdfTable noisy = small_table(truth);
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  change(noisy, [&](std::size_t, glm::vec3& v) {
    for (int c = 0; c < 3; ++c) v[c] *= static_cast<float>(1.0 + 0.01 * normal(random));
  });
  const auto fit = fit_brdf(noisy);
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->lobes, 3);
  const FitLayout layout;
  const std::vector<double> expected = parameters_of(layout, truth);
  int held = 0;
  for (int k = 0; k < layout.count(); ++k) {
    const FitParameter& p = fit->condition.parameters[static_cast<std::size_t>(k)];
    if (p.standing != Standing::determined) continue;
    const double value = expected[static_cast<std::size_t>(k)];
    EXPECT_NEAR(p.value, p.name.ends_with(".m") ? std::exp(value) : value, p.slack) << p.name;
    EXPECT_LT(p.slack, 0.5 * std::max(p.value, 0.1)) << p.name;
    ++held;
  }
  EXPECT_GE(held, 15);
}

TEST(BrdfFit, IsTheSameEveryTime) {
  const BrdfTable table = small_table(recipe("gu_ford_f8"));
  FitOptions options;
  options.samples = 1000;
  const auto first = fit_brdf(table, options), second = fit_brdf(table, options);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->paint, second->paint);
  EXPECT_EQ(first->condition.number, second->condition.number);
}

TEST(BrdfFit, LeavesRoomForTheFlakes) {
  const AnalyticPaint smooth = paint({0.02, 0.02, 0.02}, {{{0.1, 0.1, 0.1}, 0.02, 0.1}});
  const Brdf flakes = analytic_brdf(paint({0.0, 0.0, 0.0}, {{{0.2, 0.15, 0.1}, 0.4, 0.9}}));
  const Brdf both = [&](const glm::dvec3& i, const glm::dvec3& o) {
    return analytic_brdf(smooth)(i, o) + flakes(i, o);
  };
  FitOptions options;
  options.known = flakes;
  const auto fit = fit_brdf(tabulate(both, {90, 30, 30}), options);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->errors.whole.rms, 1e-5);
  EXPECT_EQ(fit->lobes, 1);
  EXPECT_NEAR(fit->paint.diffuse.x, 0.02, 1e-5);
}

// ---- few samples

std::vector<BrdfSample> readings(const Brdf& of, const std::vector<std::pair<double, double>>& angles) {
  std::vector<BrdfSample> out;
  for (const auto& [light, aspecular] : angles) {
    BrdfSample sample{in_plane_direction(light), in_plane_direction(eye_deg(light, aspecular)), {}, 1.0, {}};
    sample.rgb = of(sample.in, sample.out);
    out.push_back(sample);
  }
  return out;
}

TEST(BrdfFit, TakesFewerLobesFromFewerReadings) {
  const Brdf silver = analytic_brdf(recipe("gu_polaris_silber"));
  const std::vector<std::pair<double, double>> six = {{45, 15}, {45, 25}, {45, 45}, {45, 75}, {45, 110}, {45, -15}};
  std::vector<std::pair<double, double>> twelve = six;
  for (const double as : {-45.0, -30.0, -15.0, 15.0, 45.0, 80.0}) twelve.emplace_back(15.0, as);
  const auto few = fit_brdf(readings(silver, six));
  ASSERT_TRUE(few);
  expect_sane(*few, "six");
  EXPECT_EQ(few->points, 6u);
  EXPECT_LE(few->lobes, 1);
  EXPECT_LT(few->errors.whole.rms, 0.2);
  const auto more = fit_brdf(readings(silver, twelve));
  ASSERT_TRUE(more);
  expect_sane(*more, "twelve");
  EXPECT_GT(more->lobes, few->lobes);
  EXPECT_LT(more->errors.whole.rms, 0.02);
  const auto one = fit_brdf(readings(silver, {{45, 45}}));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->lobes, 0);
  EXPECT_LT(one->errors.whole.rms, 1e-6);
}

TEST(BrdfFit, MasksWhatHasNoLogarithmAndCountsIt) {
  std::vector<BrdfSample> samples = readings(analytic_brdf(paint({0.3, 0.2, 0.1})), {{45, 15}, {45, 45}, {45, 110}});
  const BrdfSample good = samples.front();
  for (const double bad : {-0.1, std::nan(""), static_cast<double>(INFINITY)}) {
    samples.push_back(good);
    samples.back().rgb.y = bad;
  }
  samples.push_back(good);
  samples.back().out = in_plane_direction(-89.5);
  samples.push_back(good);
  samples.back().weight = 0.0;
  const auto fit = fit_brdf(samples);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 3u);
  EXPECT_EQ(fit->masked, 5u);
  EXPECT_NEAR(fit->paint.diffuse.y, 0.2, 1e-9);
  const std::vector<BrdfSample> none(samples.begin() + 3, samples.end());
  const auto refused = fit_brdf(none);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "samples");
  EXPECT_FALSE(fit_brdf(std::vector<BrdfSample>{}));
  EXPECT_FALSE(fit_brdf(BrdfTable{}));
  FitOptions table;
  table.colour = FitColour::table;
  EXPECT_FALSE(fit_brdf(samples, table));
}

// ---- the colour table

TEST(BrdfFit, FindsAColourTable) {
  AnalyticPaint truth = paint({0.05, 0.05, 0.05}, {{{0.15, 0.15, 0.15}, 0.3, 0.8}, {{0.02, 0.02, 0.02}, 0.02, 0.2}});
  truth.table = ColourTable{10, std::vector<glm::vec3>(100)};
  for (std::size_t i = 0; i < 10; ++i)
    for (std::size_t h = 0; h < 10; ++h)
      truth.table->linear[i * 10 + h] = {1.0f + 0.08f * static_cast<float>(h) - 0.05f * static_cast<float>(i), 1.0f,
                                         1.0f - 0.06f * static_cast<float>(h) + 0.08f * static_cast<float>(i)};
  const BrdfTable table = tabulate(analytic_brdf(truth), {90, 45, 45});
  FitOptions options;
  options.samples = 1000;
  const auto plain = fit_brdf(table, options);
  options.colour = FitColour::table;
  options.table_nodes = 10;
  const auto fit = fit_brdf(table, options);
  ASSERT_TRUE(plain && fit);
  expect_sane(*fit, "table");
  ASSERT_TRUE(fit->paint.table);
  EXPECT_LT(fit->errors.whole.rms, 0.03);
  EXPECT_GT(plain->errors.whole.rms, 3.0 * fit->errors.whole.rms);
  const auto spheres = packs::compare_fit(table, analytic_brdf(fit->paint), 48);
  EXPECT_LT(spheres.mean, 0.5);
  for (const glm::vec3& entry : fit->paint.table->linear)
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(entry[c] >= 0.0f && entry[c] <= 4.0f);
}

// ---- the sphere

TEST(BrdfSphere, ShowsADiffuseBallAndTellsColoursApart) {
  const Brdf white = analytic_brdf(paint({1.0, 1.0, 1.0})), grey = analytic_brdf(paint({0.5, 0.5, 0.5}));
  const SpherePicture picture = shade_brdf_sphere(white, 33);
  // The middle faces the eye: each lamp counts with the cosine of its middle but for the lamp's own spread.
  const double middle = 0.6 * std::cos(40.0 * deg) + 0.25 * std::cos(60.0 * deg);
  EXPECT_NEAR(static_cast<double>(picture.pixels[16 * 33 + 16].y), middle, 0.01);
  EXPECT_EQ(picture.mask[0], 0);
  const auto same = compare_on_sphere(white, white, 33);
  EXPECT_EQ(same.max, 0.0);
  EXPECT_GT(same.pixels, 800u);
  const auto different = compare_on_sphere(white, grey, 33);
  EXPECT_GT(different.mean, 10.0);
  EXPECT_LE(different.mean, different.p95);
  EXPECT_LE(different.p95, different.max);
}

// ---- a real paint

TEST(BrdfFit, AnIridescentCarPaintNeedsTheColourTable) {
  const std::filesystem::path file(LACKWERK_SOURCE_DIR "/../shared/data/rgl/irid_flake_paint1_rgb.bsdf");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "shared/data/rgl/irid_flake_paint1_rgb.bsdf is not there";
  const auto material = packs::read_rgl(file);
  ASSERT_TRUE(material) << material.error().line();
  const Brdf both_ways = [&](const glm::dvec3& i, const glm::dvec3& o) {
    return glm::max(((*material)(i, o) + (*material)(o, i)) * 0.5, glm::dvec3(0.0));
  };
  const BrdfTable table = tabulate(both_ways, {90, 30, 36});
  FitOptions options;
  options.samples = 1000;
  const auto by_lobe = fit_brdf(table, options);
  options.colour = FitColour::table;
  options.table_nodes = 31;
  const auto by_table = fit_brdf(table, options);
  ASSERT_TRUE(by_lobe && by_table);
  expect_sane(*by_lobe, "lobes");
  expect_sane(*by_table, "table");
  // Measured 11.6 and 1.6 on the usual table of 90 x 90 x 180 cells.
  const double lobes = packs::compare_fit(table, analytic_brdf(by_lobe->paint), 48).mean;
  const double chi = packs::compare_fit(table, analytic_brdf(by_table->paint), 48).mean;
  EXPECT_LT(chi, 2.5);
  EXPECT_GT(lobes, 3.0 * chi);
  // The clear coat's peak is a lobe of its own in both: around m = 0.016.
  EXPECT_NEAR(by_lobe->paint.lobes[2].m, 0.016, 0.005);
  EXPECT_NEAR(by_table->paint.lobes[static_cast<std::size_t>(by_table->lobes - 1)].m, 0.016, 0.005);
}

}  // namespace
}  // namespace lackwerk::core
