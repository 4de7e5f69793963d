// A scan as points, and what every scan goes through before it can be compared: finite, thinned, freed of stray points.
//
// Why it exists: scanners deliver any density and stray points in the air; matching and transport want neither. Values;
// pure, any thread; same bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::core {

/// Positions in the scan's own unit (millimetres for most scanners); one label per point, or none at all.
struct PointCloud {
  std::vector<glm::dvec3> points;
  std::vector<std::int32_t> labels;
};

/// The smallest box around points; `low` > `high` where there are none.
struct CloudBox {
  glm::dvec3 low{1e300};
  glm::dvec3 high{-1e300};
};
[[nodiscard]] CloudBox box_of(std::span<const glm::dvec3> points);

/// The length of the box's longest edge, 0 for no or equal points: what scales a scan to the unit cube.
[[nodiscard]] double extent_of(const CloudBox& box);

/// A cloud of the points at `indices`, in their order, with their labels.
[[nodiscard]] PointCloud picked(const PointCloud& cloud, std::span<const std::uint32_t> indices);

struct CloudCleaning {
  std::size_t neighbours = 8;    ///< whose mean distance is judged
  double most_deviations = 3.0;  ///< a point goes when its mean distance lies this many deviations above the mean
};

/// Indices of the points that stay, ascending: statistical outlier removal (Rusu et al. 2008). A cloud of no more than
/// `neighbours` points stays as it is; so does one of duplicates.
[[nodiscard]] std::vector<std::uint32_t> inliers_of(std::span<const glm::dvec3> points, const CloudCleaning& cleaning);

/// One point for each cube of edge `spacing` that has any: the mean of its points; the label that most of them have
/// (the smallest on a draw). Cubes are counted from the cloud's lowest corner; points come by cube (x, then y, then z).
/// Errors: spacing not positive, or below 2^-20 of the extent.
[[nodiscard]] Result<PointCloud> resampled(const PointCloud& cloud, double spacing);

/// The median distance of a point to its nearest other one: the scan's own spacing; 0 below two points.
[[nodiscard]] double spacing_of(std::span<const glm::dvec3> points);

}  // namespace lackwerk::core
