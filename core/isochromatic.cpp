#include "core/isochromatic.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace lackwerk::core {

using glm::dvec2;
using glm::dvec3;

namespace {

using Model = IsochromaticModel<double>;
const dvec3 up(0.0, 0.0, 1.0);

/// The index inside the computation: cure C takes the coat away.
double effective(double index, CriticalAngleCure cure) {
  check_at_most(1.0, index, "index of a coat");
  return cure == CriticalAngleCure::index_one ? 1.0 : index;
}

/// 1 - cos of an angle to the angle, without cancellation at small ones.
double angle_of(double versine) { return 2.0 * std::asin(std::sqrt(0.5 * std::clamp(versine, 0.0, 1.0))); }

dvec2 cured(const dvec2& sines, CriticalAngleCure cure) {
  if (cure == CriticalAngleCure::slide) return Model{}.isochromatic_slide(sines, 1.0);
  if (cure == CriticalAngleCure::slide_along) return Model{}.isochromatic_slide(sines, -1.0);
  return Model{}.isochromatic_clip(sines);
}

std::array<InPlane, 2> both(const dvec2& place) {
  const double light = angle_of(place.x), eye = angle_of(std::abs(place.y));
  const double side = place.y < 0.0 ? -1.0 : 1.0;
  return {InPlane{light, side * eye}, InPlane{eye, side * light}};
}

}  // namespace

FlakeAngles flake_angles(const dvec3& in, const dvec3& out, double index) {
  const auto line = Model{}.isoline(up, in, out, effective(index, CriticalAngleCure::clip));
  return {std::atan2(line.difference, std::hypot(line.along, line.across)), std::atan2(line.across, line.along)};
}

dvec2 map_place(const dvec3& in, const dvec3& out, double index, CriticalAngleCure cure) {
  const double n = effective(index, cure);
  return cured(Model{}.isochromatic_sines(Model{}.isoline(up, in, out, n), n), cure);
}

std::array<InPlane, 2> in_plane(const dvec3& in, const dvec3& out, double index, CriticalAngleCure cure) {
  return both(map_place(in, out, index, cure));
}

std::array<InPlane, 2> in_plane(const FlakeAngles& flake, double index, CriticalAngleCure cure) {
  const double n = effective(index, cure);
  const auto sine = [n](double inside) { return n * std::sin(inside); };
  // As in isochromatic_sines: beyond 90 degrees inside the sine would fall again.
  const double steep = std::min(flake.theta_inc + flake.theta_flake, std::asin(1.0));
  return both(cured({sine(steep), std::clamp(sine(flake.theta_inc - flake.theta_flake), -1.0, 1.0)}, cure));
}

InPlaneDirections in_plane_directions(const InPlane& geometry) {
  return {{std::sin(geometry.light), 0.0, std::cos(geometry.light)},
          {-std::sin(geometry.eye), 0.0, std::cos(geometry.eye)}};
}

bool needs_cure(const dvec3& in, const dvec3& out, double index) {
  const FlakeAngles flake = flake_angles(in, out, index);
  return flake.theta_inc + flake.theta_flake > std::asin(1.0 / index);
}

}  // namespace lackwerk::core
