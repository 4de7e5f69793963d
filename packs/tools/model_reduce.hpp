// A model with no more triangles than a kiosk can use.
//
// Why it exists: models from a design office have millions of triangles, more than a screen has pixels. They are
// thinned once their normals are made, from all of their triangles: vertices are only left out, never moved, so what is
// left mirrors as the whole did. Made with meshoptimizer. Free function; deterministic; one thread.
#pragma once

#include <cstddef>
#include <vector>

#include "packs/scene.hpp"

namespace lackwerk::packs {

struct ModelReduction {
  std::size_t before = 0, after = 0;  ///< triangles; equal where nothing was done
  double error_mm = 0.0;              ///< estimated largest distance between the surfaces
};

/// Thins every part by the same share until about `most_triangles` are left; nothing happens where there are no more.
/// Borders stay whole where that is possible, so that neighbours still meet. A part whose normals differ on every face
/// cannot be thinned under them: it gets new ones, with edges sharper than `crease_deg` kept. `after` may miss the aim
/// where faces do not hang together. Parts with positions, normals and indices alone.
[[nodiscard]] ModelReduction reduce_parts(std::vector<MeshPart>& parts, std::size_t most_triangles, double crease_deg);

}  // namespace lackwerk::packs
