#include "core/analysis/flake_clusters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.hpp"

namespace lackwerk::core {

namespace {

/// A texel's place in the octree: three bits a level (L, a, b), the coarsest highest.
struct Key {
  std::uint64_t morton = 0;
  std::uint32_t texel = 0;
};

/// Spreads the low 21 bits of x to every third bit.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  x = (x | x << 2) & 0x1249249249249249u;
  return x;
}

/// Collects every third bit again.
std::uint64_t gather(std::uint64_t x) {
  x &= 0x1249249249249249u;
  x = (x | x >> 2) & 0x10c30c30c30c30c3u;
  x = (x | x >> 4) & 0x100f00f00f00f00fu;
  x = (x | x >> 8) & 0x001f0000ff0000ffu;
  x = (x | x >> 16) & 0x001f00000000ffffu;
  x = (x | x >> 32) & 0x00000000001fffffu;
  return x;
}

/// Sorted keys and the edge of a finest cell. The root cube is as wide as the widest axis; cells get a power of two as
/// edge, so that scaling is exact.
std::vector<Key> morton_keys(std::span<const glm::vec3> lab, int depth, double& cell_edge) {
  glm::vec3 lo = lab[0];
  glm::vec3 hi = lab[0];
  bool finite = true;
  for (const glm::vec3& texel : lab) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], texel[axis]);
      hi[axis] = std::max(hi[axis], texel[axis]);
      finite = finite && std::isfinite(texel[axis]);
    }
  }
  check_equal(finite, true, "every texel is finite");
  const glm::dvec3 origin(lo);
  const glm::dvec3 size = glm::dvec3(hi) - origin;
  int exponent = 0;
  std::frexp(std::max({size.x, size.y, size.z}), &exponent);  // every size < 2^exponent
  const double scale = std::ldexp(1.0, depth - exponent);
  cell_edge = 1.0 / scale;

  std::vector<Key> keys(lab.size());
  for (std::size_t i = 0; i < lab.size(); ++i) {
    const glm::dvec3 cell = (glm::dvec3(lab[i]) - origin) * scale;
    keys[i] = {spread(static_cast<std::uint64_t>(cell.x)) << 2 | spread(static_cast<std::uint64_t>(cell.y)) << 1 |
                   spread(static_cast<std::uint64_t>(cell.z)),
               static_cast<std::uint32_t>(i)};
  }
  return keys;
}

/// Least significant digit first, of at most 12 bits (16 levels are four passes), counted all at once, skipping digits
/// that never differ. 4096 open ends of a pass still fit the second cache.
void radix_sort(std::vector<Key>& keys) {
  constexpr int most_bits = 12;
  constexpr std::size_t most_digits = std::size_t{1} << most_bits;
  constexpr int most_passes = (3 * 21 + most_bits - 1) / most_bits;
  std::uint64_t differing = 0;
  for (const Key& key : keys) differing |= key.morton ^ keys.front().morton;
  const int passes = (std::bit_width(differing) + most_bits - 1) / most_bits;
  if (passes == 0) return;
  const int digit_bits = (std::bit_width(differing) + passes - 1) / passes;
  const std::uint64_t mask = (std::uint64_t{1} << digit_bits) - 1;
  std::array<std::array<std::uint32_t, most_digits>, most_passes> place{};
  for (const Key& key : keys)
    for (int pass = 0; pass < passes; ++pass)
      ++place[static_cast<std::size_t>(pass)][key.morton >> (pass * digit_bits) & mask];
  std::vector<Key> other(keys.size());
  for (int pass = 0; pass < passes; ++pass) {
    const int shift = pass * digit_bits;
    if ((differing >> shift & mask) == 0) continue;
    std::array<std::uint32_t, most_digits>& ends = place[static_cast<std::size_t>(pass)];
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : ends) sum += std::exchange(entry, sum);
    for (const Key& key : keys) other[ends[key.morton >> shift & mask]++] = key;
    keys.swap(other);
  }
}

/// What is known of the texels below a node, in units of cells: integers in doubles, exact at 16 levels.
struct Moments {
  double count = 0.0;
  double lo[3] = {1e300, 1e300, 1e300};
  double hi[3] = {-1e300, -1e300, -1e300};
  double sum[3] = {};
  double squares[3] = {};

