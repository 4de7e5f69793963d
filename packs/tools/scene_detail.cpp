#include "packs/tools/scene_detail.hpp"

#include <meshoptimizer.h>

#include <utility>

namespace lackwerk::packs {
namespace {

constexpr std::size_t small_part_triangles = 1000;
constexpr std::uint32_t unused = 0xffffffffU;

template <class T>
std::vector<T> picked(const std::vector<T>& from, const std::vector<std::uint32_t>& vertices) {
  std::vector<T> out;
  if (from.empty()) return out;
  out.reserve(vertices.size());
  for (const std::uint32_t v : vertices) out.push_back(from[v]);
  return out;
}

/// The part's surface under other triangles, without the vertices that none of them uses.
MeshPart with_triangles(const MeshPart& part, const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> vertices, place(part.positions_mm.size(), unused);
  MeshPart out;
  for (const std::uint32_t v : indices) {
    if (place[v] == unused) {
      place[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(v);
    }
    out.indices.push_back(place[v]);
  }
  out.name = part.name;
  out.kind = part.kind;
  out.detail = part.detail;
  out.positions_mm = picked(part.positions_mm, vertices);
  out.normals = picked(part.normals, vertices);
  out.visibility = picked(part.visibility, vertices);
  out.irradiance = picked(part.irradiance, vertices);
  return out;
}

}  // namespace

MeshPart coarser(const MeshPart& part, const CoarseLimits& limits) {
  if (part.indices.size() <= 3 * limits.most_triangles) return part;
  const float* positions = &part.positions_mm[0].x;
  const float scale_mm = meshopt_simplifyScale(positions, part.positions_mm.size(), sizeof(glm::vec3));
  if (!(scale_mm > 0.0f)) return part;
  std::vector<std::uint32_t> indices(part.indices.size());
  indices.resize(meshopt_simplify(indices.data(), part.indices.data(), part.indices.size(), positions,
                                  part.positions_mm.size(), sizeof(glm::vec3), 3 * limits.most_triangles,
                                  limits.most_error_mm / scale_mm, meshopt_SimplifyLockBorder, nullptr));
  return indices.empty() ? part : with_triangles(part, indices);
}

void add_with_twin(std::vector<MeshPart>& parts, MeshPart part, const CoarseLimits& limits) {
  const std::size_t triangles = part.indices.size() / 3;
  part.detail = detail_full | detail_coarse;
  if (triangles >= small_part_triangles) {
    MeshPart twin = coarser(part, limits);
    if (4 * (twin.indices.size() / 3) <= 3 * triangles) {
      part.detail = detail_full;
      twin.detail = detail_coarse;
      parts.push_back(std::move(part));
      parts.push_back(std::move(twin));
      return;
    }
  }
  parts.push_back(std::move(part));
}

std::size_t triangles_at(const Scene& scene, std::uint8_t level) {
  std::size_t count = 0;
  for (const MeshPart& part : scene.parts)
    if ((part.detail & level) != 0) count += part.indices.size() / 3;
  return count;
}

}  // namespace lackwerk::packs
