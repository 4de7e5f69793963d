#include "packs/tools/model_reduce.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <utility>

#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::uint32_t unused = 0xffffffffU;
/// By how much a part may miss its aim before a rougher way is tried.
constexpr double good_enough = 1.25;

struct Thinned {
  MeshPart part;
  double error_mm = 0.0;
};

/// The part under other triangles, without the vertices that none of them uses.
MeshPart with_triangles(const MeshPart& part, const std::vector<std::uint32_t>& indices) {
  MeshPart out;
  out.name = part.name;
  out.kind = part.kind;
  out.indices.reserve(indices.size());
  std::vector<std::uint32_t> place(part.positions_mm.size(), unused);
  for (const std::uint32_t v : indices) {
    if (place[v] == unused) {
      place[v] = static_cast<std::uint32_t>(out.positions_mm.size());
      out.positions_mm.push_back(part.positions_mm[v]);
      out.normals.push_back(part.normals[v]);
    }
    out.indices.push_back(place[v]);
  }
  return out;
}

Thinned thinned(const MeshPart& part, std::size_t triangles, unsigned options) {
  constexpr float any_error = 1.0f;  // in shares of the part's size
  const float* positions = &part.positions_mm[0].x;
  std::vector<std::uint32_t> indices(part.indices.size());
  float error = 0.0f;
  indices.resize(meshopt_simplify(indices.data(), part.indices.data(), part.indices.size(), positions,
                                  part.positions_mm.size(), sizeof(glm::vec3), 3 * triangles, any_error, options,
                                  &error));
  const float scale_mm = meshopt_simplifyScale(positions, part.positions_mm.size(), sizeof(glm::vec3));
  return {with_triangles(part, indices), static_cast<double>(error) * static_cast<double>(scale_mm)};
}

/// Vertices at one place become one; which of their normals is kept says nothing.
MeshPart welded(MeshPart part) {
  std::vector<std::uint32_t> same(part.positions_mm.size());
  meshopt_generateVertexRemap(same.data(), part.indices.data(), part.indices.size(), part.positions_mm.data(),
                              part.positions_mm.size(), sizeof(glm::vec3));
  std::vector<std::uint32_t> first(part.positions_mm.size(), unused);  // by the number that meshoptimizer gives
  for (std::uint32_t v = 0; v < same.size(); ++v)
    if (same[v] != unused && first[same[v]] == unused) first[same[v]] = v;
  for (std::uint32_t& v : part.indices) v = first[same[v]];
  return with_triangles(part, part.indices);  // unused twins would count as seams
}

MeshPart with_new_normals(const MeshPart& part, double crease_deg) {
  car::Patch patch;
  patch.positions.assign(part.positions_mm.begin(), part.positions_mm.end());
  patch.triangles.reserve(part.indices.size() / 3);
  for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3)
    patch.triangles.push_back({part.indices[k], part.indices[k + 1], part.indices[k + 2]});
  const car::Patch smooth = car::with_normals(patch, crease_deg);
  MeshPart out;
  out.name = part.name;
  out.kind = part.kind;
  out.positions_mm.assign(smooth.positions.begin(), smooth.positions.end());
  out.normals.assign(smooth.normals.begin(), smooth.normals.end());
  out.indices.reserve(3 * smooth.triangles.size());
  for (const car::Triangle& t : smooth.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

Thinned thinned_at_any_price(const MeshPart& part, std::size_t triangles, double crease_deg) {
  const auto most = static_cast<std::size_t>(good_enough * static_cast<double>(3 * triangles));
  Thinned out = thinned(part, triangles, meshopt_SimplifyLockBorder);
  if (out.part.indices.size() <= most) return out;
  const MeshPart joined = welded(part);
  bool is_joined = false;
  for (const unsigned options : {static_cast<unsigned>(meshopt_SimplifyLockBorder), 0U}) {
    Thinned next = thinned(joined, triangles, options);
    if (next.part.indices.empty() || next.part.indices.size() >= out.part.indices.size()) continue;
    out = std::move(next);
    is_joined = true;
    if (out.part.indices.size() <= most) break;
  }
  if (is_joined) out.part = with_new_normals(out.part, crease_deg);
  return out;
}

}  // namespace

ModelReduction reduce_parts(std::vector<MeshPart>& parts, std::size_t most_triangles, double crease_deg) {
  ModelReduction out;
  for (const MeshPart& part : parts) out.before += part.indices.size() / 3;
  out.after = out.before;
  if (out.before <= most_triangles) return out;
  const double share = static_cast<double>(most_triangles) / static_cast<double>(out.before);
  out.after = 0;
  for (MeshPart& part : parts) {
    const std::size_t triangles = part.indices.size() / 3;
    const auto wanted = static_cast<std::size_t>(share * static_cast<double>(triangles));
    Thinned next = thinned_at_any_price(part, std::max<std::size_t>(wanted, 1), crease_deg);
    if (!next.part.indices.empty()) {
      part = std::move(next.part);
      out.error_mm = std::max(out.error_mm, next.error_mm);
    }
    out.after += part.indices.size() / 3;
  }
  return out;
}

}  // namespace lackwerk::packs
