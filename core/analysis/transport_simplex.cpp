#include "core/analysis/transport_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/check.hpp"

namespace lackwerk::core {

namespace {

constexpr std::int32_t no_node = -1;

/// A spanning tree of all nodes: sources first, then targets. The last target is the root.
class Basis {
 public:
  explicit Basis(const TransportProblem& problem)
      : problem_(problem),
        sources_(problem.source_mass.size()),
        targets_(problem.target_mass.size()),
        nodes_(sources_ + targets_),
        potential_(sources_ + targets_, 0) {
    const double rows = std::sqrt(static_cast<double>(sources_) / static_cast<double>(targets_));
    block_rows_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rows)));
    // Rows come sorted by place: neighbours in turn would take the same targets. The golden section scatters them.
    stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(sources_)));
    while (std::gcd(stride_, sources_) != 1) ++stride_;
    start();
  }

  /// One exchange of arcs; false at an optimum.
  bool pivot();
  [[nodiscard]] TransportSolution solution() const;

 private:
  struct Node {
    std::int32_t parent = no_node;
    std::int32_t depth = 0;
    std::int32_t first_child = no_node;
    std::int32_t next = no_node, previous = no_node;  ///< among the children of the parent
    std::int64_t flow = 0;                            ///< between it and its parent, from source to target
  };
  struct Arc {
    std::int32_t source = no_node, target = no_node;
    std::int64_t reduced = 0;
  };
  struct Leaving {
    std::int32_t node = no_node;  ///< the lower end
    std::int64_t flow = std::numeric_limits<std::int64_t>::max();
    bool below_source = false;  ///< on the entering arc's source side
  };

  [[nodiscard]] Node& at(std::int32_t node) { return nodes_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] bool is_source(std::int32_t node) const { return static_cast<std::size_t>(node) < sources_; }
  [[nodiscard]] std::int64_t cost_of(std::int32_t one, std::int32_t two) const;

  void start();
  [[nodiscard]] Arc entering();
  [[nodiscard]] Leaving leaving(const Arc& arc);
  void push(const Arc& arc, std::int64_t flow);
  void unlink(std::int32_t node);
  void link(std::int32_t node, std::int32_t parent, std::int64_t flow);
  void refresh(std::int32_t top, std::int64_t shift);

  TransportProblem problem_;
  std::size_t sources_, targets_;
  std::vector<Node> nodes_;
  std::vector<std::int64_t> potential_;
  std::size_t block_rows_ = 1;  ///< so that a block has about sqrt(pairs) of them
  std::size_t next_row_ = 0;
  std::size_t stride_ = 1;  ///< from row to row, without a common divisor with their number
};

std::int64_t Basis::cost_of(std::int32_t one, std::int32_t two) const {
  const auto source = static_cast<std::size_t>(std::min(one, two));
  return problem_.cost[source * targets_ + static_cast<std::size_t>(std::max(one, two)) - sources_];
}

/// Mass with its part in the perturbation: sources have one unit more, which the root takes.
struct Perturbed {
  std::int64_t mass = 0;
  std::int64_t units = 0;
  bool operator==(const Perturbed&) const = default;
  [[nodiscard]] bool operator<(const Perturbed& other) const {
    return mass != other.mass ? mass < other.mass : units < other.units;
  }
  Perturbed& operator-=(const Perturbed& other) {
    mass -= other.mass;
    units -= other.units;
    return *this;
  }
};

