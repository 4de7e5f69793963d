// Regularised transport against the exact solver, over the cases that break it.
#include "core/analysis/sinkhorn.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>
#include <string>

#include "core/analysis/transport.hpp"

namespace lackwerk::core {
namespace {

struct Side {
  std::vector<glm::dvec3> centres;
  std::vector<std::int64_t> mass;
};

/// Clusters in the range of Lab with masses that sum to 2^20.
Side random_side(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Side side;
  std::int64_t left = 1 << 20;
  for (std::size_t i = 0; i < count; ++i) {
    side.centres.emplace_back(100.0 * uniform(), 60.0 * uniform() - 30.0, 60.0 * uniform() - 30.0);
    const std::int64_t share = i + 1 == count ? left : left / static_cast<std::int64_t>(count - i);
    side.mass.push_back(share);
    left -= share;
  }
  return side;
}

TransportSupport full(const Side& from, const Side& to) {
  std::vector<double> cost;
  for (const auto& a : from.centres)
    for (const auto& b : to.centres) cost.push_back(glm::distance(a, b));
  return dense_support(from.centres.size(), to.centres.size(), std::move(cost));
}

std::vector<double> masses(const Side& side) { return {side.mass.begin(), side.mass.end()}; }

SinkhornOptions at(double gamma, SinkhornDomain domain = SinkhornDomain::plain) {
  SinkhornOptions options;
  options.gamma = gamma;
  options.gamma_is_relative = false;
  options.domain = domain;
  options.tolerance = 1e-4;
  return options;
}

/// Finite, not negative, and as near to the marginals as it says.
void expect_sound(const SinkhornPlan& plan, const std::string& what) {
  for (const double mass : plan.mass) ASSERT_TRUE(std::isfinite(mass) && mass >= 0.0) << what;
  EXPECT_TRUE(std::isfinite(plan.cost) && std::isfinite(plan.objective)) << what;
  EXPECT_TRUE(std::isfinite(plan.marginal_violation)) << what;
}

TEST(Sinkhorn, ApproachesTheExactCostAsGammaFalls) {
  const Side from = random_side(40, 1);
  const Side to = random_side(50, 2);
  const auto exact = solve_transport(from.centres, from.mass, to.centres, to.mass);
  ASSERT_TRUE(exact) << exact.error().line();
  const TransportSupport support = full(from, to);
  double last = 1e9;
  for (const double gamma : {10.0, 3.0, 1.0, 0.3, 0.1}) {
    const auto plan = solve_sinkhorn(support, masses(from), masses(to), at(gamma));
    ASSERT_TRUE(plan) << plan.error().line();
    EXPECT_EQ(plan->state, SinkhornState::converged) << gamma;
    EXPECT_LE(plan->marginal_violation, 1.1e-4) << gamma;
    const double gap = plan->cost / exact->cost - 1.0;
    EXPECT_GT(gap, -1e-3) << gamma;  // a violation of 1e-4 may save that much
    EXPECT_LT(gap, last) << gamma;
    // The entropic plan costs at most gamma * log(smaller side) more (its entropy's range).
    EXPECT_LE(plan->cost - exact->cost, gamma * std::log(40.0) * 1048576.0) << gamma;
    last = gap;
  }
  EXPECT_LT(last, 0.02);
}

TEST(Sinkhorn, DomainsAndPrecisionsAgree) {
  const Side from = random_side(30, 3);
  const Side to = random_side(20, 4);
  const TransportSupport support = full(from, to);
  const auto plain = solve_sinkhorn(support, masses(from), masses(to), at(2.0));
  const auto logarithmic = solve_sinkhorn(support, masses(from), masses(to), at(2.0, SinkhornDomain::logarithmic));
  SinkhornOptions single = at(2.0);
  single.precision = SinkhornPrecision::single_float;
  const auto in_float = solve_sinkhorn(support, masses(from), masses(to), single);
  ASSERT_TRUE(plain && logarithmic && in_float);
  EXPECT_EQ(plain->domain, SinkhornDomain::plain);
  EXPECT_EQ(logarithmic->domain, SinkhornDomain::logarithmic);
  EXPECT_EQ(in_float->domain, SinkhornDomain::plain);
  EXPECT_NEAR(logarithmic->cost / plain->cost, 1.0, 1e-3);
  EXPECT_NEAR(in_float->cost / plain->cost, 1.0, 1e-3);
  EXPECT_NEAR(logarithmic->objective / plain->objective, 1.0, 1e-3);
}

TEST(Sinkhorn, SameInputGivesTheSameBytes) {
  const Side from = random_side(30, 5);
  const Side to = random_side(30, 6);
  const TransportSupport support = full(from, to);
  for (const double gamma : {5.0, 0.05}) {
    const auto one = solve_sinkhorn(support, masses(from), masses(to), at(gamma));
    const auto two = solve_sinkhorn(support, masses(from), masses(to), at(gamma));
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->mass, two->mass);
    EXPECT_EQ(one->iterations, two->iterations);
  }
}

TEST(Sinkhorn, SwitchesToTheLogarithmicDomainWherePlainDies) {
  // All mass of the first row must go to the far column: its scaling is exp(1000 / gamma).
  const TransportSupport support = dense_support(2, 2, {0.0, 1000.0, 0.0, 1000.0});
  const TransportSupport far = {2, {0, 2, 3}, {0, 1, 0}, {0.0, 1000.0, 0.0}};
  const std::vector<double> half{0.5, 0.5};
  for (const SinkhornPrecision precision : {SinkhornPrecision::single_float, SinkhornPrecision::double_float}) {
    SinkhornOptions options = at(0.5);
    options.precision = precision;
    const auto equal = solve_sinkhorn(support, half, half, options);
    ASSERT_TRUE(equal);
    EXPECT_EQ(equal->state, SinkhornState::converged);
    EXPECT_NEAR(equal->mass[0], 0.25, 1e-4);
    const auto forced = solve_sinkhorn(far, half, half, options);
    ASSERT_TRUE(forced);
    expect_sound(*forced, "forced");
    EXPECT_NEAR(forced->mass[1], 0.5, 1e-3);
  }
  const Side from = random_side(50, 7);
  const Side to = random_side(50, 8);
  SinkhornOptions options = at(0.05);
  options.precision = SinkhornPrecision::single_float;
  const auto plan = solve_sinkhorn(full(from, to), masses(from), masses(to), options);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->domain, SinkhornDomain::logarithmic);
  expect_sound(*plan, "float at 0.05");
}

