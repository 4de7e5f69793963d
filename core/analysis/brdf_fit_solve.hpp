// The non-linear part of a fit, by Ceres: lobes for a given colour table, and a colour table for given lobes.
//
// Why it exists: the one place that knows Ceres. Both problems minimise the same robust error: Soft-L1 of the three
// channels' log errors together, quadratic below about 10 % and linear above, so that a few wild cells do not lead
// (Guenther et al. 2005, eq. 2, take L1 throughout, whose minimum no Newton step finds). One thread inside; pure
// functions; any thread; deterministic.
#pragma once

#include <span>
#include <vector>

#include "core/analysis/brdf_fit_model.hpp"

namespace lackwerk::core {

struct LobeSolution {
  std::vector<double> parameters;
  double cost = 0.0;  ///< half the sum of weighted Soft-L1 values over all points
  int iterations = 0;
  bool has_converged = false;
};

/// From `start` downhill (Levenberg-Marquardt within bounds), at most `most_iterations` steps.
[[nodiscard]] LobeSolution solve_lobes(const FitLayout& layout, std::span<const FitPoint> points,
                                       std::vector<double> start, int most_iterations);

/// Highest entry of a fitted colour table: packs hold it in 8 bits of sqrt(chi / largest), so 4 keeps the step at 1
/// below 1.6 %.
inline constexpr double max_fitted_chi = 4.0;

/// The colour table that fits `points` best before the lobes of `paint` (its own table is the start where it has one
/// of this size). Nodes no point touches follow their neighbours. The points' chi is not looked at.
[[nodiscard]] ColourTable solve_table(const AnalyticPaint& paint, std::span<const FitPoint> points,
                                      std::uint16_t num_theta, int most_iterations);

}  // namespace lackwerk::core
