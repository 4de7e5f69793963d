#include "kiosk/tools/report/stiff_transport.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/transport.hpp"
#include "core/analysis/transport_lemon.hpp"
#include "kiosk/tools/report/transport_cases.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

/// The transport's documented cost, distance + 1e-6 distance^2, in long double.
std::vector<long double> exact_costs(const TransportCase& instance) {
  std::vector<long double> out;
  out.reserve(instance.from.centres.size() * instance.to.centres.size());
  for (const glm::dvec3& one : instance.from.centres)
    for (const glm::dvec3& two : instance.to.centres) {
      long double squares = 0.0L;
      for (int axis = 0; axis < 3; ++axis) {
        const long double d = static_cast<long double>(one[axis]) - static_cast<long double>(two[axis]);
        squares += d * d;
      }
      out.push_back(std::sqrt(squares) + 1e-6L * squares);
    }
  return out;
}

long double objective(const std::vector<core::PlanEntry>& entries, const std::vector<long double>& cost,
                      std::size_t columns) {
  long double sum = 0.0L;
  for (const core::PlanEntry& entry : entries)
    sum += static_cast<long double>(entry.mass) * cost[entry.source * columns + entry.target];
  return sum;
}

/// The least objective that LEMON finds, costs rounded to 2^-42 of the largest.
long double reference(const TransportCase& instance, const std::vector<long double>& cost) {
  const long double largest = *std::max_element(cost.begin(), cost.end());
  std::vector<std::int64_t> scaled;
  scaled.reserve(cost.size());
  for (const long double c : cost) scaled.push_back(largest > 0.0L ? std::llround(std::ldexp(c / largest, 42)) : 0);
  const auto solved = core::LemonSimplex({instance.from.mass, instance.to.mass, scaled}).solve();
  return solved ? objective(solved->entries, cost, instance.to.mass.size()) : std::nanl("");
}

/// How far a plan's sums are from the masses: the largest difference.
double violation(const TransportCase& instance, const core::TransportPlan& plan) {
  std::vector<std::int64_t> sent = instance.from.mass;
  std::vector<std::int64_t> got = instance.to.mass;
  for (const core::PlanEntry& entry : plan.entries) {
    sent[entry.source] -= entry.mass;
    got[entry.target] -= entry.mass;
  }
  std::int64_t worst = 0;
  for (const std::int64_t left : sent) worst = std::max(worst, std::abs(left));
  for (const std::int64_t left : got) worst = std::max(worst, std::abs(left));
  return static_cast<double>(worst);
}

void add(Findings& findings, const std::string& name, const char* measure, double worst, double bound,
         const std::string& where) {
  StiffCase found;
  found.kernel = "transport";
  found.name = name;
  found.measure = measure;
  found.worst = worst;
  found.bound = bound;
  found.where = where;
  findings.stiff.push_back(std::move(found));
}

}  // namespace

void add_stiff_transport(Findings& findings) {
  // Either solver's plan is exact for costs rounded to half of 2^-39 of the largest (the coarser of the two), so
  // their objectives are apart by at most 2^-39 of the largest cost times all mass. That is below 1e-9 of the objective
  // as long as the mean way is above 1/500 of the longest, which holds in all cases but those of objective 0; there
  // both must find 0.
  constexpr double gap_bound = 1e-9;
  for (const TransportCase& instance : transport_cases()) {
    const auto plan =
        core::solve_transport(instance.from.centres, instance.from.mass, instance.to.centres, instance.to.mass);
    double gap = none;
    double off = none;
    std::string where = plan ? std::to_string(plan->entries.size()) + " entries" : plan.error().line();
    if (plan && instance.from.mass.empty()) {
      gap = plan->cost;
      off = static_cast<double>(plan->entries.size());
    } else if (plan) {
      const std::vector<long double> cost = exact_costs(instance);
      const long double best = reference(instance, cost);
      const long double ours = objective(plan->entries, cost, instance.to.mass.size());
      gap = static_cast<double>(best > 0.0L ? std::abs(ours - best) / best : std::abs(ours - best));
      off = violation(instance, *plan);
      where += ", mean way " + digits(plan->cost / total_mass(instance.from)) + " Lab";
    }
    add(findings, instance.name, "relative objective gap", gap, gap_bound, where);
    add(findings, instance.name, "marginal violation, mass", off, 0.0, where);
  }
}

}  // namespace lackwerk::report
