// The one GGX lobe: energy against plain quadrature, Figure 2 of Kneiphof et al. 2018, and where it ends.
#include "core/analysis/ggx_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <ostream>
#include <random>
#include <vector>

#include "core/analysis/reference_sampling.hpp"
#include "core/environment.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec3;

AnalyticPaint one_lobe(double m, double ior, double f0 = 1.0) {
  AnalyticPaint paint;
  paint.lobes[0] = {dvec3(1.0), m, f0};
  paint.coat_ior = paint.refraction_ior = ior;
  return paint;
}

AnalyticPaint three_lobes() {
  AnalyticPaint paint;
  paint.diffuse = {0.1, 0.2, 0.3};
  paint.lobes[0] = {{0.05, 0.04, 0.01}, 0.45, 0.9};
  paint.lobes[1] = {{0.02, 0.04, 0.05}, 0.2, 0.5};
  paint.lobes[2] = {{0.01, 0.01, 0.01}, 0.08, 0.2};
  paint.coat_ior = paint.refraction_ior = 1.5;
  return paint;
}

/// Mean over the hemisphere by cosine, midpoints: rings even in cos^2.
template <class Value>
dvec3 over_hemisphere(const Value& value, int rings = 600, int sectors = 16) {
  dvec3 sum(0.0);
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < sectors; ++k) {
      const double z2 = (r + 0.5) / rings, sine = std::sqrt(1.0 - z2),
                   phi = 2.0 * std::numbers::pi * (k + 0.5) / sectors;
      sum += value(dvec3(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(z2)));
    }
  return sum / static_cast<double>(rings * sectors);
}

double ggx_at(double alpha, const dvec3& i, const dvec3& o) {
  const dvec3 h = glm::normalize(i + o);
  return ggx_factor(alpha, std::hypot(h.x, h.y) / h.z, h.z, i.z, o.z);
}

TEST(GgxFactor, KeepsEnergyWhereItIsSmoothAndIsReciprocal) {
  const dvec3 n(0.0, 0.0, 1.0);
  // Walter et al. 2007: without masking all light comes back; masking takes the more, the rougher.
  double before = 1.0;
  for (const double alpha : {0.1, 0.3, 0.6, 1.0}) {
    const double albedo = over_hemisphere([&](const dvec3& i) { return dvec3(ggx_at(alpha, i, n)); }, 20000, 1).x;
    EXPECT_LT(albedo, before) << alpha;
    before = albedo;
  }
  EXPECT_NEAR(before, 1.0 - std::numbers::ln2, 1e-4) << "by hand: 2 cos / (2 (1 + cos)) over the cosine";
  EXPECT_NEAR(over_hemisphere([&](const dvec3& i) { return dvec3(ggx_at(0.05, i, n)); }, 200000, 1).x, 1.0, 0.02);
  const dvec3 a = glm::normalize(dvec3(0.3, 0.5, 0.7)), b = glm::normalize(dvec3(-0.8, 0.1, 0.4));
  EXPECT_DOUBLE_EQ(ggx_at(0.4, a, b), ggx_at(0.4, b, a));
}

TEST(GgxFit, KeepsTheEnergyOfEveryChannelAtNormalView) {
  const AnalyticPaint paint = three_lobes();
  PaintModel<double> model;
  AnalyticPaint shiny = paint;
  shiny.diffuse = dvec3(0.0);
  bind_model(InterpolatablePaint(), shiny, no_textures(), model);
  const dvec3 n(0.0, 0.0, 1.0);
  const dvec3 truth =
      over_hemisphere([&](const dvec3& i) { return model.paint_factor(n, i, n, glm::dvec2(0.0), 0.0, 0.0); }, 20000, 1);
  const auto loss = [&](double cosine) { return 1.0 - model.fresnel_dielectric(cosine, paint.coat_ior); };

  const GgxFit both = fit_ggx(paint);
  ASSERT_EQ(both.outcome, GgxOutcome::fitted);
  const dvec3 through =
      both.scale() *
      over_hemisphere([&](const dvec3& i) { return dvec3(ggx_at(both.alpha, i, n) * loss(i.z) * loss(1.0)); }, 20000,
                      1);
  const GgxFit view = fit_ggx(paint, {}, 1.0);
  const dvec3 below =
      view.scale() * over_hemisphere([&](const dvec3& i) { return dvec3(ggx_at(view.alpha, i, n) * 0.96); }, 20000, 1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(both.energy[c], truth[c], 1e-3 * truth[c]);
    EXPECT_NEAR(through[c], truth[c], 2e-3 * truth[c]) << "eq. 9's coat";
    EXPECT_NEAR(below[c], truth[c], 2e-3 * truth[c]) << "glTF's coat";
  }
}

