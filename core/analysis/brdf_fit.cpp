#include "core/analysis/brdf_fit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <string>

#include "core/analysis/brdf_fit_solve.hpp"
#include "core/analysis/brdf_fit_start.hpp"
#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

/// Points on which starts are compared: 80 numbers for each of 18 parameters.
constexpr std::size_t coarse_points = 1500;
constexpr int first_iterations = 20, coarse_iterations = 60, fine_iterations = 200, table_iterations = 12;
/// Starts that are run to their end.
constexpr std::size_t finalists = 2;
/// Whether a lobe could be spared is first asked of these; beyond this rise of the cost the answer is no.
constexpr std::size_t screening_points = 400;
constexpr int screening_iterations = 25;
constexpr double screening_part = 0.05;
/// Lobes and colour table are fitted in turn this often.
constexpr int table_rounds = 3;
/// A table needs more points than lobes: it has about a thousand nodes.
constexpr std::uint32_t table_sample_factor = 4;
/// A lobe stays if it lowers the cost by this part. Five parameters fitted to nothing but noise lower it by 5 of
/// 4,500 numbers on average: 1.1e-3.
constexpr double worthwhile = 2e-3;
/// Cost per number that is rounding: errors of 1e-7.
constexpr double rounding = 1e-14;

std::vector<FitPoint> every_nth(std::span<const FitPoint> points, std::size_t count) {
  const std::size_t n = std::max<std::size_t>(1, points.size() / count);
  std::vector<FitPoint> out;
  for (std::size_t k = 0; k < points.size(); k += n) out.push_back(points[k]);
  return out;
}

/// Without lobe `lobe`.
std::vector<double> without(const FitLayout& layout, const std::vector<double>& parameters, int lobe) {
  std::vector<double> out = parameters;
  const auto first = out.begin() + layout.s(lobe, 0);
  out.erase(first, first + layout.channels + 2);
  return out;
}
/// Lobe `from` goes into `to`: weights at normal incidence are added.
std::vector<double> merged(const FitLayout& layout, std::vector<double> parameters, int from, int to) {
  const auto at = [&](int k) -> double& { return parameters[static_cast<std::size_t>(k)]; };
  const double f0 = std::max(at(layout.f0(to)), 1e-3);
  for (int c = 0; c < layout.channels; ++c) at(layout.s(to, c)) += at(layout.s(from, c)) * at(layout.f0(from)) / f0;
  return without(layout, parameters, from);
}

struct Solution {
  FitLayout layout;
  LobeSolution lobes;
};

/// The best of a lobe less: each left out, and each merged into its neighbour in roughness.
Solution one_lobe_less(const Solution& all, std::span<const FitPoint> few) {
  const FitLayout& layout = all.layout;
  Solution best{{layout.lobes - 1, layout.channels}, {}};
  best.lobes.cost = std::numeric_limits<double>::infinity();
  const auto consider = [&](std::vector<double> start) {
    LobeSolution solved = solve_lobes(best.layout, few, std::move(start), screening_iterations);
    if (solved.cost < best.lobes.cost) best.lobes = std::move(solved);
  };
  std::vector<int> order(static_cast<std::size_t>(layout.lobes));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return all.lobes.parameters[static_cast<std::size_t>(layout.ln_m(a))] >
           all.lobes.parameters[static_cast<std::size_t>(layout.ln_m(b))];
  });
  for (std::size_t k = 0; k < order.size(); ++k) {
    consider(without(layout, all.lobes.parameters, order[k]));
    if (k > 0) consider(merged(layout, all.lobes.parameters, order[k], order[k - 1]));
  }
  return best;
}

/// Leaves lobes out as long as that costs nothing: equal lobes, and lobes fitted to noise. A few points tell where it
/// would cost much.
Solution without_spare_lobes(Solution best, std::span<const FitPoint> coarse) {
  const std::vector<FitPoint> few = every_nth(coarse, screening_points);
  const auto allows = [](double cost, double less, double part, std::size_t points) {
    return less <= cost * (1.0 + part) + rounding * 3.0 * static_cast<double>(points);
  };
  while (best.layout.lobes > 0) {
    const LobeSolution all = solve_lobes(best.layout, few, best.lobes.parameters, screening_iterations);
    Solution fewer = one_lobe_less(best, few);
    // Ten times as generous: a start that has not run to its end.
    const std::size_t slow = 10 * few.size();
    if (!allows(all.cost, fewer.lobes.cost, screening_part, slow)) break;
    fewer.lobes = solve_lobes(fewer.layout, coarse, std::move(fewer.lobes.parameters), coarse_iterations);
    if (!allows(best.lobes.cost, fewer.lobes.cost, worthwhile, coarse.size())) break;
    best = std::move(fewer);
  }
  return best;
}

Solution best_lobes(FitLayout layout, std::span<const FitPoint> points, int starts) {
  const std::vector<FitPoint> coarse = every_nth(points, coarse_points);
  std::vector<LobeSolution> runs;
  for (auto& start : fit_starts(layout, coarse, starts))
    runs.push_back(solve_lobes(layout, coarse, std::move(start), first_iterations));
  std::stable_sort(runs.begin(), runs.end(),
                   [](const LobeSolution& a, const LobeSolution& b) { return a.cost < b.cost; });
  if (runs.size() > finalists) runs.resize(finalists);
  Solution best{layout, {}};
  best.lobes.cost = std::numeric_limits<double>::infinity();
  for (LobeSolution& run : runs) {
    LobeSolution solved = solve_lobes(layout, coarse, std::move(run.parameters), coarse_iterations);
    if (solved.cost < best.lobes.cost) best.lobes = std::move(solved);
  }
  best = without_spare_lobes(std::move(best), coarse);
  best.lobes = solve_lobes(best.layout, points, std::move(best.lobes.parameters), fine_iterations);
  return best;
}

