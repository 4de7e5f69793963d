// The showroom floor under the car.
//
// Why it exists: the contact shadow is baked per vertex, so the floor must be fine where the shadow changes. Pure
// function; the result belongs to the caller.
#pragma once

#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

/// A rectangle of even cells under and round the car, and rings that grow from it to a circle.
struct FloorShape {
  double half_length_mm = 2520.0;  ///< of the rectangle: the car and a little more
  double half_width_mm = 1140.0;
  double cell_mm = 60.0;  ///< the largest side of a cell
  int rings = 11;         ///< the first as wide as a cell or wider
  double radius_mm = 7000.0;
};

[[nodiscard]] Patch build_floor(const FloorShape& shape);

}  // namespace lackwerk::packs::car
