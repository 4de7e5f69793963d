// A colour map as a paint: a colour table below a clear coat, and nothing else.
//
// Why it exists: packs mix lobes, colour tables and slices. A paint known by six readings in the plane of incidence has
// none of them, but its map (colour_map.hpp) tells every pair of directions; averaged over phi_d it becomes the colour
// table of a white diffuse part, which mixes with anything. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "core/analysis/colour_map.hpp"
#include "core/paint.hpp"

namespace lackwerk::core {

/// The share of light that passes a coat of this index on its way in and out again: (1 - F(in)) (1 - F(out)), F the
/// dielectric's Fresnel reflectance. Unit directions above the horizon; `index` >= 1. A carrier for colour maps
/// (ColourMapSettings::carrier): what is left is the paint below the coat.
[[nodiscard]] double coat_transmission(const glm::dvec3& in, const glm::dvec3& out, double index);

/// diffuse = 1, no lobes, chi(theta_h, theta_i) = the map's radiance factor over its carrier, mean over phi_d of the
/// pairs that reach air; nodes that no such pair has take the nearest one that has, at smaller theta_h first.
/// Directions bend by the map's index; `coat_ior` is what the paint mirrors and loses light by: the index where the
/// carrier is coat_transmission, 1 where there is none. `num_theta` in [2, 256].
[[nodiscard]] AnalyticPaint paint_of_map(const ColourMap& map, double coat_ior, std::uint16_t num_theta);

}  // namespace lackwerk::core
