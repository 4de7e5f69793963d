#include "core/analysis/cloud_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/analysis/cloud_graph.hpp"
#include "core/analysis/cloud_levels.hpp"
#include "core/analysis/cloud_neighbours.hpp"

namespace lackwerk::core {

namespace {

/// The spanning tree hung up at its root: places in walking order (parents first), and each place's way to its tip.
struct HungTree {
  std::vector<std::uint32_t> order, parent;
  std::vector<double> to_tip;  ///< longest way down from a place
};

std::uint32_t lowest(std::span<const glm::dvec3> points, int up) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i)
    if (points[i][up] < points[found][up]) found = i;
  return found;
}

HungTree hang(std::span<const CloudEdge> tree, std::size_t count, std::uint32_t root) {
  std::vector<std::uint32_t> begin(count + 1, 0);
  for (const CloudEdge& e : tree) {
    ++begin[e.one + 1];
    ++begin[e.two + 1];
  }
  for (std::size_t i = 0; i < count; ++i) begin[i + 1] += begin[i];
  std::vector<std::pair<std::uint32_t, double>> next(begin.back());
  std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
  for (const CloudEdge& e : tree) {
    next[cursor[e.one]++] = {e.two, e.length};
    next[cursor[e.two]++] = {e.one, e.length};
  }
  HungTree hung;
  hung.parent.assign(count, CloudSegment::none);
  hung.to_tip.assign(count, 0.0);
  std::vector<double> step(count, 0.0);
  hung.order.push_back(root);
  for (std::size_t k = 0; k < hung.order.size(); ++k) {
    const std::uint32_t v = hung.order[k];
    for (std::uint32_t e = begin[v]; e < begin[v + 1]; ++e) {
      const auto [u, length] = next[e];
      if (u == hung.parent[v]) continue;
      hung.parent[u] = v;
      step[u] = length;
      hung.order.push_back(u);
    }
  }
  for (std::size_t k = count; k-- > 1;) {
    const std::uint32_t u = hung.order[k];
    double& above = hung.to_tip[hung.parent[u]];
    above = std::max(above, hung.to_tip[u] + step[u]);
  }
  return hung;
}

/// Each place's segment, and the segments' parents; numbered in walking order.
struct Cut {
  std::vector<std::uint32_t> segment_of, parent;
};

Cut cut(const HungTree& hung, double shortest_branch) {
  const std::size_t count = hung.order.size();
  std::vector<std::uint32_t> branches(count, 0);
  for (std::size_t k = 1; k < count; ++k)
    if (hung.to_tip[hung.order[k]] > shortest_branch) ++branches[hung.parent[hung.order[k]]];
  Cut out;
  out.segment_of.assign(count, 0);
  out.parent.push_back(CloudSegment::none);
  for (std::size_t k = 1; k < count; ++k) {
    const std::uint32_t u = hung.order[k];
    const std::uint32_t v = hung.parent[u];
    const bool begins = branches[v] > 1 && hung.to_tip[u] > shortest_branch;
    out.segment_of[u] = begins ? static_cast<std::uint32_t>(out.parent.size()) : out.segment_of[v];
    if (begins) out.parent.push_back(out.segment_of[v]);
  }
  return out;
}

/// A default for SegmentOptions::shortest_branch.
double shortest_of(const SegmentOptions& options, double longest_way) {
  constexpr double least_share = 0.125;
  return options.shortest_branch > 0.0 ? options.shortest_branch : least_share * longest_way;
}

Cut cut_spanning_tree(std::span<const glm::dvec3> places, std::span<const CloudEdge> edges,
                      const SegmentOptions& options) {
  const HungTree hung = hang(spanning_tree(places.size(), edges), places.size(), lowest(places, options.up));
  return cut(hung, shortest_of(options, hung.to_tip[hung.order.front()]));
}

