// Exact optimal transport between two small clouds of weighted colours.
//
// Why it exists: which flake colour becomes which when one paint turns into another is a balanced transportation
// problem (Golla & Klein 2018, eq. 8 to 13). Masses are texel counts and stay integers, so marginals match exactly;
// costs become integers too, because floating-point network simplex cycles on lattices. Owns nothing; pure, any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::core {

/// 128 bits: sums of mass (up to 2^62) times cost (up to 2^40) would overflow 64 without a word.
__extension__ typedef __int128 Int128;

/// `mass` (> 0) of source cluster `source` goes to target cluster `target`.
struct PlanEntry {
  std::uint32_t source = 0;
  std::uint32_t target = 0;
  std::int64_t mass = 0;
  bool operator==(const PlanEntry&) const = default;
};

struct TransportPlan {
  std::vector<PlanEntry> entries;  ///< by source, then target; at most sources + targets - 1 of them
  double cost = 0.0;               ///< sum of mass * Euclidean distance, in mass * Lab
  Int128 primal = 0;               ///< objective in scaled integer costs, tie-break included
  Int128 dual = 0;                 ///< a lower bound of it from feasible potentials; equal to primal: optimal
};

/// Moves `source_mass` onto `target_mass` at the least sum of mass * distance.
///
/// Centres are in Lab (or any Euclidean space), one per mass; masses >= 0, equal in total, total at most 2^62. To the
/// distance d comes 1e-6 d^2, which makes the plan unique on grey (collinear) slices; remaining ties fall by the order
/// of the centres in space, so permuted input gives the permuted plan. Clusters of mass 0 take no part; clusters with
/// identical centres share their plan in index order (north-west corner), so that identical inputs give the diagonal.
/// Errors (field says which side): sizes differ, a mass is negative, a centre is not finite (or beyond 1e100), totals
/// differ.
[[nodiscard]] Result<TransportPlan> solve_transport(std::span<const glm::dvec3> source_centres,
                                                    std::span<const std::int64_t> source_mass,
                                                    std::span<const glm::dvec3> target_centres,
                                                    std::span<const std::int64_t> target_mass);

}  // namespace lackwerk::core
