#include "packs/tools/map_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/analysis/colour_map.hpp"
#include "core/analysis/map_paint.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/capture_brdf.hpp"

namespace lackwerk::packs {
namespace {

constexpr double rad = std::numbers::pi / 180.0;
/// The aspecular angle nearest to the mirror direction of all standard geometries (ASTM E2194, E2539).
constexpr double gloss_cut = 15.0 * rad;
/// Beyond it a coat of 1.5 lets in less than 0.61 of the light, twice: divided by that, noise would be all there is.
constexpr double steepest = 80.0 * rad;

Result<core::Brdf> measured_brdf(const Capture& capture, double ior) {
  if (!capture.angles.empty()) {
    std::vector<core::InPlaneReading> readings;
    for (const AngleReading& reading : capture.angles)
      readings.push_back(
          {{reading.light_deg * rad, -core::eye_deg(reading.light_deg, reading.aspecular_deg) * rad}, reading.lab});
    return core::brdf_of_readings(readings, ior);
  }
  if (!capture.measured)
    return fail("", "measured", "holds nothing that was measured", "make it with `lackwerk import`");
  // A hole is no number, which the map fills from its neighbours.
  return core::Brdf([&table = *capture.measured](const glm::dvec3& in, const glm::dvec3& out) {
    return table.at(in, out).value_or(glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  });
}

/// Flakes are drawn by themselves: the table must not hold them too.
void take_flakes_out(const Capture& capture, core::ColourTable& table) {
  const core::MeanFlakes flakes = mean_flakes(capture);
  if (!flakes) return;
  const double step = 0.5 * std::numbers::pi / (table.num_theta - 1);
  for (std::size_t k = 0; k < table.linear.size(); ++k) {
    const std::size_t column = k % table.num_theta, row = k / table.num_theta;
    const double theta_h = static_cast<double>(column) * step, theta_i = static_cast<double>(row) * step;
    const glm::dvec3 mean = flakes(theta_h, theta_i);
    for (int c = 0; c < 3; ++c) table.linear[k][c] = std::max(0.0f, table.linear[k][c] - static_cast<float>(mean[c]));
  }
}

}  // namespace

Result<core::AnalyticPaint> map_capture(const Capture& capture, double ior, std::uint16_t nodes) {
  const auto brdf = measured_brdf(capture, ior);
  if (!brdf) return tl::unexpected(brdf.error());
  core::ColourMapSettings settings;
  settings.index = ior;
  settings.steepest = steepest;
  if (ior > 1.0) {
    settings.gloss_cut = gloss_cut;
    settings.carrier = [ior](const glm::dvec3& in, const glm::dvec3& out) {
      return core::coat_transmission(in, out, ior);
    };
  }
  const auto map = core::colour_map_of(*brdf, settings);
  if (!map) return tl::unexpected(map.error());
  core::AnalyticPaint paint = core::paint_of_map(*map, ior, nodes);
  take_flakes_out(capture, *paint.table);
  return paint;
}

}  // namespace lackwerk::packs