/// Cuts behind each level from which more than one branch goes on.
Cut cut_levels(std::span<const glm::dvec3> places, std::span<const CloudEdge> edges, const SegmentOptions& options) {
  // Neighbours in a cube's next but one, not beyond: 15 of a thin stem reach across a fork.
  constexpr double edge_spacings = 2.5;
  const double reach = edge_spacings * spacing_of(places);
  const auto graph = without_short_cuts(places.size(), edges, reach);
  const CloudWays ways = ways_from(lowest(places, options.up), places.size(), graph);
  const double shortest = shortest_of(options, ways.longest);
  // A level as high as an edge is long hangs together; a branch has four at least (and there is one where all places
  // are the same).
  const double height = std::max({reach, 0.25 * shortest, std::numeric_limits<double>::min()});
  const CloudLevels tree = levels_of(ways, graph, height);
  const std::size_t count = tree.levels.size();

  const auto is_branch = [&](std::size_t k) { return tree.levels[k].end - tree.levels[k].begin > shortest; };
  std::vector<std::uint32_t> branches(count, 0);
  for (std::size_t k = 1; k < count; ++k)
    if (is_branch(k)) ++branches[tree.levels[k].parent];
  std::vector<std::uint32_t> segment(count, 0);
  std::vector<std::uint32_t> parent{CloudSegment::none};
  std::vector<double> begin{0.0};
  std::vector<double> fork{HUGE_VAL};  // where a segment's branches begin
  for (std::size_t k = 1; k < count; ++k) {
    const std::uint32_t below = segment[tree.levels[k].parent];
    if (branches[tree.levels[k].parent] < 2 || !is_branch(k)) {
      segment[k] = below;
      continue;
    }
    segment[k] = static_cast<std::uint32_t>(parent.size());
    parent.push_back(below);
    begin.push_back(tree.levels[k].begin);
    fork.push_back(HUGE_VAL);
    fork[below] = std::min(fork[below], tree.levels[k].begin);
  }

  // Where forks lie closer than a branch is long, their order is chance: what lies between goes to what is below.
  std::vector<std::uint32_t> kept(parent.size(), 0);
  Cut out;
  out.parent.push_back(CloudSegment::none);
  for (std::size_t s = 1; s < parent.size(); ++s) {
    if (fork[s] - begin[s] < shortest) {
      kept[s] = kept[parent[s]];
      continue;
    }
    kept[s] = static_cast<std::uint32_t>(out.parent.size());
    out.parent.push_back(kept[parent[s]]);
  }
  out.segment_of.reserve(places.size());
  for (const std::uint32_t level : tree.level_of) out.segment_of.push_back(kept[segment[level]]);
  return out;
}

CloudSegments gathered(std::span<const std::uint32_t> segment_of, std::span<const std::uint32_t> parent) {
  CloudSegments out;
  out.segments.resize(parent.size());
  for (std::uint32_t s = 0; s < parent.size(); ++s) {
    out.segments[s].parent = parent[s];
    out.segments[s].label = static_cast<std::int32_t>(s);
    if (parent[s] != CloudSegment::none) out.segments[parent[s]].children.push_back(s);
  }
  for (std::uint32_t i = 0; i < segment_of.size(); ++i) out.segments[segment_of[i]].points.push_back(i);
  return out;
}

/// Pairs of labelled parts that touch, with their least distance.
using Touching = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;

/// Hangs the parts up from `root`, level by level through touching pairs, then nearest first. Gives walking order.
std::vector<std::uint32_t> hang_parts(const Touching& touching, std::size_t count, std::uint32_t root, double touch,
                                      std::vector<std::uint32_t>& parent) {
  std::vector<std::vector<std::pair<std::uint32_t, double>>> next(count);
  for (const auto& [pair, distance] : touching) {
    next[pair.first].emplace_back(pair.second, distance);
    next[pair.second].emplace_back(pair.first, distance);
  }
  parent.assign(count, CloudSegment::none);
  std::vector<bool> done(count, false);
  std::vector<std::uint32_t> order{root};
  done[root] = true;
  for (std::size_t walked = 0; order.size() < count;) {
    for (; walked < order.size(); ++walked) {
      for (const auto& [u, distance] : next[order[walked]]) {
        if (done[u] || distance > touch) continue;
        done[u] = true;
        parent[u] = order[walked];
        order.push_back(u);
      }
    }
    std::uint32_t nearest = CloudSegment::none;
    double least = HUGE_VAL;
    for (const std::uint32_t v : order) {
      for (const auto& [u, distance] : next[v]) {
        if (done[u] || distance >= least) continue;
        nearest = u;
        least = distance;
        parent[u] = v;
      }
    }
    if (nearest == CloudSegment::none) break;  // all done: the graph is connected
    done[nearest] = true;
    order.push_back(nearest);
  }
  return order;
}

}  // namespace

