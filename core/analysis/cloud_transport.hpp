// Where each point of one part of a scan goes in the next: sparse regularised transport and the choice of pairs.
//
// Why it exists: the animation moves points along straight lines from pair to pair (Golla 2021, 4.3.4); each point must
// leave, each must arrive, and no more pairs than that needs. Values; pure, any thread; same bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/sinkhorn.hpp"
#include "core/error.hpp"

namespace lackwerk::core {

struct CloudTransportOptions {
  std::size_t neighbours = 15;  ///< k of GT 4.3.4
  double gamma = 0.05;          ///< relative to the median cost of the support
  double tolerance = 0.01;      ///< of marginals, as SinkhornOptions; the choice of pairs needs no more
  int most_iterations = 1000;
  /// Groups of the coarse plan. Its drift says where a point's neighbours are looked for: a part that has grown has
  /// them far from where they were.
  std::size_t clusters = 64;
  /// Cost is the square of the distance, so that a part that grows stretches; else the distance, where its base may
  /// stay and its tip jump at the same cost.
  bool squared = true;
  /// Adds the pairs of a plan between and within the groups, so that the support always allows one.
  bool backbone = true;
};

struct CloudPair {
  std::uint32_t from = 0, to = 0;
  bool operator==(const CloudPair&) const = default;
};

struct CloudPairs {
  std::vector<CloudPair> pairs;  ///< by from, then to; every point of both clouds is in one at least
  SinkhornState state = SinkhornState::converged;
  int iterations = 0;
  double marginal_violation = 0.0;
  std::size_t support = 0;     ///< pairs that could have been chosen
  double mean_distance = 0.0;  ///< under the regularised plan
};

/// The pairs that may exchange mass, by row. Both clouds have points.
[[nodiscard]] TransportSupport cloud_support(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                                             const CloudTransportOptions& options);

/// The largest entry of each row and of each column of the plan, the nearer pair on a draw, then the smaller index
/// (GT's T' and T''). Each row and column of the support has a pair.
[[nodiscard]] std::vector<CloudPair> largest_pairs(const TransportSupport& support, std::span<const double> mass);

/// Pairs the points of two parts of scans, all points of one weighing the same. Either empty: no pairs. A support that
/// allows no plan (backbone off) is widened by the backbone and solved again.
[[nodiscard]] Result<CloudPairs> pair_points(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                                             const CloudTransportOptions& options);

}  // namespace lackwerk::core
