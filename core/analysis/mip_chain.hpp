// Mip levels of a flake slice.
//
// Why it exists: from a distance a pixel sees many flakes; each level gets its own statistics (Golla 2021, 2.4.1). The
// average is over area and in linear RGB, exact for odd edges too, so that every level has the same mean. Pure; any
// thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace lackwerk::core {

struct MipLevel {
  std::uint32_t edge = 0;
  std::vector<glm::vec3> texels;  ///< row-major, edge * edge
};

/// Number of levels of a square of `edge` texels: edges halve, rounded down, to 1 (480 has 9: 480 240 120 60 30 15 7
/// 3 1). 0 for 0.
[[nodiscard]] int mip_level_count(std::uint32_t edge);

/// All levels, `level0` (linear RGB, row-major, edge * edge texels, edge >= 1; anything else aborts) moved into the
/// first. Each texel is the mean over its area of the level before, with exact weights at fractional borders.
[[nodiscard]] std::vector<MipLevel> mip_chain(std::vector<glm::vec3> level0, std::uint32_t edge);

}  // namespace lackwerk::core
