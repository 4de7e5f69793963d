#include "core/analysis/standard_angles.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/colour.hpp"
#include "core/in_plane.hpp"

namespace lackwerk::core {
namespace {

constexpr std::array<MeasuringAngle, 12> twelve{{{45.0, 15.0},
                                                 {45.0, 25.0},
                                                 {45.0, 45.0},
                                                 {45.0, 75.0},
                                                 {45.0, 110.0},
                                                 {45.0, -15.0},
                                                 {15.0, -45.0},
                                                 {15.0, -30.0},
                                                 {15.0, -15.0},
                                                 {15.0, 15.0},
                                                 {15.0, 45.0},
                                                 {15.0, 80.0}}};

/// Instruments are adjusted to about 0.1 degrees (E2194 asks for 0.15): anything closer is the same name rounded.
constexpr double same_deg = 0.05;

bool same(const MeasuringAngle& a, const MeasuringAngle& b) {
  return std::abs(a.light_deg - b.light_deg) <= same_deg && std::abs(a.aspecular_deg - b.aspecular_deg) <= same_deg;
}

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

std::span<const MeasuringAngle> standard_angles() { return twelve; }

std::string angle_name(const MeasuringAngle& angle) {
  return shortest(angle.aspecular_deg) + "as" + shortest(angle.light_deg);
}

std::optional<glm::dvec3> colour_at(const PartialBrdf& brdf, const MeasuringAngle& angle) {
  const glm::dvec3 light = in_plane_direction(angle.light_deg);
  const glm::dvec3 eye = in_plane_direction(eye_deg(angle.light_deg, angle.aspecular_deg));
  if (light.z <= 0.0 || eye.z <= 0.0) return std::nullopt;
  const std::optional<glm::dvec3> f = brdf(light, eye);
  if (!f) return std::nullopt;
  return lab_from_linear(std::numbers::pi * *f);
}

AngleComparison compare_angles(std::span<const AngleColour> a, std::span<const AngleColour> b) {
  AngleComparison out;
  for (const AngleColour& one : a) {
    const auto other = std::find_if(b.begin(), b.end(), [&](const AngleColour& c) { return same(c.angle, one.angle); });
    if (other == b.end()) continue;
    out.angles.push_back({one.angle, one.lab, other->lab, ciede2000(one.lab, other->lab)});
    out.mean += out.angles.back().ciede2000;
    if (out.angles.back().ciede2000 > out.angles[out.worst].ciede2000) out.worst = out.angles.size() - 1;
  }
  if (!out.angles.empty()) out.mean /= static_cast<double>(out.angles.size());
  return out;
}

}  // namespace lackwerk::core
