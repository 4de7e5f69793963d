// The built-in studio: a dark hall with lights, as one would plan it to photograph a car.
//
// Why it exists: the kiosk must show a good picture without any downloaded map. It is a formula, so it costs no bytes
// and no licence; the scene builder turns it into an environment like any map. Pure functions; any thread.
#pragma once

#include <glm/vec3.hpp>

#include "core/analysis/environment_build.hpp"

namespace lackwerk::core {

/// The studio's room: seen from 0.7 m above the floor under the middle of the car.
inline constexpr EnvironmentRoom studio_room = {7200.0f, {0.0f, 0.0f, 700.0f}};

/// Linear sRGB radiance that reaches the room's centre from direction d (unit), relative to the exposure: 1 is what a
/// white surface in full light shows. Smooth everywhere; lamps are at least 1.5 degrees wide.
[[nodiscard]] glm::dvec3 studio_radiance(const glm::dvec3& d);

/// The environment "studio".
[[nodiscard]] Environment build_studio();

}  // namespace lackwerk::core
