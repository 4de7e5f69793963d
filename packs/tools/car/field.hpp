// Implicit surfaces: a solid is where a function is negative.
//
// Why it exists: mesher, cutter and details all ask the same three questions of a shape (inside or outside, which way
// is out, where is the nearest surface point), whatever the shape is made of. Fields are immutable after
// construction and may be shared between threads; nobody here owns one.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace lackwerk::packs::car {

using Vec3 = glm::dvec3;

/// A smooth solid. Values are roughly signed distances in millimetres, negative inside.
class Field {
 public:
  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field() = default;

  [[nodiscard]] virtual double value(const Vec3& p) const = 0;
};

/// Gradient by central differences; in double precision good to about 1e-8, far below what an 8-bit picture shows.
[[nodiscard]] Vec3 gradient(const Field& field, const Vec3& p);

/// Outward unit normal of the level surface through p.
[[nodiscard]] inline Vec3 unit_normal(const Field& field, const Vec3& p) { return glm::normalize(gradient(field, p)); }

/// Moves p onto the surface along the gradient. A point in the symmetry plane y = 0 stays in it exactly.
[[nodiscard]] Vec3 project_to_surface(const Field& field, Vec3 p);

}  // namespace lackwerk::packs::car
