#include "kiosk/tools/report/transport_knobs.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "core/analysis/flake_clusters.hpp"
#include "core/analysis/interpolation.hpp"
#include "core/analysis/sinkhorn.hpp"
#include "core/analysis/transport.hpp"
#include "core/analysis/transport_lemon.hpp"
#include "core/colour.hpp"
#include "kiosk/tools/report/transport_cases.hpp"

namespace lackwerk::report {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// One pair of slices, with the integer problem for the bare solvers and the exact cost.
struct Pair {
  MassCloud from, to;
  std::vector<double> distance;
  std::vector<std::int64_t> cost;
  double exact = 0.0;
  [[nodiscard]] core::TransportProblem problem() const { return {from.mass, to.mass, cost}; }
};

MassCloud clustered(const packs::FlakeSlice& slice) {
  std::vector<glm::vec3> lab(slice.texels.size());
  std::transform(slice.texels.begin(), slice.texels.end(), lab.begin(),
                 [](const glm::vec3& rgb) { return core::lab_from_linear(rgb); });
  MassCloud out;
  for (const core::LabCuboid& cluster : core::cluster_texels(lab, {})) {
    out.centres.push_back(0.5 * (glm::dvec3(cluster.lo) + glm::dvec3(cluster.hi)));
    out.mass.push_back(cluster.count);
  }
  return out;
}

Result<Pair> pair_of(MassCloud from, MassCloud to) {
  Pair out;
  out.from = std::move(from);
  out.to = std::move(to);
  const auto exact = core::solve_transport(out.from.centres, out.from.mass, out.to.centres, out.to.mass);
  if (!exact) return tl::unexpected(exact.error());
  out.exact = exact->cost;
  out.distance = distances(out.from, out.to);
  // As solve_transport: 1e-6 d^2 on top, 40 bits for the largest.
  const double largest = std::max(1e-9, *std::max_element(out.distance.begin(), out.distance.end()));
  out.cost.reserve(out.distance.size());
  for (const double d : out.distance)
    out.cost.push_back(std::llround(std::ldexp((d + 1e-6 * d * d) / (largest + 1e-6 * largest * largest), 39)));
  return out;
}

/// What one solver did on all pairs.
struct Tally {
  std::vector<double> ms, excess;
  double violation = 0.0;
};

Setting setting_of(const std::string& label, const std::string& line, Tally tally) {
  Setting out;
  out.label = label;
  out.line = line;
  out.time = timing_of(std::move(tally.ms));
  set_errors(out, std::move(tally.excess));
  out.note = "marginals off by " + digits(tally.violation) + " of the mass";
  return out;
}

double cost_of(const Pair& pair, const std::vector<core::PlanEntry>& entries) {
  double sum = 0.0;
  for (const core::PlanEntry& entry : entries)
    sum += static_cast<double>(entry.mass) * pair.distance[entry.source * pair.to.mass.size() + entry.target];
  return sum;
}

void add_sinkhorn(const Workbench& bench, const std::vector<Pair>& pairs, Knob& knob) {
  for (const auto precision : {core::SinkhornPrecision::double_float, core::SinkhornPrecision::single_float})
    for (const auto domain : {core::SinkhornDomain::plain, core::SinkhornDomain::logarithmic}) {
      const std::string line = std::string("Sinkhorn, ") +
                               (domain == core::SinkhornDomain::plain ? "plain, " : "log, ") +
                               (precision == core::SinkhornPrecision::single_float ? "float" : "double");
      for (const double gamma : {10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01}) {
        core::SinkhornOptions options;
        options.gamma = gamma;
        options.gamma_is_relative = false;
        options.tolerance = 1e-4;
        options.most_iterations = bench.choose(20000, 2000);
        options.domain = domain;
        options.precision = precision;
        Tally tally;
        int unfinished = 0;
        int switched = 0;
        for (const Pair& pair : pairs) {
          const std::vector<double> rows(pair.from.mass.begin(), pair.from.mass.end());
          const std::vector<double> columns(pair.to.mass.begin(), pair.to.mass.end());
          const auto support = core::dense_support(rows.size(), columns.size(), pair.distance);
          const auto start = Clock::now();
          const auto plan = core::solve_sinkhorn(support, rows, columns, options);
          tally.ms.push_back(ms_since(start));
          // Mass that has not arrived yet is cheap: what is astray counts as an error of its own.
          tally.excess.push_back(plan ? std::abs(plan->cost / pair.exact - 1.0) + plan->marginal_violation : none);
          if (!plan) continue;
          tally.violation = std::max(tally.violation, plan->marginal_violation);
          if (plan->state != core::SinkhornState::converged) ++unfinished;
          if (plan->domain != domain) ++switched;
        }
        Setting setting = setting_of(line + ", gamma " + digits(gamma), line, std::move(tally));
        setting.value = gamma;
        if (switched > 0) setting.note += "; " + std::to_string(switched) + " went to the log domain";
        if (unfinished > 0) setting.note += "; " + std::to_string(unfinished) + " not ended at the iteration limit";
        knob.settings.push_back(std::move(setting));
      }
    }
}

Speed ratio(const char* id, const char* what, double value, double aim, int count, const char* bound_by) {
  Speed out;
  out.id = id;
  out.what = what;
  out.value = value;
  out.unit = "ratio";
  out.aim = aim;
  out.count = count;
  out.bound_by = bound_by;
  return out;
}

}  // namespace

