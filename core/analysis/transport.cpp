#include "core/analysis/transport.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "core/analysis/transport_lemon.hpp"
#include "core/analysis/transport_simplex.hpp"

namespace lackwerk::core {

namespace {

constexpr std::int64_t most_mass = std::int64_t{1} << 62;
constexpr double most_far = 1e100;  // squares of distances stay finite
constexpr double tie_break = 1e-6;  // per Lab; changes the objective by 1e-4 of itself at a distance of 100
constexpr int cost_bits = 40;

/// One side with clusters of equal centre merged, ordered by centre.
struct Side {
  struct Group {
    glm::dvec3 centre{0.0};
    std::int64_t mass = 0;
    std::size_t begin = 0;  ///< into `members`
    std::size_t end = 0;
  };
  std::vector<Group> groups;
  std::vector<std::uint32_t> members;  ///< cluster indices, ascending within a group, none of mass 0
  std::int64_t total = 0;
};

Result<Side> gather(const char* name, std::span<const glm::dvec3> centres, std::span<const std::int64_t> mass) {
  if (centres.size() != mass.size())
    return fail({}, name, std::to_string(centres.size()) + " centres for " + std::to_string(mass.size()) + " masses");
  Side side;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const std::string field = std::string(name) + "[" + std::to_string(i) + "]";
    if (mass[i] < 0) return fail({}, field, "the mass " + std::to_string(mass[i]) + " is negative");
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(centres[i][axis]) <= most_far)) return fail({}, field, "the centre is not finite");
    if (mass[i] > most_mass - side.total) return fail({}, field, "the masses sum to more than 2^62");
    side.total += mass[i];
    if (mass[i] > 0) side.members.push_back(static_cast<std::uint32_t>(i));
  }
  const auto key = [&](std::uint32_t i) { return std::tuple(centres[i].x, centres[i].y, centres[i].z, i); };
  std::sort(side.members.begin(), side.members.end(),
            [&](std::uint32_t one, std::uint32_t two) { return key(one) < key(two); });
  for (std::size_t m = 0; m < side.members.size(); ++m) {
    const std::uint32_t i = side.members[m];
    if (side.groups.empty() || side.groups.back().centre != centres[i]) side.groups.push_back({centres[i], 0, m, m});
    side.groups.back().mass += mass[i];
    side.groups.back().end = m + 1;
  }
  return side;
}

double distance(const glm::dvec3& one, const glm::dvec3& two) {
  const glm::dvec3 d = one - two;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

/// Integer costs of all pairs, row by row; the largest uses cost_bits bits.
std::vector<std::int64_t> scaled_costs(const Side& source, const Side& target) {
  std::vector<double> cost;
  cost.reserve(source.groups.size() * target.groups.size());
  double largest = 0.0;
  for (const auto& from : source.groups) {
    for (const auto& to : target.groups) {
      const double d = distance(from.centre, to.centre);
      cost.push_back(d + tie_break * d * d);
      largest = std::max(largest, cost.back());
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  const double scale = std::ldexp(1.0, cost_bits - std::max(exponent, -900));  // finite for the tiniest costs too
  std::vector<std::int64_t> scaled(cost.size());
  std::transform(cost.begin(), cost.end(), scaled.begin(), [&](double c) { return std::llround(c * scale); });
  return scaled;
}

std::vector<std::int64_t> group_masses(const Side& side) {
  std::vector<std::int64_t> mass;
  mass.reserve(side.groups.size());
  for (const Side::Group& group : side.groups) mass.push_back(group.mass);
  return mass;
}

/// Whether the plan is proven optimal; fills in the proof.
bool certify(const TransportProblem& problem, const TransportSolution& solution, TransportPlan& plan) {
  plan.primal = primal_objective(problem, solution.entries);
  plan.dual = dual_objective(problem, solution.source_potential);
  return plan.primal == plan.dual;
}

/// The plan between groups, by source group, then target group. Empty if no solver ended at a proven optimum.
std::vector<PlanEntry> solve_groups(const Side& source, const Side& target, TransportPlan& plan) {
  const std::vector<std::int64_t> leave = group_masses(source);
  const std::vector<std::int64_t> arrive = group_masses(target);
  const std::vector<std::int64_t> cost = scaled_costs(source, target);
  const TransportProblem problem{leave, arrive, cost};
  auto solution = solve_simplex(problem, usual_pivot_limit(problem));
  if (solution && certify(problem, *solution, plan)) return std::move(solution->entries);
  // The proof does not rest on our own solver: where it finds none, LEMON's may.
  solution = LemonSimplex(problem).solve();
  if (solution && certify(problem, *solution, plan)) return std::move(solution->entries);
  return {};
}

/// Hands what a group sends (or gets) to its members, first to first. Entries must come group by group.
template <class GroupOf, class Assign>
std::vector<PlanEntry> split(const std::vector<PlanEntry>& entries, const Side& side,
                             std::span<const std::int64_t> mass, GroupOf group_of, Assign assign) {
  std::vector<PlanEntry> out;
  out.reserve(entries.size() + side.members.size());
  std::size_t member = 0;
  std::int64_t left = 0;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const Side::Group& group = side.groups[group_of(entries[e])];
    if (e == 0 || group_of(entries[e]) != group_of(entries[e - 1])) {
      member = group.begin;
      left = mass[side.members[member]];
    }
    for (std::int64_t rest = entries[e].mass; rest > 0;) {
      if (left == 0) left = mass[side.members[++member]];
      const std::int64_t part = std::min(rest, left);
      out.push_back(entries[e]);
      out.back().mass = part;
      assign(out.back(), side.members[member]);
      rest -= part;
      left -= part;
    }
  }
  return out;
}

}  // namespace

Result<TransportPlan> solve_transport(std::span<const glm::dvec3> source_centres,
                                      std::span<const std::int64_t> source_mass,
                                      std::span<const glm::dvec3> target_centres,
                                      std::span<const std::int64_t> target_mass) {
  auto source = gather("source", source_centres, source_mass);
  if (!source) return tl::unexpected(source.error());
  auto target = gather("target", target_centres, target_mass);
  if (!target) return tl::unexpected(target.error());
  if (source->total != target->total)
    return fail({}, "target",
                "the masses sum to " + std::to_string(target->total) + ", those of the source to " +
                    std::to_string(source->total));
  TransportPlan plan;
  if (source->total == 0) return plan;

  auto entries = solve_groups(*source, *target, plan);
  if (entries.empty()) return fail({}, {}, "the transport solver found no optimum");

  entries = split(
      entries, *source, source_mass, [](const PlanEntry& e) { return e.source; },
      [](PlanEntry& e, std::uint32_t member) { e.source = member; });
  std::stable_sort(entries.begin(), entries.end(),
                   [](const PlanEntry& one, const PlanEntry& two) { return one.target < two.target; });
  entries = split(
      entries, *target, target_mass, [](const PlanEntry& e) { return e.target; },
      [](PlanEntry& e, std::uint32_t member) { e.target = member; });
  std::sort(entries.begin(), entries.end(), [](const PlanEntry& one, const PlanEntry& two) {
    return std::tie(one.source, one.target) < std::tie(two.source, two.target);
  });
  for (const PlanEntry& entry : entries)
    plan.cost += static_cast<double>(entry.mass) * distance(source_centres[entry.source], target_centres[entry.target]);
  plan.entries = std::move(entries);
  return plan;
}

}  // namespace lackwerk::core