  void add(const Moments& other) {
    count += other.count;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], other.lo[axis]);
      hi[axis] = std::max(hi[axis], other.hi[axis]);
      sum[axis] += other.sum[axis];
      squares[axis] += other.squares[axis];
    }
  }
  void add_cell(std::uint64_t morton, double texels) {
    count += texels;
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<double>(gather(morton >> (2 - axis)));
      lo[axis] = std::min(lo[axis], x);
      hi[axis] = std::max(hi[axis], x);
      sum[axis] += texels * x;
      squares[axis] += texels * x * x;
    }
  }
};

/// Texels times distance from uniform in the box: along each axis, the 2-Wasserstein distance of two distributions of
/// one shape is the root of (difference of means)^2 + (difference of standard deviations)^2.
double misfit_of(const Moments& node) {
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = node.sum[axis] / node.count;
    const double spread_here = std::sqrt(std::max(0.0, node.squares[axis] / node.count - mean * mean));
    const double shift = mean - 0.5 * (node.lo[axis] + node.hi[axis]);
    const double excess = spread_here - (node.hi[axis] - node.lo[axis]) / std::sqrt(12.0);
    square += shift * shift + excess * excess;
  }
  return node.count * std::sqrt(square);
}

/// Texels per volume; sides are floored.
double density_of(const Moments& node, double floor_cells) {
  double volume = 1.0;
  for (int axis = 0; axis < 3; ++axis) volume *= std::max(node.hi[axis] - node.lo[axis], floor_cells);
  return node.count / volume;
}

/// An inner node of the compressed tree (at least two children): the keys in [begin, end), which first differ in octal
/// digit `level`, counted from the finest.
struct Node {
  double due = 0.0;  ///< when it is pruned: the largest disparity at or below it
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint16_t level = 0;
  std::uint16_t children = 0;
};

/// An inner node whose keys are still coming in.
struct Open {
  Node node;
  Moments moments;
  double misfit = 0.0;              ///< of its own box, once finished
  double child_misfit = 0.0;        ///< sum over children; finest cells have none
  std::array<double, 8> density{};  ///< of children, missing octants last
};

/// All inner nodes in post-order, from sorted keys, with a stack of the open ones (levels fall towards its top).
class TreeBuilder {
 public:
  TreeBuilder(const ClusterSettings& settings, double cell_edge)
      : rule_(settings.rule), floor_cells_(settings.floor_lab / cell_edge) {}

  std::vector<Node> build(const std::vector<Key>& keys) {
    nodes_.reserve(keys.size() / 2);
    for (std::uint32_t begin = 0; begin < keys.size();) {
      std::uint32_t end = begin + 1;
      while (end < keys.size() && keys[end].morton == keys[begin].morton) ++end;
      // The octal digit, counted from 1 at the finest, in which this cell parts from the next.
      int level = above_root;
      if (end < keys.size()) level = (std::bit_width(keys[begin].morton ^ keys[end].morton) + 2) / 3;
      if (depth_ > 0 && top().node.level <= level) {
        add_cell(top(), keys[begin].morton, end - begin);
        close_below(level, end);
      } else if (level != above_root) {
        add_cell(push(level, begin), keys[begin].morton, end - begin);
      }
      begin = end;
    }
    return std::move(nodes_);
  }

 private:
  static constexpr int above_root = 64;

  Open& top() { return open_[depth_ - 1]; }
  Open& push(int level, std::uint32_t begin) {
    Open& open = open_[depth_++];
    open = Open{};
    open.node = {-std::numeric_limits<double>::infinity(), begin, 0, static_cast<std::uint16_t>(level), 0};
    return open;
  }

  /// Closes nodes until the next key, which parts at `level`, belongs into the one on top.
  void close_below(int level, std::uint32_t end) {
    while (top().node.level < level) {
      finish(top(), end);
      if (depth_ > 1 && open_[depth_ - 2].node.level <= level) {
        hang(top(), open_[depth_ - 2]);
        --depth_;
      } else if (level == above_root) {
        return;
      } else {
        const Open child = top();
        --depth_;
        hang(child, push(level, child.node.begin));
      }
    }
  }

  void add_cell(Open& parent, std::uint64_t morton, std::uint32_t texels) const {
    parent.moments.add_cell(morton, texels);
    parent.density[parent.node.children++] = texels / (floor_cells_ * floor_cells_ * floor_cells_);
  }

  void hang(const Open& child, Open& parent) const {
    parent.moments.add(child.moments);
    parent.node.due = std::max(parent.node.due, child.node.due);
    parent.child_misfit += child.misfit;
    parent.density[parent.node.children++] =
        rule_ == PruneRule::density ? density_of(child.moments, floor_cells_) : 0.0;
  }

