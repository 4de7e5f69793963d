// Entropy-regularised optimal transport: the Sinkhorn iteration on a dense or sparse support.
//
// Why it exists: between two scans of 100,000 points a full cost matrix does not fit into memory and the exact solver
// (transport.hpp) is too slow; near neighbours are enough (Golla 2021, 4.3.4). It also stands beside the exact solver
// in the error-against-time report. Owns nothing; pure, any thread; same bytes for the same input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::core {

/// Which pairs may exchange mass, and at what cost: compressed rows. Pairs that are not listed cost infinity.
struct TransportSupport {
  std::uint32_t columns = 0;
  std::vector<std::uint32_t> row_begin{0};  ///< rows + 1 places into `column` and `cost`, ascending from 0
  std::vector<std::uint32_t> column;        ///< < columns, ascending within a row
  std::vector<double> cost;                 ///< finite, either sign

  [[nodiscard]] std::size_t rows() const { return row_begin.size() - 1; }
};

/// Every pair allowed; `cost` row by row, one for each of rows * columns pairs.
[[nodiscard]] TransportSupport dense_support(std::size_t rows, std::size_t columns, std::vector<double> cost);

enum class SinkhornDomain {
  plain,        ///< scalings of exp(-C/gamma); where that dies, the logarithmic domain takes over
  logarithmic,  ///< log-sum-exp and absorbed kernels, gamma annealed: cannot underflow
};
enum class SinkhornPrecision { single_float, double_float };

struct SinkhornOptions {
  double gamma = 0.05;            ///< > 0; in units of cost, or of the median cost of the support
  bool gamma_is_relative = true;  ///< to the median cost (the mean where the median is 0, 1 where all are 0)
  double tolerance = 1e-6;        ///< largest sum |row sum - mass| / total; not below 32 roundings of the precision
  int most_iterations = 20000;    ///< of both sides once, in all stages together
  /// Adds a part of the last step to each step of the rows, as much as the rate observed asks for (heavy ball, Polyak
  /// 1964): where mass must creep along a thin support, tens of times fewer iterations. Falls back to none by itself.
  bool momentum = false;
  bool feasible = false;  ///< the support is known to allow a plan: slow progress is no reason to look whether it does
  SinkhornDomain domain = SinkhornDomain::plain;
  SinkhornPrecision precision = SinkhornPrecision::double_float;  ///< of the kernel; potentials stay double
};

enum class SinkhornState {
  converged,
  iteration_limit,  ///< the support allows a plan; it was not reached
  infeasible,       ///< the support allows no plan: see stuck_rows and starved_columns
};

struct SinkhornPlan {
  std::vector<double> mass;  ///< one per pair of the support, >= 0, always finite
  SinkhornState state = SinkhornState::converged;
  SinkhornDomain domain = SinkhornDomain::plain;  ///< the one that finished
  int iterations = 0;
  double gamma = 0.0;               ///< in units of cost
  double marginal_violation = 0.0;  ///< the larger of sum |row sum - mass| and the same of columns, over the total
  double cost = 0.0;                ///< sum of mass * cost
  double objective = 0.0;           ///< cost + gamma * sum T log T (GT eq. 4.4, T in units of the given masses)
  /// Where infeasible: rows whose mass exceeds what all their columns together take, and the columns that none of them
  /// reaches, which lack as much. Linking the ones to the others is what widens the support.
  std::vector<std::uint32_t> stuck_rows, starved_columns;
};

/// Moves `row_mass` onto `column_mass` within the support.
///
/// Iterates u = m / (K v), v = m' / (K^T u) (Cuturi 2013; GT prints K u and K v). Costs are first reduced by row and
/// column minima, a shift of potentials that changes no plan, so that offsets of 1e6 cost no digits. Rows and columns
/// of mass 0 take no part. Errors (field says where): sizes differ, a mass is negative or not finite, totals differ by
/// more than 1e-9 of themselves, a cost is not finite, columns out of range or order, gamma or tolerance not positive.
[[nodiscard]] Result<SinkhornPlan> solve_sinkhorn(const TransportSupport& support, std::span<const double> row_mass,
                                                  std::span<const double> column_mass, const SinkhornOptions& options);

/// Whether the support allows a plan at all, by maximum flow with masses rounded to 2^-40 of the total. Fills the lists
/// of `plan` and returns false where not. Masses as in solve_sinkhorn, and valid.
[[nodiscard]] bool support_is_feasible(const TransportSupport& support, std::span<const double> row_mass,
                                       std::span<const double> column_mass, SinkhornPlan& plan);

}  // namespace lackwerk::core
