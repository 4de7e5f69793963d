// Isochromatic lines: the in-plane geometries that show the same colour as any pair of directions, in C++.
//
// Why it exists: an effect paint's colour follows from where its flakes stand (theta_flake) and how steeply they are
// lit (theta_inc), two numbers instead of three (Kirchner & Ferrero 2014; Kirchner et al. 2015, KI). A map over the
// plane of incidence, or a spectrophotometer that measures nothing else, then tells the whole paint. The mathematics is
// the text of isochromatic.glsl, at any scalar type: shader and CPU are the same. Pure functions; any thread.
//
// Directions are unit vectors away from the surface, z = normal, none below the horizon. Angles are radians. The
// index is that of the coat, [1, 2.5].
#pragma once

#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace lackwerk::core {

/// For scalar types whose square root is found beside them (16-bit ones) as well as for float and double.
template <class T>
[[nodiscard]] T square_root(T x) {
  using std::sqrt;
  return sqrt(x);
}

/// The shader's functions. T: float, double, or a 16-bit type with vectors of its own.
template <class T, class V2 = glm::vec<2, T>, class V3 = glm::vec<3, T>>
struct IsochromaticModel {
  using real = T;
  using vec2 = V2;
  using vec3 = V3;

  // ---- GLSL's built-in functions, at this scalar type
  static real sqrt(real x) { return square_root(x); }
  static real abs(real x) { return x < T(0) ? -x : x; }
  static real min(real a, real b) { return b < a ? b : a; }
  static real max(real a, real b) { return a < b ? b : a; }
  static real clamp(real x, real lo, real hi) { return min(max(x, lo), hi); }
  static real dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static real length(vec3 a) { return square_root(dot(a, a)); }
  static vec3 cross(vec3 a, vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  }

#define R(x) static_cast<real>(x)
#include "core/isochromatic.glsl"
#undef R
};

/// What to do where theta_inc + theta_flake is beyond the critical angle: no light in air goes that way inside the
/// coat (KI, "Limitations").
enum class CriticalAngleCure {
  clip,         ///< A: the angle in air becomes 90 degrees
  slide,        ///< B as printed: the place moves perpendicular to the gloss line to the map's edge
  slide_along,  ///< B the other way: beside the gloss line, which keeps the aspecular angle
  index_one,    ///< C: the coat is taken as air, so that nothing bends; grazing geometries still need A then
};

/// The flake that mirrors one direction into the other, inside the coat.
struct FlakeAngles {
  double theta_inc = 0.0;    ///< between light and flake normal, [0, asin(1 / index)]
  double theta_flake = 0.0;  ///< between flake normal and paint normal, [0, asin(1 / index)]
};
[[nodiscard]] FlakeAngles flake_angles(const glm::dvec3& in, const glm::dvec3& out, double index);

/// An in-plane geometry, in air.
struct InPlane {
  double light = 0.0;  ///< angle from the normal, [0, pi/2]
  double eye = 0.0;    ///< [-pi/2, pi/2]; above 0 opposite the light (phi' = 180), below on its side (phi' = 0)
};

/// The two in-plane geometries of a pair's isochromatic line: light and eye of one are eye and light of the other. The
/// first has the light at the larger angle, so that a pair which lies in the plane gives itself and its reverse.
[[nodiscard]] std::array<InPlane, 2> in_plane(const glm::dvec3& in, const glm::dvec3& out, double index,
                                              CriticalAngleCure cure);
/// The same from the flake's angles, for lines that are known by them.
[[nodiscard]] std::array<InPlane, 2> in_plane(const FlakeAngles& flake, double index, CriticalAngleCure cure);

/// The directions of an in-plane geometry: light and eye in the xz plane.
struct InPlaneDirections {
  glm::dvec3 in{0.0, 0.0, 1.0}, out{0.0, 0.0, 1.0};
};
[[nodiscard]] InPlaneDirections in_plane_directions(const InPlane& geometry);

/// theta_inc + theta_flake is beyond the critical angle at this index.
[[nodiscard]] bool needs_cure(const glm::dvec3& in, const glm::dvec3& out, double index);

/// Place in the colour map as it is drawn, see isochromatic.glsl: x = 1 - cos(theta'_ill) in [0, 1],
/// y = +-(1 - cos(theta'_det)) in [-1, 1]; |y| <= x up to rounding.
[[nodiscard]] glm::dvec2 map_place(const glm::dvec3& in, const glm::dvec3& out, double index, CriticalAngleCure cure);

}  // namespace lackwerk::core
