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

[[nodiscard]] BodyParts build_body(const BodyField& body, const BodyGraphics& graphics, const BodyShape& shape);

}  // namespace lackwerk::packs::car
