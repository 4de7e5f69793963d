#include "core/analysis/studio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lackwerk::core {
namespace {

// All places are in mm, axes as in packs/scene.hpp. Every lamp is a rectangle in its own plane, seen from the room's
// centre; ramps are cubic, so that no hard edge shows in a curved mirror.

double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3.0 - 2.0 * c);
}

/// 1 well inside |x| < half, 0 well outside, over a ramp of width 2 * soft around the edge.
double inside(double x, double half, double soft) { return smooth((half - std::abs(x)) / (2.0 * soft) + 0.5); }

/// A rectangle with rounded corners: 1 inside, 0 outside.
double rounded(double x, double y, double half_x, double half_y, double radius, double soft) {
  const double qx = std::max(std::abs(x) - half_x + radius, 0.0);
  const double qy = std::max(std::abs(y) - half_y + radius, 0.0);
  return smooth((radius - std::sqrt(qx * qx + qy * qy)) / (2.0 * soft) + 0.5);
}

/// Hall: dark walls, a soft band of light at the horizon, so that the outline of a dark car still reads, warmer towards
/// the nose and cooler towards the tail.
glm::dvec3 hall(const glm::dvec3& d) {
  const double band = std::exp(-7.0 * std::abs(d.z) * std::sqrt(d.z * d.z + 0.01));
  const double key = 0.5 + 0.5 * d.y;  // the key light's side is a little lighter
  const glm::dvec3 wall = glm::dvec3(0.020, 0.022, 0.026) + glm::dvec3(0.012, 0.012, 0.012) * key;
  const glm::dvec3 horizon =
      glm::mix(glm::dvec3(0.080, 0.090, 0.108), glm::dvec3(0.100, 0.094, 0.088), 0.5 + 0.5 * d.x);
  return wall + horizon * (band * (0.75 + 0.5 * key));
}

/// Overhead, 3.3 m high: a soft box 6.4 m long and 1.9 m wide, brightest along its key edge and falling off to the
/// other side and towards its ends, as cloth lit from one edge does; beside it two slim tubes, the lines that draw a
/// shoulder.
glm::dvec3 overhead(const glm::dvec3& d) {
  if (d.z < 0.05) return glm::dvec3(0.0);
  const glm::dvec3 q = d * ((3300.0 - 700.0) / d.z);
  const double across = q.y / 950.0;  // -1 at the far edge, 1 at the key edge
  const double along = q.x / 3200.0;
  const double cloth = (0.28 + 0.72 * smooth(0.5 + 0.55 * across)) * (1.0 - 0.45 * along * along);
  const double box = 4.3 * cloth * rounded(q.x, q.y, 3200.0, 950.0, 260.0, 90.0);
  const double ends = inside(q.x, 3300.0, 220.0);
  const double tubes = 13.0 * ends * inside(std::abs(q.y) - 1720.0, 80.0, 34.0);
  const double spill = 0.16 * std::exp(-0.5 * (q.x * q.x / 9.0e6 + q.y * q.y / 2.6e6));  // on the ceiling
  return glm::dvec3(1.0, 0.99, 0.97) * box + glm::dvec3(0.94, 1.0, 1.08) * tubes +
         glm::dvec3(0.95, 1.0, 1.06) * (spill * smooth((d.z - 0.05) / 0.3));
}

/// Flank panels, 4.6 m from the middle and 7.6 m long: bright at their upper edge, fading downwards; the left one is
/// the key, the right one a narrower, cooler fill.
glm::dvec3 flanks(const glm::dvec3& d) {
  if (std::abs(d.y) < 0.05) return glm::dvec3(0.0);
  const bool key = d.y > 0.0;
  const glm::dvec3 q = d * (4600.0 / std::abs(d.y)) + glm::dvec3(0.0, 0.0, 700.0);
  const double x = q.x - 300.0;
  const double middle = key ? 1420.0 : 1250.0;
  const double half = key ? 760.0 : 460.0;
  const double up = (q.z - middle) / half;
  const double fade = (0.25 + 0.75 * smooth(0.5 + 0.5 * up)) * (1.0 - 0.35 * (x / 3800.0) * (x / 3800.0));
  const double shape = rounded(x, q.z - middle, 3800.0, half, 220.0, 110.0);
  return (key ? glm::dvec3(2.55, 2.48, 2.36) : glm::dvec3(1.35, 1.44, 1.58)) * (fade * shape);
}

