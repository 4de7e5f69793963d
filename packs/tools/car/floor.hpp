// The showroom floor under the car.
//
// Why it exists: the contact shadow is baked per vertex, so the floor must be fine exactly where the shadow changes.
// Pure function; the result belongs to the caller.
#pragma once

#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

struct FloorShape {
  double radius_mm = 7000.0;
  double half_length_mm = 2300.0;  ///< of the car above: the grid is densest along its edge
  double half_width_mm = 940.0;
  int cells_along = 56;  ///< under the car
  int cells_across = 26;
  int rings = 20;  ///< from the car's outline to the floor's edge
};

[[nodiscard]] Patch build_floor(const FloorShape& shape);

}  // namespace lackwerk::packs::car
