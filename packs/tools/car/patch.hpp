// Pieces of finished surface (with normals) and the operations the details are made of.
//
// Why it exists: wheels, lamps, mirrors and the cut body all end up as the same thing, a `MeshPart`; everything before
// that is done here in double precision. Values, owned by the caller; pure functions, any thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "packs/scene.hpp"
#include "packs/tools/car/outline.hpp"
#include "packs/tools/car/surface_mesh.hpp"

namespace lackwerk::packs::car {

struct Patch {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< as long as positions
  std::vector<Triangle> triangles;
};

void append(Patch& to, const Patch& from);

/// The triangles for which `wanted` holds, with normals of the field.
[[nodiscard]] Patch extract(const SurfaceMesh& mesh, const Field& field,
                            const std::function<bool(const Triangle&)>& wanted);

/// Each pair of vertices that bounds exactly one triangle, in the direction of that triangle, as pairs of indices.
/// Vertices at the same place count as one.
struct BorderEdge {
  std::uint32_t from = 0, to = 0;
};
[[nodiscard]] std::vector<BorderEdge> border(const Patch& patch);

/// Walls that follow the border of `rim` and reach from it to the same border displaced by `offset`. The walls face
/// the inside of the hole. Borders in the symmetry plane get no wall.
[[nodiscard]] Patch hole_walls(const Patch& rim, const std::function<Vec3(const Vec3&)>& offset);
[[nodiscard]] Patch displaced(Patch patch, const std::function<Vec3(const Vec3&)>& offset);
[[nodiscard]] Patch reversed(Patch patch);
[[nodiscard]] Patch mirrored_y(Patch patch);
[[nodiscard]] Patch transformed(Patch patch, const std::function<Vec3(const Vec3&)>& place);  ///< keeps normals
[[nodiscard]] Patch rotated_about_y(Patch patch, double angle_deg);

/// Computes smooth normals from the triangles; an edge bent by more than `crease_deg` stays sharp. Vertices at the same
/// place are treated as one.
[[nodiscard]] Patch with_normals(const Patch& patch, double crease_deg);

/// A grid of rows x columns points; `at(row, column)`; rows x columns counter-clockwise seen from outside when rows
/// run right and columns up. Normals are left for `with_normals`.
[[nodiscard]] Patch grid(int rows, int columns, const std::function<Vec3(int, int)>& at);

/// Turns a profile (x = radius, y = along the axis) about the y axis. Profiles that run from inner to outer radius
/// face towards +y.
[[nodiscard]] Patch revolve(const std::vector<Vec2>& profile, int segments);

/// A box with all edges rounded, centred at `centre`.
[[nodiscard]] Patch rounded_box(const Vec3& centre, const Vec3& half_size, double radius_mm);

/// Cuts a patch into parts that 16-bit indices can address and appends them. Triangles without area are dropped.
void add_parts(std::vector<MeshPart>& parts, const Patch& patch, const std::string& name, SurfaceKind kind);

}  // namespace lackwerk::packs::car
