// How long a flake shines while the angles change: measured on pictures, and fitted by the shader's random cells.
//
// Why it exists: with one random value per texel the same texel is brightest at all angles and nothing twinkles.
// paint_model.glsl gives every angular cell its own value (flake_gaussian); how wide a cell must be for the texels'
// autocorrelation to be that of the source is found here. Pure functions over values; any thread.
//
// The autocorrelation is Pearson's over the texels' luminance between two angles, averaged over the first angle: a
// change of the mean between angles does not count, only which texels shine. A life is its half width: the lag at
// which it has fallen to 1/2, in degrees inside the coat.
#pragma once

#include <span>
#include <vector>

#include "core/analysis/flake_clusters.hpp"
#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

/// Autocorrelation at lags 0, step, 2 step, ...
struct LifeCurve {
  double step_deg = 0.0;
  std::vector<double> correlation;  ///< [0] is 1
};

/// Pearson's correlation of two pictures of the same texels, in [-1, 1]; 0 where one of them is flat.
[[nodiscard]] double texel_correlation(std::span<const float> a, std::span<const float> b);

/// `pictures`: luminance of the same texels at angles `step_deg` apart. For each lag the mean over the first `starts`
/// pictures, so that every lag has the same starts; pictures that are flat are left out. starts >= 1, below their
/// number.
[[nodiscard]] LifeCurve life_curve(std::span<const std::vector<float>> pictures, double step_deg, std::size_t starts);

/// Where the curve first falls to 1/2, linear between lags; widest_cell_deg where it does not.
[[nodiscard]] double half_width_deg(const LifeCurve& curve);

/// Half width of what random cells of width 1 make of these distributions (one list of clusters per slice; the mean of
/// their autocorrelations). Luminance is a staircase over the rank; its Hermite coefficients a_n give the correlation
/// sum a_n^2 r^n / sum a_n^2 where the Gaussian values correlate by r (Mehler), averaged over where in a cell the
/// first angle lies. About 0.5; 1 for distributions without contrast.
[[nodiscard]] double half_width_in_cells(std::span<const std::vector<LabCuboid>> slices);

/// Half width of flakes that shine over `life_deg` at the most: one that shines while its normal lies in a disc of that
/// diameter around the half vector has the overlap of two discs for its autocorrelation, 1/2 at 0.404 diameters.
[[nodiscard]] constexpr double half_width_of_life(double life_deg) { return 0.40397 * life_deg; }

/// The cells that give these half widths along theta_h and theta_i. Half widths of widest_cell_deg (the correlation
/// never falls to 1/2) give one cell for all angles. Widths are rounded to 1/16 degree, far below what a life is known
/// to, so that no last digit of a mathematical library reaches a pack.
[[nodiscard]] FlakeLife fit_life(double half_h_deg, double half_i_deg, std::span<const std::vector<LabCuboid>> slices,
                                 LifeOrigin origin);

}  // namespace lackwerk::core
