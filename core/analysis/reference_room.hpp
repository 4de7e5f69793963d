// Directions drawn in proportion to the environment, as seen from any point of the room.
//
// Why it exists: EnvironmentSampler draws directions from the room's centre; seen from a point p the same spot of the
// wall lies elsewhere and fills another solid angle. The density follows by the Jacobian through the area of the wall
// or floor: d omega_centre / d omega_p = (N.w / |X - c|^2) / (N.d / |X - p|^2). Read-only after it was made: any
// thread. Geometry of the room: core/environment.glsl, room_direction.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/environment.hpp"

namespace lackwerk::core {

class RoomSampler {
 public:
  explicit RoomSampler(const Environment& environment);

  /// Whether directions can be drawn from p (mm): inside the room.
  [[nodiscard]] bool reaches(const glm::dvec3& p) const;

  /// A unit direction from p, or nothing where the spot drawn cannot be seen from p. u in [0, 1)^2. p: reached.
  [[nodiscard]] std::optional<glm::dvec3> sample(const glm::dvec3& p, const glm::dvec2& u) const;

  /// Its density per steradian around p. `room`: room_direction(p, d), which whoever looks the light up has already.
  [[nodiscard]] double pdf(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& room) const;

 private:
  EnvironmentSampler sampler_;
  glm::dvec3 centre_;
  double radius_;  ///< 0 = far away
};

}  // namespace lackwerk::core
