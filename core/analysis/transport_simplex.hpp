// The transportation problem in integers, solved exactly by a simplex method made for it.
//
// Why it exists: a general network simplex (LEMON's) carries artificial arcs, capacities and arc states that a dense
// bipartite problem has no need of, and building its graph costs as much again. The basis here is a spanning tree of
// the sources and targets themselves. Owns nothing; pure, any thread; same bytes for the same input.
//
// Simplex on strongly feasible trees (Cunningham 1976; the transportation problem: Barr, Glover & Klingman 1977): every
// basic arc that carries nothing points to the root, which is what a perturbation of each source's mass by the same
// infinitesimal amount, taken up by the root, would leave feasible (Orden 1956). No cycling is possible, whatever arc
// enters; equal masses, where most pivots move nothing, are the norm here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/analysis/transport.hpp"

namespace lackwerk::core {

/// Integer masses > 0 with equal totals of at most 2^62, and one cost per pair, row by row, either sign.
struct TransportProblem {
  std::span<const std::int64_t> source_mass, target_mass;
  std::span<const std::int64_t> cost;
};

/// A plan with potentials that prove how good it is.
struct TransportSolution {
  std::vector<PlanEntry> entries;              ///< by source, then target
  std::vector<std::int64_t> source_potential;  ///< reduced cost = cost + source potential - target potential
  std::size_t pivots = 0;                      ///< of the simplex; 0 where the solver does not tell
};

/// Pivots within which every problem met so far ended many times over: 50 for each pair of nodes. Degenerate problems
/// may stall for long in theory.
[[nodiscard]] std::size_t usual_pivot_limit(const TransportProblem& problem);

/// The plan of least sum of mass * cost. None if `most_pivots` do not suffice, or if potentials could leave 63 bits:
/// (sources + targets) * (largest |cost|) must stay below 2^61. Both sides need at least one node.
[[nodiscard]] std::optional<TransportSolution> solve_simplex(const TransportProblem& problem, std::size_t most_pivots);

/// Sum of mass * cost of a plan.
[[nodiscard]] Int128 primal_objective(const TransportProblem& problem, std::span<const PlanEntry> entries);

/// A lower bound of every plan's objective: each target takes the largest price that the sources' potentials allow, so
/// it holds whatever they are. Equal to the primal objective of a plan: that plan is optimal.
[[nodiscard]] Int128 dual_objective(const TransportProblem& problem, std::span<const std::int64_t> source_potential);

}  // namespace lackwerk::core
