#include "core/analysis/transport_lemon.hpp"

#include <lemon/network_simplex.h>
#include <lemon/static_graph.h>

#include <utility>

namespace lackwerk::core {

namespace {

using Graph = lemon::StaticDigraph;
using Simplex = lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t>;

}  // namespace

struct LemonSimplex::Parts {
  Graph graph;
  std::unique_ptr<Simplex> simplex;
};

LemonSimplex::LemonSimplex(const TransportProblem& problem) : problem_(problem), parts_(std::make_unique<Parts>()) {
  const std::size_t rows = problem.source_mass.size();
  const std::size_t columns = problem.target_mass.size();
  std::vector<std::pair<int, int>> arcs;  // arc id = place in `cost`
  arcs.reserve(problem.cost.size());
  for (std::size_t s = 0; s < rows; ++s)
    for (std::size_t t = 0; t < columns; ++t) arcs.emplace_back(static_cast<int>(s), static_cast<int>(rows + t));
  Graph& graph = parts_->graph;
  graph.build(static_cast<int>(rows + columns), arcs.begin(), arcs.end());
  Graph::NodeMap<std::int64_t> supply(graph);
  Graph::ArcMap<std::int64_t> arc_cost(graph);
  for (std::size_t s = 0; s < rows; ++s) supply[Graph::nodeFromId(static_cast<int>(s))] = problem.source_mass[s];
  for (std::size_t t = 0; t < columns; ++t)
    supply[Graph::nodeFromId(static_cast<int>(rows + t))] = -problem.target_mass[t];
  for (std::size_t i = 0; i < problem.cost.size(); ++i)
    arc_cost[Graph::arcFromId(static_cast<int>(i))] = problem.cost[i];
  parts_->simplex = std::make_unique<Simplex>(graph);
  parts_->simplex->supplyMap(supply).costMap(arc_cost);
}

LemonSimplex::~LemonSimplex() = default;

bool LemonSimplex::run() { return parts_->simplex->run() == Simplex::OPTIMAL; }

std::optional<TransportSolution> LemonSimplex::solve() {
  if (!run()) return std::nullopt;
  const Simplex& simplex = *parts_->simplex;
  const std::size_t columns = problem_.target_mass.size();
  TransportSolution out;
  for (std::size_t i = 0; i < problem_.cost.size(); ++i) {
    const std::int64_t mass = simplex.flow(Graph::arcFromId(static_cast<int>(i)));
    if (mass > 0)
      out.entries.push_back({static_cast<std::uint32_t>(i / columns), static_cast<std::uint32_t>(i % columns), mass});
  }
  out.source_potential.reserve(problem_.source_mass.size());
  for (std::size_t s = 0; s < problem_.source_mass.size(); ++s)
    out.source_potential.push_back(simplex.potential(Graph::nodeFromId(static_cast<int>(s))));
  return out;
}

}  // namespace lackwerk::core
