// Makes the environment that a scene carries out of a map or of a function of direction.
//
// Why it exists: everything that happens to the light before it becomes bytes happens here, once, in the scene builder:
// resampling, prefiltering, the cut into lights, encoding. Pure functions that share their work among threads of their
// own; the same input gives the same bytes however many there are.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "core/analysis/environment_filter.hpp"
#include "core/analysis/environment_latlong.hpp"
#include "core/environment.hpp"

namespace lackwerk::core {

/// Where the light is painted: see environment.hpp.
struct EnvironmentRoom {
  float radius_mm = 0.0f;  ///< >= 0; 0 = infinitely far
  glm::vec3 centre_mm{0.0f};
};

/// Level 0 shows the means of `radiance` over its texels (samples x samples directions each, 1 or more). Levels 1 to 9
/// and the lights are made of what level 0 shows when it is read back, so that renderer and reference share one
/// truth. Texels are chosen so that the *filtered* picture keeps the light: a filter over square roots alone would
/// darken every edge of a lamp. The range is the brightest texel's, nothing is clipped.
[[nodiscard]] Environment build_environment(const std::string& name, const Radiance& radiance,
                                            const EnvironmentRoom& room, int samples = 4);
/// From a map that `repair` accepted. Maps wider than 2048 pixels are reduced first.
[[nodiscard]] Environment build_environment(const LatLongMap& map, const EnvironmentRoom& room);

/// What a level shows: means of its linearly filtered picture over its texels.
[[nodiscard]] OctahedralImage shown_means(const Environment& environment, int level);

/// Integral of a map over the sphere (radiance times steradians).
[[nodiscard]] glm::dvec3 sphere_integral(const OctahedralImage& image);

}  // namespace lackwerk::core