struct Stiff {
  std::string name;
  Side from, to;
};

std::vector<Stiff> stiff_cases() {
  std::vector<Stiff> cases;
  const auto add = [&](const char* name, Side from, Side to) {
    cases.push_back(Stiff{name, std::move(from), std::move(to)});
  };
  const Side some = random_side(50, 11);
  const Side other = random_side(50, 12);
  add("identical", some, some);
  Side permuted = some;
  std::reverse(permuted.centres.begin(), permuted.centres.end());
  std::reverse(permuted.mass.begin(), permuted.mass.end());
  add("permuted", some, permuted);
  Side heavy = other;
  std::fill(heavy.mass.begin(), heavy.mass.end(), 200);
  heavy.mass[7] = (1 << 20) - 49 * 200;
  add("one mass 0.99", some, heavy);
  Side light = some;
  for (auto& mass : light.mass) mass = std::int64_t{1} << 40;
  Side light_to = light;
  light_to.centres = other.centres;
  light.mass[3] = 1;  // 1e-12 of the others
  light.mass[4] += (std::int64_t{1} << 40) - 1;
  add("masses to 1e-12", light, light_to);
  Side one_place = some;
  std::fill(one_place.centres.begin(), one_place.centres.end(), glm::dvec3(0.0));
  Side sphere = other;
  for (auto& c : sphere.centres) c = 50.0 * glm::normalize(c);
  add("all costs equal", one_place, sphere);
  Side doubled = some;
  for (std::size_t i = 0; i < 25; ++i) doubled.centres[i + 25] = doubled.centres[i];
  add("duplicates", doubled, doubled);
  Side away = other;
  for (auto& c : away.centres) c += glm::dvec3(1e6, 0.0, 0.0);
  add("offset of 1e6", some, away);
  Side one;
  one.centres = {glm::dvec3(50.0, 0.0, 0.0)};
  one.mass = {1 << 20};
  add("1 x 50", one, other);
  return cases;
}

