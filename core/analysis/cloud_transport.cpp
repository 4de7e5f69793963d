#include "core/analysis/cloud_transport.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/cloud_wasserstein.hpp"
#include "core/check.hpp"

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

/// Where mass goes between the groups: how far that of each source group on average, and how far that of each target
/// group has come. The exact plan counts distances, not squares: along a stem that grows, staying and jumping to the
/// tip cost it the same; so the drift is that of a regularised plan between the groups.
struct Drift {
  std::vector<glm::dvec3> leaving, arriving;
};
Result<Drift> drift_between(const CloudClusters& from, const CloudClusters& to, bool squared) {
  std::vector<double> cost;
  for (const glm::dvec3& a : from.centres)
    for (const glm::dvec3& b : to.centres)
      cost.push_back(squared ? squared_distance(a, b) : std::sqrt(squared_distance(a, b)));
  const auto masses = [](const CloudClusters& side) {
    std::vector<double> out;
    for (const auto& members : side.members)
      out.push_back(static_cast<double>(members.size()) / static_cast<double>(side.points));
    return out;
  };
  const std::vector<double> leave = masses(from);
  const std::vector<double> arrive = masses(to);
  SinkhornOptions options;
  options.gamma = 0.01;  // relative: a blur of a tenth of the typical distance
  options.tolerance = 1e-3;
  options.most_iterations = 2000;
  options.domain = SinkhornDomain::logarithmic;
  const auto plan = solve_sinkhorn(dense_support(leave.size(), arrive.size(), cost), leave, arrive, options);
  if (!plan) return tl::unexpected(plan.error());
  Drift drift{std::vector<glm::dvec3>(leave.size(), glm::dvec3(0.0)),
              std::vector<glm::dvec3>(arrive.size(), glm::dvec3(0.0))};
  for (std::size_t g = 0; g < leave.size(); ++g) {
    for (std::size_t h = 0; h < arrive.size(); ++h) {
      const double mass = plan->mass[g * arrive.size() + h];
      drift.leaving[g] += mass / leave[g] * (to.centres[h] - from.centres[g]);
      drift.arriving[h] += mass / arrive[h] * (to.centres[h] - from.centres[g]);
    }
  }
  return drift;
}

}  // namespace

TransportSupport cloud_support(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                               const CloudTransportOptions& options) {
  const CloudClusters sources = clusters_of(from, options.clusters);
  const CloudClusters targets = clusters_of(to, options.clusters);
  const auto drift = drift_between(sources, targets, options.squared);
  check_equal(drift.has_value(), true, "a plan between groups of equal mass exists");
  Pairs pairs;
  pairs.reserve((from.size() + to.size()) * (options.neighbours + 1));
  std::vector<CloudNeighbour> near;
  {
    const CloudTree tree(to);
    for (std::size_t g = 0; g < drift->leaving.size(); ++g) {
      for (const std::uint32_t a : sources.members[g]) {
        tree.nearest(from[a] + drift->leaving[g], options.neighbours, near);
        for (const CloudNeighbour& n : near) pairs.push_back({a, n.index});
      }
    }
  }
  {
    const CloudTree tree(from);
    for (std::size_t g = 0; g < drift->arriving.size(); ++g) {
      for (const std::uint32_t b : targets.members[g]) {
        tree.nearest(to[b] - drift->arriving[g], options.neighbours, near);
        for (const CloudNeighbour& n : near) pairs.push_back({n.index, b});
      }
    }
  }
  if (options.backbone) add_backbone(sources, targets, plan_between(sources, targets), pairs);
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
  sinkhorn.domain = SinkhornDomain::logarithmic;
  sinkhorn.precision = SinkhornPrecision::single_float;
  auto plan = solve_sinkhorn(support, leave, arrive, sinkhorn);
  if (plan && plan->state == SinkhornState::infeasible && !options.backbone) {
    CloudTransportOptions wider = options;
    wider.backbone = true;
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
