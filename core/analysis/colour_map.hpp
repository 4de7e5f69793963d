// The colour map: an effect paint over the plane of incidence alone, two angles instead of three.
//
// Why it exists: a spectrophotometer measures in the plane only, and a table of two angles fits any GPU; isochromatic
// lines (core/isochromatic.hpp) carry every other pair of directions into that plane (Kirchner et al. 2015, KI). Built
// from any BRDF or from readings in the plane. Values, read-only after making; any thread.
//
// Conventions as in brdf_table.hpp; a colour map holds radiance factors pi f (white = 1), linear sRGB. Its place is
// drawn as in KI's Figure 2: x = 1 - cos(theta'_ill), y = +-(1 - cos(theta'_det)), upper half phi' = 180.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/error.hpp"
#include "core/isochromatic.hpp"

namespace lackwerk::core {

/// How the nodes lie between the normal and 90 degrees.
enum class MapSpacing : std::uint8_t {
  half_angle,  ///< even in sqrt(1 - cos), which is nearly even in the angle
  cosine,      ///< even in the cosine, as KI draws it
};

struct ColourMapSettings {
  std::uint32_t edge = 64;  ///< nodes from the normal to 90 degrees, [2, 1024]; the map is edge x (2 edge - 1)
  double index = 1.5;       ///< of the coat, [1, 2.5]
  CriticalAngleCure cure = CriticalAngleCure::clip;
  MapSpacing spacing = MapSpacing::half_angle;
  /// The mirror image of the clear coat, taken off before anything is stored (KI subtract Fresnel's); empty: none.
  /// Look-ups do not put it back.
  Brdf gloss;
  /// Where the gloss is not known: nothing is read within this aspecular angle of the mirror direction. The colour
  /// there is the one at its border at the same theta'_ill + theta'_det. Spectrophotometers start at 15 degrees.
  double gloss_cut = 0.0;
  /// Grazing limit of what is read, (0, pi/2): a BRDF tells nothing at 90 degrees, and instruments end before.
  double steepest = 89.0 / 180.0 * 3.14159265358979323846;
  /// A known factor that is no property of a line, such as the coat's two transmissions: divided out of what is read,
  /// multiplied in again at the look-up. Above 0 for all directions above the horizon. Empty: 1, as in KI.
  std::function<double(const glm::dvec3& in, const glm::dvec3& out)> carrier;
};

class ColourMap {
 public:
  [[nodiscard]] const ColourMapSettings& settings() const { return settings_; }
  [[nodiscard]] std::uint32_t width() const { return settings_.edge; }
  [[nodiscard]] std::uint32_t height() const { return 2 * settings_.edge - 1; }
  /// Radiance factors over the carrier, width * height, the half phi' = 0 first, row by row; finite, >= 0. Symmetric
  /// under the exchange of light and eye.
  [[nodiscard]] const std::vector<glm::vec3>& nodes() const { return nodes_; }

  /// Radiance factor over the carrier at a place (isochromatic.glsl), bilinear.
  [[nodiscard]] glm::dvec3 at_place(const glm::dvec2& place) const;
  /// Radiance factor of any pair of unit directions, neither below the horizon.
  [[nodiscard]] glm::dvec3 factor(const glm::dvec3& in, const glm::dvec3& out) const;

 private:
  friend Result<ColourMap> colour_map_of(const Brdf&, const ColourMapSettings&);
  ColourMap() = default;
  ColourMapSettings settings_;
  std::vector<glm::vec3> nodes_;
};

/// Reads the BRDF at the in-plane geometry of every node, both ways round, and keeps the mean. Values that are not
/// finite are holes, filled from their neighbours; negative ones (noise, gloss taken off) become 0. Error: settings out
/// of range, or not one finite value.
[[nodiscard]] Result<ColourMap> colour_map_of(const Brdf& brdf, const ColourMapSettings& settings = {});

/// One in-plane measurement without gloss.
struct InPlaneReading {
  InPlane at;           ///< radians; the eye below 0 on the light's side
  glm::dvec3 lab{0.0};  ///< of the radiance factor, D65
};
inline constexpr std::size_t max_readings = 1024;

/// A whole BRDF from in-plane readings: in Lab, by kriging with a linear variogram over (theta_flake, theta_inc) inside
/// the coat of this index: exact at the readings, never steeper than between them, flat outside. Colour follows
/// theta_flake faster than theta_inc, whose distances count 0.15 (colour_map.cpp). Readings of one flake geometry count
/// as one, their mean. Errors name the reading: fewer than 2, more than max_readings, not finite, beyond the horizon.
[[nodiscard]] Result<Brdf> brdf_of_readings(std::span<const InPlaneReading> readings, double index);

// ---- comparing

/// Polar angles of light and eye from 0 to `steepest` and the azimuth between them from 0 to 180, degrees. The defaults
/// are the 448 geometries of KI's measurements: 8 x 8 x 7.
struct GeometryGrid {
  double polar_step = 10.0, steepest = 70.0, azimuth_step = 30.0;
  double least_aspecular = 0.0;  ///< geometries nearer to the mirror direction are left out
  bool in_plane = true;          ///< false: without azimuth 0 and 180 and without normal light or eye
  std::function<bool(const glm::dvec3& in, const glm::dvec3& out)> keep;  ///< others are left out; empty: all stay
};
struct ColourError {
  double mean = 0.0, p95 = 0.0, max = 0.0;
};
struct BrdfComparison {
  ColourError ab, e2000;       ///< dE*ab (CIE 1976) and CIEDE2000
  std::size_t geometries = 0;  ///< compared
  std::size_t left_out = 0;    ///< by the grid's own rules, or not finite in either
};
/// Colour differences of two BRDFs as Lab of their radiance factors (white = 100).
[[nodiscard]] BrdfComparison compare(const Brdf& a, const Brdf& b, const GeometryGrid& grid = {});

}  // namespace lackwerk::core
