// A picture of all directions as it comes out of a file, before it becomes an environment.
//
// Why it exists: HDR maps are kept as lat-long pictures; here stands which pixel is which direction, and what happens
// to pixels that are no light at all. A value; any thread.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::core {

/// Linear sRGB radiances, width = 2 height, row 0 first. Row y looks down from +z by (y + 0.5) / height * 180 degrees.
/// The middle of the picture looks along +x (the car's nose), its left half along +y (the car's left side), both ends
/// along -x: column x has the azimuth (0.5 - (x + 0.5) / width) * 360 degrees from +x towards +y.
struct LatLongMap {
  std::string name;  ///< for messages and for the environment made of it
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;
};

/// Radiance of a unit direction, linear sRGB, finite and >= 0. Called from several threads at once.
using Radiance = std::function<glm::dvec3(const glm::dvec3&)>;

struct MapRepairs {
  int negative = 0;    ///< pixels with a channel below 0, which became 0
  int not_finite = 0;  ///< pixels with NaN or an infinity, which became the mean of their valid neighbours
};

/// Mends a map. Fails where mending would be guessing: more than 1 % of the pixels bad, no light at all, no pixels, a
/// number of pixels that does not fit its size, or a shape that is not 2 : 1 (one pixel more or less is accepted).
[[nodiscard]] Result<MapRepairs> repair(LatLongMap& map);

/// The map between its pixels: linear, round the azimuth and over the poles. The map must outlive the function.
[[nodiscard]] Radiance radiance_of(const LatLongMap& map);

/// Half as wide and high, each pixel the mean of four by solid angle, until it is at most `width` wide (stops where a
/// size is odd). Keeps the light of the whole sphere to rounding.
[[nodiscard]] LatLongMap reduced(LatLongMap map, int width);

/// Solid angle of a pixel of row y, steradians.
[[nodiscard]] double pixel_solid_angle(const LatLongMap& map, int y);

}  // namespace lackwerk::core