TEST(GgxFit, ReproducesFigure2UnderAnIndexOfOneAndAHalf) {
  // The text of the figure: roughness rises at once, because the coat widens lobes; the scale is not constant.
  double alpha = 0.0;
  for (int k = 1; k <= 50; ++k) {
    const GgxFit fit = fit_ggx(one_lobe(0.02 * k, 1.5));
    ASSERT_EQ(fit.outcome, GgxOutcome::fitted) << 0.02 * k;
    EXPECT_GT(fit.alpha, alpha) << 0.02 * k;
    alpha = fit.alpha;
  }
  // By hand for narrow lobes: s = 4 eta^2, because D of the paint has no 1/4 and the coat widens solid angles by eta^2
  // but does not weaken what comes out (eq. 6 has no 1 / eta^2); and alpha = 0.9321 eta m.
  EXPECT_NEAR(fit_ggx(one_lobe(0.01, 1.5)).lobes.x, 9.0, 0.01);
  EXPECT_NEAR(fit_ggx(one_lobe(0.01, 1.0)).lobes.x, 4.0, 0.005);
  EXPECT_NEAR(fit_ggx(one_lobe(0.01, 1.5)).alpha, narrow_lobe_ratio * 1.5 * 0.01, 2e-5);
  // Read off a second program (plain Riemann sums over 3000 nodes, roughness in steps of 0.005).
  EXPECT_NEAR(std::sqrt(fit_ggx(one_lobe(0.2, 1.5)).alpha), std::sqrt(0.308), 0.003);
  EXPECT_NEAR(fit_ggx(one_lobe(0.2, 1.5)).lobes.x, 10.21, 0.03);
  EXPECT_NEAR(std::sqrt(fit_ggx(one_lobe(0.4, 1.5)).alpha), std::sqrt(0.593), 0.003);
  EXPECT_NEAR(fit_ggx(one_lobe(0.4, 1.5)).lobes.x, 9.05, 0.06);
  // Without a coat a wide Beckmann lobe asks for more than alpha = 1.
  EXPECT_EQ(fit_ggx(one_lobe(0.65, 1.0)).outcome, GgxOutcome::fitted);
  EXPECT_EQ(fit_ggx(one_lobe(0.70, 1.0)).outcome, GgxOutcome::too_wide);
}

TEST(GgxFit, IsTheBestAlphaOfItsKind) {
  // Nothing near has a smaller error: eq. 10 summed over the hemisphere, apart from the fit's own line of angles.
  const AnalyticPaint paint = three_lobes();
  PaintModel<double> model;
  AnalyticPaint shiny = paint;
  shiny.diffuse = dvec3(0.0);
  bind_model(InterpolatablePaint(), shiny, no_textures(), model);
  const dvec3 n(0.0, 0.0, 1.0);
  const auto error = [&](double alpha) {
    const auto f = [&](const dvec3& i) { return luminance_of(model.paint_factor(n, i, n, glm::dvec2(0.0), 0.0, 0.0)); };
    const auto engine = [&](const dvec3& i) {
      return ggx_at(alpha, i, n) * (1.0 - model.fresnel_dielectric(i.z, 1.5)) * 0.96;
    };
    const dvec3 energies = over_hemisphere([&](const dvec3& i) { return dvec3(f(i), engine(i), 0.0); }, 20000, 1);
    const double s = energies.x / energies.y;
    return over_hemisphere(
               [&](const dvec3& i) {
                 const double d = (s * engine(i) - f(i)) * i.z;
                 return dvec3(f(i) * d * d);
               },
               20000, 1)
        .x;
  };
  const double alpha = fit_ggx(paint).alpha, least = error(alpha);
  for (const double factor : {0.5, 0.9, 0.97, 1.03, 1.1, 1.5}) EXPECT_GT(error(alpha * factor), least) << factor;
}

