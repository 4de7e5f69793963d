// Turns body field and graphics into finished patches.
//
// Why it exists: here the body is meshed, cut, sorted by material, and given depth where flat regions would look like
// stickers: intakes, grooves, wheel openings. Pure function; the result belongs to the caller.
#pragma once

#include <map>
#include <utility>

#include "packs/tools/car/body_graphics.hpp"
#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

/// Everything of the left half, by region, and what gives the flat regions depth.
struct BodyParts {
  std::map<Region, Patch> regions;
  Patch lip;     ///< painted returns at the wheel openings, hollow of the plate
  Patch dark;    ///< shut lines, inside of intakes, wheel wells
  Patch lining;  ///< inside of roof and pillars
};

/// How finely the outside is meshed.
struct BodyFineness {
  double edge_scale = 1.0;         ///< of what the drawing asks for: borders fine, open surface coarser
  double bend_deg = 12.0;          ///< between the normals at both ends of an edge
  double glossy_error_deg = 0.26;  ///< of an interpolated normal on paint: below it reflections look ragged
  double glass_error_deg = 0.9;
  double shortest_edge_mm = 8.0;
};

[[nodiscard]] BodyParts build_body(const BodyField& body, const BodyGraphics& graphics, const BodyShape& shape,
                                   const BodyFineness& fineness);

}  // namespace lackwerk::packs::car
