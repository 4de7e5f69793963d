// One wheel: tyre, multi-spoke rim, brake disc and caliper.
//
// Why it exists: wheels carry half of a car's stance. Built at the origin with the axle along y and the outer face
// towards +y; the caller places copies. Pure function, values out.
#pragma once

#include "packs/tools/car/body_shape.hpp"
#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

/// Millimetres; y is measured from the tyre's outer flank (negative = inward).
struct WheelShape {
  double rim_radius_mm = 268.0;  ///< to the outer edge of the rim flange
  int spoke_pairs = 5;
  double spoke_hub_radius_mm = 52.0;
  double spoke_end_radius_mm = 256.0;
  double spoke_hub_y_mm = -40.0;  ///< face of the spokes at the hub: a dished wheel
  double spoke_end_y_mm = -14.0;
  double spoke_hub_half_width_mm = 19.0;
  double spoke_end_half_width_mm = 11.5;
  double spoke_hub_gap_mm = 15.0;  ///< half the distance of a pair's middles at the hub
  double spoke_end_gap_mm = 47.0;  ///< and at the rim: a V that opens outward
  double spoke_depth_hub_mm = 52.0;
  double spoke_depth_end_mm = 30.0;
  double spoke_bevel_mm = 5.0;
  double disc_radius_mm = 192.0;
  double disc_y_mm = -108.0;
  double hub_radius_mm = 74.0;
};

struct WheelPatches {
  Patch tyre;     ///< rubber
  Patch rim;      ///< rim, spokes, disc
  Patch caliper;  ///< trim
  Patch cap;      ///< chrome
};

[[nodiscard]] WheelPatches build_wheel(const WheelLayout& layout, const WheelShape& shape);

}  // namespace lackwerk::packs::car
