// Packs of any number of paints without measuring any: random clusters in every row, transported like real ones.
//
// Why it exists: the time of realise() depends on how many tuples there are, not on their colours, and five paints from
// the virtual goniometer would take longer than the measurement. Deterministic. A pure function; any thread.
#pragma once

#include <cstddef>

#include "core/analysis/interpolation.hpp"
#include "core/error.hpp"

namespace lackwerk::report {

/// `paints` in [1, 5] with `clusters` a row, in AxF's layout of 67 slices and nine mip levels of 480 texels an edge.
[[nodiscard]] Result<core::InterpolatableData> synthetic_pack(std::size_t paints, int clusters);

}  // namespace lackwerk::report
