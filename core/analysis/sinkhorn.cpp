#include "core/analysis/sinkhorn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace lackwerk::core {

namespace {

/// The rows and columns that have mass, with masses that sum to 1 and reduced costs (>= 0, a 0 in each row and column).
struct Problem {
  std::vector<std::uint32_t> begin{0}, column;
  std::vector<std::size_t> entry;  ///< place in the support
  std::vector<double> cost;
  std::vector<double> row_mass, column_mass;
  double largest_cost = 0.0;

  [[nodiscard]] std::size_t rows() const { return row_mass.size(); }
  [[nodiscard]] std::size_t columns() const { return column_mass.size(); }
};

enum class Stop { converged, drifted, limit, stalled };

/// How much of the last step goes on, from how fast the violation falls. Near the solution an iteration shrinks each
/// mode of the error by its own factor below 1; with momentum b the slowest, l, shrinks by z where z^2 - (l + b) z + b
/// is 0, and best, by sqrt(b), where sqrt(b) is 1 - sqrt(1 - l).
class Momentum {
 public:
  explicit Momentum(bool wanted) : wanted_(wanted) {}
  [[nodiscard]] bool wanted() const { return wanted_; }
  [[nodiscard]] double part() const { return part_; }
  /// Told after each iteration.
  void look(double violation) {
    if (!wanted_ || ++since_ < span) return;
    since_ = 0;
    const double rate = std::pow(violation / then_, 1.0 / span);
    then_ = violation;
    if (!(rate < 1.0)) {
      part_ = 0.0;  // too much, or too early: plain iterations never diverge
    } else if (rate > std::sqrt(part_)) {
      const double slowest = std::min(most_slow, rate + part_ / rate - part_);
      const double root = 1.0 - std::sqrt(std::max(0.0, 1.0 - slowest));
      part_ = root * root;
    }
  }

 private:
  static constexpr int span = 16;
  static constexpr double most_slow = 0.9995;  ///< beyond it rounding is amplified
  bool wanted_;
  int since_ = 0;
  double then_ = std::numeric_limits<double>::infinity();
  double part_ = 0.0;
};

/// Counts iterations and notices when they lead nowhere.
struct Watch {
  int iterations = 0;
  int most = 0;
  bool look_for_stall = false;
  Momentum momentum{false};  ///< outlives absorptions: the rate is the problem's
  double violation_then = std::numeric_limits<double>::infinity();
};
constexpr int stall_span = 256;         ///< iterations between two looks
constexpr double stall_progress = 0.9;  ///< less than a tenth gained in one span: 5,000 more would gain one digit

/// `plain` scalings may use half the exponents of their type, so that no product of two overflows.
template <class Real>
Real widest_plain() {
  return std::sqrt(std::numeric_limits<Real>::max()) / Real{2};
}
/// Scalings wider than this are absorbed into the potentials: kernels then keep 30 decades below (float's range).
constexpr double widest_absorbed = 1e8;

template <class Real>
struct Scalings {
  std::vector<Real> kernel, u, v, sum;
};

/// v = m' / (K^T u). False, with v left as it was, where a column's sum has died or a scaling leaves the range.
template <class Real>
bool fit_columns(const Problem& p, Scalings<Real>& s, Real widest) {
  s.sum.assign(p.columns(), Real{0});
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e) s.sum[p.column[e]] += s.kernel[e] * s.u[a];
  for (std::size_t b = 0; b < p.columns(); ++b) {
    s.sum[b] = static_cast<Real>(p.column_mass[b]) / s.sum[b];
    if (!(s.sum[b] <= widest) || !(s.sum[b] >= Real{1} / widest)) return false;
  }
  s.v.swap(s.sum);
  return true;
}