Result<void> add_transport(Workbench& bench, Findings& findings) {
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  std::vector<Pair> pairs;
  const std::size_t most = bench.choose<std::size_t>(6, 3);
  const auto& paints = **captures;
  for (std::size_t k = 0; k < most; ++k) {
    const auto& one = paints[k % paints.size()].slices;
    const auto& two = paints[(k + 1) % paints.size()].slices;
    const std::size_t slice = std::min(one.size(), two.size()) * k / (2 * most);  // the brighter half
    auto pair = pair_of(clustered(one[slice]), clustered(two[slice]));
    if (!pair) return tl::unexpected(pair.error());
    if (pair->exact > 0.0) pairs.push_back(std::move(*pair));
  }
  auto stiff = pair_of(flake_like_cloud(11), flake_like_cloud(12));
  if (!stiff) return tl::unexpected(stiff.error());
  pairs.push_back(std::move(*stiff));

  Tally whole, bare, lemon;
  for (const Pair& pair : pairs) {
    const core::TransportProblem problem = pair.problem();
    core::LemonSimplex solver(problem);
    whole.ms.push_back(bench
                           .time([&] {
                             (void)core::solve_transport(pair.from.centres, pair.from.mass, pair.to.centres,
                                                         pair.to.mass);
                           })
                           .median_ms);
    whole.excess.push_back(0.0);
    bare.ms.push_back(
        bench.time([&] { (void)core::solve_simplex(problem, core::usual_pivot_limit(problem)); }).median_ms);
    lemon.ms.push_back(bench.time([&] { (void)solver.run(); }).median_ms);
    const auto ours = core::solve_simplex(problem, core::usual_pivot_limit(problem));
    const auto theirs = solver.solve();
    bare.excess.push_back(ours ? cost_of(pair, ours->entries) / pair.exact - 1.0 : none);
    lemon.excess.push_back(theirs ? cost_of(pair, theirs->entries) / pair.exact - 1.0 : none);
  }
  Knob knob;
  knob.id = "transport";
  knob.title = "Transport solver and gamma";
  knob.what = "How the clusters of one paint's slice are sent to another's: " + std::to_string(pairs.size()) +
              " pairs of slices, clustered to at most 50.";
  knob.error_unit = "transport cost off the exact one, relative, and share of mass astray";
  knob.time_of = "one pair of slices";
  knob.chosen = "own simplex";
  knob.settings.push_back(setting_of("own simplex", "exact", whole));
  knob.settings.push_back(setting_of("bare simplex", "exact", bare));
  knob.settings.back().eligible = false;
  knob.settings.back().note += "; without merging of equal centres, costs and proof";
  knob.settings.push_back(setting_of("LEMON alone", "exact", lemon));
  knob.settings.back().note += "; the solver's run alone, its graph built before";
  add_sinkhorn(bench, pairs, knob);
  const double own_ms = knob.settings[0].time.median_ms;
  const double bare_ms = knob.settings[1].time.median_ms;
  const double lemon_ms = knob.settings[2].time.median_ms;
  knob.why = "Exact, with a proof, in " + digits(1e3 * own_ms) + " us; LEMON alone takes " + digits(1e3 * lemon_ms) +
             " us. Sinkhorn's plans are dense and cannot become tuples.";
  findings.knobs.push_back(std::move(knob));
  const int count = static_cast<int>(pairs.size());
  findings.speeds.push_back(ratio("transport", "whole transport over LEMON's solver run alone", own_ms / lemon_ms, 1.0,
                                  count, "the pivots' subtrees and the search for the entering pair"));
  findings.speeds.push_back(ratio("transport_best", "whole transport over our bare simplex", own_ms / bare_ms, 2.0,
                                  count, "roots and rounding of the costs, and the proof"));
  return {};
}

}  // namespace lackwerk::report
