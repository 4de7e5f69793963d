// A tree that grows: scans of known truth at any time between 0 and 1.
//
// Why it exists: growth between two scans can only be judged where it is known what became of every branch, and what
// stood there in between; real scans tell neither. Stands in for the "synthetic tree 2" of Golla 2021, 4.4. Values;
// pure, any thread; same bytes for the same seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "core/analysis/point_cloud.hpp"

namespace lackwerk::packs {

/// A tapered tube along a gently bent axis that grows at its tip and thickens. Lengths and radii in metres.
struct TreeBranch {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t parent = none;
  int level = 0;       ///< 0: the trunk
  double along = 0.0;  ///< where it stands on its parent, of the parent's length at time 1, [0, 1]
  double birth = 0.0;  ///< time at which it buds; below 0: it is there from the first
  double gone = std::numeric_limits<double>::infinity();  ///< time at which it is cropped, with all it bears
  double length = 0.0, radius = 0.0;                      ///< at time 1; the radius at its base
  glm::dvec3 direction{0.0, 0.0, 1.0};                    ///< at its base, unit length
  glm::dvec3 bend{0.0};                                   ///< of its tip at time 1, of its length
};

struct GrowingTreeOptions {
  unsigned seed = 1;
  double height = 6.0;      ///< of the trunk at time 1
  double thickness = 0.03;  ///< radius of the trunk at the ground, of the height; a sapling has a quarter of that
  int levels = 4;           ///< with the trunk, [1, 4]
  int boughs = 14;          ///< on the trunk; twigs are fewer
  bool crops = true;        ///< one of the lowest boughs is cropped at time 0.6
};

struct GrowingTree {
  std::vector<TreeBranch> branches;  ///< the trunk first, parents before children
};

[[nodiscard]] GrowingTree growing_tree(const GrowingTreeOptions& options);

/// Whether the branch can be seen at `time`: budded, and not cropped.
[[nodiscard]] bool stands(const TreeBranch& branch, double time);

/// Exactly `points` points on the surface at `time` in [0, 1], evenly by area; z is up, the trunk stands on 0. Labels
/// are indices of branches, at any time. Scans of other numbers `scan` are other points of the same surface.
[[nodiscard]] core::PointCloud tree_at(const GrowingTree& tree, double time, std::size_t points, unsigned scan);

}  // namespace lackwerk::packs
