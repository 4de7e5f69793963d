#include "packs/tools/car/floor.hpp"

#include <cmath>
#include <glm/common.hpp>

namespace lackwerk::packs::car {

Patch build_floor(const FloorShape& shape) {
  const int along = static_cast<int>(std::ceil(2.0 * shape.half_length_mm / shape.cell_mm));
  const int across = static_cast<int>(std::ceil(2.0 * shape.half_width_mm / shape.cell_mm));
  Patch floor = grid(along + 1, across + 1, [&](int r, int c) {
    return Vec3{shape.half_length_mm * (2.0 * r / along - 1.0), shape.half_width_mm * (2.0 * c / across - 1.0), 0.0};
  });
  // Rings around that rectangle that grow wider and turn into a circle.
  std::vector<Vec3> edge;
  edge.reserve(2 * static_cast<std::size_t>(along + across));
  const auto at = [&](int r, int c) {
    return floor
        .positions[static_cast<std::size_t>(r) * static_cast<std::size_t>(across + 1) + static_cast<std::size_t>(c)];
  };
  for (int r = 0; r < along; ++r) edge.push_back(at(r, 0));
  for (int c = 0; c < across; ++c) edge.push_back(at(along, c));
  for (int r = along; r > 0; --r) edge.push_back(at(r, across));
  for (int c = across; c > 0; --c) edge.push_back(at(0, c));
  const int around = static_cast<int>(edge.size());
  constexpr double growth = 1.9;  // the first of eleven rings is about as wide as a cell
  append(floor, grid(around + 1, shape.rings + 1, [&](int r, int ring) {
           const Vec3 inner = edge[static_cast<std::size_t>((around - r) % around)];
           const Vec3 outer = glm::normalize(inner) * shape.radius_mm;
           const double t = std::pow(static_cast<double>(ring) / shape.rings, growth);
           return inner + (outer - inner) * t;
         }));
  floor.normals.assign(floor.positions.size(), Vec3{0.0, 0.0, 1.0});
  return floor;
}

}  // namespace lackwerk::packs::car