/// Iterates from scalings that fit the columns.
template <class Real>
Stop iterate(const Problem& p, Scalings<Real>& s, Real widest, double tolerance, Watch& watch) {
  std::vector<Real> fresh(p.rows()), before;
  while (true) {
    double violation = 0.0;
    bool alive = true;
    for (std::size_t a = 0; a < p.rows(); ++a) {
      Real sum{0};
      for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e) sum += s.kernel[e] * s.v[p.column[e]];
      violation += std::abs(static_cast<double>(s.u[a]) * static_cast<double>(sum) - p.row_mass[a]);
      fresh[a] = static_cast<Real>(p.row_mass[a]) / sum;
      alive = alive && fresh[a] <= widest && fresh[a] >= Real{1} / widest;
    }
    if (violation <= tolerance) return Stop::converged;
    if (!alive) return Stop::drifted;
    if (watch.iterations >= watch.most) return Stop::limit;
    ++watch.iterations;
    if (watch.look_for_stall && watch.iterations % stall_span == 0) {
      if (violation > stall_progress * watch.violation_then) return Stop::stalled;
      watch.violation_then = violation;
    }
    watch.momentum.look(violation);
    const auto part = static_cast<Real>(watch.momentum.part());
    if (part > Real{0} && before.size() == p.rows())
      for (std::size_t a = 0; a < p.rows(); ++a)
        fresh[a] = std::clamp(fresh[a] * std::pow(s.u[a] / before[a], part), Real{1} / widest, widest);
    if (watch.momentum.wanted()) before = s.u;
    s.u.swap(fresh);
    if (!fit_columns(p, s, widest)) {
      s.u.swap(fresh);  // back to a pair that fits the columns
      return Stop::drifted;
    }
  }
}

/// One iteration of log-sum-exp: never over- or underflows, whatever the costs. Potentials in units of cost.
void iterate_logarithmic(const Problem& p, double gamma, std::vector<double>& f, std::vector<double>& g) {
  for (std::size_t a = 0; a < p.rows(); ++a) {
    double most = -std::numeric_limits<double>::infinity();
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e) most = std::max(most, g[p.column[e]] - p.cost[e]);
    double sum = 0.0;
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e)
      sum += std::exp((g[p.column[e]] - p.cost[e] - most) / gamma);
    f[a] = gamma * (std::log(p.row_mass[a]) - std::log(sum)) - most;
  }
  std::vector<double> most(p.columns(), -std::numeric_limits<double>::infinity());
  std::vector<double> sum(p.columns(), 0.0);
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e)
      most[p.column[e]] = std::max(most[p.column[e]], f[a] - p.cost[e]);
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e)
      sum[p.column[e]] += std::exp((f[a] - p.cost[e] - most[p.column[e]]) / gamma);
  for (std::size_t b = 0; b < p.columns(); ++b)
    g[b] = gamma * (std::log(p.column_mass[b]) - std::log(sum[b])) - most[b];
}

template <class Real>
void fill_kernel(const Problem& p, double gamma, const std::vector<double>& f, const std::vector<double>& g,
                 Scalings<Real>& s) {
  s.kernel.resize(p.cost.size());
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e) {
      const auto k = static_cast<Real>(std::exp((f[a] + g[p.column[e]] - p.cost[e]) / gamma));
      s.kernel[e] = k < std::numeric_limits<Real>::min() ? Real{0} : k;  // subnormal numbers are slow and inexact
    }
  s.u.assign(p.rows(), Real{1});
  s.v.assign(p.columns(), Real{1});
}

template <class Real>
Stop solve_plain(const Problem& p, double gamma, double tolerance, Scalings<Real>& s, Watch& watch) {
  fill_kernel(p, gamma, std::vector<double>(p.rows(), 0.0), std::vector<double>(p.columns(), 0.0), s);
  if (!fit_columns(p, s, widest_plain<Real>())) return Stop::drifted;
  return iterate(p, s, widest_plain<Real>(), tolerance, watch);
}

/// Gamma falls to its value from the largest cost by quarters, each stage starting from the potentials of the last: at
/// a large gamma few iterations bring mass across the whole support. 100 iterations and a violation of 1 % are enough
/// there.
constexpr double stage_ratio = 0.25;
constexpr int stage_iterations = 100;
constexpr double stage_tolerance = 0.01;

struct Potentials {
  std::vector<double> f, g;
};

