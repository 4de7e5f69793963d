#include "core/analysis/cloud_graph.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/analysis/cloud_neighbours.hpp"

namespace lackwerk::core {

namespace {

bool before(const CloudEdge& one, const CloudEdge& two) {
  return std::tie(one.length, one.one, one.two) < std::tie(two.length, two.one, two.two);
}

CloudEdge edge(std::uint32_t one, std::uint32_t two, double length) {
  return {std::min(one, two), std::max(one, two), length};
}

/// A part of the graph and the narrowest way from it to what is together.
struct Part {
  std::vector<std::uint32_t> points;
  CloudEdge way{0, 0, 1e300};
};

/// Lets `part` know of the points that have come together.
void look_at(Part& part, std::span<const glm::dvec3> points, const CloudTree& tree,
             std::span<const std::uint32_t> members) {
  std::vector<CloudNeighbour> near;
  for (const std::uint32_t p : part.points) {
    tree.nearest(points[p], 1, near);
    const CloudEdge way = edge(p, members[near[0].index], near[0].distance);
    if (before(way, part.way)) part.way = way;
  }
}

void bridge(std::span<const glm::dvec3> points, DisjointSets& sets, std::vector<CloudEdge>& edges) {
  std::vector<std::uint32_t> slot(points.size(), 0);
  std::vector<Part> parts;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t first = sets.find(i);
    if (first == i) {
      slot[i] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    parts[slot[first]].points.push_back(i);
  }
  auto joined = std::max_element(parts.begin(), parts.end(), [](const Part& one, const Part& two) {
    return one.points.size() < two.points.size();
  });
  while (parts.size() > 1) {
    const std::vector<std::uint32_t> members = std::move(joined->points);
    parts.erase(joined);
    std::vector<glm::dvec3> places;
    places.reserve(members.size());
    for (const std::uint32_t m : members) places.push_back(points[m]);
    const CloudTree tree(places);
    for (Part& part : parts) look_at(part, points, tree, members);
    joined = std::min_element(parts.begin(), parts.end(),
                              [](const Part& one, const Part& two) { return before(one.way, two.way); });
    edges.push_back(joined->way);
  }
}

}  // namespace

DisjointSets::DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

std::uint32_t DisjointSets::find(std::uint32_t member) {
  while (parent_[member] != member) {
    parent_[member] = parent_[parent_[member]];
    member = parent_[member];
  }
  return member;
}

bool DisjointSets::merge(std::uint32_t one, std::uint32_t two) {
  one = find(one);
  two = find(two);
  parent_[std::max(one, two)] = std::min(one, two);
  return one != two;
}

std::vector<CloudEdge> connected_graph(std::span<const glm::dvec3> points, std::size_t neighbours) {
  const CloudTree tree(points);
  std::vector<CloudEdge> edges;
  edges.reserve(points.size() * neighbours);
  DisjointSets sets(points.size());
  std::vector<CloudNeighbour> near;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    tree.nearest(points[i], neighbours + 1, near);
    for (const CloudNeighbour& n : near) {
      if (n.index == i) continue;
      edges.push_back(edge(i, n.index, n.distance));
      sets.merge(i, n.index);
    }
  }
  std::sort(edges.begin(), edges.end(), before);
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const CloudEdge& a, const CloudEdge& b) { return a.one == b.one && a.two == b.two; }),
              edges.end());
  bridge(points, sets, edges);
  return edges;
}

std::vector<CloudEdge> spanning_tree(std::size_t points, std::span<const CloudEdge> edges) {
  DisjointSets sets(points);
  std::vector<CloudEdge> tree;
  for (const CloudEdge& e : edges)
    if (sets.merge(e.one, e.two)) tree.push_back(e);
  return tree;
}

}  // namespace lackwerk::core
