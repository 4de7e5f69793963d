// How far one part of a scan lies from another: exact optimal transport between clusters of their points.
//
// Why it exists: matching compares many pairs of segments, and a few dozen clusters tell them apart as well as all
// points do; the same coarse plan shows the fine transport where mass drifts to. Values; pure, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/transport.hpp"

namespace lackwerk::core {

/// Points in groups of equal size (give or take one), each with its mean.
struct CloudClusters {
  std::vector<std::vector<std::uint32_t>> members;  ///< places in the span given
  std::vector<glm::dvec3> centres;
  std::size_t points = 0;
};

/// At most `most` (a power of two is used up) groups, by halving at the median along the longest edge. No group is
/// empty; no points: no group.
[[nodiscard]] CloudClusters clusters_of(std::span<const glm::dvec3> points, std::size_t most);

/// The optimal plan between the groups, each point weighing 1 / points of its cloud; masses count in units of
/// 1 / (points * points). Both clouds have points, fewer than 2^31.
[[nodiscard]] TransportPlan plan_between(const CloudClusters& from, const CloudClusters& to);

/// The 1-Wasserstein distance of the clouds that the groups stand for, in units of the scan, off by at most the mean
/// radii of the groups.
[[nodiscard]] double wasserstein(const CloudClusters& from, const CloudClusters& to);

}  // namespace lackwerk::core
