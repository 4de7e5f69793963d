#include "core/analysis/cloud_transport.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tuple>
#include <utility>

#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/cloud_wasserstein.hpp"
#include "core/analysis/transport_simplex.hpp"

namespace lackwerk::core {

namespace {

using Pairs = std::vector<CloudPair>;

bool before(const CloudPair& one, const CloudPair& two) {
  return std::tie(one.from, one.to) < std::tie(two.from, two.to);
}

/// Hands the coarse plan down to the points, first to first: at most one pair more than there are points and entries,
/// and a plan with exact marginals among them.
void add_backbone(const CloudClusters& from, const CloudClusters& to, const TransportPlan& plan, Pairs& pairs) {
  struct Cursor {
    std::size_t member = 0;
    std::int64_t left = 0;
  };
  const auto each_from = static_cast<std::int64_t>(to.points);  // what one point weighs, in the plan's units
  const auto each_to = static_cast<std::int64_t>(from.points);
  std::vector<Cursor> sources(from.members.size(), Cursor{0, each_from});
  std::vector<Cursor> targets(to.members.size(), Cursor{0, each_to});
  for (const PlanEntry& entry : plan.entries) {
    Cursor& source = sources[entry.source];
    Cursor& target = targets[entry.target];
    for (std::int64_t rest = entry.mass; rest > 0;) {
      if (source.left == 0) source = {source.member + 1, each_from};
      if (target.left == 0) target = {target.member + 1, each_to};
      pairs.push_back({from.members[entry.source][source.member], to.members[entry.target][target.member]});
      const std::int64_t part = std::min({rest, source.left, target.left});
      rest -= part;
      source.left -= part;
      target.left -= part;
    }
  }
}

double squared_distance(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// The plan between the groups that costs least. plan_between's counts distances, not squares: along a stem that grows,
/// staying and jumping to the tip cost it the same.
TransportPlan coarse_plan(const CloudClusters& from, const CloudClusters& to, bool squared) {
  if (!squared) return plan_between(from, to);
  std::vector<double> cost;
  cost.reserve(from.centres.size() * to.centres.size());
  double largest = 0.0;
  for (const glm::dvec3& a : from.centres) {
    for (const glm::dvec3& b : to.centres) {
      cost.push_back(squared_distance(a, b));
      largest = std::max(largest, cost.back());
    }
  }
  if (!(largest > 0.0)) return plan_between(from, to);
  constexpr int cost_bits = 40;
  std::vector<std::int64_t> scaled;
  scaled.reserve(cost.size());
  for (const double c : cost) scaled.push_back(std::llround(std::ldexp(c / largest, cost_bits)));
  const auto masses = [](const CloudClusters& side, std::size_t others) {
    std::vector<std::int64_t> out;
    out.reserve(side.members.size());
    for (const auto& members : side.members) out.push_back(static_cast<std::int64_t>(members.size() * others));
    return out;
  };
  const std::vector<std::int64_t> leave = masses(from, to.points);
  const std::vector<std::int64_t> arrive = masses(to, from.points);
  const TransportProblem problem{leave, arrive, scaled};
  auto solution = solve_simplex(problem, usual_pivot_limit(problem));
  if (!solution) return plan_between(from, to);
  TransportPlan plan;
  plan.entries = std::move(solution->entries);
  return plan;
}

/// Where the points of a group move: the mean way of the groups around it, and how it changes from place to place. A
/// part that grows stretches, so one way for a whole group would leave gaps between groups and crowd their seams.
struct LocalWay {
  glm::dvec3 centre{0.0}, way{0.0};
  glm::dmat3 change{0.0};
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& place) const { return way + change * (place - centre); }
};

/// Least squares over each group and those nearest to it.
std::vector<LocalWay> smooth_ways(const std::vector<glm::dvec3>& centres, const std::vector<glm::dvec3>& ways) {
  constexpr std::size_t around = 9;
  // What the groups do not span (across a thin stem) is not guessed at.
  constexpr double ridge = 0.01;
  std::vector<LocalWay> out(centres.size());
  const CloudTree tree(centres);
  std::vector<CloudNeighbour> near;
  for (std::size_t g = 0; g < centres.size(); ++g) {
    tree.nearest(centres[g], around, near);
    LocalWay& local = out[g];
    for (const CloudNeighbour& n : near) {
      local.centre += (centres[n.index] - centres[g]) / static_cast<double>(near.size());
      local.way += ways[n.index] / static_cast<double>(near.size());
    }
    local.centre += centres[g];
    glm::dmat3 spread(0.0), change(0.0);
    for (const CloudNeighbour& n : near) {
      const glm::dvec3 off = centres[n.index] - local.centre;
      spread += glm::outerProduct(off, off);
      change += glm::outerProduct(ways[n.index] - local.way, off);
    }
    const double size = spread[0][0] + spread[1][1] + spread[2][2];
    if (!(size > 0.0)) continue;
    const glm::dmat3 fitted = change / size * glm::inverse(spread / size + glm::dmat3(ridge));
    bool finite = true;
    for (int axis = 0; axis < 3; ++axis) finite = finite && std::isfinite(glm::dot(fitted[axis], glm::dvec3(1.0)));
    if (finite) local.change = fitted;
  }
  return out;
}

/// Where mass goes between the groups: of each source group, and (backwards) to each target group.
struct Drift {
  std::vector<LocalWay> leaving, arriving;
};
Drift drift_of(const CloudClusters& from, const CloudClusters& to, const TransportPlan& plan) {
  std::vector<glm::dvec3> leaving(from.centres.size(), glm::dvec3(0.0));
  std::vector<glm::dvec3> arriving(to.centres.size(), glm::dvec3(0.0));
  const auto points = static_cast<double>(from.points);
  const auto others = static_cast<double>(to.points);
  for (const PlanEntry& e : plan.entries) {
    const glm::dvec3 way = to.centres[e.target] - from.centres[e.source];
    const auto mass = static_cast<double>(e.mass);
    leaving[e.source] += mass / (others * static_cast<double>(from.members[e.source].size())) * way;
    arriving[e.target] += mass / (points * static_cast<double>(to.members[e.target].size())) * way;
  }
  return {smooth_ways(from.centres, leaving), smooth_ways(to.centres, arriving)};
}

}  // namespace

TransportSupport cloud_support(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                               const CloudTransportOptions& options) {
  const CloudClusters sources = clusters_of(from, options.clusters);
  const CloudClusters targets = clusters_of(to, options.clusters);
  const TransportPlan plan = coarse_plan(sources, targets, options.squared);
  const Drift drift = drift_of(sources, targets, plan);
  Pairs pairs;
  pairs.reserve((from.size() + to.size()) * (options.neighbours + 1));
  std::vector<CloudNeighbour> near;
  {
    const CloudTree tree(to);
    for (std::size_t g = 0; g < drift.leaving.size(); ++g) {
      for (const std::uint32_t a : sources.members[g]) {
        tree.nearest(from[a] + drift.leaving[g](from[a]), options.neighbours, near);
        for (const CloudNeighbour& n : near) pairs.push_back({a, n.index});
      }
    }
  }
  {
    const CloudTree tree(from);
    for (std::size_t g = 0; g < drift.arriving.size(); ++g) {
      for (const std::uint32_t b : targets.members[g]) {
        tree.nearest(to[b] - drift.arriving[g](to[b]), options.neighbours, near);
        for (const CloudNeighbour& n : near) pairs.push_back({n.index, b});
      }
    }
  }
  if (options.backbone) add_backbone(sources, targets, plan, pairs);
  std::sort(pairs.begin(), pairs.end(), before);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  TransportSupport support;
  support.columns = static_cast<std::uint32_t>(to.size());
  support.column.reserve(pairs.size());
  support.cost.reserve(pairs.size());
  for (const CloudPair& pair : pairs) {
    while (support.rows() < pair.from) support.row_begin.push_back(static_cast<std::uint32_t>(support.column.size()));
    support.column.push_back(pair.to);
    const double square = squared_distance(from[pair.from], to[pair.to]);
    support.cost.push_back(options.squared ? square : std::sqrt(square));
  }
  while (support.rows() < from.size()) support.row_begin.push_back(static_cast<std::uint32_t>(support.column.size()));
  return support;
}

std::vector<CloudPair> largest_pairs(const TransportSupport& support, std::span<const double> mass) {
  struct Best {
    double mass = -1.0;
    double cost = 0.0;
    std::uint32_t partner = 0;
    void offer(double m, double c, std::uint32_t p) {
      if (std::tuple(-m, c, p) < std::tuple(-mass, cost, partner)) *this = {m, c, p};
    }
  };
  Pairs pairs;
  std::vector<Best> columns(support.columns);
  for (std::uint32_t a = 0; a < support.rows(); ++a) {
    Best row;
    for (std::uint32_t e = support.row_begin[a]; e < support.row_begin[a + 1]; ++e) {
      row.offer(mass[e], support.cost[e], support.column[e]);
      columns[support.column[e]].offer(mass[e], support.cost[e], a);
    }
    pairs.push_back({a, row.partner});
  }
  for (std::uint32_t b = 0; b < support.columns; ++b) pairs.push_back({columns[b].partner, b});
  std::sort(pairs.begin(), pairs.end(), before);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Result<CloudPairs> pair_points(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                               const CloudTransportOptions& options) {
  CloudPairs out;
  if (from.empty() || to.empty()) return out;
  const std::vector<double> leave(from.size(), 1.0 / static_cast<double>(from.size()));
  const std::vector<double> arrive(to.size(), 1.0 / static_cast<double>(to.size()));
  TransportSupport support = cloud_support(from, to, options);
  SinkhornOptions sinkhorn;
  sinkhorn.gamma = options.gamma;
  sinkhorn.tolerance = options.tolerance;
  sinkhorn.most_iterations = options.most_iterations;
  sinkhorn.momentum = true;
  sinkhorn.feasible = options.backbone;
  sinkhorn.domain = SinkhornDomain::logarithmic;
  sinkhorn.precision = SinkhornPrecision::single_float;
  auto plan = solve_sinkhorn(support, leave, arrive, sinkhorn);
  if (plan && plan->state == SinkhornState::infeasible && !options.backbone) {
    CloudTransportOptions wider = options;
    wider.backbone = true;
    sinkhorn.feasible = true;
    support = cloud_support(from, to, wider);
    plan = solve_sinkhorn(support, leave, arrive, sinkhorn);
  }
  if (!plan) return tl::unexpected(plan.error());
  out.pairs = largest_pairs(support, plan->mass);
  out.state = plan->state;
  out.iterations = plan->iterations;
  out.marginal_violation = plan->marginal_violation;
  out.support = support.cost.size();
  for (std::uint32_t a = 0; a < support.rows(); ++a)
    for (std::uint32_t e = support.row_begin[a]; e < support.row_begin[a + 1]; ++e)
      out.mean_distance += plan->mass[e] * std::sqrt(squared_distance(from[a], to[support.column[e]]));
  return out;
}

}  // namespace lackwerk::core
