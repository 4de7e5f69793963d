// LEMON's network simplex on the same integer problem.
//
// Why it exists: a second exact solver, written by others, stands behind our own (transport_simplex.hpp) where that one
// does not end, and beside it in tests and reports. Keeps LEMON's headers in one file. Owns its graph; one thread each.
#pragma once

#include <memory>
#include <optional>

#include "core/analysis/transport_simplex.hpp"

namespace lackwerk::core {

class LemonSimplex {
 public:
  /// Builds the graph. Masses > 0 of equal totals, costs as in TransportProblem; the spans must outlive this.
  explicit LemonSimplex(const TransportProblem& problem);
  ~LemonSimplex();
  LemonSimplex(const LemonSimplex&) = delete;
  LemonSimplex& operator=(const LemonSimplex&) = delete;

  /// The solver alone, from its first basis to the optimum; again from the start at each call. False: it found none.
  bool run();
  /// Runs, and reads the plan and potentials. None where run() finds none.
  [[nodiscard]] std::optional<TransportSolution> solve();

 private:
  struct Parts;
  TransportProblem problem_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lackwerk::core
