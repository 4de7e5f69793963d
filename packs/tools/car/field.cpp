#include "packs/tools/car/field.hpp"

#include <cmath>

namespace lackwerk::packs::car {

Vec3 gradient(const Field& field, const Vec3& p) {
  constexpr double step_mm = 0.02;
  Vec3 g;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 a = p;
    Vec3 b = p;
    a[axis] -= step_mm;
    b[axis] += step_mm;
    g[axis] = (field.value(b) - field.value(a)) / (2.0 * step_mm);
  }
  return g;
}

Vec3 project_to_surface(const Field& field, Vec3 p) {
  constexpr int max_steps = 8;
  constexpr double tolerance_mm = 1e-4;
  const bool on_centreline = p.y == 0.0;
  for (int i = 0; i < max_steps; ++i) {
    const double f = field.value(p);
    if (std::abs(f) < tolerance_mm) break;
    const Vec3 g = gradient(field, p);
    p -= g * (f / glm::dot(g, g));
    if (on_centreline) p.y = 0.0;
  }
  return p;
}

}  // namespace lackwerk::packs::car