/// Boxes before the nose and behind the tail, 6.5 m away, brighter in their middle.
glm::dvec3 ends(const glm::dvec3& d) {
  if (std::abs(d.x) < 0.05) return glm::dvec3(0.0);
  const glm::dvec3 q = d * (6500.0 / std::abs(d.x)) + glm::dvec3(0.0, 0.0, 700.0);
  const double shape = rounded(q.y, q.z - 1500.0, 1500.0, 620.0, 260.0, 150.0);
  const double glow = 0.55 + 0.45 * std::exp(-1.4 * (q.y * q.y / 2.25e6 + (q.z - 1700.0) * (q.z - 1700.0) / 0.5e6));
  return (d.x > 0.0 ? glm::dvec3(1.55, 1.56, 1.58) : glm::dvec3(1.30, 1.35, 1.45)) * (glow * shape);
}

/// Spots under the ceiling: small, very bright, what makes flakes sparkle and a coat glint.
struct Spot {
  glm::dvec3 place;  ///< from the room's centre, mm
  double radius_deg;
  double radiance;
};
constexpr std::array<Spot, 8> spots = {{
    {{3600.0, 2500.0, 2300.0}, 0.95, 110.0},
    {{1300.0, 2800.0, 2450.0}, 0.85, 85.0},
    {{-1300.0, 2800.0, 2450.0}, 0.85, 85.0},
    {{-3700.0, 2400.0, 2300.0}, 1.05, 120.0},
    {{3700.0, -2450.0, 2300.0}, 1.05, 120.0},
    {{1200.0, -2850.0, 2450.0}, 0.80, 70.0},
    {{-1400.0, -2750.0, 2450.0}, 0.80, 70.0},
    {{-3600.0, -2500.0, 2300.0}, 0.95, 100.0},
}};

glm::dvec3 spot_light(const glm::dvec3& d) {
  constexpr double degree = 3.14159265358979323846 / 180.0;
  double sum = 0.0;
  for (const Spot& spot : spots) {
    const glm::dvec3 axis = glm::normalize(spot.place);
    if (glm::dot(d, axis) < 0.985) continue;  // 9.9 degrees: the halo has gone
    const double angle = 2.0 * std::asin(std::min(0.5 * glm::length(d - axis), 1.0)) / degree;
    sum += spot.radiance * smooth((spot.radius_deg - angle) / 0.4 + 0.5);
    sum += 0.5 * std::exp(-0.3 * angle * angle);  // a faint halo
  }
  return glm::dvec3(1.0, 0.965, 0.90) * sum;
}

/// Floor: a pool of light around the stage, brighter on the key side, fading into the dark of the hall.
glm::dvec3 floor_light(const glm::dvec3& d) {
  const glm::dvec3 q = d * (700.0 / std::max(-d.z, 0.02));
  const double r2 = (q.x * q.x * 0.5 + (q.y - 400.0) * (q.y - 400.0)) * 1e-6;
  return glm::dvec3(1.0, 0.99, 0.97) * (0.045 + 0.36 * std::exp(-0.06 * r2));
}

}  // namespace

glm::dvec3 studio_radiance(const glm::dvec3& d) {
  const double down = smooth(0.5 - d.z / 0.10);
  const glm::dvec3 above = down < 1.0 ? hall(d) + overhead(d) + flanks(d) + ends(d) + spot_light(d) : glm::dvec3(0.0);
  return above * (1.0 - down) + (down > 0.0 ? floor_light(d) * down : glm::dvec3(0.0));
}

Environment build_studio() {
  return build_environment(
      "studio", [](const glm::dvec3& d) { return studio_radiance(d); }, studio_room);
}

}  // namespace lackwerk::core
