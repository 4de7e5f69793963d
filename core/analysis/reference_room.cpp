#include "core/analysis/reference_room.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace lackwerk::core {
namespace {

using glm::dvec3;

/// room_direction sends flatter directions to the wall even where the floor comes first.
constexpr double flattest = -1e-4;
/// A spot nearer than this to the room's radius (relative, squared) is on the wall, not the floor.
constexpr double on_wall = 1.0 - 1e-9;

}  // namespace

RoomSampler::RoomSampler(const Environment& environment)
    : sampler_(environment), centre_(environment.centre_mm), radius_(static_cast<double>(environment.room_radius_mm)) {}

bool RoomSampler::reaches(const dvec3& p) const {
  if (radius_ <= 0.0) return true;
  const dvec3 q = p - centre_;
  return centre_.z > 0.0 && p.z >= 0.0 && glm::dot(q, q) < 0.98 * radius_ * radius_;
}

std::optional<dvec3> RoomSampler::sample(const dvec3& p, const glm::dvec2& u) const {
  const dvec3 w = sampler_.sample(u).direction;
  if (radius_ <= 0.0) return w;
  const double to_floor = w.z < 0.0 ? centre_.z / -w.z : 2.0 * radius_;
  const dvec3 d = glm::normalize(w * std::min(to_floor, radius_) - (p - centre_));
  if (to_floor < radius_ && d.z >= flattest) return std::nullopt;
  return d;
}

double RoomSampler::pdf(const dvec3& p, const dvec3& d, const dvec3& room) const {
  if (radius_ <= 0.0) return sampler_.pdf(d);
  const double squared = glm::dot(room, room);
  const dvec3 w = room / std::sqrt(squared);
  const dvec3 q = room - (p - centre_);
  const double away = glm::dot(q, q);
  if (d.z < flattest && squared < radius_ * radius_ * on_wall)
    return sampler_.pdf(w) * (w.z * away) / (d.z * squared);  // the floor: N = +z, both cosines negative
  if (room.z + centre_.z < 0.0) return 0.0;                   // the strip below the horizon that sample() leaves out
  return sampler_.pdf(w) * away / (glm::dot(w, d) * squared);
}

}  // namespace lackwerk::core
