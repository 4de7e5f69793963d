// The one paint model, evaluated as C++: against closed forms, against itself reversed, and float against double.
#include "core/paint_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "core/colour.hpp"
#include "tests/unit/one_slice_paint.hpp"

namespace lackwerk::core {
namespace {

using Model = PaintModel<double>;
using Vec = glm::dvec3;
const Vec up(0.0, 0.0, 1.0);

Vec direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Model one_lobe(double s, double m, double f0) {
  Model model;
  model.u_lobe[0] = {s, s, s, f0};
  model.u_inv_m = {1.0 / m, 1.0, 1.0};
  return model;
}

/// Albedo of a model for view direction o, by sampling half vectors as Guenther et al. 2005, 5.2 do: the density of
/// theta = atan(m sqrt(-ln(1-r))) is D cos / pi, so that D drops out.
double albedo(Model& model, double m, const Vec& o) {
  constexpr int n = 400;
  double sum = 0.0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const double r = (a + 0.5) / n;
      const double theta = std::atan(m * std::sqrt(-std::log1p(-r)));
      const Vec h = direction(theta, 2.0 * std::numbers::pi * (b + 0.5) / n);
      const double ho = glm::dot(h, o);
      const Vec i = h * (2.0 * ho) - o;
      if (ho <= 0.0 || i.z <= 0.0) continue;
      const double c = std::cos(theta), t = std::tan(theta) / m;
      const double d = std::exp(-t * t) / (m * m * c * c * c * c);
      // rho/pi * i.z dw_i with dw_i = 4 ho dw_h and dw_h = pi / (D cos) dr dphi/(2 pi).
      sum +=
          model.paint_factor(up, i, o, {0, 0}, 0, 0).x / std::numbers::pi * i.z * 4.0 * ho * std::numbers::pi / (d * c);
    }
  return sum / (n * n);
}

TEST(PaintModel, FresnelHasItsClosedForms) {
  for (const double ior : {1.0, 1.2, 1.5, 2.5}) {
    const double r0 = std::pow((ior - 1) / (ior + 1), 2);
    EXPECT_NEAR(Model().fresnel_dielectric(1.0, ior), r0, 1e-6) << ior;
    for (double c = 0.05; c < 1.0; c += 0.05) {
      const double ct = std::sqrt(1 - (1 - c * c) / (ior * ior));
      const double rs = (c - ior * ct) / (c + ior * ct), rp = (ior * c - ct) / (ior * c + ct);
      EXPECT_NEAR(Model().fresnel_dielectric(c, ior), 0.5 * (rs * rs + rp * rp), 2e-5) << ior << ' ' << c;
    }
  }
  EXPECT_NEAR(Model().fresnel_dielectric(1e-4, 1.5), 1.0, 1e-3);
}

TEST(PaintModel, RefractionObeysSnell) {
  for (double t = 0.0; t < 1.57; t += 0.1) {
    const Vec in = Model().refract_into(direction(t, 0.7), up, 1.5);
    EXPECT_NEAR(glm::length(in), 1.0, 1e-12);
    EXPECT_NEAR(std::sqrt(1 - in.z * in.z) * 1.5, std::sin(t), 1e-7);
  }
}

TEST(PaintModel, LobeAlbedoAtNormalViewIsFourSF) {
  // DESIGN.md, section 4: with D as printed and pi below, the albedo of a narrow lobe is 4 s r.
  for (const double m : {0.013, 0.05, 0.1}) {
    Model model = one_lobe(0.02, m, 0.5);
    EXPECT_NEAR(albedo(model, m, up), 4 * 0.02 * 0.5, 4 * 0.02 * 0.5 * 0.03) << m;
  }
}

TEST(PaintModel, IsReciprocal) {
  Model model = one_lobe(0.1, 0.3, 0.4);
  model.u_diffuse = {0.1, 0.2, 0.3};
  model.u_coat_ior = 1.5;
  model.u_refraction_ior = 1.5;
  std::mt19937 random(3);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int k = 0; k < 1000; ++k) {
    const Vec i = direction(1.5 * unit(), 6.28 * unit()), o = direction(1.5 * unit(), 6.28 * unit());
    const double there = model.paint_factor(up, i, o, {0, 0}, 0, 0).y;
    const double back = model.paint_factor(up, o, i, {0, 0}, 0, 0).y;
    EXPECT_NEAR(there, back, 1e-9 * (1 + there));
  }
}

