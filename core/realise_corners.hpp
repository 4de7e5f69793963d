// The corner blending of realise() (Golla & Klein 2018, eq. 14 and 15): every row of every mip level, four lanes at a
// time.
//
// Why it exists: it is nearly all of what a drag costs the processor. The lanes are the compilers' own vector types,
// which g++ and clang have on every architecture; a box's lower corner fills one vector (L, a, b and a spare lane), its
// upper corner another. Same operations in the same order on every machine: the same bytes. Pure; any thread, one
// output per thread.
#pragma once

#include "core/interpolatable_paint.hpp"
#include "core/realise.hpp"

namespace lackwerk::core {

/// Level 0: sets `out.width`, sizes `out.corners`, fills its rows and `out.level0_luminance`, which the other levels go
/// by. Rows of the other levels are 0 where the buffer has grown, else as they were. Weights must have passed
/// check_weights.
void realise_level0(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out);

/// The rows of levels [first, last), 1 <= first, last <= level_count, after realise_level0 with the same weights.
void realise_levels(const InterpolatablePaint& paint, const Weights& weights, int first, int last, RealisedPaint& out);

}  // namespace lackwerk::core
