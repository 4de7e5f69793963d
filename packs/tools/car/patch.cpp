#include "packs/tools/car/patch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <unordered_map>

namespace lackwerk::packs::car {

namespace {

/// For each vertex the index of the first vertex at the same place (to a micrometre or so).
std::vector<std::uint32_t> weld_map(const std::vector<Vec3>& positions) {
  constexpr double grid_mm = 0.01;
  std::map<std::array<long long, 3>, std::uint32_t> first;
  std::vector<std::uint32_t> same(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 q = glm::round(positions[i] / grid_mm);
    const std::array<long long, 3> key{std::llround(q.x), std::llround(q.y), std::llround(q.z)};
    same[i] = first.try_emplace(key, static_cast<std::uint32_t>(i)).first->second;
  }
  return same;
}

Vec3 area_normal(const Patch& patch, const Triangle& t) {
  return glm::cross(patch.positions[t[1]] - patch.positions[t[0]], patch.positions[t[2]] - patch.positions[t[0]]);
}

}  // namespace

void append(Patch& to, const Patch& from) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  for (const Triangle& t : from.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

Patch extract(const SurfaceMesh& mesh, const Field& field, const std::function<bool(const Triangle&)>& wanted) {
  Patch out;
  std::vector<std::uint32_t> index(mesh.positions.size(), no_vertex);
  for (const Triangle& t : mesh.triangles) {
    if (!wanted(t)) continue;
    Triangle u{};
    for (int k = 0; k < 3; ++k) {
      if (index[t[k]] == no_vertex) {
        index[t[k]] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(mesh.positions[t[k]]);
        out.normals.push_back(unit_normal(field, mesh.positions[t[k]]));
      }
      u[k] = index[t[k]];
    }
    out.triangles.push_back(u);
  }
  return out;
}

std::vector<BorderEdge> border(const Patch& patch) {
  const std::vector<std::uint32_t> same = weld_map(patch.positions);
  std::unordered_map<std::uint64_t, int> uses;
  for (const Triangle& t : patch.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[edge_key(same[t[k]], same[t[(k + 1) % 3]])];
  }
  std::vector<BorderEdge> edges;
  for (const Triangle& t : patch.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (uses[edge_key(same[a], same[b])] == 1) edges.push_back({a, b});
    }
  }
  return edges;
}

Patch hole_walls(const Patch& rim, const std::function<Vec3(const Vec3&)>& offset) {
  Patch walls;
  for (const BorderEdge& e : border(rim)) {
    const Vec3& a = rim.positions[e.from];
    const Vec3& b = rim.positions[e.to];
    if (a.y == 0.0 && b.y == 0.0) continue;
    const auto base = static_cast<std::uint32_t>(walls.positions.size());
    walls.positions.insert(walls.positions.end(), {a, b, b + offset(b), a + offset(a)});
    walls.triangles.push_back({base, base + 1, base + 2});
    walls.triangles.push_back({base, base + 2, base + 3});
  }
  constexpr double wall_crease_deg = 40.0;
  return with_normals(walls, wall_crease_deg);
}

Patch displaced(Patch patch, const std::function<Vec3(const Vec3&)>& offset) {
  for (Vec3& p : patch.positions) p += offset(p);
  return patch;
}

Patch reversed(Patch patch) {
  for (Triangle& t : patch.triangles) std::swap(t[1], t[2]);
  for (Vec3& n : patch.normals) n = -n;
  return patch;
}

Patch mirrored_y(Patch patch) {
  for (Vec3& p : patch.positions) p.y = -p.y;
  for (Vec3& n : patch.normals) n.y = -n.y;
  for (Triangle& t : patch.triangles) std::swap(t[1], t[2]);
  return patch;
}

Patch transformed(Patch patch, const std::function<Vec3(const Vec3&)>& place) {
  for (Vec3& p : patch.positions) p = place(p);
  return patch;
}

Patch rotated_about_y(Patch patch, double angle_deg) {
  const double c = std::cos(glm::radians(angle_deg));
  const double s = std::sin(glm::radians(angle_deg));
  const auto turn = [c, s](Vec3& v) { v = Vec3{c * v.x + s * v.z, v.y, -s * v.x + c * v.z}; };
  for (Vec3& p : patch.positions) turn(p);
  for (Vec3& n : patch.normals) turn(n);
  return patch;
}

Patch with_normals(const Patch& patch, double crease_deg) {
  const std::vector<std::uint32_t> same = weld_map(patch.positions);
  std::vector<std::vector<std::uint32_t>> around(patch.positions.size());
  std::vector<Vec3> face(patch.triangles.size());
  for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
    face[i] = area_normal(patch, patch.triangles[i]);
    for (const std::uint32_t v : patch.triangles[i]) around[same[v]].push_back(static_cast<std::uint32_t>(i));
  }
  const double least_cosine = std::cos(glm::radians(crease_deg));
  Patch out;
  std::map<std::array<long long, 4>, std::uint32_t> made;  // vertex and its rounded normal
  for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
    const double area = glm::length(face[i]);
    if (area <= 0.0) continue;
    const Vec3 own = face[i] / area;
    Triangle t{};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = same[patch.triangles[i][k]];
      Vec3 sum(0.0);
      for (const std::uint32_t other : around[v]) {
        const double l = glm::length(face[other]);
        if (l > 0.0 && glm::dot(face[other], own) >= least_cosine * l) sum += face[other];
      }
      const Vec3 n = glm::normalize(sum);
      constexpr double steps = 1000.0;
      const std::array<long long, 4> key{v, std::llround(n.x * steps), std::llround(n.y * steps),
                                         std::llround(n.z * steps)};
      const auto [it, fresh] = made.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
      if (fresh) {
        out.positions.push_back(patch.positions[v]);
        out.normals.push_back(n);
      }
      t[k] = it->second;
    }
    out.triangles.push_back(t);
  }
  return out;
}