TEST(PaintModel, NothingFromBelowAndNoNaNAtGrazing) {
  Model model = one_lobe(0.1, 1e-3, 0.4);
  model.u_coat_ior = 1.5;
  EXPECT_EQ(model.paint_factor(up, direction(1.6, 0), up, {0, 0}, 0, 0), Vec(0.0));
  for (const double m : {1e-3, 1e-2, 0.1, 1.0}) {
    model.u_inv_m.x = 1.0 / m;
    for (const double t : {0.0, 1.0, 1.57, 1.5707, 1.57079, 1.5707963})
      for (const double phi : {0.0, 1.0, std::numbers::pi}) {
        const Vec f = model.paint_factor(up, direction(t, 0), direction(t, phi), {0, 0}, 0, 0);
        EXPECT_TRUE(std::isfinite(f.x) && f.x >= 0.0) << m << ' ' << t << ' ' << phi;
      }
  }
}

TEST(PaintModel, FloatFollowsDouble) {
  Model exact = one_lobe(0.1, 0.013, 0.9);
  PaintModel<float> quick;
  quick.u_lobe[0] = {0.1f, 0.1f, 0.1f, 0.9f};
  quick.u_inv_m = {1.0f / 0.013f, 1.0f, 1.0f};
  double worst = 0.0;
  for (double t = 0.0; t < 1.4; t += 0.05)
    for (double d = -0.05; d <= 0.05; d += 0.002) {
      const Vec i = direction(t, 0), o = direction(t + d, std::numbers::pi);
      const double a = exact.paint_factor(up, i, o, {0, 0}, 0, 0).x;
      const auto b = static_cast<double>(quick.paint_factor({0, 0, 1}, glm::vec3(i), glm::vec3(o), {0, 0}, 0, 0).x);
      worst = std::max(worst, std::abs(a - b) / (a + 1e-3));
    }
  EXPECT_LT(worst, 2e-3) << "largest relative deviation of float in a lobe of m = 0.013";
}

TEST(PaintModel, DecodesLabAsColourDoes) {
  Model model;
  for (const Vec lab : {Vec(50, 20, -30), Vec(5, 1, 1), Vec(480, -20, 40), Vec(100, 0, 0)}) {
    const Vec here = model.linear_from_lab_factor(lab);
    const Vec there = glm::max(linear_from_lab(lab), Vec(0.0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(here[c], there[c], 1e-9 * (1 + there[c]));
  }
}

TEST(PaintModel, TexelsHaveTheMeanOfTheTable) {
  // Half black, and rare bright flakes.
  const testing::FlakeRow row{{{{0, 100, 32768, 32768, 32768, 32768}}, {{60000, 65535, 32000, 34000, 32000, 33000}}},
                              {990, 10}};
  testing::OneSlicePaint source(row, row, 5);
  Model& model = source.model;
  Vec sum(0.0);
  int bright = 0;
  constexpr int n = 512;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec f = model.flake_level(0.0, 0.0, {x + 0.5, y + 0.5}, 0.0);
      sum += f;
      bright += f.y > 1.0 ? 1 : 0;
    }
  const Vec mean = sum / double(n * n), table = model.flake_mean(0.0, 0.0);
  EXPECT_NEAR(bright / double(n * n), 0.01, 0.0006);  // 3 sigma of 262,144 draws
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], table[c], 0.07 * table[c]);
  // Far away the pixel holds the mean, and where there is no slice there is nothing.
  EXPECT_EQ(model.flake_factor(0.0, 0.0, {3, 3}, 5.0), table);
  EXPECT_EQ(model.flake_level(3.0, 3.0, {3, 3}, 0.0), Vec(0.0));
}

}  // namespace
}  // namespace lackwerk::core
