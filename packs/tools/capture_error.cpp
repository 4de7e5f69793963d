#include "packs/tools/capture_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/colour.hpp"
#include "core/in_plane.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/fit_picture.hpp"

namespace lackwerk::packs {
namespace {

/// Pixels along an edge of the sphere that is judged; 7,200 of them show it.
constexpr int judged_edge = 96;

FormError over_readings(const Capture& capture, const core::Brdf& model) {
  std::vector<double> differences;
  double sum = 0.0;
  for (const AngleReading& reading : capture.angles) {
    const core::DirectionPair at = reading_sample(reading).directions;
    differences.push_back(core::ciede2000(reading.lab, core::lab_from_linear(model(at.in, at.out) * std::numbers::pi)));
    sum += differences.back();
  }
  std::sort(differences.begin(), differences.end());
  const std::size_t count = differences.size();
  // Nearest rank, as on the sphere.
  const auto p95 = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(count))) - 1;
  return {capture.form,
          JudgedBy::readings,
          static_cast<std::uint32_t>(count),
          static_cast<float>(sum / static_cast<double>(count)),
          static_cast<float>(differences[p95]),
          static_cast<float>(differences.back())};
}

}  // namespace

ReadingSample reading_sample(const AngleReading& reading) {
  ReadingSample out;
  out.directions = {core::in_plane_direction(reading.light_deg),
                    core::in_plane_direction(core::eye_deg(reading.light_deg, reading.aspecular_deg))};
  const glm::dvec3 radiance_factor = core::linear_from_lab(reading.lab);
  for (int c = 0; c < 3; ++c) out.brdf[c] = std::max(0.0, radiance_factor[c]) / std::numbers::pi;
  return out;
}

FormError capture_error(const Capture& capture, const core::Brdf& model) {
  if (capture.measured) {
    const core::SphereComparison spheres = compare_fit(*capture.measured, model, judged_edge);
    return {capture.form,
            JudgedBy::sphere,
            static_cast<std::uint32_t>(spheres.pixels),
            static_cast<float>(spheres.mean),
            static_cast<float>(spheres.p95),
            static_cast<float>(spheres.max)};
  }
  if (!capture.angles.empty()) return over_readings(capture, model);
  return {capture.form, JudgedBy::nothing, 0, 0.0f, 0.0f, 0.0f};
}

FormError capture_error(const Capture& capture) { return capture_error(capture, capture_brdf(capture)); }

}  // namespace lackwerk::packs
