// Properties of the exact transport on seeded random and on stiff instances.
#include "core/analysis/transport.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

using testing::uniform;

struct Side {
  std::vector<glm::dvec3> centres;
  std::vector<std::int64_t> mass;
};

double length(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// Adds what is missing to the first cluster of the lighter side.
void balance(Side& one, Side& two) {
  const auto sum = [](const Side& side) {
    return std::accumulate(side.mass.begin(), side.mass.end(), std::int64_t{0});
  };
  const std::int64_t missing = sum(one) - sum(two);
  (missing > 0 ? two : one).mass[0] += std::abs(missing);
}

Side random_side(std::mt19937& random, std::size_t clusters, double heaviest = 1e5) {
  Side side;
  for (std::size_t i = 0; i < clusters; ++i) {
    side.centres.emplace_back(uniform(random, 0, 200), uniform(random, -50, 50), uniform(random, -50, 50));
    side.mass.push_back(1 + static_cast<std::int64_t>(std::pow(uniform(random, 0, 1), 4) * heaviest));
  }
  return side;
}

/// Solves and checks everything that must hold for any plan.
TransportPlan solve(const Side& source, const Side& target, const std::string& what = {}) {
  SCOPED_TRACE(what);
  const auto result = solve_transport(source.centres, source.mass, target.centres, target.mass);
  if (!result) {
    ADD_FAILURE() << result.error().line();
    return {};
  }
  std::vector<std::int64_t> sent(source.mass.size(), 0), got(target.mass.size(), 0);
  double cost = 0.0;
  for (const PlanEntry& entry : result->entries) {
    EXPECT_GT(entry.mass, 0);
    sent.at(entry.source) += entry.mass;
    got.at(entry.target) += entry.mass;
    cost += static_cast<double>(entry.mass) * length(source.centres[entry.source] - target.centres[entry.target]);
  }
  EXPECT_EQ(sent, source.mass);
  EXPECT_EQ(got, target.mass);
  const auto used = [](const std::vector<std::int64_t>& mass) {
    return mass.size() - static_cast<std::size_t>(std::count(mass.begin(), mass.end(), 0));
  };
  if (!result->entries.empty()) {
    EXPECT_LE(result->entries.size(), used(source.mass) + used(target.mass) - 1);
  }
  EXPECT_TRUE(result->primal == result->dual);
  EXPECT_NEAR(result->cost, cost, 1e-12 * cost);
  for (std::size_t i = 1; i < result->entries.size(); ++i) {
    const PlanEntry& last = result->entries[i - 1];
    const PlanEntry& entry = result->entries[i];
    EXPECT_LT(std::tie(last.source, last.target), std::tie(entry.source, entry.target));
  }
  return *result;
}

void expect_diagonal(const TransportPlan& plan, const Side& side) {
  EXPECT_EQ(plan.cost, 0.0);
  EXPECT_TRUE(plan.primal == 0);
  ASSERT_EQ(plan.entries.size(), side.mass.size());
  for (std::uint32_t i = 0; i < plan.entries.size(); ++i) EXPECT_EQ(plan.entries[i], (PlanEntry{i, i, side.mass[i]}));
}

TEST(Transport, RandomInstances) {
  std::mt19937 random(1);
  for (int round = 0; round < 150; ++round) {
    Side source = random_side(random, 1 + random() % 60);
    Side target = random_side(random, 1 + random() % 60);
    balance(source, target);
    solve(source, target, "round " + std::to_string(round));
  }
}

TEST(Transport, AgreesWithBruteForceOnAssignments) {
  std::mt19937 random(2);
  for (int round = 0; round < 60; ++round) {
    Side source = random_side(random, 5);
    Side target = random_side(random, 5);
    source.mass.assign(5, 3);
    target.mass.assign(5, 3);
    std::vector<std::size_t> order{0, 1, 2, 3, 4};
    double best = std::numeric_limits<double>::infinity();
    do {
      double cost = 0.0;
      for (std::size_t i = 0; i < 5; ++i) cost += 3.0 * length(source.centres[i] - target.centres[order[i]]);
      best = std::min(best, cost);
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(solve(source, target).cost, best, 3e-4 * best);  // the tie-break is 1e-6 d of the cost
  }
}

TEST(Transport, IdenticalSidesGiveZeroAndTheDiagonal) {
  std::mt19937 random(3);
  for (int round = 0; round < 40; ++round) {
    Side side = random_side(random, 1 + random() % 50);
    expect_diagonal(solve(side, side), side);
    for (std::size_t i = 0; i + 1 < side.centres.size(); i += 2)
      side.centres[i] = side.centres[random() % 3 % side.centres.size()];
    expect_diagonal(solve(side, side, "with duplicates"), side);
  }
}

TEST(Transport, PermutedInputGivesThePermutedPlan) {
  std::mt19937 random(4);
  for (int round = 0; round < 40; ++round) {
    Side source = random_side(random, 30);
    Side target = random_side(random, 20);
    if (round % 2 == 0)  // a lattice, full of ties
      for (Side* side : {&source, &target}) {
        std::uint32_t n = 0;
        for (auto& c : side->centres) c = glm::dvec3(n % 4, n / 4 % 4, n / 16), ++n;
      }
    balance(source, target);
    std::vector<std::uint32_t> order(source.mass.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    Side shuffled;
    for (const std::uint32_t i : order) {
      shuffled.centres.push_back(source.centres[i]);
      shuffled.mass.push_back(source.mass[i]);
    }
    const TransportPlan plain = solve(source, target);
    TransportPlan permuted = solve(shuffled, target);
    for (PlanEntry& entry : permuted.entries) entry.source = order[entry.source];
    std::sort(permuted.entries.begin(), permuted.entries.end(), [](const PlanEntry& one, const PlanEntry& two) {
      return std::tie(one.source, one.target) < std::tie(two.source, two.target);
    });
    EXPECT_EQ(plain.entries, permuted.entries);
  }
}

TEST(Transport, SwappedSidesGiveTheTransposedPlan) {
  std::mt19937 random(5);
  for (int round = 0; round < 30; ++round) {
    Side source = random_side(random, 25);
    Side target = random_side(random, 40);
    balance(source, target);
    TransportPlan forth = solve(source, target);
    TransportPlan back = solve(target, source);
    for (PlanEntry& entry : back.entries) std::swap(entry.source, entry.target);
    std::sort(back.entries.begin(), back.entries.end(), [](const PlanEntry& one, const PlanEntry& two) {
      return std::tie(one.source, one.target) < std::tie(two.source, two.target);
    });
    EXPECT_EQ(forth.entries, back.entries);
    EXPECT_TRUE(forth.primal == back.primal);
  }
}

TEST(Transport, GreySlicesKeepTheirOrder) {
  std::mt19937 random(6);
  Side source = random_side(random, 40);
  Side target = random_side(random, 40);
  for (Side* side : {&source, &target})
    for (auto& centre : side->centres) centre = {centre.x, 0, 0};
  balance(source, target);
  const TransportPlan plan = solve(source, target);
  for (const PlanEntry& one : plan.entries)
    for (const PlanEntry& two : plan.entries)
      if (source.centres[one.source].x < source.centres[two.source].x) {
        EXPECT_LE(target.centres[one.target].x, target.centres[two.target].x);
      }
}

TEST(Transport, StiffMasses) {
  std::mt19937 random(7);
  Side source = random_side(random, 50, 1e3);
  Side target = random_side(random, 50, 1e3);
  source.mass[17] = 100 * std::accumulate(source.mass.begin(), source.mass.end(), std::int64_t{0});
  balance(source, target);
  solve(source, target, "one mass 0.99");

  source = random_side(random, 50, 1e3);
  target = random_side(random, 50, 1e3);
  source.mass[3] = 1'000'000'000'000'000;
  balance(source, target);
  solve(source, target, "masses to 1e-12 and less of the total");

  source.mass[3] = std::int64_t{1} << 61;
  target = random_side(random, 50, 1e3);
  balance(source, target);
  solve(source, target, "sums near 2^61, objective beyond 64 bits");

  target.mass[5] += 7;
  source.mass[9] += 7;
  for (std::size_t i = 10; i < 30; ++i) source.mass[i + 1] += std::exchange(source.mass[i], 0);
  solve(source, target, "zero masses take no part");
}

TEST(Transport, StiffCentres) {
  std::mt19937 random(8);
  for (const double offset : {0.0, 1e6}) {
    Side source, target;
    for (int i = 0; i < 64; ++i) {
      source.centres.emplace_back(offset + i % 4, i / 4 % 4, i / 16);
      target.centres.push_back(source.centres.back() + 0.5);
      source.mass.push_back(1 + static_cast<std::int64_t>(random() % 5));
      target.mass.push_back(1 + static_cast<std::int64_t>(random() % 5));
    }
    balance(source, target);
    solve(source, target, "lattice");
  }
  Side source = random_side(random, 20);
  Side target = random_side(random, 30);
  balance(source, target);
  const double near_cost = solve(source, target).cost;
  for (Side* side : {&source, &target})
    for (auto& centre : side->centres) centre += 1e6;
  EXPECT_NEAR(solve(source, target, "offset").cost, near_cost, 1e-6 * near_cost);

  for (auto& centre : source.centres) centre = glm::dvec3(5.0);
  const TransportPlan equal = solve(source, target, "all sources in one place");
  EXPECT_GT(equal.cost, 0.0);
  for (auto& centre : target.centres) centre = glm::dvec3(5.0);
  EXPECT_EQ(solve(source, target, "all costs 0").cost, 0.0);
  for (auto& centre : target.centres) centre = glm::dvec3(5.0, 8.0, 9.0);
  const double mass = static_cast<double>(std::accumulate(target.mass.begin(), target.mass.end(), std::int64_t{0}));
  EXPECT_NEAR(solve(source, target, "all costs 5").cost, 5.0 * mass, 1e-6 * mass);
}

TEST(Transport, SplitsDuplicatesWithoutLosingAny) {
  std::mt19937 random(9);
  for (int round = 0; round < 40; ++round) {
    Side source = random_side(random, 40);
    Side target = random_side(random, 40);
    for (Side* side : {&source, &target})
      for (auto& centre : side->centres) centre = glm::dvec3(random() % 4, random() % 2, 0);
    balance(source, target);
    solve(source, target);  // marginals and the number of entries are checked there
  }
}

TEST(Transport, OneToMany) {
  std::mt19937 random(10);
  Side one = random_side(random, 1);
  Side many = random_side(random, 50);
  balance(one, many);
  EXPECT_EQ(solve(one, many).entries.size(), 50u);
  EXPECT_EQ(solve(many, one).entries.size(), 50u);
}

TEST(Transport, EmptyIsAPlanToo) {
  EXPECT_TRUE(solve({}, {}).entries.empty());
  EXPECT_TRUE(solve({{{1, 2, 3}}, {0}}, {}).entries.empty());
}

TEST(Transport, RefusesWhatIsNoProblem) {
  const auto error = [](const Side& source, const Side& target) {
    const auto result = solve_transport(source.centres, source.mass, target.centres, target.mass);
    return result ? std::string("accepted") : result.error().line();
  };
  const Side good{{{1, 2, 3}}, {5}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error({{{1, nan, 3}}, {5}}, good), "source[0]: the centre is not finite");
  EXPECT_EQ(error(good, {{{1, 2, -inf}}, {5}}), "target[0]: the centre is not finite");
  EXPECT_EQ(error({{{1, 2, 3}}, {-5}}, good), "source[0]: the mass -5 is negative");
  EXPECT_EQ(error(good, {{{1, 2, 3}}, {6}}), "target: the masses sum to 6, those of the source to 5");
  EXPECT_EQ(error({{{1, 2, 3}}, {}}, good), "source: 1 centres for 0 masses");
  const std::int64_t huge = std::int64_t{1} << 62;
  EXPECT_EQ(error({{{1, 2, 3}, {2, 2, 2}}, {huge, 1}}, good), "source[1]: the masses sum to more than 2^62");
}

}  // namespace
}  // namespace lackwerk::core