template <class Real>
Stop solve_stage(const Problem& p, double gamma, double tolerance, Potentials& potentials, Scalings<Real>& s,
                 Watch& watch) {
  while (true) {
    iterate_logarithmic(p, gamma, potentials.f, potentials.g);
    ++watch.iterations;
    fill_kernel(p, gamma, potentials.f, potentials.g, s);
    const Stop stop = iterate(p, s, static_cast<Real>(widest_absorbed), tolerance, watch);
    for (std::size_t a = 0; a < p.rows(); ++a) potentials.f[a] += gamma * std::log(static_cast<double>(s.u[a]));
    for (std::size_t b = 0; b < p.columns(); ++b) potentials.g[b] += gamma * std::log(static_cast<double>(s.v[b]));
    if (stop != Stop::drifted || watch.iterations >= watch.most) return stop == Stop::drifted ? Stop::limit : stop;
  }
}

template <class Real>
Stop solve_logarithmic(const Problem& p, double gamma, double tolerance, Potentials& potentials, Scalings<Real>& s,
                       Watch& watch) {
  potentials = {std::vector<double>(p.rows(), 0.0), std::vector<double>(p.columns(), 0.0)};
  double stage = p.largest_cost;
  while (stage > gamma) {
    Watch brief{0, std::min(stage_iterations, watch.most - watch.iterations), false, Momentum(watch.momentum.wanted())};
    (void)solve_stage(p, stage, std::max(tolerance, stage_tolerance), potentials, s, brief);
    watch.iterations += brief.iterations;
    stage *= stage_ratio;
  }
  return solve_stage(p, gamma, tolerance, potentials, s, watch);
}

Problem reduced(const TransportSupport& support, std::span<const double> row_mass, std::span<const double> column_mass,
                double row_total, double column_total) {
  Problem p;
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(column_mass.size(), none);
  for (std::size_t b = 0; b < column_mass.size(); ++b) {
    if (column_mass[b] == 0.0) continue;
    place[b] = static_cast<std::uint32_t>(p.column_mass.size());
    p.column_mass.push_back(column_mass[b] / column_total);
  }
  std::vector<double> least(p.columns(), std::numeric_limits<double>::infinity());
  for (std::size_t a = 0; a < row_mass.size(); ++a) {
    if (row_mass[a] == 0.0) continue;
    p.row_mass.push_back(row_mass[a] / row_total);
    double row_least = std::numeric_limits<double>::infinity();
    for (std::size_t e = support.row_begin[a]; e < support.row_begin[a + 1]; ++e) {
      if (place[support.column[e]] == none) continue;
      p.column.push_back(place[support.column[e]]);
      p.cost.push_back(support.cost[e]);
      p.entry.push_back(e);
      row_least = std::min(row_least, support.cost[e]);
    }
    for (std::size_t e = p.begin.back(); e < p.cost.size(); ++e) {
      p.cost[e] -= row_least;
      least[p.column[e]] = std::min(least[p.column[e]], p.cost[e]);
    }
    p.begin.push_back(static_cast<std::uint32_t>(p.cost.size()));
  }
  for (std::size_t e = 0; e < p.cost.size(); ++e) {
    p.cost[e] -= least[p.column[e]];
    p.largest_cost = std::max(p.largest_cost, p.cost[e]);
  }
  return p;
}

/// The median cost of the pairs that take part, or what stands for it.
double typical_cost(const TransportSupport& support, const Problem& p) {
  std::vector<double> costs;
  costs.reserve(p.entry.size());
  for (const std::size_t e : p.entry) costs.push_back(std::abs(support.cost[e]));
  const auto middle = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2);
  std::nth_element(costs.begin(), middle, costs.end());
  if (*middle > 0.0) return *middle;
  const double sum = std::accumulate(costs.begin(), costs.end(), 0.0);
  return sum > 0.0 ? sum / static_cast<double>(costs.size()) : 1.0;
}

