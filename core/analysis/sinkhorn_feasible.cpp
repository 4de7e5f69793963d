// Whether a sparse support allows a plan: Hall's condition by maximum flow.
#include <lemon/preflow.h>
#include <lemon/static_graph.h>

#include <cmath>
#include <utility>

#include "core/analysis/sinkhorn.hpp"

namespace lackwerk::core {

namespace {

/// Masses as whole numbers that sum to 2^40, give or take half a unit each.
std::vector<std::int64_t> whole(std::span<const double> mass) {
  double total = 0.0;
  for (const double m : mass) total += m;
  std::vector<std::int64_t> out;
  out.reserve(mass.size());
  for (const double m : mass) out.push_back(std::llround(std::ldexp(m / total, 40)));
  return out;
}

}  // namespace

bool support_is_feasible(const TransportSupport& support, std::span<const double> row_mass,
                         std::span<const double> column_mass, SinkhornPlan& plan) {
  using Graph = lemon::StaticDigraph;
  const std::vector<std::int64_t> out = whole(row_mass);
  const std::vector<std::int64_t> in = whole(column_mass);
  const int rows = static_cast<int>(out.size());
  const int columns = static_cast<int>(in.size());
  const int source = rows + columns;
  std::vector<std::pair<int, int>> arcs;  // sorted by their beginning, as the graph wants them
  std::vector<std::int64_t> room;
  constexpr std::int64_t unbounded = std::int64_t{1} << 42;  // no cut of least capacity goes through a pair
  for (int a = 0; a < rows; ++a) {
    const auto row = static_cast<std::size_t>(a);
    for (std::size_t e = support.row_begin[row]; e < support.row_begin[row + 1]; ++e) {
      arcs.emplace_back(a, rows + static_cast<int>(support.column[e]));
      room.push_back(unbounded);
    }
  }
  for (int b = 0; b < columns; ++b) {
    arcs.emplace_back(rows + b, source + 1);
    room.push_back(in[static_cast<std::size_t>(b)]);
  }
  std::int64_t wanted = 0;
  for (int a = 0; a < rows; ++a) {
    arcs.emplace_back(source, a);
    room.push_back(out[static_cast<std::size_t>(a)]);
    wanted += room.back();
  }
  Graph graph;
  graph.build(source + 2, arcs.begin(), arcs.end());
  Graph::ArcMap<std::int64_t> capacity(graph);
  for (std::size_t i = 0; i < room.size(); ++i) capacity[Graph::arcFromId(static_cast<int>(i))] = room[i];
  lemon::Preflow<Graph, Graph::ArcMap<std::int64_t>> flow(graph, capacity, Graph::nodeFromId(source),
                                                          Graph::nodeFromId(source + 1));
  flow.runMinCut();
  if (wanted - flow.flowValue() <= rows + columns) return true;  // the rounding of the masses
  for (int a = 0; a < rows; ++a)
    if (out[static_cast<std::size_t>(a)] > 0 && flow.minCut(Graph::nodeFromId(a)))
      plan.stuck_rows.push_back(static_cast<std::uint32_t>(a));
  for (int b = 0; b < columns; ++b)
    if (in[static_cast<std::size_t>(b)] > 0 && !flow.minCut(Graph::nodeFromId(rows + b)))
      plan.starved_columns.push_back(static_cast<std::uint32_t>(b));
  return false;
}

}  // namespace lackwerk::core
