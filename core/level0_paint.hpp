// The nearest mip level of a pack's paints, ready to be realised and asked for its means.
//
// Why it exists: colours of a paint shop and laws of physics need mean flakes and boxes at level 0 alone; realising all
// levels, and their textures, would take ten times as long. What is returned points into the paint it was made of.
// Pure; any thread.
#pragma once

#include "core/interpolatable_paint.hpp"
#include "core/paint_textures.hpp"
#include "core/realise.hpp"

namespace lackwerk::core {

/// The paints with level 0 as their only level. Valid while the spans of `paint` are.
[[nodiscard]] InterpolatablePaint level0_of(const InterpolatablePaint& paint);

/// What the functions of the model that show no single flakes read: chi and mean flakes, as the renderer gets them
/// (8 bits, within 0.4 %). `realised` gives its corners away.
[[nodiscard]] PaintTextures mean_textures(const InterpolatablePaint& paint, RealisedPaint& realised);

}  // namespace lackwerk::core
