// Cuts a surface mesh along curves, so that the borders between materials are smooth lines instead of staircases.
//
// Why it exists: triangles never straddle a border afterwards, hence a material is simply a set of triangles. A
// vertex close to a curve is moved onto it (along the surface), others get a new vertex where an edge crosses; a
// vertex once on a curve stays there. Holds references, is meant to live for one build; one thread.
#pragma once

#include <functional>

#include "packs/tools/car/surface_mesh.hpp"

namespace lackwerk::packs::car {

/// A border: the zero of `distance`, in force only where `active` holds.
struct Cut {
  std::function<double(const Vec3&)> distance;
  std::function<bool(const Vec3&)> active;
};

class MeshCutter {
 public:
  MeshCutter(SurfaceMesh& mesh, const Field& field) : mesh_(mesh), field_(field), locked_(mesh.positions.size()) {}

  void cut(const Cut& cut);

 private:
  struct Crossing {
    std::uint32_t a = 0, b = 0;
    Vec3 at{};
    double along = 0.0;  ///< 0 at a, 1 at b
  };
  [[nodiscard]] std::vector<Crossing> find_crossings(const Cut& cut) const;
  [[nodiscard]] Crossing solve(const Cut& cut, std::uint32_t a, std::uint32_t b) const;
  void snap_close_vertices(const std::vector<Crossing>& crossings);
  [[nodiscard]] bool may_move(std::uint32_t vertex, const Vec3& to) const;

  SurfaceMesh& mesh_;
  const Field& field_;
  std::vector<bool> locked_;
  std::vector<double> value_;                             ///< of the current cut, per vertex
  std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< per vertex, for the current cut
};

}  // namespace lackwerk::packs::car
