// Colour maps as paints, and how far a capture's model is from its measurement.
#include "packs/tools/map_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/analysis/map_paint.hpp"
#include "core/colour.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/capture_error.hpp"
#include "packs/tools/pack_builder.hpp"
#include "packs/tools/recipe.hpp"

namespace lackwerk::packs {
namespace {

constexpr double rad = std::numbers::pi / 180.0;

/// A coated paint whose colour follows the flake's two angles and nothing else: what isochromatic maps are exact for.
Capture flop_paint(double ior) {
  Capture capture;
  capture.identity.name = "flop";
  capture.analytic.diffuse = glm::dvec3(1.0);
  capture.analytic.coat_ior = capture.analytic.refraction_ior = ior;
  constexpr std::uint16_t edge = 46;
  core::ColourTable table{edge, std::vector<glm::vec3>(std::size_t{edge} * edge)};
  for (std::size_t k = 0; k < table.linear.size(); ++k) {
    const std::size_t column = k % edge, row = k / edge;
    const double h = static_cast<double>(column) * 2.0 * rad, d = static_cast<double>(row) * 2.0 * rad;
    table.linear[k] = glm::vec3(glm::dvec3(0.9, 0.6, 0.3) * std::exp(-h * h / 0.2) + glm::dvec3(0.02, 0.05, 0.1) * d);
  }
  capture.analytic.table = std::move(table);
  return capture;
}

/// What a twelve-angle instrument would read of it.
std::vector<AngleReading> readings_of(const Capture& capture) {
  const core::Brdf brdf = capture_brdf(capture);
  std::vector<AngleReading> out;
  for (const auto& [light, aspeculars] : std::vector<std::pair<double, std::vector<double>>>{
           {45.0, {-15.0, 15.0, 25.0, 45.0, 75.0, 110.0}}, {15.0, {-45.0, -30.0, -15.0, 15.0, 45.0, 80.0}}}) {
    for (const double aspecular : aspeculars) {
      AngleReading reading{light, aspecular, {}};
      const core::DirectionPair at = reading_sample(reading).directions;
      reading.lab = core::lab_from_linear(brdf(at.in, at.out) * std::numbers::pi);
      out.push_back(reading);
    }
  }
  return out;
}

TEST(CoatTransmission, IsFresnelTwiceAndOneWithoutACoat) {
  const glm::dvec3 up(0.0, 0.0, 1.0), low(std::sin(1.4), 0.0, std::cos(1.4));
  EXPECT_NEAR(core::coat_transmission(up, up, 1.5), 0.96 * 0.96, 1e-5);  // F = ((n - 1) / (n + 1))^2 = 0.04
  EXPECT_EQ(core::coat_transmission(up, low, 1.0), 1.0);
  EXPECT_LT(core::coat_transmission(low, up, 1.5), 0.9 * core::coat_transmission(up, up, 1.5));
  EXPECT_EQ(core::coat_transmission(low, up, 1.5), core::coat_transmission(up, low, 1.5));
}

TEST(PaintOfMap, GivesThePaintBackWhereColourFollowsTheFlakeAlone) {
  for (const double ior : {1.0, 1.5}) {
    const Capture truth = flop_paint(ior);
    core::ColourMapSettings settings;
    settings.index = ior;
    settings.carrier = [ior](const glm::dvec3& in, const glm::dvec3& out) {
      return core::coat_transmission(in, out, ior);
    };
    const auto map = core::colour_map_of(capture_brdf(truth), settings);
    ASSERT_TRUE(map);
    const core::AnalyticPaint paint = core::paint_of_map(*map, ior, 46);
    EXPECT_EQ(paint.coat_ior, ior);
    EXPECT_EQ(paint.refraction_ior, ior);
    // Both angles to 20 degrees inside: the pairs of all phi_d reach air and need no cure.
    double worst = 0.0;
    for (std::size_t i = 0; i <= 10; ++i)
      for (std::size_t h = 0; h <= 10; ++h)
        for (int c = 0; c < 3; ++c) {
          const auto is = static_cast<double>(paint.table->linear[i * 46 + h][c]);
          const auto was = static_cast<double>(truth.analytic.table->linear[i * 46 + h][c]);
          worst = std::max(worst, std::abs(is - was) / (was + 0.01));
        }
    EXPECT_LT(worst, 0.03) << "index " << ior;
    std::printf("  index %.1f: worst of 121 nodes %.2f %%\n", ior, 100.0 * worst);
  }
}

TEST(PaintOfMap, EveryNodeIsANumberForEveryIndex) {
  for (const double ior : {1.0, 1.2, 1.5, 2.0, 2.5}) {
    core::ColourMapSettings settings;
    settings.index = ior;
    settings.edge = 16;
    const auto map = core::colour_map_of(capture_brdf(flop_paint(ior)), settings);
    ASSERT_TRUE(map);
    for (const std::uint16_t nodes : {std::uint16_t{2}, std::uint16_t{17}}) {
      const core::AnalyticPaint paint = core::paint_of_map(*map, 1.0, nodes);
      ASSERT_EQ(paint.table->linear.size(), std::size_t{nodes} * nodes);
      for (const glm::vec3& chi : paint.table->linear)
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(chi[c]) && chi[c] >= 0.0f) << ior << ", " << nodes;
      EXPECT_GT(paint.table->linear.back().x, 0.0f) << "the farthest node takes its neighbour's colour";
    }
  }
}

TEST(MapCapture, TwelveReadingsBecomeAPaintThatShowsThem) {
  Capture capture = flop_paint(1.5);
  const core::Brdf truth = capture_brdf(capture);
  capture.angles = readings_of(capture);
  const auto paint = map_capture(capture, 1.5, 46);
  ASSERT_TRUE(paint) << paint.error().line();
  capture.analytic = *paint;
  capture.form = PaintForm::mapped;
  const FormError error = capture_error(capture);
  EXPECT_EQ(error.form, PaintForm::mapped);
  EXPECT_EQ(error.judged_by, JudgedBy::readings);
  EXPECT_EQ(error.count, 12u);
  EXPECT_LT(error.e2000_mean, 1.0f);
  EXPECT_LE(error.e2000_p95, error.e2000_max);
  std::printf("  at the readings: CIEDE2000 mean %.2f, max %.2f\n", static_cast<double>(error.e2000_mean),
              static_cast<double>(error.e2000_max));
  // Beside the plane of incidence nothing was read; the lines carry the colour there.
  const core::Brdf shown = capture_brdf(capture);
  double sum = 0.0;
  int count = 0;
  for (double azimuth = 30.0; azimuth < 180.0; azimuth += 30.0)
    for (const double polar : {15.0, 30.0, 45.0}) {
      const glm::dvec3 in(std::sin(30.0 * rad), 0.0, std::cos(30.0 * rad));
      const glm::dvec3 out(std::sin(polar * rad) * std::cos(azimuth * rad),
                           std::sin(polar * rad) * std::sin(azimuth * rad), std::cos(polar * rad));
      sum += core::ciede2000(core::lab_from_linear(truth(in, out) * std::numbers::pi),
                             core::lab_from_linear(shown(in, out) * std::numbers::pi));
      ++count;
    }
  EXPECT_LT(sum / count, 3.0);
  std::printf("  out of plane, %d geometries: CIEDE2000 mean %.2f\n", count, sum / count);
}

TEST(MapCapture, FlakesAreNotCountedTwice) {
  Capture capture = flop_paint(1.5);
  capture.angles = readings_of(capture);
  const auto whole = map_capture(capture, 1.5, 46);
  capture.layout = {2, {0, 2, 3}};
  capture.edge_texels = 2;
  capture.texel_mm = 0.1f;
  for (int slice = 0; slice < 3; ++slice) capture.slices.push_back({std::vector<glm::vec3>(4, glm::vec3(0.1f))});
  const auto less = map_capture(capture, 1.5, 46);
  ASSERT_TRUE(whole && less);
  EXPECT_NEAR(whole->table->linear[0].x - less->table->linear[0].x, 0.1f, 1e-5f);
  for (const glm::vec3& chi : less->table->linear) EXPECT_GE(chi.z, 0.0f);
}

TEST(MapCapture, RefusesWhatTellsNothing) {
  Capture capture = flop_paint(1.5);
  const auto nothing = map_capture(capture, 1.5, 46);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().field, "measured");
  capture.angles = {{45.0, 15.0, {50.0, 0.0, 0.0}}};
  EXPECT_FALSE(map_capture(capture, 1.5, 46)) << "one reading is no map";
  capture.angles = readings_of(flop_paint(1.5));
  EXPECT_FALSE(map_capture(capture, 3.0, 46)) << "no coat has this index";
}

