// How many bytes a pack's flakes take on the GPU.
//
// Why it exists: the knobs "levels" and "memory" ask for sizes of textures that are not made. Pure; any thread.
#pragma once

#include <cstdint>

namespace lackwerk::report {

/// What decides the size of the flakes' textures.
struct FlakeTextureSize {
  int slices = 0;      ///< that the pack keeps
  int levels = 0;      ///< mip levels; the last one is its mean and has no rows
  int width = 0;       ///< tuples of the widest row
  int table_size = 0;  ///< nodes an edge of the colour table chi; 0: none
};

/// All textures of one pack in bytes: rank and corner rows of levels 0 to levels - 2, slice map, means, chi, and the
/// random numbers, 2 bytes a texel.
[[nodiscard]] std::uint64_t flake_texture_bytes(const FlakeTextureSize& size);

/// The same as Golla & Klein (2018), 3.2 lay it out: for every level a row of `steps` bytes and two corners of three
/// numbers for each of `clusters`, 16 bits each; and one number of 8 bits for each texel of a random texture of 512.
[[nodiscard]] std::uint64_t papers_texture_bytes(int slices, int levels, int clusters, int steps);

}  // namespace lackwerk::report
