#include "packs/tools/car/surface_mesh.hpp"
#include "core/check.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace lackwerk::packs::car {

namespace {

Vec3 shrink_onto(const Field& field, const WrapBox& box, const Vec3& outside) {
  const Vec3 inside{std::clamp(outside.x, box.spine_from_x, box.spine_to_x), box.spine_y, box.spine_z};
  double low = 0.0;
  double high = 1.0;
  constexpr int halvings = 26;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (field.value(inside + (outside - inside) * middle) < 0.0 ? low : high) = middle;
  }
  Vec3 p = inside + (outside - inside) * (0.5 * (low + high));
  if (outside.y == 0.0) p.y = 0.0;
  return p;
}

/// Collects lattice points on the faces of a box, each once.
class BoxLattice {
 public:
  BoxLattice(const Field& field, const WrapBox& box) : field_(field), box_(box) {
    for (int axis = 0; axis < 3; ++axis) {
      cells_[axis] = std::max(2, static_cast<int>(std::ceil((box.high[axis] - box.low[axis]) / box.cell_mm)));
    }
  }

  SurfaceMesh build() {
    const bool half = box_.low.y == 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != 1 || !half) face(axis, false);
      face(axis, true);
    }
    return std::move(mesh_);
  }

 private:
  void face(int axis, bool high) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int j = 0; j < cells_[v]; ++j) {
      for (int i = 0; i < cells_[u]; ++i) {
        std::array<std::uint32_t, 4> corner{};
        for (int k = 0; k < 4; ++k) {
          std::array<int, 3> at{};
          at[axis] = high ? cells_[axis] : 0;
          at[u] = i + (k == 1 || k == 2 ? 1 : 0);
          at[v] = j + (k >= 2 ? 1 : 0);
          corner[k] = vertex(at);
        }
        if (!high) std::swap(corner[1], corner[3]);
        add_quad(corner);
      }
    }
  }

  void add_quad(const std::array<std::uint32_t, 4>& c) {
    const auto& p = mesh_.positions;
    if (glm::distance(p[c[0]], p[c[2]]) <= glm::distance(p[c[1]], p[c[3]])) {
      mesh_.triangles.push_back({c[0], c[1], c[2]});
      mesh_.triangles.push_back({c[0], c[2], c[3]});
    } else {
      mesh_.triangles.push_back({c[0], c[1], c[3]});
      mesh_.triangles.push_back({c[1], c[2], c[3]});
    }
  }

  std::uint32_t vertex(const std::array<int, 3>& at) {
    const auto [it, fresh] = index_.try_emplace(at, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (fresh) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const double t = static_cast<double>(at[axis]) / cells_[axis];
        p[axis] = box_.low[axis] + (box_.high[axis] - box_.low[axis]) * t;
      }
      mesh_.positions.push_back(shrink_onto(field_, box_, p));
    }
    return it->second;
  }

  const Field& field_;
  const WrapBox& box_;
  std::array<int, 3> cells_{};
  std::map<std::array<int, 3>, std::uint32_t> index_;
  SurfaceMesh mesh_;
};

/// Splits edges round by round: those too long or too bent, plus the longest edge of every touched triangle, which
/// keeps triangles from degenerating (Rivara's rule). What is known about vertices and edges is kept between rounds.
class Refinement {
 public:
  Refinement(SurfaceMesh& mesh, const Field& field, const MeshQuality& quality)
      : mesh_(mesh), field_(field), quality_(quality) {
    for (const Vec3& p : mesh.positions) know(p);
  }

  /// One round; false when nothing was left to do.
  bool run_round() {
    marked_.clear();
    for (const Triangle& t : mesh_.triangles) {
      for (int k = 0; k < 3; ++k) {
        if (wants_split(t[k], t[(k + 1) % 3])) marked_.insert(edge_key(t[k], t[(k + 1) % 3]));
      }
    }
    if (marked_.empty()) return false;
    for (bool changed = true; changed;) {
      changed = false;
      for (const Triangle& t : mesh_.triangles) changed = close(t) || changed;
    }
    split_triangles(mesh_, [this](std::uint32_t a, std::uint32_t b) { return split(a, b); });
    return true;
  }

 private:
  struct Middle {
    Vec3 at{}, normal{};
    std::uint32_t vertex = no_vertex;
  };

  void know(const Vec3& p) { know(unit_normal(field_, p), quality_.tolerance(p)); }
  void know(const Vec3& normal, const Tolerance& tolerance) {
    normals_.push_back(normal);
    tolerances_.push_back(tolerance);
  }

  [[nodiscard]] double length(std::uint32_t a, std::uint32_t b) const {
    return glm::distance(mesh_.positions[a], mesh_.positions[b]);
  }

  [[nodiscard]] Middle& middle(std::uint32_t a, std::uint32_t b) {
    const auto [it, fresh] = middle_.try_emplace(edge_key(a, b));
    if (fresh) {
      it->second.at = project_to_surface(field_, 0.5 * (mesh_.positions[a] + mesh_.positions[b]));
      it->second.normal = unit_normal(field_, it->second.at);
    }
    return it->second;
  }

