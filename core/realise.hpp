// realise(weights): from the mixable form to what the GPU gets (Golla & Klein 2018, eq. 14 and 15).
//
// Why it exists: it is the one thing that happens per frame while a customer drags. Pure functions over values; the
// output buffers are the caller's and are reused, so a drag allocates nothing. Any thread, one output per thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

/// Sums further from 1 than this are refused as a caller's mistake; closer ones are what float sliders produce.
inline constexpr double weight_sum_tolerance = 1e-6;

/// Checks number of weights, finiteness, sums, and that flake_white lies in [0, 1].
[[nodiscard]] Result<void> check_weights(const InterpolatablePaint& paint, const Weights& weights);

/// What the GPU gets. `corners` is the texture: row_count() rows of `width` tuples of one QuantisedCuboid each
/// (as texels: three RGBA8 per tuple; low byte first); unused tuples are 0.
struct RealisedPaint {
  AnalyticPaint analytic;                ///< table in linear sRGB
  int width = 0;                         ///< most tuples in any row
  std::vector<QuantisedCuboid> corners;  ///< row_count() * width
  std::vector<glm::vec3> flake_mean;     ///< per slice: mean of pi * Xi over level 0, linear sRGB, >= 0
  std::vector<double> level0_luminance;  ///< working memory of realise
};

/// Linear blend of a, s, m, F0, IORs and (in Lab) chi, lobes paired by roughness; clamped to m >= 1e-3, a and s >= 0,
/// F0 in [0, 1], IOR >= 1 (Golla & Klein 2018, 4.2).
[[nodiscard]] AnalyticPaint realise_analytic(const InterpolatablePaint& paint, const Weights& weights);

/// The same blend as it comes out, nothing clamped and lobes as they were paired: for judging how far a mix may go.
[[nodiscard]] AnalyticPaint extrapolate_analytic(const InterpolatablePaint& paint, const Weights& weights);

/// Blends all corners and their means into `out`. Weights must have passed check_weights. At e_k the corners are
/// bit for bit those of paint k. Extrapolated corners are clamped to the pack's range and keep min <= max. In mixes the
/// rows of the farther mip levels are scaled to the mean luminance of level 0 (level_balance.hpp). flake_white scales a
/// and b of all corners, and so the means, towards 0, or towards the nearest that the pack's range has; at 0 it changes
/// no bit.
void realise(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out);

/// The part of realise() that depends on the flakes' weights: everything but `analytic`, which stays as it is.
void realise_flakes(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out);

/// What every picture needs of the flakes: their means, and for them the corners of level 0. The other levels' corners
/// keep what they were.
void realise_flake_means(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out);

/// The corners of levels [first, last), 1 <= first, after realise_flake_means with the same weights: only what a view
/// shows. All levels from 1 on make realise_flakes of it.
void realise_flake_levels(const InterpolatablePaint& paint, const Weights& weights, int first, int last,
                          RealisedPaint& out);

}  // namespace lackwerk::core
