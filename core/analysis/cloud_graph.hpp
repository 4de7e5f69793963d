// Neighbourhood graphs of a cloud and their spanning trees.
//
// Why it exists: both ways to segment a scan walk the same graph. Values; pure, any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace lackwerk::core {

struct CloudEdge {
  std::uint32_t one = 0, two = 0;  ///< one < two
  double length = 0.0;
};

/// Each point's nearest `neighbours` others, each edge once, by length, then by ends; and, last, edges that bridge what
/// is left apart, each at the narrowest place to what is already together (the largest part to begin with).
[[nodiscard]] std::vector<CloudEdge> connected_graph(std::span<const glm::dvec3> points, std::size_t neighbours);

/// Minimum spanning tree of a connected graph whose edges come in order (Kruskal 1956): one edge less than points.
[[nodiscard]] std::vector<CloudEdge> spanning_tree(std::size_t points, std::span<const CloudEdge> edges);

/// Sets that merge. `find` gives a set's smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count);
  [[nodiscard]] std::uint32_t find(std::uint32_t member);
  /// False where both were in one set already.
  bool merge(std::uint32_t one, std::uint32_t two);

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace lackwerk::core