Patch grid(int rows, int columns, const std::function<Vec3(int, int)>& at) {
  Patch patch;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) patch.positions.push_back(at(r, c));
  }
  const auto index = [columns](int r, int c) { return static_cast<std::uint32_t>(r * columns + c); };
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      patch.triangles.push_back({index(r, c), index(r + 1, c), index(r + 1, c + 1)});
      patch.triangles.push_back({index(r, c), index(r + 1, c + 1), index(r, c + 1)});
    }
  }
  return patch;
}

Patch revolve(const std::vector<Vec2>& profile, int segments) {
  const int columns = static_cast<int>(profile.size());
  return grid(segments + 1, columns, [&profile, segments](int r, int c) {
    const double angle = 2.0 * 3.14159265358979323846 * (r % segments) / segments;
    return Vec3{-profile[c].x * std::sin(angle), profile[c].y, profile[c].x * std::cos(angle)};
  });
}

Patch rounded_box(const Vec3& centre, const Vec3& half_size, double radius_mm) {
  // A cube grid with extra lines near each edge, pushed onto the rounded shape.
  const std::array<double, 6> line{-1.0, -0.55, 0.0, 0.0, 0.55, 1.0};
  constexpr int count = 6;
  Patch patch;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = -1; side <= 1; side += 2) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      Patch face = grid(count, count, [&](int r, int c) {
        Vec3 cube;
        cube[axis] = side;
        cube[u] = line[side > 0 ? r : count - 1 - r];
        cube[v] = line[c];
        const Vec3 core = half_size - radius_mm;
        Vec3 inner;
        inner[axis] = side * core[axis];
        inner[u] = (side > 0 ? r : count - 1 - r) < count / 2 ? -core[u] : core[u];
        inner[v] = c < count / 2 ? -core[v] : core[v];
        return centre + inner + glm::normalize(cube) * radius_mm;
      });
      append(patch, face);
    }
  }
  constexpr double smooth_all_deg = 50.0;
  return with_normals(patch, smooth_all_deg);
}

void add_parts(std::vector<MeshPart>& parts, const Patch& patch, const std::string& name, SurfaceKind kind) {
  constexpr std::size_t most_vertices = 65535;
  std::size_t next = 0;
  for (int number = 1; next < patch.triangles.size(); ++number) {
    MeshPart part;
    part.name = number == 1 ? name : name + "_" + std::to_string(number);
    part.kind = kind;
    std::vector<std::uint32_t> index(patch.positions.size(), no_vertex);
    for (; next < patch.triangles.size() && part.positions_mm.size() + 3 <= most_vertices; ++next) {
      constexpr double least_area_mm2 = 1e-5;
      if (glm::length(area_normal(patch, patch.triangles[next])) < least_area_mm2) continue;
      for (const std::uint32_t v : patch.triangles[next]) {
        if (index[v] == no_vertex) {
          index[v] = static_cast<std::uint32_t>(part.positions_mm.size());
          part.positions_mm.emplace_back(patch.positions[v]);
          part.normals.emplace_back(patch.normals[v]);
        }
        part.indices.push_back(index[v]);
      }
    }
    parts.push_back(std::move(part));
  }
}

}  // namespace lackwerk::packs::car