  [[nodiscard]] bool wants_split(std::uint32_t a, std::uint32_t b) {
    const double l = length(a, b);
    if (l < 2.0 * quality_.shortest_edge_mm) return false;
    const Tolerance& at_a = tolerances_[a];
    const Tolerance& at_b = tolerances_[b];
    if (l > 0.5 * (at_a.longest_edge_mm + at_b.longest_edge_mm)) return true;
    const double bend_deg = std::fmin(at_a.bend_deg, at_b.bend_deg);
    if (glm::dot(normals_[a], normals_[b]) < std::cos(glm::radians(bend_deg))) return true;
    const double error_deg = std::fmin(at_a.normal_error_deg, at_b.normal_error_deg);
    if (error_deg >= 180.0) return false;
    const Vec3 interpolated = glm::normalize(normals_[a] + normals_[b]);
    return glm::distance(interpolated, middle(a, b).normal) > glm::radians(error_deg);
  }

  bool close(const Triangle& t) {
    int longest = 0;
    bool touched = false;
    for (int k = 0; k < 3; ++k) {
      touched = touched || marked_.count(edge_key(t[k], t[(k + 1) % 3])) > 0;
      if (length(t[k], t[(k + 1) % 3]) > length(t[longest], t[(longest + 1) % 3])) longest = k;
    }
    return touched && marked_.insert(edge_key(t[longest], t[(longest + 1) % 3])).second;
  }

  std::uint32_t split(std::uint32_t a, std::uint32_t b) {
    if (marked_.count(edge_key(a, b)) == 0) return no_vertex;
    Middle& m = middle(a, b);
    if (m.vertex == no_vertex) {
      m.vertex = static_cast<std::uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(m.at);
      know(m.normal, quality_.tolerance(m.at));
    }
    return m.vertex;
  }

  SurfaceMesh& mesh_;
  const Field& field_;
  const MeshQuality& quality_;
  std::vector<Vec3> normals_;
  std::vector<Tolerance> tolerances_;
  std::unordered_set<std::uint64_t> marked_;
  std::unordered_map<std::uint64_t, Middle> middle_;
};

}  // namespace

SurfaceMesh wrap_field(const Field& field, const WrapBox& box) { return BoxLattice(field, box).build(); }

void refine(SurfaceMesh& mesh, const Field& field, const MeshQuality& quality) {
  Refinement refinement(mesh, field, quality);
  // A tolerance that no edge can meet would double the mesh every round; the car needs under 100,000.
  constexpr int max_rounds = 16;
  constexpr std::size_t max_triangles = 1'000'000;
  for (int round = 0; round < max_rounds; ++round) {
    if (!refinement.run_round()) break;
    check_at_most(mesh.triangles.size(), max_triangles, "triangles of a refined mesh");
  }
}

void split_triangles(SurfaceMesh& mesh, const std::function<std::uint32_t(std::uint32_t, std::uint32_t)>& split) {
  std::vector<Triangle> out;
  out.reserve(mesh.triangles.size() * 2);
  for (const Triangle& t : mesh.triangles) {
    std::array<std::uint32_t, 3> m{};
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      m[k] = split(t[k], t[(k + 1) % 3]);
      count += m[k] != no_vertex ? 1 : 0;
    }
    const auto& p = mesh.positions;
    if (count == 0) {
      out.push_back(t);
    } else if (count == 3) {
      out.push_back({t[0], m[0], m[2]});
      out.push_back({t[1], m[1], m[0]});
      out.push_back({t[2], m[2], m[1]});
      out.push_back({m[0], m[1], m[2]});
    } else if (count == 1) {
      const int k = m[0] != no_vertex ? 0 : (m[1] != no_vertex ? 1 : 2);
      out.push_back({t[k], m[k], t[(k + 2) % 3]});
      out.push_back({m[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    } else {
      // Rotate so that edge 2 is whole: a corner triangle at vertex 1 and a quad (0, m0, m1, 2) remain.
      const int whole = m[0] == no_vertex ? 0 : (m[1] == no_vertex ? 1 : 2);
      const int s = (whole + 1) % 3;
      const std::uint32_t a = t[s];
      const std::uint32_t b = t[(s + 1) % 3];
      const std::uint32_t c = t[(s + 2) % 3];
      const std::uint32_t ab = m[s];
      const std::uint32_t bc = m[(s + 1) % 3];
      out.push_back({ab, b, bc});
      if (glm::distance(p[a], p[bc]) <= glm::distance(p[ab], p[c])) {
        out.push_back({a, ab, bc});
        out.push_back({a, bc, c});
      } else {
        out.push_back({a, ab, c});
        out.push_back({ab, bc, c});
      }
    }
  }
  mesh.triangles = std::move(out);
}

}  // namespace lackwerk::packs::car