double luminance(const glm::dvec3& v) {
  return rgb_to_xyz[1][0] * v.x + rgb_to_xyz[1][1] * v.y + rgb_to_xyz[1][2] * v.z;
}

/// The one colour that all points share best: geometric means, luminance 1.
glm::dvec3 shared_colour(std::span<const FitPoint> points) {
  glm::dvec3 sum(0.0);
  for (const FitPoint& p : points)
    for (int c = 0; c < 3; ++c) sum[c] += std::log(fit_dark + p.target[c]);
  glm::dvec3 colour;
  for (int c = 0; c < 3; ++c) colour[c] = std::exp(sum[c] / static_cast<double>(points.size()));
  return colour / luminance(colour);
}

void set_chi(std::vector<FitPoint>& points, const AnalyticPaint& paint) {
  for (FitPoint& p : points) p.chi = chi_at(paint, p.theta_h, p.theta_d);
}

/// Factor that brings the points' mean luminance of chi to 1: where chi ends and the lobes begin is free.
double chi_level(std::span<const FitPoint> points) {
  double sum = 0.0;
  for (const FitPoint& p : points) sum += luminance(p.chi);
  return sum / static_cast<double>(points.size());
}

/// Grey lobes, then table and lobes in turn: lobes on some of the points, the table on all. The points' chi is left as
/// the table's.
Solution lobes_under_table(std::vector<FitPoint>& points, const FitOptions& options, int lobes, AnalyticPaint& paint) {
  const glm::dvec3 colour = shared_colour(points);
  for (FitPoint& p : points) p.chi = colour;
  Solution solution = best_lobes({lobes, 1}, every_nth(points, options.samples), options.starts);
  paint = paint_of(solution.layout, solution.lobes.parameters);
  paint.table = ColourTable{options.table_nodes,
                            std::vector<glm::vec3>(std::size_t{options.table_nodes} * options.table_nodes, colour)};
  for (int round = 0; round < table_rounds; ++round) {
    ColourTable table = solve_table(paint, points, options.table_nodes, table_iterations);
    paint.table = table;
    set_chi(points, paint);
    const double level = chi_level(points);
    for (glm::vec3& entry : table.linear)
      entry = glm::min(entry / static_cast<float>(level), glm::vec3(static_cast<float>(max_fitted_chi)));
    paint.table = table;
    set_chi(points, paint);
    std::vector<double> start = solution.lobes.parameters;
    start[0] *= level;
    for (int k = 0; k < solution.layout.lobes; ++k) start[static_cast<std::size_t>(solution.layout.s(k, 0))] *= level;
    solution.lobes = solve_lobes(solution.layout, every_nth(points, options.samples), std::move(start),
                                 round + 1 < table_rounds ? coarse_iterations : fine_iterations);
    paint = paint_of(solution.layout, solution.lobes.parameters);
    paint.table = std::move(table);
  }
  return solution;
}

int affordable_lobes(int wanted, FitColour colour, std::size_t points) {
  const int channels = colour == FitColour::table ? 1 : 3;
  int lobes = wanted;
  while (lobes > 0 && 3 * points < 2 * static_cast<std::size_t>(FitLayout{lobes, channels}.count())) --lobes;
  return lobes;
}

}  // namespace

Result<BrdfFit> fit_brdf(std::span<const BrdfSample> samples, const FitOptions& options) {
  check_at_most(0, options.lobes, "lobes of a fit");
  check_at_most(options.lobes, static_cast<int>(max_lobes), "lobes of a fit");
  FitPoints given = fit_points(samples);
  if (given.points.empty())
    return fail("", "samples", "none of " + std::to_string(samples.size()) + " values can be fitted",
                "values are finite and >= 0, with light and eye at most 87 degrees from the normal");
  const std::size_t nodes = std::size_t{options.table_nodes} * (options.table_nodes + 1u) / 2;
  if (options.colour == FitColour::table && given.points.size() < nodes)
    return fail("", "samples", std::to_string(given.points.size()) + " values are too few for a colour table",
                "give " + std::to_string(nodes) + " or more, or fit colour per lobe");
  const int lobes = affordable_lobes(options.lobes, options.colour, given.points.size());
  BrdfFit fit;
  Solution solution;
  if (options.colour == FitColour::table) {
    solution = lobes_under_table(given.points, options, lobes, fit.paint);
  } else {
    solution = best_lobes({lobes, 3}, given.points, options.starts);
    fit.paint = paint_of(solution.layout, solution.lobes.parameters);
  }
  fit.lobes = solution.layout.lobes;
  fit.points = given.points.size();
  fit.masked = given.masked;
  fit.has_converged = solution.lobes.has_converged;
  fit.condition = fit_condition(solution.layout, parameters_of(solution.layout, fit.paint), given.points);
  fit.errors = fit_errors(fit.paint, given.points);
  return fit;
}

Result<BrdfFit> fit_brdf(const BrdfTable& table, const FitOptions& options, const std::vector<std::uint8_t>& filled) {
  const std::uint32_t count = options.samples * (options.colour == FitColour::table ? table_sample_factor : 1);
  std::vector<BrdfSample> samples = table_samples(table, count, filled);
  if (options.known)
    for (BrdfSample& sample : samples) sample.known = options.known(sample.in, sample.out);
  auto fit = fit_brdf(samples, options);
  if (fit) fit->errors = fit_errors(fit->paint, table, filled, options.known);
  return fit;
}

}  // namespace lackwerk::core
