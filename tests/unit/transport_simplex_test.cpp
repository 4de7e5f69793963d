// Our transportation simplex against LEMON's network simplex, in integers.
#include "core/analysis/transport_simplex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "core/analysis/transport_lemon.hpp"

namespace lackwerk::core {
namespace {

struct Instance {
  std::vector<std::int64_t> source, target, cost;
  [[nodiscard]] TransportProblem problem() const { return {source, target, cost}; }
};

/// Masses in [1, most_mass], the lighter side's first filled up; costs in [0, most_cost].
Instance random_instance(std::mt19937& random, std::size_t rows, std::size_t columns, std::uint32_t most_mass,
                         std::uint32_t most_cost) {
  Instance out;
  for (std::size_t s = 0; s < rows; ++s) out.source.push_back(1 + random() % most_mass);
  for (std::size_t t = 0; t < columns; ++t) out.target.push_back(1 + random() % most_mass);
  const auto sum = [](const std::vector<std::int64_t>& mass) {
    return std::accumulate(mass.begin(), mass.end(), std::int64_t{0});
  };
  const std::int64_t missing = sum(out.source) - sum(out.target);
  (missing > 0 ? out.target : out.source)[0] += std::abs(missing);
  for (std::size_t i = 0; i < rows * columns; ++i) out.cost.push_back(random() % (std::uint64_t{most_cost} + 1));
  return out;
}

/// Solves with both and checks marginals, the proof and the objective. Returns our objective.
Int128 expect_optimal(const Instance& instance, const std::string& what) {
  SCOPED_TRACE(what);
  const TransportProblem problem = instance.problem();
  const auto ours = solve_simplex(problem, usual_pivot_limit(problem));
  const auto theirs = LemonSimplex(problem).solve();
  EXPECT_TRUE(ours);
  EXPECT_TRUE(theirs);
  if (!ours || !theirs) return 0;
  std::vector<std::int64_t> sent(instance.source.size(), 0), got(instance.target.size(), 0);
  for (const PlanEntry& entry : ours->entries) {
    EXPECT_GT(entry.mass, 0);
    sent.at(entry.source) += entry.mass;
    got.at(entry.target) += entry.mass;
  }
  EXPECT_EQ(sent, instance.source);
  EXPECT_EQ(got, instance.target);
  EXPECT_LE(ours->entries.size(), sent.size() + got.size() - 1);
  const Int128 primal = primal_objective(problem, ours->entries);
  EXPECT_TRUE(primal == primal_objective(problem, theirs->entries));
  EXPECT_TRUE(primal == dual_objective(problem, ours->source_potential));
  return primal;
}

TEST(TransportSimplex, AgreesWithLemonOnRandomProblems) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const std::size_t rows = 1 + random() % 60;
    const std::size_t columns = 1 + random() % 60;
    expect_optimal(random_instance(random, rows, columns, 100'000, 4'000'000'000), "round " + std::to_string(round));
  }
}

TEST(TransportSimplex, AgreesWithLemonOnDegenerateProblems) {
  std::mt19937 random(2);
  for (int round = 0; round < 200; ++round) {  // few masses, few costs: ties everywhere
    const std::size_t rows = 1 + random() % 40;
    const std::size_t columns = round % 2 == 0 ? rows : 1 + random() % 40;
    expect_optimal(random_instance(random, rows, columns, 1 + round % 3, round % 5), "round " + std::to_string(round));
  }
}

TEST(TransportSimplex, AgreesWithLemonOnLattices) {
  for (const int edge : {2, 3, 5, 8, 12}) {  // equal masses between two lattices a half step apart, city-block costs
    Instance instance;
    const auto count = static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
    instance.source.assign(count, 7);
    instance.target.assign(count, 7);
    for (std::size_t s = 0; s < count; ++s)
      for (std::size_t t = 0; t < count; ++t) {
        const auto place = [&](std::size_t i) {
          const int n = static_cast<int>(i);
          return std::pair(2 * (n % edge), 2 * (n / edge));
        };
        const auto [x, y] = place(s);
        const auto [to_x, to_y] = place(count - 1 - t);
        instance.cost.push_back(std::abs(x - to_x - 1) + std::abs(y - to_y - 1));
      }
    expect_optimal(instance, "edge " + std::to_string(edge));
  }
}

TEST(TransportSimplex, AgreesWithLemonOnOddShapes) {
  std::mt19937 random(3);
  struct Shape {
    std::size_t rows, columns;
  };
  for (const Shape shape : {Shape{1, 1}, Shape{1, 50}, Shape{50, 1}, Shape{2, 250}, Shape{250, 2}, Shape{250, 50},
                            Shape{50, 250}, Shape{250, 250}})
    for (const std::uint32_t most_mass : {1u, 5000u}) {
      const std::string what = std::to_string(shape.rows) + " x " + std::to_string(shape.columns);
      expect_optimal(random_instance(random, shape.rows, shape.columns, most_mass, 1'000'000'000), what);
    }
}

TEST(TransportSimplex, CostsOfEitherSignAndSumsBeyond64Bits) {
  std::mt19937 random(4);
  Instance instance = random_instance(random, 20, 30, 1000, 1'000'000'000);
  for (std::int64_t& cost : instance.cost) cost -= 500'000'000;
  expect_optimal(instance, "signed");
  for (std::int64_t& cost : instance.cost) cost = (cost + 500'000'000) * 1000;  // 2^40
  for (auto* side : {&instance.source, &instance.target})
    for (std::int64_t& mass : *side) mass *= std::int64_t{1} << 44;
  EXPECT_TRUE(expect_optimal(instance, "large") > (Int128{1} << 64));
}

TEST(TransportSimplex, SameInputGivesTheSamePivots) {
  std::mt19937 random(5);
  const Instance instance = random_instance(random, 50, 50, 3, 20);
  const auto one = solve_simplex(instance.problem(), 1'000'000);
  const auto two = solve_simplex(instance.problem(), 1'000'000);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->pivots, two->pivots);
  EXPECT_EQ(one->entries, two->entries);
  EXPECT_EQ(one->source_potential, two->source_potential);
}

TEST(TransportSimplex, SaysWhereItCannot) {
  std::mt19937 random(6);
  Instance instance = random_instance(random, 30, 30, 1000, 1'000'000);
  EXPECT_FALSE(solve_simplex(instance.problem(), 3));  // pivots
  instance.cost[7] = std::int64_t{1} << 60;
  EXPECT_FALSE(solve_simplex(instance.problem(), 1'000'000));  // potentials beyond 63 bits
}

}  // namespace
}  // namespace lackwerk::core
