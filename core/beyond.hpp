// How far beyond the measured paints a mix may go and still be physical.
//
// Why it exists: extrapolation is delightful until a paint gives back more light than it gets. The builder measures the
// limit once and the pack states it. Pure; any thread.
#pragma once

#include <string>

#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

inline constexpr double most_beyond = 1.0;

struct Beyond {
  double limit = 0.0;  ///< [0, most_beyond], a multiple of 0.05
  std::string stop;    ///< what the next step would break, for the engineer; empty: nothing does up to most_beyond
};

/// The largest b such that for every paint k and up to b the weights (1+b) e_k - b/n are still a paint:
/// - it gives back no more light than it gets: the directional albedo at 0, 45 and 75 degrees (of lobes and flakes
///   through the coat; the coat's own mirror image is not of the paint) is at most 1 in every channel, or at most paint
///   k's own where that is above 1;
/// - it is still what was extrapolated: clamping the parameters to their ranges (realise.hpp) changes none of the shop
///   colours (character.hpp) by more than 1 CIEDE2000, about what an eye can tell.
/// Clamping as such is no offence: F0 held at 1, a weight held at 0, or a colour table held inside the gamut are a
/// paint, and in most packs some paint has such a number from the start. The albedo at 0 degrees is taken at 14, where
/// its table ends (directional_albedo.hpp), and is known to 1 %. A single paint has no beyond.
[[nodiscard]] Beyond measure_beyond(const InterpolatablePaint& paint);

/// Its limit alone.
[[nodiscard]] double beyond_limit(const InterpolatablePaint& paint);

}  // namespace lackwerk::core