/// Each source in turn fills the cheapest targets that have room. Perturbed, no source ends together with a target
/// before the last, so the arcs used are a tree, and a strongly feasible one.
void Basis::start() {
  struct Used {
    std::int32_t source, target;
    std::int64_t flow;
  };
  std::vector<Used> used;
  used.reserve(nodes_.size() - 1);
  std::vector<Perturbed> room;
  room.reserve(targets_);
  for (const std::int64_t mass : problem_.target_mass) room.push_back({mass, 0});
  room.back().units = static_cast<std::int64_t>(sources_);
  std::vector<std::size_t> open(targets_);
  for (std::size_t t = 0; t < targets_; ++t) open[t] = t;
  for (std::size_t k = 0, s = 0; k < sources_; ++k, s = (s + stride_) % sources_) {
    const std::int64_t* const cost = problem_.cost.data() + s * targets_;
    Perturbed left{problem_.source_mass[s], 1};
    while (Perturbed{} < left) {
      check_at_most(std::size_t{1}, open.size(), "targets left for a source");
      const auto place = std::min_element(open.begin(), open.end(),
                                          [&](std::size_t one, std::size_t two) { return cost[one] < cost[two]; });
      const std::size_t t = *place;
      const Perturbed sent = std::min(left, room[t]);
      used.push_back({static_cast<std::int32_t>(s), static_cast<std::int32_t>(sources_ + t), sent.mass});
      left -= sent;
      room[t] -= sent;
      if (room[t] == Perturbed{}) open.erase(place);
    }
  }
  check_equal(used.size() + 1, nodes_.size(), "arcs of the first basis, and one");

  // Hang the tree from its root, along the arcs of each node.
  std::vector<std::vector<std::size_t>> arcs(nodes_.size());
  for (std::size_t a = 0; a < used.size(); ++a) {
    arcs[static_cast<std::size_t>(used[a].source)].push_back(a);
    arcs[static_cast<std::size_t>(used[a].target)].push_back(a);
  }
  std::vector<std::int32_t> reached{static_cast<std::int32_t>(nodes_.size()) - 1};
  reached.reserve(nodes_.size());
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const std::int32_t node = reached[k];
    for (const std::size_t a : arcs[static_cast<std::size_t>(node)]) {
      const std::int32_t other = used[a].source == node ? used[a].target : used[a].source;
      if (other == at(node).parent) continue;
      link(other, node, used[a].flow);
      at(other).depth = at(node).depth + 1;
      const std::int64_t cost = cost_of(node, other);
      potential_[static_cast<std::size_t>(other)] =
          potential_[static_cast<std::size_t>(node)] + (is_source(other) ? -cost : cost);
      reached.push_back(other);
    }
  }
}

/// The most negative of a block of rows, from where the last search ended. Reduced 0: there is none at all.
Basis::Arc Basis::entering() {
  Arc best;
  const std::int64_t* const price = potential_.data() + sources_;
  std::size_t in_block = 0;
  for (std::size_t seen = 0; seen < sources_; ++seen) {
    const std::size_t s = next_row_;
    next_row_ = (s + stride_) % sources_;
    const std::int64_t* const cost = problem_.cost.data() + s * targets_;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    std::size_t where = 0;
    for (std::size_t t = 0; t < targets_; ++t) {
      const std::int64_t value = cost[t] - price[t];
      if (value < least) {
        least = value;
        where = t;
      }
    }
    least += potential_[s];
    if (least < best.reduced) best = {static_cast<std::int32_t>(s), static_cast<std::int32_t>(sources_ + where), least};
    if (++in_block == block_rows_) {
      if (best.reduced < 0) break;
      in_block = 0;
    }
  }
  return best;
}

/// The arc of the cycle that first runs dry: going round from the join along the entering arc, the last such. That
/// keeps the tree strongly feasible.
Basis::Leaving Basis::leaving(const Arc& arc) {
  Leaving found;
  std::int32_t below_source = arc.source;
  std::int32_t below_target = arc.target;
  Leaving on_target_side;
  while (below_source != below_target) {
    if (at(below_source).depth >= at(below_target).depth) {
      const Node& node = at(below_source);
      if (is_source(below_source) && node.flow < found.flow) found = {below_source, node.flow, true};
      below_source = node.parent;
    } else {
      const Node& node = at(below_target);
      if (!is_source(below_target) && node.flow <= on_target_side.flow)
        on_target_side = {below_target, node.flow, false};
      below_target = node.parent;
    }
  }
  return on_target_side.node != no_node && on_target_side.flow <= found.flow ? on_target_side : found;
}

void Basis::push(const Arc& arc, std::int64_t flow) {
  std::int32_t below_source = arc.source;
  std::int32_t below_target = arc.target;
  while (below_source != below_target) {
    if (at(below_source).depth >= at(below_target).depth) {
      at(below_source).flow += is_source(below_source) ? -flow : flow;
      below_source = at(below_source).parent;
    } else {
      at(below_target).flow += is_source(below_target) ? flow : -flow;
      below_target = at(below_target).parent;
    }
  }
}

void Basis::unlink(std::int32_t node) {
  const Node& gone = at(node);
  if (gone.previous == no_node)
    at(gone.parent).first_child = gone.next;
  else
    at(gone.previous).next = gone.next;
  if (gone.next != no_node) at(gone.next).previous = gone.previous;
}

void Basis::link(std::int32_t node, std::int32_t parent, std::int64_t flow) {
  Node& added = at(node);
  added.parent = parent;
  added.flow = flow;
  added.previous = no_node;
  added.next = at(parent).first_child;
  if (added.next != no_node) at(added.next).previous = node;
  at(parent).first_child = node;
}

