// What one look-up of a measured BRDF costs: colour map beside the full table of three angles. Run by scripts/bench.
#include "core/isochromatic.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/analysis/colour_map.hpp"

namespace lackwerk::core {
namespace {

using Pairs = std::vector<std::pair<glm::dvec3, glm::dvec3>>;

Pairs random_pairs() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> polar(0.0, 1.4), azimuth(0.0, 6.28);
  const auto direction = [&] {
    const double theta = polar(random), phi = azimuth(random);
    return glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  Pairs out(4096);
  for (auto& pair : out) pair = {direction(), direction()};
  return out;
}

glm::dvec3 flop(const glm::dvec3& in, const glm::dvec3& out) {
  const FlakeAngles flake = flake_angles(in, out, 1.5);
  return glm::dvec3(1.0, 0.8, 0.5 + flake.theta_inc) * std::exp(-16.0 * flake.theta_flake * flake.theta_flake);
}

template <class F>
void over_pairs(benchmark::State& state, F look_up) {
  const Pairs pairs = random_pairs();
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& [in, out] = pairs[k++ % pairs.size()];
    benchmark::DoNotOptimize(look_up(in, out));
  }
}

void map_place_alone(benchmark::State& state) {
  over_pairs(state, [](const auto& in, const auto& out) { return map_place(in, out, 1.5, CriticalAngleCure::clip); });
}
BENCHMARK(map_place_alone)->Unit(benchmark::kNanosecond);

void colour_map_look_up(benchmark::State& state) {
  const auto map = colour_map_of(flop);
  over_pairs(state, [&](const auto& in, const auto& out) { return map->factor(in, out); });
}
BENCHMARK(colour_map_look_up)->Unit(benchmark::kNanosecond);

void full_table_look_up(benchmark::State& state) {
  const BrdfTable table = tabulate(flop);
  over_pairs(state, [&](const auto& in, const auto& out) { return table.at(in, out); });
}
BENCHMARK(full_table_look_up)->Unit(benchmark::kNanosecond);

void colour_map_build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(colour_map_of(flop));
}
BENCHMARK(colour_map_build)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lackwerk::core
