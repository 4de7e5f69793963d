#include "kiosk/tools/report/flake_memory.hpp"

#include <algorithm>

#include "core/paint_textures.hpp"
#include "core/rank_table.hpp"

namespace lackwerk::report {

namespace {

std::uint64_t whole(int count) { return static_cast<std::uint64_t>(std::max(count, 0)); }

constexpr std::uint64_t random_texels = std::uint64_t{core::random_edge} * core::random_edge;

}  // namespace

std::uint64_t flake_texture_bytes(const FlakeTextureSize& size) {
  constexpr std::uint64_t rgba = 4;
  constexpr std::uint64_t bytes_a_random_texel = 2;
  const std::uint64_t rows = whole(size.levels - 1) * whole(size.slices);
  const std::uint64_t row =
      sizeof(core::RankStep) * core::rank_table_steps + sizeof(core::QuantisedCuboid) * whole(size.width);
  const std::uint64_t grids = 2 * rgba * core::angle_grid * core::angle_grid;
  const std::uint64_t random = rows > 0 ? bytes_a_random_texel * random_texels : 0;
  return rows * row + random + grids + rgba * whole(size.table_size) * whole(size.table_size);
}

std::uint64_t papers_texture_bytes(int slices, int levels, int clusters, int steps) {
  constexpr std::uint64_t corner_bytes = std::uint64_t{2} * 3 * sizeof(std::uint16_t);
  const std::uint64_t row = whole(steps) + whole(clusters) * corner_bytes;
  return whole(levels) * whole(slices) * row + random_texels;
}

}  // namespace lackwerk::report
