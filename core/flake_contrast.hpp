// How much of the sparkle is left at each mip level.
//
// Why it exists: where a pixel covers thousands of flakes their sum no longer sparkles, and drawing single ones would
// be work for nothing. Pure function; any thread.
#pragma once

#include <vector>

#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

/// Per mip level: the largest, over paints and slices, of the standard deviation of a texel's luminance over the mean
/// luminance of that paint's brightest slice. Falls with the level; empty without flakes.
[[nodiscard]] std::vector<double> flake_contrast(const InterpolatablePaint& paint);

/// The level, between two if need be, at which the contrast falls to `threshold`; the number of levels if it never
/// does.
[[nodiscard]] double calm_level(const std::vector<double>& contrast, double threshold);

}  // namespace lackwerk::core
