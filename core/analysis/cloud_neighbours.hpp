// The nearest points of a cloud, found in a tree.
//
// Why it exists: nanoflann's headers stay in one file, and ties fall the same way everywhere (smaller index first).
// A tree borrows its points: they must outlive it and not move. Queries may come from any thread at once.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

namespace lackwerk::core {

struct CloudNeighbour {
  std::uint32_t index = 0;
  double distance = 0.0;
};

class CloudTree {
 public:
  /// `points` are finite.
  explicit CloudTree(std::span<const glm::dvec3> points);
  ~CloudTree();
  CloudTree(CloudTree&&) noexcept;
  CloudTree& operator=(CloudTree&&) noexcept;
  CloudTree(const CloudTree&) = delete;
  CloudTree& operator=(const CloudTree&) = delete;

  /// The `count` points nearest to `place` (all where there are fewer), by distance, then index.
  void nearest(const glm::dvec3& place, std::size_t count, std::vector<CloudNeighbour>& out) const;

  [[nodiscard]] const glm::dvec3& point(std::uint32_t index) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace lackwerk::core
