#include "packs/tools/car/mesh_cutter.hpp"

#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <unordered_set>

namespace lackwerk::packs::car {

MeshCutter::Crossing MeshCutter::solve(const Cut& cut, std::uint32_t a, std::uint32_t b) const {
  // Bisection with a secant guess inside the bracket: robust where a distance has a kink.
  double low = 0.0;
  double high = 1.0;
  double at_low = value_[a];
  double at_high = value_[b];
  Crossing crossing{a, b, {}, 0.5};
  constexpr int max_steps = 24;
  constexpr double tolerance_mm = 1e-3;
  for (int i = 0; i < max_steps; ++i) {
    const double secant = at_low / (at_low - at_high);
    const double t = i % 3 == 2 ? 0.5 : std::fmin(0.95, std::fmax(0.05, secant));
    crossing.along = low + (high - low) * t;
    const Vec3 chord = mesh_.positions[a] + (mesh_.positions[b] - mesh_.positions[a]) * crossing.along;
    crossing.at = project_to_surface(field_, chord);
    const double value = cut.distance(crossing.at);
    if (std::abs(value) < tolerance_mm) break;
    if ((value < 0.0) == (at_low < 0.0)) {
      low = crossing.along;
      at_low = value;
    } else {
      high = crossing.along;
      at_high = value;
    }
  }
  return crossing;
}

std::vector<MeshCutter::Crossing> MeshCutter::find_crossings(const Cut& cut) const {
  std::vector<Crossing> crossings;
  std::unordered_set<std::uint64_t> seen;
  for (const Triangle& t : mesh_.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (value_[a] * value_[b] >= 0.0) continue;
      if (!seen.insert(edge_key(a, b)).second) continue;
      if (!cut.active(0.5 * (mesh_.positions[a] + mesh_.positions[b]))) continue;
      crossings.push_back(solve(cut, a, b));
    }
  }
  return crossings;
}

bool MeshCutter::may_move(std::uint32_t vertex, const Vec3& to) const {
  for (const std::uint32_t index : triangles_of_[vertex]) {
    const Triangle& t = mesh_.triangles[index];
    std::array<Vec3, 3> before{};
    std::array<Vec3, 3> after{};
    for (int k = 0; k < 3; ++k) {
      before[k] = mesh_.positions[t[k]];
      after[k] = t[k] == vertex ? to : before[k];
    }
    const Vec3 n0 = glm::cross(before[1] - before[0], before[2] - before[0]);
    const Vec3 n1 = glm::cross(after[1] - after[0], after[2] - after[0]);
    constexpr double least_share_of_area = 0.1;
    if (glm::dot(n0, n1) < least_share_of_area * glm::dot(n0, n0)) return false;
  }
  return true;
}

void MeshCutter::snap_close_vertices(const std::vector<Crossing>& crossings) {
  constexpr double snap_share = 0.28;
  struct Best {
    double share = snap_share;
    Vec3 at{};
  };
  std::unordered_map<std::uint32_t, Best> best;
  std::vector<std::uint32_t> order;  // of discovery: keeps the result independent of the hash map's order
  for (const Crossing& c : crossings) {
    const bool nearer_a = c.along < 0.5;
    const std::uint32_t vertex = nearer_a ? c.a : c.b;
    const double share = nearer_a ? c.along : 1.0 - c.along;
    if (share >= snap_share || locked_[vertex]) continue;
    const auto [it, fresh] = best.try_emplace(vertex);
    if (fresh) order.push_back(vertex);
    if (fresh || share < it->second.share) it->second = {share, c.at};
  }
  for (const std::uint32_t vertex : order) {
    Vec3 to = best[vertex].at;
    // A vertex of the symmetry plane may only slide within it.
    if (mesh_.positions[vertex].y == 0.0 && to.y != 0.0) continue;
    if (!may_move(vertex, to)) continue;
    mesh_.positions[vertex] = to;
    value_[vertex] = 0.0;
    locked_[vertex] = true;
  }
}

void MeshCutter::cut(const Cut& cut) {
  value_.resize(mesh_.positions.size());
  for (std::size_t i = 0; i < value_.size(); ++i) {
    // A vertex put here by an earlier, coinciding border counts as on this one, else slivers would appear.
    constexpr double on_border_mm = 0.05;
    const double value = cut.distance(mesh_.positions[i]);
    value_[i] = std::abs(value) < on_border_mm ? 0.0 : value;
  }
  triangles_of_.assign(mesh_.positions.size(), {});
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh_.triangles[i]) triangles_of_[v].push_back(static_cast<std::uint32_t>(i));
  }
  snap_close_vertices(find_crossings(cut));
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_on;
  for (const Crossing& c : find_crossings(cut)) {
    vertex_on.emplace(edge_key(c.a, c.b), static_cast<std::uint32_t>(mesh_.positions.size()));
    mesh_.positions.push_back(c.at);
    locked_.push_back(true);
  }
  split_triangles(mesh_, [&vertex_on](std::uint32_t a, std::uint32_t b) {
    const auto it = vertex_on.find(edge_key(a, b));
    return it == vertex_on.end() ? no_vertex : it->second;
  });
}

}  // namespace lackwerk::packs::car