/// Sum of the masses, or what is wrong with them.
Result<double> total_of(const char* name, std::span<const double> mass) {
  double total = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (!(mass[i] >= 0.0) || !std::isfinite(mass[i]))
      return fail({}, std::string(name) + "[" + std::to_string(i) + "]", "the mass is negative or not finite");
    total += mass[i];
  }
  if (!std::isfinite(total)) return fail({}, name, "the masses sum to infinity");
  return total;
}

Result<void> check_support(const TransportSupport& support, std::size_t rows, std::size_t columns) {
  if (support.row_begin.empty() || support.rows() != rows)
    return fail({}, "support", "its rows and the row masses differ in number");
  if (support.columns != columns) return fail({}, "support", "its columns and the column masses differ in number");
  if (support.row_begin.front() != 0 || support.row_begin.back() != support.column.size() ||
      support.cost.size() != support.column.size())
    return fail({}, "support", "its rows do not end where its pairs do");
  for (std::size_t a = 0; a < rows; ++a) {
    const std::string field = "row " + std::to_string(a);
    if (support.row_begin[a + 1] < support.row_begin[a]) return fail({}, field, "ends before it begins");
    if (support.row_begin[a + 1] > support.column.size()) return fail({}, field, "ends past the last pair");
    for (std::size_t e = support.row_begin[a]; e < support.row_begin[a + 1]; ++e) {
      if (support.column[e] >= columns || (e > support.row_begin[a] && support.column[e] <= support.column[e - 1]))
        return fail({}, field, "names a column out of range or order");
      if (!std::isfinite(support.cost[e])) return fail({}, field, "has a cost that is not finite");
    }
  }
  return {};
}

/// Sums of the plan against the masses, its cost and objective.
void measure(const TransportSupport& support, std::span<const double> row_mass, std::span<const double> column_mass,
             double total, SinkhornPlan& plan) {
  std::vector<double> column_sum(column_mass.size(), 0.0);
  double rows_off = 0.0;
  double entropy = 0.0;
  for (std::size_t a = 0; a < row_mass.size(); ++a) {
    double row_sum = 0.0;
    for (std::size_t e = support.row_begin[a]; e < support.row_begin[a + 1]; ++e) {
      const double mass = plan.mass[e];
      row_sum += mass;
      column_sum[support.column[e]] += mass;
      plan.cost += mass * support.cost[e];
      if (mass > 0.0) entropy += mass * std::log(mass);
    }
    rows_off += std::abs(row_sum - row_mass[a]);
  }
  double columns_off = 0.0;
  for (std::size_t b = 0; b < column_mass.size(); ++b) columns_off += std::abs(column_sum[b] - column_mass[b]);
  plan.objective = plan.cost + plan.gamma * entropy;
  plan.marginal_violation = std::max(rows_off, columns_off) / total;
}

/// Rows and columns with mass but without a partner. True where there are none.
bool all_have_partners(const Problem& p, const TransportSupport& support, std::span<const double> row_mass,
                       std::span<const double> column_mass, SinkhornPlan& plan) {
  std::vector<bool> reached(column_mass.size(), false);
  for (const std::size_t e : p.entry) reached[support.column[e]] = true;
  for (std::size_t b = 0; b < column_mass.size(); ++b)
    if (column_mass[b] > 0.0 && !reached[b]) plan.starved_columns.push_back(static_cast<std::uint32_t>(b));
  std::size_t row = 0;
  for (std::size_t a = 0; a < row_mass.size(); ++a) {
    if (row_mass[a] == 0.0) continue;
    if (p.begin[row] == p.begin[row + 1]) plan.stuck_rows.push_back(static_cast<std::uint32_t>(a));
    ++row;
  }
  return plan.stuck_rows.empty() && plan.starved_columns.empty();
}