TEST(GgxFit, SaysWhereALobeIsTooNarrowForAnEngine) {
  for (const double ior : {1.0, 1.3, 1.5, 2.0, 2.5}) {
    const double least = least_stable_roughness(ior);
    EXPECT_EQ(fit_ggx(one_lobe(1.01 * least, ior)).outcome, GgxOutcome::fitted) << ior;
    const GgxFit narrow = fit_ggx(one_lobe(std::max(0.99 * least, min_roughness), ior));
    EXPECT_EQ(narrow.outcome, GgxOutcome::too_narrow) << ior;
    EXPECT_EQ(narrow.alpha, least_engine_alpha);
    EXPECT_NEAR(narrow.scale().x, 4.0 * ior * ior, 0.01 * ior * ior) << "the energy is kept all the same";
  }
}

/// Root mean square of the relative error of D as an engine's shader computes it from 32-bit unit vectors, over half
/// vectors drawn from D.
double float_error(double alpha, int count) {
  std::mt19937_64 numbers(7);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::normal_distribution<double> bell;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const dvec3 n = glm::normalize(dvec3(bell(numbers), bell(numbers), bell(numbers)));
    const ReferenceFrame frame(n);
    const double u = even(numbers), t = alpha * std::sqrt(u / (1.0 - u)), c = 1.0 / std::sqrt(1.0 + t * t);
    const double phi = 2.0 * std::numbers::pi * even(numbers), z = 0.5 + 0.5 * even(numbers),
                 s = std::sqrt(1.0 - z * z);
    const dvec3 h = frame.to_world({t * c * std::cos(phi), t * c * std::sin(phi), c});
    const double turn = 2.0 * std::numbers::pi * even(numbers);
    const glm::vec3 v(frame.to_world({s * std::cos(turn), s * std::sin(turn), z}));
    const glm::vec3 l(2.0 * glm::dot(dvec3(v), h) * h - dvec3(v)), half = glm::normalize(v + l);
    const auto a2 = static_cast<float>(alpha * alpha);
    const float nh = std::min(glm::dot(glm::vec3(n), half), 1.0f), b = (nh * a2 - nh) * nh + 1.0f;
    const double shader = static_cast<double>(a2 / (b * b));
    const double exact = alpha * alpha / std::pow(c * c * (alpha * alpha - 1.0) + 1.0, 2.0);
    sum += (shader / exact - 1.0) * (shader / exact - 1.0);
  }
  return std::sqrt(sum / count);
}

TEST(GgxFit, TheLimitIsWhereFloatsLoseAPerCent) {
  constexpr int count = 50000;
  EXPECT_LT(float_error(1.25 * least_engine_alpha, count), 0.01);
  EXPECT_GT(float_error(0.75 * least_engine_alpha, count), 0.01);
  EXPECT_GT(float_error(1e-3, count), 0.05) << "Beckmann's least m: noise";
}

/// Largest over smallest scale that eq. 12 of the paper (with its 1/N) finds with 10,000 directions drawn from f, over
/// some seeds.
double spread_of_eq_12(double m, double ior) {
  const AnalyticPaint paint = one_lobe(m, ior);
  const GgxFit fit = fit_ggx(paint);
  PaintModel<double> model;
  bind_model(InterpolatablePaint(), paint, no_textures(), model);
  const dvec3 n(0.0, 0.0, 1.0);
  const LobeSampler sampler(n, n, ior);
  double least = 1e300, most = 0.0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    std::mt19937_64 numbers(seed);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    double engine = 0.0, measured = 0.0;
    for (int k = 0; k < 10000; ++k) {
      const auto i = sampler.sample({even(numbers), even(numbers)}, m);
      if (!i || i->z <= 0.0) continue;
      // Drawn from the lobe; what is left of f beside it (masking, coat) is a weight.
      const double weight = i->z / LobeSampler::pdf(sampler.target(*i), m);
      measured += weight * model.paint_factor(n, *i, n, glm::dvec2(0.0), 0.0, 0.0).x;
      engine += weight * ggx_at(fit.alpha, *i, n) * (1.0 - model.fresnel_dielectric(i->z, ior)) *
                (1.0 - model.fresnel_dielectric(1.0, ior));
    }
    least = std::min(least, measured / engine);
    most = std::max(most, measured / engine);
  }
  return most / least;
}

