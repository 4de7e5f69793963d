// Directions in the plane of incidence, as the trade's aspecular angles name them.
//
// Why it exists: the interface's three shop angles and the tools' twelve must mean the same directions. Pure; any
// thread.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>

namespace lackwerk::core {

/// The unit direction in the plane of incidence (xz, normal +z) that lies `degrees` from the normal on the light's
/// side.
[[nodiscard]] inline glm::dvec3 in_plane_direction(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {std::sin(angle), 0.0, std::cos(angle)};
}

/// Where the eye stands, degrees from the normal on the light's side: the mirror direction is at -light_deg, and
/// aspecular angles count from there towards the light (ASTM E2194, E2539).
[[nodiscard]] constexpr double eye_deg(double light_deg, double aspecular_deg) { return aspecular_deg - light_deg; }

}  // namespace lackwerk::core