/// Depths and potentials of the subtree that has been hung elsewhere.
void Basis::refresh(std::int32_t top, std::int64_t shift) {
  std::int32_t node = top;
  while (true) {
    at(node).depth = at(at(node).parent).depth + 1;
    potential_[static_cast<std::size_t>(node)] += shift;
    if (at(node).first_child != no_node) {
      node = at(node).first_child;
      continue;
    }
    while (node != top && at(node).next == no_node) node = at(node).parent;
    if (node == top) return;
    node = at(node).next;
  }
}

bool Basis::pivot() {
  const Arc arc = entering();
  if (arc.reduced >= 0) return false;
  const Leaving out = leaving(arc);
  check_equal(out.node == no_node, false, "a cycle on which nothing runs dry");
  if (out.flow > 0) push(arc, out.flow);
  // Turn the path from the entering arc's end up to the leaving arc upside down.
  const std::int32_t top = out.below_source ? arc.source : arc.target;
  std::int32_t node = top;
  std::int32_t parent = out.below_source ? arc.target : arc.source;
  std::int64_t flow = out.flow;
  while (true) {
    const std::int32_t above = at(node).parent;
    const std::int64_t flow_above = at(node).flow;
    unlink(node);
    link(node, parent, flow);
    if (node == out.node) break;
    parent = node;
    node = above;
    flow = flow_above;
  }
  refresh(top, out.below_source ? -arc.reduced : arc.reduced);
  return true;
}

TransportSolution Basis::solution() const {
  TransportSolution out;
  out.entries.reserve(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_[n].flow == 0) continue;
    const auto one = static_cast<std::int32_t>(n);
    const auto [source, target] = std::minmax(one, nodes_[n].parent);
    out.entries.push_back({static_cast<std::uint32_t>(source),
                           static_cast<std::uint32_t>(static_cast<std::size_t>(target) - sources_), nodes_[n].flow});
  }
  std::sort(out.entries.begin(), out.entries.end(), [](const PlanEntry& one, const PlanEntry& two) {
    return std::pair(one.source, one.target) < std::pair(two.source, two.target);
  });
  out.source_potential.assign(potential_.begin(), potential_.begin() + static_cast<std::ptrdiff_t>(sources_));
  return out;
}

/// Whether no potential can leave 63 bits: a path has less than all nodes, and a reduced cost adds two of them.
bool potentials_fit(const TransportProblem& problem) {
  const auto [least, most] = std::minmax_element(problem.cost.begin(), problem.cost.end());
  const Int128 largest = std::max(Int128{*most}, -Int128{*least});
  const auto nodes = static_cast<std::int64_t>(problem.source_mass.size() + problem.target_mass.size());
  return nodes < std::numeric_limits<std::int32_t>::max() && largest * nodes < (Int128{1} << 61);
}

}  // namespace

std::size_t usual_pivot_limit(const TransportProblem& problem) {
  return 50 * (problem.cost.size() + problem.source_mass.size() + problem.target_mass.size());
}

std::optional<TransportSolution> solve_simplex(const TransportProblem& problem, std::size_t most_pivots) {
  check_at_most(std::size_t{1}, std::min(problem.source_mass.size(), problem.target_mass.size()), "nodes of a side");
  check_equal(problem.cost.size(), problem.source_mass.size() * problem.target_mass.size(), "costs of all pairs");
  if (!potentials_fit(problem)) return std::nullopt;
  Basis basis(problem);
  std::size_t pivots = 0;
  while (basis.pivot())
    if (++pivots > most_pivots) return std::nullopt;
  TransportSolution out = basis.solution();
  out.pivots = pivots;
  return out;
}

Int128 primal_objective(const TransportProblem& problem, std::span<const PlanEntry> entries) {
  Int128 sum = 0;
  for (const PlanEntry& entry : entries)
    sum += Int128{entry.mass} * problem.cost[entry.source * problem.target_mass.size() + entry.target];
  return sum;
}

Int128 dual_objective(const TransportProblem& problem, std::span<const std::int64_t> source_potential) {
  const std::size_t columns = problem.target_mass.size();
  std::vector<std::int64_t> price(columns, std::numeric_limits<std::int64_t>::max());
  Int128 sum = 0;
  for (std::size_t s = 0; s < source_potential.size(); ++s) {
    const std::int64_t own = source_potential[s];
    const std::int64_t* const cost = problem.cost.data() + s * columns;
    for (std::size_t t = 0; t < columns; ++t) price[t] = std::min(price[t], own + cost[t]);
    sum -= Int128{problem.source_mass[s]} * own;
  }
  for (std::size_t t = 0; t < columns; ++t) sum += Int128{problem.target_mass[t]} * price[t];
  return sum;
}

}  // namespace lackwerk::core
