#include "core/analysis/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/analysis/cloud_neighbours.hpp"

namespace lackwerk::core {

CloudBox box_of(std::span<const glm::dvec3> points) {
  CloudBox box;
  for (const glm::dvec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

double extent_of(const CloudBox& box) {
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, box.high[axis] - box.low[axis]);
  return longest;
}

PointCloud picked(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  PointCloud out;
  out.points.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    out.points.push_back(cloud.points[i]);
    if (!cloud.labels.empty()) out.labels.push_back(cloud.labels[i]);
  }
  return out;
}

std::vector<std::uint32_t> inliers_of(std::span<const glm::dvec3> points, const CloudCleaning& cleaning) {
  std::vector<std::uint32_t> kept;
  std::vector<double> mean(points.size(), 0.0);
  if (points.size() > cleaning.neighbours && cleaning.neighbours > 0) {
    const CloudTree tree(points);
    std::vector<CloudNeighbour> near;
    for (std::size_t i = 0; i < points.size(); ++i) {
      tree.nearest(points[i], cleaning.neighbours + 1, near);  // the point itself is one of them, at distance 0
      for (const CloudNeighbour& n : near) mean[i] += n.distance / static_cast<double>(cleaning.neighbours);
    }
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const double m : mean) sum += m;
  const double average = points.empty() ? 0.0 : sum / static_cast<double>(points.size());
  for (const double m : mean) squares += (m - average) * (m - average);
  const double deviation = points.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (mean[i] <= average + cleaning.most_deviations * deviation) kept.push_back(static_cast<std::uint32_t>(i));
  return kept;
}

namespace {

struct Cell {
  std::uint64_t key = 0;  ///< 21 bits an axis, x highest
  std::uint32_t point = 0;
  bool operator<(const Cell& other) const { return key != other.key ? key < other.key : point < other.point; }
};
constexpr double most_cells = 1 << 20;  ///< an axis; the key has room for one more than that

}  // namespace

Result<PointCloud> resampled(const PointCloud& cloud, double spacing) {
  if (!(spacing > 0.0) || !std::isfinite(spacing)) return fail({}, "spacing", "must be positive");
  const CloudBox box = box_of(cloud.points);
  if (extent_of(box) > spacing * most_cells)
    return fail({}, "spacing", "is below a millionth of the scan's extent", "give a larger one");
  std::vector<Cell> cells;
  cells.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = key << 21 | static_cast<std::uint64_t>((cloud.points[i][axis] - box.low[axis]) / spacing);
    cells.push_back({key, static_cast<std::uint32_t>(i)});
  }
  std::sort(cells.begin(), cells.end());
  PointCloud out;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    glm::dvec3 sum(0.0);
    std::map<std::int32_t, std::size_t> votes;
    for (; end < cells.size() && cells[end].key == cells[begin].key; ++end) {
      sum += cloud.points[cells[end].point] - box.low;  // small numbers: no digits lost far from the origin
      if (!cloud.labels.empty()) ++votes[cloud.labels[cells[end].point]];
    }
    out.points.push_back(box.low + sum / static_cast<double>(end - begin));
    if (votes.empty()) continue;
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& one, const auto& two) { return one.second < two.second; });
    out.labels.push_back(most->first);
  }
  return out;
}

double spacing_of(std::span<const glm::dvec3> points) {
  if (points.size() < 2) return 0.0;
  const CloudTree tree(points);
  std::vector<double> nearest(points.size());
  std::vector<CloudNeighbour> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.nearest(points[i], 2, near);
    nearest[i] = near[1].distance;
  }
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

}  // namespace lackwerk::core
