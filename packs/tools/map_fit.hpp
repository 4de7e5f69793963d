// A capture's model from an isochromatic colour map, where too little was measured for lobes.
//
// Why it exists: six readings of a spectrophotometer lie in the plane of incidence; lobes fitted to them guess what
// happens beside it, isochromatic lines know (core/isochromatic.hpp). A whole measured BRDF can go the same way, to see
// what the map costs. Pure functions; any thread.
#pragma once

#include <cstdint>

#include "core/error.hpp"
#include "core/paint.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// The readings, or where there are none the measured BRDF, as a colour table below a coat of index `ior` ([1, 2.5]; 1:
/// no coat), less the capture's mean flakes. With a coat nothing is taken from within 15 degrees of the mirror
/// direction, where its gloss is: instruments do not measure there either. `nodes`: of the table, [2, 256]. Errors name
/// the field: nothing measured, fewer than two readings, an index out of range.
[[nodiscard]] Result<core::AnalyticPaint> map_capture(const Capture& capture, double ior, std::uint16_t nodes);

}  // namespace lackwerk::packs
