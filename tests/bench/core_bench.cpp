// Medians of the kernels that the figures in the documents speak of. Run by scripts/bench; asserts nothing.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/analysis/flake_clusters.hpp"
#include "core/analysis/interpolation.hpp"
#include "core/analysis/transport.hpp"
#include "core/analysis/transport_lemon.hpp"
#include "core/analysis/transport_simplex.hpp"
#include "core/directional_albedo.hpp"
#include "core/paint_model.hpp"
#include "core/paint_textures.hpp"
#include "core/rank_table.hpp"
#include "core/realise.hpp"
#include "tests/unit/random_flakes.hpp"

namespace lackwerk::core {
namespace {

/// The real layout: 67 slices, 9 levels, 50 clusters a row.
const FlakeFrame& real_frame() {
  static const FlakeFrame frame{axf_layout(), 9, 0.05f, 480, 1};
  return frame;
}

InterpolatableData real_data(std::size_t paints) {
  std::mt19937 random(1);
  return testing::build_or_fail(testing::random_paints(random, paints, real_frame(), 50, 230400), real_frame(), 2);
}

/// Two slices of 50 equal masses.
struct FiftyByFifty {
  std::vector<glm::dvec3> a = std::vector<glm::dvec3>(50), b = a;
  std::vector<std::int64_t> mass = std::vector<std::int64_t>(50, 4608);
  std::vector<std::int64_t> cost;  ///< in units of 2^-31 Lab, below 2^40
  FiftyByFifty() {
    std::mt19937 random(2);
    for (auto* side : {&a, &b})
      for (auto& centre : *side)
        centre = {testing::uniform(random, 0, 250), testing::uniform(random, -40, 40),
                  testing::uniform(random, -40, 40)};
    cost.reserve(a.size() * b.size());
    for (const auto& from : a)
      for (const auto& to : b) cost.push_back(std::llround(std::ldexp(glm::distance(from, to), 31)));
  }
  [[nodiscard]] TransportProblem problem() const { return {mass, mass, cost}; }
};

void transport_50_by_50(benchmark::State& state) {
  const FiftyByFifty clouds;
  for (auto _ : state) benchmark::DoNotOptimize(solve_transport(clouds.a, clouds.mass, clouds.b, clouds.mass));
}
BENCHMARK(transport_50_by_50)->Unit(benchmark::kMicrosecond);

void simplex_50_by_50(benchmark::State& state) {
  const FiftyByFifty clouds;
  const TransportProblem problem = clouds.problem();
  for (auto _ : state) benchmark::DoNotOptimize(solve_simplex(problem, usual_pivot_limit(problem)));
}
BENCHMARK(simplex_50_by_50)->Unit(benchmark::kMicrosecond);

void lemon_alone_50_by_50(benchmark::State& state) {
  const FiftyByFifty clouds;
  LemonSimplex solver(clouds.problem());
  for (auto _ : state) benchmark::DoNotOptimize(solver.run());
}
BENCHMARK(lemon_alone_50_by_50)->Unit(benchmark::kMicrosecond);

void clusters_of_a_slice(benchmark::State& state) {
  std::mt19937 random(3);
  std::vector<glm::vec3> lab(480 * 480, glm::vec3(0.0f));
  for (auto& texel : lab)
    if (random() % 5 == 0) {
      const auto l = static_cast<float>(std::pow(testing::uniform(random, 0, 1), 3) * 480);
      texel = {l, -0.05f * l, 0.02f * l};
    }
  for (auto _ : state) benchmark::DoNotOptimize(cluster_texels(lab, {}));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(lab.size()));
}
BENCHMARK(clusters_of_a_slice)->Unit(benchmark::kMillisecond);

void realise_all_rows(benchmark::State& state) {
  const auto data = real_data(static_cast<std::size_t>(state.range(0)));
  const auto paint = data.view();
  RealisedPaint out;
  const std::vector<double> w(paint.paints.size(), 1.0 / static_cast<double>(paint.paints.size()));
  for (auto _ : state) {
    realise(paint, Weights::uniform(w), out);
    benchmark::DoNotOptimize(out.corners.data());
  }
}
BENCHMARK(realise_all_rows)->Arg(2)->Arg(3)->Arg(5)->Unit(benchmark::kMillisecond);

/// 0: all weights move, as on the kiosk's slider; 1: the flakes' alone.
void albedo_tables(benchmark::State& state) {
  const auto data = real_data(2);
  const auto paint = data.view();
  AnalyticPaint analytic;
  analytic.diffuse = glm::dvec3(0.05);
  analytic.lobes = {Lobe{glm::dvec3(0.07), 0.38, 1.0}, Lobe{glm::dvec3(0.1), 0.17, 0.9},
                    Lobe{glm::dvec3(0.03), 0.05, 0.5}};
  analytic.coat_ior = analytic.refraction_ior = 1.5;
  std::array<PaintTextures, 2> textures{make_static_textures(paint), make_static_textures(paint)};
  for (std::size_t k = 0; k < 2; ++k) {
    RealisedPaint realised;
    const double w = k == 0 ? 0.3 : 0.6;
    realise(paint, Weights::uniform({w, 1.0 - w}), realised);
    update_textures(paint, realised, textures[k]);
  }
  AlbedoTable table;
  std::size_t turn = 0;
  for (auto _ : state) {
    turn = 1 - turn;
    if (state.range(0) == 0) analytic.coat_ior = turn == 0 ? 1.5 : 1.49;
    directional_albedo(paint, analytic, textures[turn], table);
    benchmark::DoNotOptimize(table.rows.data());
  }
}
BENCHMARK(albedo_tables)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void rank_table(benchmark::State& state) {
  const auto data = real_data(3);
  const auto paint = data.view();
  for (auto _ : state) benchmark::DoNotOptimize(build_rank_table(paint));
}
BENCHMARK(rank_table)->Unit(benchmark::kMillisecond);

void model_on_the_cpu(benchmark::State& state) {
  PaintModel<float> model;
  model.u_lobe[0] = {0.065f, 0.08f, 0.09f, 1.0f};
  model.u_inv_m = {1.0f / 0.38f, 1.0f / 0.17f, 1.0f / 0.013f};
  model.u_coat_ior = 1.5f;
  glm::vec3 i(0.6f, 0.0f, 0.8f);
  const glm::vec3 o(-0.28f, 0.0f, 0.96f);
  for (auto _ : state) {
    benchmark::DoNotOptimize(i);  // or the compiler evaluates once
    benchmark::DoNotOptimize(model.paint_factor({0, 0, 1}, i, o, {0, 0}, 0, 0));
  }
}
BENCHMARK(model_on_the_cpu)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace lackwerk::core

BENCHMARK_MAIN();
