// How far a mix may go: until it shines more than it is lit, or until clamping holds it back.
#include "core/beyond.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/realise.hpp"

namespace lackwerk::core {
namespace {

InterpolatablePaint diffusers(const std::vector<double>& albedos) {
  InterpolatablePaint paint;
  for (const double albedo : albedos) {
    auto& part = paint.paints.emplace_back();
    part.identity.name = "Paint " + std::to_string(paint.paints.size() - 1);
    part.analytic.diffuse = glm::dvec3(albedo);
  }
  return paint;
}

TEST(Beyond, OnePaintHasNone) { EXPECT_EQ(beyond_limit(diffusers({0.5})), 0.0); }

TEST(Beyond, PaintsThatStayAmongThemselvesMayGoAllTheWay) {
  for (const auto& albedos : {std::vector{0.5, 0.5, 0.5}, {0.5, 0.6}, {0.4, 0.5, 0.6, 0.55, 0.45}}) {
    const Beyond beyond = measure_beyond(diffusers(albedos));
    EXPECT_EQ(beyond.limit, most_beyond);
    EXPECT_TRUE(beyond.stop.empty()) << beyond.stop;
  }
}

TEST(Beyond, NothingShinesMoreThanItIsLit) {
  // (1 + b/2) 0.95 - b/2 0.5 = 0.95 + 0.225 b reaches 1.01 at b = 0.267.
  const Beyond beyond = measure_beyond(diffusers({0.5, 0.95}));
  EXPECT_NEAR(beyond.limit, 0.25, 1e-12);
  EXPECT_NE(beyond.stop.find("Paint 1"), std::string::npos) << beyond.stop;
  EXPECT_NE(beyond.stop.find("more light"), std::string::npos) << beyond.stop;
}

TEST(Beyond, WhatShinesMoreAlreadyMustNotShineMoreStill) {
  // 1.2 + 0.05 b passes its own 1.2 by 0.01 at b = 0.2; 1.1 only falls.
  EXPECT_NEAR(beyond_limit(diffusers({1.1, 1.2})), 0.2, 0.051);
}

TEST(Beyond, ADarkPaintIsHeldBackByBlack) {
  // 0.02 - 0.24 b would be below nothing from b = 0.083 on.
  const Beyond beyond = measure_beyond(diffusers({0.02, 0.5}));
  EXPECT_NEAR(beyond.limit, 0.05, 1e-12);
  EXPECT_NE(beyond.stop.find("Paint 0"), std::string::npos) << beyond.stop;
}

TEST(Beyond, AMirrorsFresnelAtItsCeilingIsNoReasonToStop) {
  InterpolatablePaint paint = diffusers({0.3, 0.3});
  paint.paints[0].analytic.lobes[0] = {glm::dvec3(0.02), 0.4, 1.0};
  paint.paints[1].analytic.lobes[0] = {glm::dvec3(0.02), 0.4, 0.95};
  EXPECT_EQ(beyond_limit(paint), most_beyond) << "F0 would be 1.025, which nobody can tell from 1";
}

TEST(ExtrapolateAnalytic, IsRealiseAnalyticWithoutClamps) {
  InterpolatablePaint paint = diffusers({0.02, 0.5});
  paint.paints[0].analytic.lobes[0] = {glm::dvec3(0.1), 0.3, 1.0};
  paint.paints[1].analytic.lobes[0] = {glm::dvec3(0.2), 0.4, 0.8};
  const Weights inside = Weights::uniform({0.3, 0.7}), outside = Weights::uniform({1.5, -0.5});
  EXPECT_EQ(extrapolate_analytic(paint, inside), realise_analytic(paint, inside));
  const AnalyticPaint free = extrapolate_analytic(paint, outside), held = realise_analytic(paint, outside);
  EXPECT_NEAR(free.diffuse.x, -0.22, 1e-12);
  EXPECT_EQ(held.diffuse.x, 0.0);
  EXPECT_NEAR(free.lobes[0].f0, 1.1, 1e-12);
  EXPECT_EQ(held.lobes[0].f0, 1.0);
}

}  // namespace
}  // namespace lackwerk::core
