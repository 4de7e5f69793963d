// The textures of one realised paint, as bytes: what the renderer uploads and what the CPU model reads.
//
// Why it exists: both sides must see the same quantised numbers, or their pictures could only agree by luck. Owns its
// byte arrays; made once per pack, updated per realisation. One writer at a time, any number of readers in between.
//
// All but the last are RGBA8 (core ES 2.0 has nothing wider). Sizes:
//   chi      table_size x table_size   sqrt(chi / chi_max) per channel, filtered linearly by the sampler, then squared
//   mean     grid x grid               RGBE of the flakes' mean radiance factor at node (h, i); grid = 16
//   slice    grid x grid               R = slice number, G = 255 where there is no slice
//   rank     256 x rows                RankStep (rank_table.hpp)
//   corner   3 width x rows            QuantisedCuboid: three texels a tuple, low byte first
//   random   512 x 512                 LUMINANCE_ALPHA, two bytes: a Gaussian value g, low byte first:
//                                      (g / 9.5 + 0.5) * 65535
// Of ranks and corners the GPU gets asked_rows rows.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "core/rank_table.hpp"
#include "core/realise.hpp"

namespace lackwerk::core {

inline constexpr int random_edge = 512;       ///< a power of two: core ES 2.0 repeats no others
inline constexpr double random_reach = 4.75;  ///< largest |g| the texture holds
inline constexpr int angle_grid = 16;         ///< nodes 0..12 of num_theta = 12, and a border without flakes

struct PaintTextures {
  int table_size = 0;      ///< 0: no table
  float chi_scale = 1.0f;  ///< chi_max
  std::vector<std::uint8_t> chi;
  std::vector<std::uint8_t> mean;
  std::vector<std::uint8_t> slice;
  int row_count = 0;   ///< 0: no flakes
  int asked_rows = 0;  ///< the first ones, which shaders fetch: the last level is one texel, which `mean` knows
  std::vector<RankStep> rank;
  int width = 0;  ///< tuples per row
  std::vector<QuantisedCuboid> corner;
  std::vector<std::uint8_t> random;

  [[nodiscard]] glm::dvec3 sample_chi(double u, double v) const;
  [[nodiscard]] glm::dvec3 mean_at(int bin_h, int bin_i) const;
  [[nodiscard]] const std::uint8_t* slice_texel(int bin_h, int bin_i) const;
  [[nodiscard]] const std::uint8_t* rank_texel(int step, int row) const;
  [[nodiscard]] const std::uint8_t* corner_texel(int x, int row) const;
  [[nodiscard]] const std::uint8_t* random_texel(std::int64_t x, std::int64_t y) const;
};

/// What a paint without table and flakes reads: chi = 1, mean 0, no slices.
[[nodiscard]] const PaintTextures& no_textures();

/// The parts that depend on the pack alone: slice map, rank table, random numbers (from the pack's seed: the quantiles
/// of a Gaussian at (k + 1/2) / 512^2, each once, shuffled).
[[nodiscard]] PaintTextures make_static_textures(const InterpolatablePaint& paint);

/// The parts that depend on the weights: chi, mean, corners (swapped in, not copied).
void update_textures(const InterpolatablePaint& paint, RealisedPaint& realised, PaintTextures& textures);

/// Sets a PaintModel's uniforms and textures. `textures` must outlive `model`.
template <class Model>
void bind_model(const InterpolatablePaint& paint, const AnalyticPaint& analytic, const PaintTextures& textures,
                Model& model) {
  using T = typename Model::real;
  using V3 = typename Model::vec3;
  using V4 = typename Model::vec4;
  model.u_diffuse = V3(T(analytic.diffuse.x), T(analytic.diffuse.y), T(analytic.diffuse.z));
  for (std::size_t k = 0; k < max_lobes; ++k) {
    const Lobe& lobe = analytic.lobes[k];
    model.u_lobe[k] = V4(T(lobe.s.x), T(lobe.s.y), T(lobe.s.z), T(lobe.f0));
  }
  model.u_inv_m = V3(T(1.0 / analytic.lobes[0].m), T(1.0 / analytic.lobes[1].m), T(1.0 / analytic.lobes[2].m));
  model.u_coat_ior = T(analytic.coat_ior);
  model.u_refraction_ior = T(analytic.refraction_ior);
  model.u_table_size = T(textures.table_size > 0 ? textures.table_size : 1);
  model.u_slice_count = T(paint.layout.slice_count());
  model.u_level_count = T(paint.level_count);
  model.u_bins_per_rad = T(paint.layout.num_theta > 0 ? 1.0 / paint.layout.bin_width_rad() : 1.0);
  const auto cells = paint.flake_cells_per_bin();
  model.u_flake_cells = typename Model::vec2(T(cells[0]), T(cells[1]));
  const glm::vec3 span = paint.range.hi - paint.range.lo;
  model.u_lab_lo = V3(T(paint.range.lo.x), T(paint.range.lo.y), T(paint.range.lo.z));
  model.u_lab_span = V3(T(span.x), T(span.y), T(span.z));
  model.textures = &textures;
}

}  // namespace lackwerk::core
