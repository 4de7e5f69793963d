#include "packs/tools/car/floor.hpp"

#include <cmath>
#include <glm/common.hpp>

namespace lackwerk::packs::car {

namespace {

/// Stretches [-1, 1] so that cells are smaller towards both ends.
double denser_at_ends(double t) { return std::sin(t * 1.2) / std::sin(1.2); }

}  // namespace

Patch build_floor(const FloorShape& shape) {
  Patch floor = grid(shape.cells_along + 1, shape.cells_across + 1, [&shape](int r, int c) {
    return Vec3{shape.half_length_mm * denser_at_ends(2.0 * r / shape.cells_along - 1.0),
                shape.half_width_mm * denser_at_ends(2.0 * c / shape.cells_across - 1.0), 0.0};
  });
  // Rings around that rectangle that grow wider and turn into a circle.
  std::vector<Vec3> edge;
  edge.reserve(2 * static_cast<std::size_t>(shape.cells_along + shape.cells_across));
  const auto at = [&](int r, int c) {
    return floor.positions[static_cast<std::size_t>(r) * static_cast<std::size_t>(shape.cells_across + 1) +
                           static_cast<std::size_t>(c)];
  };
  for (int r = 0; r < shape.cells_along; ++r) edge.push_back(at(r, 0));
  for (int c = 0; c < shape.cells_across; ++c) edge.push_back(at(shape.cells_along, c));
  for (int r = shape.cells_along; r > 0; --r) edge.push_back(at(r, shape.cells_across));
  for (int c = shape.cells_across; c > 0; --c) edge.push_back(at(0, c));
  const int around = static_cast<int>(edge.size());
  append(floor, grid(around + 1, shape.rings + 1, [&](int r, int ring) {
           const Vec3 inner = edge[static_cast<std::size_t>((around - r) % around)];
           const Vec3 outer = glm::normalize(inner) * shape.radius_mm;
           const double t = std::pow(static_cast<double>(ring) / shape.rings, 2.2);
           return inner + (outer - inner) * t;
         }));
  floor.normals.assign(floor.positions.size(), Vec3{0.0, 0.0, 1.0});
  return floor;
}

}  // namespace lackwerk::packs::car
