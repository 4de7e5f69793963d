// A scan as a tree of levels: what lies equally far from the ground, along the plant, and hangs together.
//
// Why it exists: a spanning tree forks anywhere in a broad leaf; a level of one does not, it is a strip across the leaf
// (Verroust and Lazarus 2000). A level falls apart only where parts of the plant do. Values; pure, any thread; same
// bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/cloud_graph.hpp"

namespace lackwerk::core {

/// The shortest way from one place to each other along a connected graph (Dijkstra 1959).
struct CloudWays {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::vector<double> length;         ///< in units of the scan
  std::vector<std::uint32_t> before;  ///< the place before each on its way; none for the first
  double longest = 0.0;
};
[[nodiscard]] CloudWays ways_from(std::uint32_t first, std::size_t places, std::span<const CloudEdge> edges);

/// One strip: places whose ways are about equally long and which edges join among themselves.
struct CloudLevel {
  std::uint32_t parent = CloudWays::none;  ///< the level through which the shortest way to it goes
  double begin = 0.0;                      ///< the least way of its places
  double end = 0.0;                        ///< the longest way of its places, and of all levels above it
};

struct CloudLevels {
  std::vector<std::uint32_t> level_of;  ///< of each place
  std::vector<CloudLevel> levels;       ///< parents first, the first holds the ground
};

/// Levels of `height` (> 0, units of the scan) along `ways`. Where a level comes together again behind a hole it goes
/// on from the part with the shorter way; the other part ends there.
[[nodiscard]] CloudLevels levels_of(const CloudWays& ways, std::span<const CloudEdge> edges, double height);

/// The edges no longer than `longest`, and those of the spanning tree: short cuts through the air between parts go, the
/// graph stays connected. `edges` as connected_graph gives them.
[[nodiscard]] std::vector<CloudEdge> without_short_cuts(std::size_t places, std::span<const CloudEdge> edges,
                                                        double longest);

}  // namespace lackwerk::core