  /// All children are there: the node gets its disparity and is kept.
  void finish(Open& open, std::uint32_t end) {
    open.node.end = end;
    double disparity = 0.0;
    if (rule_ == PruneRule::misfit) {
      open.misfit = misfit_of(open.moments);
      disparity = (open.misfit - open.child_misfit) / (open.node.children - 1);
    } else {
      double mean = 0.0;
      for (const double d : open.density) mean += d / 8.0;
      for (const double d : open.density) disparity += std::abs(d - mean) / 8.0;
    }
    open.node.due = std::max(open.node.due, disparity);
    nodes_.push_back(open.node);
  }

  PruneRule rule_;
  double floor_cells_;
  std::vector<Node> nodes_;
  std::array<Open, 23> open_;  ///< one per level, at most 21
  std::size_t depth_ = 0;
};

/// The inner nodes that survive pruning, by where they begin, ancestors first.
///
/// Pruning takes the least disparity among nodes without inner children until few enough leaves are left. A node's
/// disparity never changes, and it cannot go before its descendants, so it goes when the largest disparity at or below
/// it has come up: nodes go in order of `due`, ties in post-order. What survives is the end of that order.
std::vector<Node> survivors(std::vector<Node> nodes, int max_clusters) {
  const auto later = [&](std::uint32_t one, std::uint32_t two) {
    return nodes[one].due != nodes[two].due ? nodes[one].due > nodes[two].due : one > two;
  };
  std::vector<std::uint32_t> order(nodes.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t most = std::min(order.size(), static_cast<std::size_t>(max_clusters));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), later);
  std::vector<Node> kept;
  int leaves = 1;
  for (std::size_t i = 0; i < most; ++i) {
    leaves += nodes[order[i]].children - 1;
    if (leaves > max_clusters) break;
    kept.push_back(nodes[order[i]]);
  }
  std::sort(kept.begin(), kept.end(), [](const Node& one, const Node& two) {
    return one.begin != two.begin ? one.begin < two.begin : one.level > two.level;
  });
  return kept;
}

LabCuboid tight_box(std::span<const Key> keys, std::span<const glm::vec3> lab) {
  LabCuboid box{lab[keys[0].texel], lab[keys[0].texel], static_cast<std::uint32_t>(keys.size())};
  for (const Key& key : keys) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], lab[key.texel][axis]);
      box.hi[axis] = std::max(box.hi[axis], lab[key.texel][axis]);
    }
  }
  return box;
}

/// Where the children of the surviving nodes begin: the leaves lie between these cuts.
std::vector<std::uint32_t> leaf_begins(const std::vector<Node>& kept, const std::vector<Key>& keys) {
  std::vector<std::uint32_t> cuts{0};
  for (const Node& node : kept) {
    const int shift = 3 * (node.level - 1);
    for (std::uint32_t i = node.begin; i < node.end;) {
      cuts.push_back(i);
      const std::uint64_t last = keys[i].morton >> shift;
      const auto next = std::partition_point(keys.begin() + i, keys.begin() + node.end,
                                             [&](const Key& key) { return key.morton >> shift == last; });
      i = static_cast<std::uint32_t>(next - keys.begin());
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

}  // namespace

std::vector<LabCuboid> cluster_texels(std::span<const glm::vec3> lab, const ClusterSettings& settings) {
  check_at_most(1, settings.max_clusters, "max_clusters");
  check_at_most(1, settings.depth, "depth");
  check_at_most(settings.depth, 21, "depth");
  check_equal(settings.floor_lab > 0.0, true, "floor_lab is positive");
  if (lab.empty()) return {};
  double cell_edge = 0.0;
  std::vector<Key> keys = morton_keys(lab, settings.depth, cell_edge);
  radix_sort(keys);
  const std::vector<Node> kept = survivors(TreeBuilder(settings, cell_edge).build(keys), settings.max_clusters);

  std::vector<LabCuboid> clusters;
  std::vector<std::uint32_t> begins = leaf_begins(kept, keys);
  begins.push_back(static_cast<std::uint32_t>(keys.size()));
  for (std::size_t i = 0; i + 1 < begins.size(); ++i)
    clusters.push_back(tight_box(std::span(keys).subspan(begins[i], begins[i + 1] - begins[i]), lab));
  return clusters;
}

}  // namespace lackwerk::core