TEST(GgxFit, ThePapersSamplesAreStableOnlyForWideLobes) {
  // N samples of a Beckmann lobe reach tan(theta_h) = m sqrt(ln N); GGX has 8 % of its energy beyond, and a sample that
  // strays there weighs thousands. All is within reach only where the horizon is: tan(asin(1 / eta) / 2).
  for (const double ior : {1.0, 1.5}) {
    const double limit = std::tan(0.5 * std::asin(1.0 / ior)) / std::sqrt(std::log(10000.0));
    EXPECT_GT(spread_of_eq_12(0.5 * limit, ior), 1.1) << ior;
    EXPECT_LT(spread_of_eq_12(1.5 * limit, ior), 1.03) << ior;
  }
}

TEST(GgxFit, NothingSpecularIsNoLobe) {
  AnalyticPaint matt;
  matt.diffuse = dvec3(0.5);
  for (const AnalyticPaint& paint : {AnalyticPaint(), matt}) {
    const GgxFit fit = fit_ggx(paint);
    EXPECT_EQ(fit.outcome, GgxOutcome::no_lobe);
    EXPECT_EQ(fit.scale(), dvec3(0.0));
    EXPECT_EQ(fit.alpha, 1.0);
    EXPECT_EQ(fit.error, 0.0);
  }
}

TEST(GgxFit, FlakesCarryTheirShare) {
  AnalyticPaint paint = three_lobes();
  const GgxFit whole = fit_ggx(paint);
  const Lobe lobe = paint.lobes[0];
  paint.lobes[0].s *= 0.3;
  AnalyticPaint rest;
  rest.lobes[0] = lobe;
  rest.lobes[0].s *= 0.7;
  PaintModel<double> model;
  bind_model(InterpolatablePaint(), rest, no_textures(), model);
  const GgxFit split = fit_ggx(paint, [&](double theta_h, double theta_i) {
    // At normal view: both directions theta_h off the half vector, one of them the normal.
    EXPECT_NEAR(theta_h, theta_i, 1e-6);
    const dvec3 n(0.0, 0.0, 1.0), i(std::sin(2.0 * theta_h), 0.0, std::cos(2.0 * theta_h));
    return dvec3(model.lobes_factor(model.paint_geometry(n, i, n), 1.0));
  });
  EXPECT_NEAR(split.alpha, whole.alpha, 1e-4);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(split.scale()[c], whole.scale()[c], 1e-4 * whole.scale()[c]);
  EXPECT_GT(split.flakes.x, 0.0);
}

TEST(GgxFit, ExtremesStayNumbers) {
  for (const double m : {1e-3, 3e-3, 0.02, 0.3, 1.0})
    for (const double f0 : {0.0, 0.04, 1.0})
      for (const double ior : {1.0, 1.33, 2.5})
        for (const double s : {0.0, 1e-9, 1.0, 1e3}) {
          AnalyticPaint paint = one_lobe(m, ior, f0);
          paint.lobes[0].s = dvec3(s, 0.0, s);
          for (const bool view_only : {false, true}) {
            const GgxFit fit = view_only ? fit_ggx(paint, {}, clearcoat_factor(ior)) : fit_ggx(paint);
            const auto what = ::testing::PrintToString(m) + " " + ::testing::PrintToString(f0) + " " +
                              ::testing::PrintToString(ior) + " " + ::testing::PrintToString(s);
            EXPECT_GE(fit.alpha, least_engine_alpha) << what;
            EXPECT_LE(fit.alpha, 1.0) << what;
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(fit.scale()[c] >= 0.0 && std::isfinite(fit.scale()[c])) << what;
            EXPECT_EQ(fit.scale().y, 0.0) << what;
            EXPECT_TRUE(std::isfinite(fit.error)) << what;
            if (s < 1e-6) {
              EXPECT_EQ(fit.outcome, GgxOutcome::no_lobe) << what;
            }
            if (s == 1.0 && f0 > 0.0) {
              EXPECT_NE(fit.outcome, GgxOutcome::no_lobe) << what;
            }
          }
        }
}

}  // namespace
}  // namespace lackwerk::core