Result<CloudSegments> segments_of(std::span<const glm::dvec3> points, const SegmentOptions& options) {
  CloudSegments out;
  if (points.empty()) {
    out.segments.emplace_back();
    return out;
  }
  PointCloud skeleton{{points.begin(), points.end()}, {}};
  if (options.skeleton_spacing > 0.0) {
    auto coarse = resampled(skeleton, options.skeleton_spacing);
    if (!coarse) return tl::unexpected(coarse.error());
    skeleton = std::move(*coarse);
  }
  const std::vector<glm::dvec3>& places = skeleton.points;
  const auto edges = connected_graph(places, options.neighbours);
  const Cut found = options.by_levels ? cut_levels(places, edges, options) : cut_spanning_tree(places, edges, options);
  if (options.skeleton_spacing <= 0.0) return gathered(found.segment_of, found.parent);

  const CloudTree search(places);
  std::vector<std::uint32_t> segment_of(points.size());
  std::vector<CloudNeighbour> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    search.nearest(points[i], 1, near);
    segment_of[i] = found.segment_of[near[0].index];
  }
  return gathered(segment_of, found.parent);
}

CloudSegments labelled_segments(const PointCloud& cloud, const SegmentOptions& options) {
  CloudSegments out;
  if (cloud.points.empty()) {
    out.segments.emplace_back();
    return out;
  }
  std::map<std::int32_t, std::uint32_t> number;
  for (const std::int32_t label : cloud.labels) number.emplace(label, 0);
  std::vector<std::int32_t> labels;
  for (auto& [label, part] : number) {
    part = static_cast<std::uint32_t>(labels.size());
    labels.push_back(label);
  }
  std::vector<std::uint32_t> part_of;
  for (const std::int32_t label : cloud.labels) part_of.push_back(number[label]);

  std::vector<std::uint32_t> order, parent;
  if (options.virtual_root) {
    for (std::uint32_t part = 0; part < labels.size(); ++part) order.push_back(part);
    parent.assign(labels.size(), CloudSegment::none);
  } else {
    Touching touching;
    for (const CloudEdge& e : connected_graph(cloud.points, options.neighbours)) {
      const auto pair = std::minmax(part_of[e.one], part_of[e.two]);
      if (pair.first == pair.second) continue;
      const auto place = touching.emplace(std::pair(pair.first, pair.second), e.length).first;
      place->second = std::min(place->second, e.length);
    }
    constexpr double touching_spacings = 4.0;
    const double touch = options.touch > 0.0 ? options.touch : touching_spacings * spacing_of(cloud.points);
    const std::uint32_t root = part_of[lowest(cloud.points, options.up)];
    order = hang_parts(touching, labels.size(), root, touch, parent);
  }

  // Renumbered in walking order, behind the empty root where there is one.
  const auto first = options.virtual_root ? 1u : 0u;
  std::vector<std::uint32_t> place(labels.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k + first;
  std::vector<std::uint32_t> parents(order.size() + first, CloudSegment::none);
  for (const std::uint32_t part : order) {
    if (options.virtual_root) parents[place[part]] = 0;
    if (parent[part] != CloudSegment::none) parents[place[part]] = place[parent[part]];
  }
  std::vector<std::uint32_t> segment_of;
  segment_of.reserve(part_of.size());
  for (const std::uint32_t part : part_of) segment_of.push_back(place[part]);
  out = gathered(segment_of, parents);
  for (const std::uint32_t part : order) out.segments[place[part]].label = labels[part];
  if (options.virtual_root) out.segments[0].label = -1;
  return out;
}

}  // namespace lackwerk::core
