// An isochromatic colour map as the renderer takes it, and the bytes that it becomes on the GPU.
//
// Why it exists: a paint may be known by a map over the plane of incidence (core/isochromatic.hpp) instead of a colour
// table chi(theta_h, theta_i). Packs hold none; whoever has one gives it to Renderer::set_paint beside the paint. The
// nodes are the caller's and only read while they are encoded; bytes are a value. Any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/isochromatic.hpp"

namespace lackwerk::gles {

/// Of a core::ColourMap with spacing half_angle: {map.width(), settings().index, settings().cure, map.nodes()}.
struct PaintMap {
  std::uint32_t edge = 0;  ///< nodes from the normal to 90 degrees, [2, 1024]; the map is edge x (2 edge - 1)
  double index = 1.5;      ///< of the coat, [1, 2.5]
  core::CriticalAngleCure cure = core::CriticalAngleCure::clip;
  /// Colour factors, linear sRGB, [0, 40000]; row by row, the half phi' = 0 first.
  std::span<const glm::vec3> nodes;
};

/// RGBA8, one texel a node: (rgb a scale)^2. A factor in A that all channels share, chosen for them, keeps digits from
/// the map's largest value down to a 30,000th of it.
struct MapTexture {
  int width = 0, height = 0;
  float scale = 1.0f;  ///< square root of the largest value, and some room above
  std::vector<std::uint8_t> rgba;
};

/// Error: a number out of the ranges above, or as many nodes as the edge does not have.
[[nodiscard]] Result<MapTexture> encode_map(const PaintMap& map);

/// What the shader knows of a map (u_map in mapped_paint.glsl).
struct MapUniforms {
  float index = 1.0f;          ///< that directions bend by: 1 for cure C
  float towards_gloss = 0.0f;  ///< which way cure B slides: 1 or -1; 0 where the place is clipped
};
[[nodiscard]] MapUniforms map_uniforms(const PaintMap& map);

}  // namespace lackwerk::gles
