#include "core/analysis/cloud_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace lackwerk::core {

namespace {

/// What nanoflann asks of a data set (its names).
struct Points {
  std::span<const glm::dvec3> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;

/// nanoflann keeps whichever of equally far points it meets first; this set prefers the smaller index, so that the
/// answer does not depend on how the tree was split.
class NearestSet {
 public:
  using DistanceType = double;
  NearestSet(std::size_t capacity, std::vector<CloudNeighbour>& out) : capacity_(capacity), out_(out) { out_.clear(); }
  [[nodiscard]] std::size_t size() const { return out_.size(); }
  [[nodiscard]] bool full() const { return out_.size() == capacity_; }
  /// One rounding above the worst, so that equals of it are offered too.
  [[nodiscard]] double worstDist() const { return full() ? std::nextafter(out_.back().distance, HUGE_VAL) : HUGE_VAL; }
  bool addPoint(double squared, std::uint32_t index) {
    const auto before = [](const CloudNeighbour& one, const CloudNeighbour& two) {
      return one.distance != two.distance ? one.distance < two.distance : one.index < two.index;
    };
    const CloudNeighbour fresh{index, squared};
    if (full() && !before(fresh, out_.back())) return true;
    if (full()) out_.pop_back();
    out_.insert(std::upper_bound(out_.begin(), out_.end(), fresh, before), fresh);
    return true;
  }

 private:
  std::size_t capacity_;
  std::vector<CloudNeighbour>& out_;
};

constexpr std::size_t leaf_points = 16;

}  // namespace

struct CloudTree::Index {
  explicit Index(std::span<const glm::dvec3> all)
      : points{all}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_points)) {
    tree.buildIndex();
  }
  Points points;
  Tree tree;
};

CloudTree::CloudTree(std::span<const glm::dvec3> points)
    : index_(points.empty() ? nullptr : std::make_unique<Index>(points)) {}
CloudTree::~CloudTree() = default;
CloudTree::CloudTree(CloudTree&&) noexcept = default;
CloudTree& CloudTree::operator=(CloudTree&&) noexcept = default;

const glm::dvec3& CloudTree::point(std::uint32_t index) const { return index_->points.points[index]; }

void CloudTree::nearest(const glm::dvec3& place, std::size_t count, std::vector<CloudNeighbour>& out) const {
  out.clear();
  if (!index_ || count == 0) return;
  NearestSet set(std::min(count, index_->points.points.size()), out);
  index_->tree.findNeighbors(set, &place.x, nanoflann::SearchParams());
  for (CloudNeighbour& n : out) n.distance = std::sqrt(n.distance);
}

}  // namespace lackwerk::core
