// A triangle mesh whose vertices lie on a field's surface, and how it is made.
//
// Why it exists: the body is meshed once, finely where it bends and coarsely where it does not, and later cut along
// curves; both need an indexed mesh without normals, because the field knows those. Values, owned by the caller; the
// functions are pure and deterministic.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "packs/tools/car/field.hpp"

namespace lackwerk::packs::car {

using Triangle = std::array<std::uint32_t, 3>;

struct SurfaceMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside
};

/// A box around the left half (y >= 0) of a solid. Its surface grid is shrunk onto the solid along rays towards a
/// spine parallel to x; the solid must be star-shaped as seen from that spine.
struct WrapBox {
  Vec3 low, high;  ///< low.y = 0 for a half solid
  double spine_from_x, spine_to_x, spine_z;
  double spine_y = 0.0;
  double cell_mm;
};

/// How coarse the mesh may be at a place.
struct Tolerance {
  double longest_edge_mm;
  double bend_deg;                  ///< between the normals at both ends of an edge
  double normal_error_deg = 180.0;  ///< of the interpolated normal in the middle: what one sees as ragged reflections
};

/// Where to spend triangles.
struct MeshQuality {
  std::function<Tolerance(const Vec3&)> tolerance;
  double shortest_edge_mm;  ///< never split below twice this
};

[[nodiscard]] SurfaceMesh wrap_field(const Field& field, const WrapBox& box);

/// Splits edges until `quality` is met; new vertices are put on the surface.
void refine(SurfaceMesh& mesh, const Field& field, const MeshQuality& quality);

/// Key of an undirected edge.
[[nodiscard]] inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32U) | b : (std::uint64_t{b} << 32U) | a;
}

/// Replaces every triangle by the pieces its split edges call for. `split` answers the new vertex on an edge, or
/// `no_vertex`; asked for each edge of each triangle.
inline constexpr std::uint32_t no_vertex = 0xffffffffU;
void split_triangles(SurfaceMesh& mesh, const std::function<std::uint32_t(std::uint32_t, std::uint32_t)>& split);

}  // namespace lackwerk::packs::car
