// How good a fit is, and how much of it the data decide.
//
// Why it exists: a fit that prints numbers without their worth invites mixing paints by noise. Errors are told per
// angle region over everything that was measured; the condition says which parameters could as well be others. Pure
// functions; any thread.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/analysis/brdf_fit_model.hpp"

namespace lackwerk::core {

/// Of ln((dark + fitted) / (dark + measured)) over values and channels: 0.01 is 1 %.
struct FitError {
  std::size_t values = 0;  ///< geometries
  double bias = 0.0;       ///< mean: below 0 the fit is too dark
  double rms = 0.0;        ///<
  double p95 = 0.0;        ///< of the absolute value, nearest rank
};
struct FitErrors {
  std::array<FitError, fit_region_count> regions{};  ///< in the order of FitRegion
  FitError whole;
};
/// `paint` at each point, its colour table included; points' chi is not looked at.
[[nodiscard]] FitErrors fit_errors(const AnalyticPaint& paint, std::span<const FitPoint> points);
/// The same over every cell of a table that counts (see table_samples). `known` is added to the paint, if given.
[[nodiscard]] FitErrors fit_errors(const AnalyticPaint& paint, const BrdfTable& table,
                                   const std::vector<std::uint8_t>& filled = {}, const Brdf& known = {});

/// What the data say of one parameter.
enum class Standing : std::uint8_t {
  determined,
  undetermined,   ///< its slack is half of its value or more
  at_bound,       ///< held by a bound (s = 0, m = 1, f0 = 1, ...); the slack is not known
  without_effect  ///< no value is changed by it: roughness and Fresnel value of a lobe without weight
};
[[nodiscard]] const char* standing_name(Standing standing);

struct FitParameter {
  std::string name;    ///< as FitLayout::name
  double value = 0.0;  ///< m itself, not its logarithm
  /// How far it can move, all free parameters following as they like, before the root mean square of the log error has
  /// risen by 1 % (in quadrature, linearised). In the parameter's own unit; for m and the weights relative to its value
  /// is what counts. Infinite where nothing holds it.
  double slack = 0.0;
  Standing standing = Standing::determined;
};

struct FitCondition {
  /// Largest over smallest eigenvalue of J'J, J the log errors' Jacobian with columns scaled to length 1, over the
  /// parameters that are neither at a bound nor without effect. 1 is best; above 1e6 a thousandth decides (the square
  /// root counts). Infinite where J'J is singular in double precision (1e15).
  double number = 1.0;
  std::vector<FitParameter> parameters;
};
/// `points` with their chi, as they went into the fit.
[[nodiscard]] FitCondition fit_condition(const FitLayout& layout, std::span<const double> parameters,
                                         std::span<const FitPoint> points);

}  // namespace lackwerk::core