TEST(Sinkhorn, StiffCasesEndInAPlan) {
  for (const Stiff& stiff : stiff_cases()) {
    const auto exact = solve_transport(stiff.from.centres, stiff.from.mass, stiff.to.centres, stiff.to.mass);
    ASSERT_TRUE(exact) << stiff.name;
    const TransportSupport support = full(stiff.from, stiff.to);
    const double total = static_cast<double>(std::accumulate(stiff.to.mass.begin(), stiff.to.mass.end(), Int128{0}));
    for (const double gamma : {10.0, 1.0, 0.1, 0.01}) {
      for (const SinkhornPrecision precision : {SinkhornPrecision::single_float, SinkhornPrecision::double_float}) {
        SinkhornOptions options = at(gamma);
        options.precision = precision;
        options.tolerance = 1e-3;
        const auto plan = solve_sinkhorn(support, masses(stiff.from), masses(stiff.to), options);
        const std::string what = stiff.name + " at gamma " + std::to_string(gamma) +
                                 (precision == SinkhornPrecision::double_float ? " in double" : " in float");
        ASSERT_TRUE(plan) << what << plan.error().line();
        expect_sound(*plan, what);
        EXPECT_EQ(plan->state, SinkhornState::converged) << what << " " << plan->marginal_violation;
        EXPECT_LE(plan->marginal_violation, 1.1e-3) << what;
        // Entropy's part, and what a violation of 1e-3 may misplace across 130 Lab.
        const double far = stiff.name == "offset of 1e6" ? 1e6 : 130.0;
        EXPECT_LE(std::abs(plan->cost - exact->cost) / total, gamma * std::log(50.0) + 2e-3 * far) << what;
      }
    }
  }
}

TEST(Sinkhorn, NothingMovesNothing) {
  const auto none = solve_sinkhorn(TransportSupport{}, {}, {}, SinkhornOptions{});
  ASSERT_TRUE(none) << none.error().line();
  EXPECT_EQ(none->state, SinkhornState::converged);
  const std::vector<double> zero{0.0, 0.0};
  const auto empty = solve_sinkhorn(dense_support(2, 2, {1, 2, 3, 4}), zero, zero, SinkhornOptions{});
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->mass, std::vector<double>(4, 0.0));
  // A row without mass takes no part; its pairs stay empty.
  const auto part = solve_sinkhorn(dense_support(2, 2, {1, 2, 3, 4}), std::vector<double>{0.0, 1.0},
                                   std::vector<double>{0.5, 0.5}, SinkhornOptions{});
  ASSERT_TRUE(part);
  EXPECT_EQ(part->state, SinkhornState::converged);
  EXPECT_EQ(part->mass[0], 0.0);
  EXPECT_NEAR(part->mass[3], 0.5, 1e-6);
}

TEST(Sinkhorn, SparseSupportIsKept) {
  // Three points on a line to three a step away, each allowed to its own and its neighbour.
  const TransportSupport support = {3, {0, 2, 4, 5}, {0, 1, 1, 2, 2}, {0.1, 1.0, 0.1, 1.0, 0.1}};
  const std::vector<double> third(3, 1.0 / 3.0);
  SinkhornOptions options = at(0.1);
  options.tolerance = 1e-2;
  const auto plan = solve_sinkhorn(support, third, third, options);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->state, SinkhornState::converged);
  EXPECT_NEAR(plan->mass[0], 1.0 / 3.0, 1e-2);
  EXPECT_NEAR(plan->mass[2], 1.0 / 3.0, 1e-2);
}

