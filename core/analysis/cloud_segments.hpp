// A scan cut into its natural parts, as a tree of segments that begins at the ground.
//
// Why it exists: transport across a whole plant tears leaves apart (Golla 2021, Figure 4.3); within a stem or leaf it
// does not. Values; pure, any thread; same bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/point_cloud.hpp"
#include "core/error.hpp"

namespace lackwerk::core {

struct CloudSegment {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> points;  ///< ascending; empty for a virtual root only
  std::uint32_t parent = none;
  std::vector<std::uint32_t> children;  ///< ascending
  std::int32_t label = -1;              ///< as given; the segment's own number where it was found
};

/// segments[0] is the root; parents come before their children. Every point is in exactly one segment. No points: only
/// a virtual root.
struct CloudSegments {
  std::vector<CloudSegment> segments;
};

struct SegmentOptions {
  std::size_t neighbours = 15;  ///< of the graph (GT 4.3.2)
  int up = 2;                   ///< the vertical axis: 0, 1 or 2
  /// Branches whose longest way to a tip is shorter than this (units of the scan) are no branches; <= 0: an eighth of
  /// the longest way from the ground.
  double shortest_branch = 0.0;
  /// Spacing at which the tree is built, so that a stem is a line and no tube of parallel lines; points take the
  /// segment of the nearest place. <= 0: as the points are.
  double skeleton_spacing = 0.0;
  /// Cut a tree of levels, for plants with leaves; else the spanning tree, as GT does for thin structures only.
  bool by_levels = true;
  double touch = 0.0;         ///< labelled parts nearer than this are neighbours; <= 0: four spacings of the scan
  bool virtual_root = false;  ///< labelled parts all hang from an empty root (leaves scanned without a stem)
};

/// Segments as they are found: k nearest neighbours, a tree that hangs from the lowest point, cut behind each of its
/// places from which more than one branch longer than `shortest_branch` goes on (GT 4.3.2). The tree is one of levels,
/// so that a broad leaf is one segment, and pieces between two forks that are shorter than a branch stay with what
/// they grow on; or it is the minimum spanning tree. Gaps are bridged at their narrowest place. Errors: as resampled().
[[nodiscard]] Result<CloudSegments> segments_of(std::span<const glm::dvec3> points, const SegmentOptions& options);

/// Segments from labels, one per point: the root has the lowest point; what touches a segment is its child, level by
/// level; what touches nothing hangs from the nearest part.
[[nodiscard]] CloudSegments labelled_segments(const PointCloud& cloud, const SegmentOptions& options);

}  // namespace lackwerk::core
