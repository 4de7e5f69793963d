#include "core/analysis/cloud_levels.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace lackwerk::core {

namespace {

/// A place and how far it is.
using Reached = std::pair<double, std::uint32_t>;

}  // namespace

CloudWays ways_from(std::uint32_t first, std::size_t places, std::span<const CloudEdge> edges) {
  std::vector<std::uint32_t> begin(places + 1, 0);
  for (const CloudEdge& e : edges) {
    ++begin[e.one + 1];
    ++begin[e.two + 1];
  }
  for (std::size_t i = 0; i < places; ++i) begin[i + 1] += begin[i];
  std::vector<Reached> next(begin.back());
  std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
  for (const CloudEdge& e : edges) {
    next[cursor[e.one]++] = {e.length, e.two};
    next[cursor[e.two]++] = {e.length, e.one};
  }
  CloudWays ways;
  ways.length.assign(places, HUGE_VAL);
  ways.before.assign(places, CloudWays::none);
  ways.length[first] = 0.0;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  open.emplace(0.0, first);
  while (!open.empty()) {
    const auto [length, v] = open.top();
    open.pop();
    if (length > ways.length[v]) continue;  // an older, longer way
    ways.longest = length;
    for (std::uint32_t e = begin[v]; e < begin[v + 1]; ++e) {
      const auto [step, u] = next[e];
      if (length + step >= ways.length[u]) continue;
      ways.length[u] = length + step;
      ways.before[u] = v;
      open.emplace(ways.length[u], u);
    }
  }
  return ways;
}

CloudLevels levels_of(const CloudWays& ways, std::span<const CloudEdge> edges, double height) {
  const std::size_t count = ways.length.size();
  std::vector<double> band;
  band.reserve(count);
  for (const double length : ways.length) band.push_back(std::floor(length / height));
  DisjointSets sets(count);
  for (const CloudEdge& e : edges)
    if (band[e.one] == band[e.two]) sets.merge(e.one, e.two);

  // The place of each set with the shortest way stands for it; a way comes into a set from a lower band only.
  std::vector<std::uint32_t> nearest(count, CloudWays::none);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t& best = nearest[sets.find(i)];
    if (best == CloudWays::none || ways.length[i] < ways.length[best]) best = i;
  }
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < count; ++i)
    if (nearest[sets.find(i)] == i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t one, std::uint32_t two) {
    return std::tie(band[one], ways.length[one], one) < std::tie(band[two], ways.length[two], two);
  });

  CloudLevels out;
  out.levels.reserve(order.size());
  std::vector<std::uint32_t> number(count, 0);
  for (const std::uint32_t i : order) {
    number[sets.find(i)] = static_cast<std::uint32_t>(out.levels.size());
    CloudLevel level;
    if (ways.before[i] != CloudWays::none) level.parent = number[sets.find(ways.before[i])];
    level.begin = level.end = ways.length[i];
    out.levels.push_back(level);
  }
  out.level_of.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    out.level_of.push_back(number[sets.find(i)]);
    CloudLevel& level = out.levels[out.level_of.back()];
    level.end = std::max(level.end, ways.length[i]);
  }
  for (std::size_t k = out.levels.size(); k-- > 1;) {
    double& below = out.levels[out.levels[k].parent].end;
    below = std::max(below, out.levels[k].end);
  }
  return out;
}

std::vector<CloudEdge> without_short_cuts(std::size_t places, std::span<const CloudEdge> edges, double longest) {
  std::vector<CloudEdge> out = spanning_tree(places, edges);
  std::erase_if(out, [&](const CloudEdge& e) { return e.length <= longest; });  // they come again below
  for (const CloudEdge& e : edges)
    if (e.length <= longest) out.push_back(e);
  return out;
}

}  // namespace lackwerk::core