TEST(Sinkhorn, InfeasibleSupportsAreNamed) {
  // Row 2 has no column with mass; column 2 has no row.
  const TransportSupport lonely = {3, {0, 1, 2, 2}, {0, 1}, {1.0, 1.0}};
  const std::vector<double> third(3, 1.0 / 3.0);
  const auto one = solve_sinkhorn(lonely, third, third, at(1.0));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->state, SinkhornState::infeasible);
  EXPECT_EQ(one->stuck_rows, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(one->starved_columns, (std::vector<std::uint32_t>{2}));

  // Rows 0 and 1 know column 0 only; column 1 and 2 are left to row 2: Hall's condition fails, every side has partners.
  const TransportSupport crowded = {3, {0, 1, 2, 5}, {0, 0, 0, 1, 2}, {1.0, 1.0, 1.0, 1.0, 1.0}};
  for (const SinkhornDomain domain : {SinkhornDomain::plain, SinkhornDomain::logarithmic}) {
    const auto two = solve_sinkhorn(crowded, third, third, at(1.0, domain));
    ASSERT_TRUE(two);
    expect_sound(*two, "crowded");
    EXPECT_EQ(two->state, SinkhornState::infeasible);
    EXPECT_EQ(two->stuck_rows, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(two->starved_columns, (std::vector<std::uint32_t>{1, 2}));
  }
}

TEST(Sinkhorn, BadInputIsOneLine) {
  const std::vector<double> one{1.0};
  const auto field = [&](const TransportSupport& support, std::vector<double> rows, std::vector<double> columns,
                         const SinkhornOptions& options) {
    const auto plan = solve_sinkhorn(support, rows, columns, options);
    return plan ? std::string("none") : plan.error().field;
  };
  const TransportSupport single = dense_support(1, 1, {1.0});
  EXPECT_EQ(field(single, {1.0}, {1.0}, {}), "none");
  EXPECT_EQ(field(single, {-1.0}, {1.0}, {}), "rows[0]");
  EXPECT_EQ(field(single, {1.0}, {NAN}, {}), "columns[0]");
  EXPECT_EQ(field(single, {1.0}, {2.0}, {}), "columns");
  EXPECT_EQ(field(single, {1.0, 1.0}, {2.0}, {}), "support");
  EXPECT_EQ(field(dense_support(1, 1, {NAN}), {1.0}, {1.0}, {}), "row 0");
  EXPECT_EQ(field({1, {0, 1}, {1}, {1.0}}, {1.0}, {1.0}, {}), "row 0");
  EXPECT_EQ(field({1, {0, 2}, {0}, {1.0}}, {1.0}, {1.0}, {}), "support");
  EXPECT_EQ(field(single, {1.0}, {1.0}, at(0.0)), "gamma");
  EXPECT_EQ(field(single, {1.0}, {1.0}, at(NAN)), "gamma");
}

TEST(Sinkhorn, MomentumFindsTheSamePlanInFewerIterations) {
  // A chain where mass must creep from link to link: each row reaches the columns beside its own.
  constexpr std::uint32_t count = 300;
  TransportSupport chain;
  chain.columns = count;
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a < 2 ? 0 : a - 2; b < std::min(count, a + 3); ++b) {
      chain.column.push_back(b);
      chain.cost.push_back(std::abs(static_cast<double>(a) - static_cast<double>(b)));
    }
    chain.row_begin.push_back(static_cast<std::uint32_t>(chain.column.size()));
  }
  std::vector<double> leave(count, 1.0), arrive(count, 1.0);
  leave[10] += 1.0;  // carried the length of the chain, a little by everyone
  arrive[count - 10] += 1.0;
  for (std::size_t i = 0; i < count; ++i) {
    leave[i] /= count + 1.0;
    arrive[i] /= count + 1.0;
  }
  for (const auto precision : {SinkhornPrecision::double_float, SinkhornPrecision::single_float}) {
    SinkhornOptions options = at(1.0, SinkhornDomain::logarithmic);
    options.precision = precision;
    options.most_iterations = 200000;
    const auto plain = solve_sinkhorn(chain, leave, arrive, options);
    options.momentum = options.feasible = true;
    const auto quick = solve_sinkhorn(chain, leave, arrive, options);
    ASSERT_TRUE(plain && quick);
    EXPECT_EQ(plain->state, SinkhornState::converged) << plain->marginal_violation;
    EXPECT_EQ(quick->state, SinkhornState::converged) << quick->marginal_violation;
    EXPECT_LT(5 * quick->iterations, plain->iterations) << plain->iterations << " without";
    expect_sound(*quick, "momentum");
    double apart = 0.0;
    for (std::size_t e = 0; e < plain->mass.size(); ++e) apart += std::abs(plain->mass[e] - quick->mass[e]);
    EXPECT_LT(apart, 0.01);
  }
}

}  // namespace
}  // namespace lackwerk::core
