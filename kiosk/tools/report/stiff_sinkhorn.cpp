#include "kiosk/tools/report/stiff_sinkhorn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/sinkhorn.hpp"
#include "core/analysis/transport.hpp"
#include "kiosk/tools/report/transport_cases.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

using core::SinkhornDomain;
using core::SinkhornPrecision;

constexpr double tolerance = 1e-3;  // of the marginals, relative to all mass
/// Sinkhorn's rate falls with exp(-cost / gamma) (Franklin & Lorenz 1989), so that no number of iterations serves every
/// gamma. From this gamma on, one or two percent of the costs' spread here, all must converge within the limit; below
/// it a run may stop there, must say so, and may be this far off.
constexpr double surely_converging = 3.0;  // Lab
constexpr int most_iterations = 2000;
constexpr double most_left_over = 0.05;
constexpr std::array gammas = {10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01};

void add(Findings& findings, const std::string& name, const char* measure, double worst, double bound,
         const std::string& where) {
  StiffCase found;
  found.kernel = "sinkhorn";
  found.name = name;
  found.measure = measure;
  found.worst = worst;
  found.bound = bound;
  found.where = where;
  findings.stiff.push_back(std::move(found));
}

/// The largest of what it was given, and where; NaN stays.
struct Worst {
  double value = 0.0;
  std::string where;
  void take(double next, const std::string& at) {
    if (next <= value || std::isnan(value)) return;
    value = next;
    where = at;
  }
};

struct Worsts {
  Worst violation, left_over, below, above, not_numbers, untrue;
};

std::vector<double> real(const std::vector<std::int64_t>& mass) { return {mass.begin(), mass.end()}; }

/// One case at one setting. Costs per unit of mass, in Lab.
void try_one(const TransportCase& instance, const core::SinkhornOptions& options, double exact, Worsts& worst) {
  const std::string where = "gamma " + digits(options.gamma) +
                            (options.precision == SinkhornPrecision::single_float ? ", float" : ", double") +
                            (options.domain == SinkhornDomain::plain ? ", plain" : ", log");
  const std::vector<double> costs = distances(instance.from, instance.to);
  const auto plan = core::solve_sinkhorn(core::dense_support(instance.from.mass.size(), instance.to.mass.size(), costs),
                                         real(instance.from.mass), real(instance.to.mass), options);
  const bool finite =
      plan && std::isfinite(plan->cost) && std::isfinite(plan->objective) &&
      std::all_of(plan->mass.begin(), plan->mass.end(), [](double mass) { return std::isfinite(mass) && mass >= 0.0; });
  worst.not_numbers.take(finite ? 0.0 : 1.0, where);
  const double violation = plan ? plan->marginal_violation : none;
  // A tenth more than asked for: the violation is summed again in double after a stop judged in the kernel's type.
  const bool met = violation <= 1.1 * tolerance;
  const bool says_met = plan && plan->state == core::SinkhornState::converged;
  const bool says_not = plan && plan->state == core::SinkhornState::iteration_limit;
  worst.untrue.take(says_met ? (met ? 0.0 : 1.0) : (says_not ? 0.0 : 1.0), where);
  (options.gamma >= surely_converging ? worst.violation : worst.left_over).take(violation, where);
  if (!plan || costs.empty()) return;
  const double total = total_mass(instance.from);
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  // Mass off by v of the total can be put right by sending it elsewhere, and each way differs from another by at most
  // the spread of the costs; what is missing or too much pays the least cost.
  const double astray = plan->marginal_violation * (*most - *least);
  double moved = 0.0;
  for (const double mass : plan->mass) moved += mass;
  const double cost = (plan->cost - (moved - total) * *least) / total;
  const double rounding = 1e-12 * *most;  // 2500 terms summed in double
  const auto smaller = static_cast<double>(std::min(instance.from.mass.size(), instance.to.mass.size()));
  worst.below.take(exact - cost - astray - rounding, where);
  worst.above.take(cost - exact - options.gamma * std::log(smaller) - astray - rounding, where);
}

void add_dense(Findings& findings, const TransportCase& instance) {
  const auto exact =
      core::solve_transport(instance.from.centres, instance.from.mass, instance.to.centres, instance.to.mass);
  const double total = total_mass(instance.from);
  double way = none;
  if (exact) way = total > 0.0 ? exact->cost / total : 0.0;
  // The exact plan is optimal with 1e-6 d^2 added, so the least cost may be lower by as much.
  Worsts worst;
  for (const double gamma : gammas)
    for (const SinkhornPrecision precision : {SinkhornPrecision::single_float, SinkhornPrecision::double_float})
      for (const SinkhornDomain domain : {SinkhornDomain::plain, SinkhornDomain::logarithmic}) {
        core::SinkhornOptions options;
        options.gamma = gamma;
        options.gamma_is_relative = false;
        options.tolerance = tolerance;
        options.most_iterations = most_iterations;
        options.precision = precision;
        options.domain = domain;
        try_one(instance, options, way, worst);
      }
  add(findings, instance.name, "marginal violation / all mass, gamma from 3 Lab on", worst.violation.value,
      1.1 * tolerance, worst.violation.where);
  add(findings, instance.name, "marginal violation / all mass, gamma below 3 Lab", worst.left_over.value,
      most_left_over, worst.left_over.where);
  add(findings, instance.name, "below the exact cost, Lab", worst.below.value, 0.0, worst.below.where);
  add(findings, instance.name, "above the entropic bound gamma log n, Lab", worst.above.value, 0.0, worst.above.where);
  add(findings, instance.name, "runs with values that are no numbers", worst.not_numbers.value, 0.0,
      worst.not_numbers.where);
  add(findings, instance.name, "runs that say what is not so", worst.untrue.value, 0.0, worst.untrue.where);
}

/// 1 unless both domains and precisions say that the support allows no plan.
void add_infeasible(Findings& findings, const char* name, const core::TransportSupport& support) {
  const std::vector<double> third(3, 1.0 / 3.0);
  Worst worst;
  for (const SinkhornPrecision precision : {SinkhornPrecision::single_float, SinkhornPrecision::double_float})
    for (const SinkhornDomain domain : {SinkhornDomain::plain, SinkhornDomain::logarithmic}) {
      core::SinkhornOptions options;
      options.gamma = 1.0;
      options.gamma_is_relative = false;
      options.precision = precision;
      options.domain = domain;
      const auto plan = core::solve_sinkhorn(support, third, third, options);
      const bool said = plan && plan->state == core::SinkhornState::infeasible && !plan->stuck_rows.empty();
      worst.take(said ? 0.0 : 1.0, domain == SinkhornDomain::plain ? "plain" : "log");
    }
  add(findings, name, "runs that do not say so", worst.value, 0.0, worst.where);
}

}  // namespace

void add_stiff_sinkhorn(Findings& findings) {
  for (const TransportCase& instance : transport_cases()) add_dense(findings, instance);
  core::TransportSupport lonely;  // row 2 has no column, column 2 no row
  lonely.columns = 3;
  lonely.row_begin = {0, 1, 2, 2};
  lonely.column = {0, 1};
  lonely.cost = {1.0, 1.0};
  add_infeasible(findings, "sparse, a row without partners", lonely);
  core::TransportSupport crowded;  // rows 0 and 1 know column 0 alone: Hall's condition fails
  crowded.columns = 3;
  crowded.row_begin = {0, 1, 2, 5};
  crowded.column = {0, 0, 0, 1, 2};
  crowded.cost.assign(5, 1.0);
  add_infeasible(findings, "sparse, two rows for one column", crowded);
}

}  // namespace lackwerk::report
