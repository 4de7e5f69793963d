// Fewer triangles for the same shape.
//
// Why it exists: a weak machine draws a moving picture of 60,000 triangles, not of 200,000, and imported models may
// have millions. Made with meshoptimizer: vertices are only left out, never moved, so their normals (and with them the
// mirror images at the vertices) stay as they were. Pure functions over values; deterministic; any thread.
#pragma once

#include <cstddef>

#include "packs/scene.hpp"

namespace lackwerk::packs {

struct CoarseLimits {
  std::size_t most_triangles = 0;  ///< stop here; 0 = go as far as the error allows
  float most_error_mm = 1.5f;      ///< of the surface
};

/// The part with fewer triangles, where the error allows it. Its outer borders stay whole, so that neighbours still
/// meet. Arrays that were baked go along with their vertices.
[[nodiscard]] MeshPart coarser(const MeshPart& part, const CoarseLimits& limits);

/// Draws `part` at full detail only and appends a coarser twin for the other level. A part that would lose less than a
/// quarter of its triangles, or has fewer than 1000, serves both levels instead.
void add_with_twin(std::vector<MeshPart>& parts, MeshPart part, const CoarseLimits& limits);

/// Triangles drawn at a level (one of the detail bits).
[[nodiscard]] std::size_t triangles_at(const Scene& scene, std::uint8_t level);

}  // namespace lackwerk::packs