template <class Real>
Stop run(const Problem& p, const SinkhornOptions& options, SinkhornPlan& plan, Watch& watch) {
  const double tolerance =
      std::max(options.tolerance, 32.0 * static_cast<double>(std::numeric_limits<Real>::epsilon()));
  Scalings<Real> s;
  Stop stop = Stop::drifted;
  plan.domain = options.domain;
  if (options.domain == SinkhornDomain::plain) stop = solve_plain(p, plan.gamma, tolerance, s, watch);
  if (stop == Stop::drifted) {
    plan.domain = SinkhornDomain::logarithmic;
    Potentials potentials;
    stop = solve_logarithmic(p, plan.gamma, tolerance, potentials, s, watch);
  }
  for (std::size_t a = 0; a < p.rows(); ++a)
    for (std::uint32_t e = p.begin[a]; e < p.begin[a + 1]; ++e)
      plan.mass[p.entry[e]] =
          static_cast<double>(s.u[a]) * static_cast<double>(s.kernel[e]) * static_cast<double>(s.v[p.column[e]]);
  return stop;
}

}  // namespace

TransportSupport dense_support(std::size_t rows, std::size_t columns, std::vector<double> cost) {
  TransportSupport support;
  support.columns = static_cast<std::uint32_t>(columns);
  for (std::size_t a = 0; a < rows; ++a) {
    for (std::size_t b = 0; b < columns; ++b) support.column.push_back(static_cast<std::uint32_t>(b));
    support.row_begin.push_back(static_cast<std::uint32_t>(support.column.size()));
  }
  support.cost = std::move(cost);
  return support;
}

Result<SinkhornPlan> solve_sinkhorn(const TransportSupport& support, std::span<const double> row_mass,
                                    std::span<const double> column_mass, const SinkhornOptions& options) {
  const auto row_total = total_of("rows", row_mass);
  if (!row_total) return tl::unexpected(row_total.error());
  const auto column_total = total_of("columns", column_mass);
  if (!column_total) return tl::unexpected(column_total.error());
  if (const auto sound = check_support(support, row_mass.size(), column_mass.size()); !sound)
    return tl::unexpected(sound.error());
  constexpr double most_apart = 1e-9;  // far above the rounding of a sum of 1e6 masses, far below any tolerance of use
  if (!(std::abs(*row_total - *column_total) <= most_apart * std::max(*row_total, *column_total)))
    return fail({}, "columns",
                "their masses sum to " + std::to_string(*column_total) + ", those of the rows to " +
                    std::to_string(*row_total));
  if (!(options.gamma > 0.0) || !std::isfinite(options.gamma)) return fail({}, "gamma", "must be positive");
  if (!(options.tolerance > 0.0)) return fail({}, "tolerance", "must be positive");

  SinkhornPlan plan;
  plan.mass.assign(support.cost.size(), 0.0);
  if (*row_total == 0.0) return plan;
  const Problem p = reduced(support, row_mass, column_mass, *row_total, *column_total);
  if (!all_have_partners(p, support, row_mass, column_mass, plan)) {
    plan.state = SinkhornState::infeasible;
    plan.marginal_violation = 1.0;
    return plan;
  }
  plan.gamma = options.gamma * (options.gamma_is_relative ? typical_cost(support, p) : 1.0);
  if (!(plan.gamma > 0.0)) return fail({}, "gamma", "is 0 beside the median cost");

  // A stall asks the flow, once: a support without a plan would go on for ever.
  const bool feasible = options.feasible || p.cost.size() == p.rows() * p.columns();
  Watch watch{0, options.most_iterations, !feasible, Momentum(options.momentum)};
  const auto solve = [&] {
    return options.precision == SinkhornPrecision::single_float ? run<float>(p, options, plan, watch)
                                                                : run<double>(p, options, plan, watch);
  };
  Stop stop = solve();
  if (!feasible && (stop == Stop::stalled || stop == Stop::limit)) {
    if (!support_is_feasible(support, row_mass, column_mass, plan)) {
      plan.state = SinkhornState::infeasible;
    } else if (stop == Stop::stalled) {
      watch.look_for_stall = false;
      stop = solve();
    }
  }
  for (double& mass : plan.mass) mass *= *row_total;
  if (plan.state != SinkhornState::infeasible)
    plan.state = stop == Stop::converged ? SinkhornState::converged : SinkhornState::iteration_limit;
  plan.iterations = watch.iterations;
  measure(support, row_mass, column_mass, *row_total, plan);
  return plan;
}

}  // namespace lackwerk::core