TEST(CaptureError, IsNothingWhereTheModelIsTheMeasurementAndGrowsWhereItIsNot) {
  Capture capture = flop_paint(1.0);
  EXPECT_EQ(capture_error(capture).judged_by, JudgedBy::nothing);
  EXPECT_EQ(capture_error(capture).count, 0u);
  capture.measured = core::tabulate(capture_brdf(capture), {24, 24, 36});
  const FormError same = capture_error(capture);
  EXPECT_EQ(same.judged_by, JudgedBy::sphere);
  EXPECT_GT(same.count, 7000u);
  EXPECT_LT(same.e2000_max, 0.01f);
  capture.analytic.diffuse *= 0.8;
  EXPECT_GT(capture_error(capture).e2000_mean, 1.0f);
}

TEST(PackBuilder, StoresHowEachPaintCameToItsForm) {
  Capture mapped = flop_paint(1.5);
  mapped.angles = readings_of(mapped);
  const auto paint = map_capture(mapped, 1.5, 46);
  ASSERT_TRUE(paint);
  mapped.analytic = *paint;
  mapped.form = PaintForm::mapped;
  const auto built = build_pack(std::vector<Capture>{flop_paint(1.5), mapped}, {});
  ASSERT_TRUE(built) << built.error().line();
  EXPECT_EQ(built->info.errors[0].form, FormError{});
  EXPECT_EQ(built->info.errors[1].form, capture_error(mapped));
  EXPECT_EQ(built->info.errors[1].form.count, 12u);
}

}  // namespace
}  // namespace lackwerk::packs
