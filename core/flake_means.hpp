// The mean colour of each slice's flakes, from the boxes of level 0.
//
// Why it exists: wherever single flakes do not show, their mean is drawn; it must follow the weights as exactly as the
// boxes do. Pure; any thread.
#pragma once

#include "core/interpolatable_paint.hpp"
#include "core/realise.hpp"

namespace lackwerk::core {

/// Fills `out.flake_mean` from `out.corners`.
void realise_means(const InterpolatablePaint& paint, RealisedPaint& out);

}  // namespace lackwerk::core
