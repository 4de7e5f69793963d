// A pack's paints in the form that can be mixed: what the pack file holds, seen through spans.
//
// Why it exists: the kiosk maps the file and realises from it without copying (the spans may point into the mapping),
// the builder fills the same shape from vectors. It owns nothing but small tables; whoever made it keeps the memory
// alive. Read-only: any number of threads.
//
// Flakes: row = level * slice_count + slice. Each row holds tuples (one cluster per paint under one transported mass,
// Golla & Klein 2018, 4.1), sorted by L at equal weights, so that a random rank in [0, 1) means the same flake at all
// weights. Each paint keeps its own clusters once; tuples index them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/paint.hpp"
#include "core/slice_layout.hpp"

namespace lackwerk::core {

inline constexpr int max_paints = 5;
/// A row index has 8 bits in the rank table: 5 paints of 50 clusters give at most 5*50-4 = 246 tuples.
inline constexpr int max_tuples_per_row = 256;
inline constexpr int max_clusters_per_row = 250;

/// Lab corners on a 16-bit grid shared by all paints of a pack: value = lo + (hi - lo) * q / 65535, per axis.
struct LabRange {
  glm::vec3 lo{0.0f};
  glm::vec3 hi{1.0f};
};

/// A cuboid in Lab on that grid. Memory order is the renderer's texture order: [axis L,a,b][corner min,max].
struct QuantisedCuboid {
  std::array<std::uint16_t, 6> q{};  ///< L min, L max, a min, a max, b min, b max
  bool operator==(const QuantisedCuboid&) const = default;
};
static_assert(sizeof(QuantisedCuboid) == 12);

/// How a paint's random cell widths were found.
enum class LifeOrigin : std::uint8_t {
  assumed = 0,  ///< no measurement: a life of default_life_deg
  slices = 1,  ///< from the correlation of neighbouring slices, which only bounds it where lives are shorter than a bin
  fine = 2,    ///< from the capture's own measurement at fine angle steps
};

/// Rump et al. 2008 (quoted in Golla & Klein 2018): a flake shines over 6 to 7 degrees of theta_h. Used where nothing
/// better is known.
inline constexpr double default_life_deg = 6.5;
/// The cell for that life: what the three demo paints were fitted with, 4.6 to 5. A cell as wide as the life would keep
/// flakes half as long again.
inline constexpr float default_cell_deg = 4.75f;
/// A cell this wide stands for all angles: the texel keeps its flake.
inline constexpr float widest_cell_deg = 90.0f;

/// Angular life of a paint's flakes, as the shader's random cells give it; fitted by the builder. Angles are those
/// inside the coat.
struct FlakeLife {
  float cell_h_deg = default_cell_deg;  ///< width of a random cell along theta_h, [1, 90]; 90: one for all angles
  float cell_i_deg = widest_cell_deg;   ///< along theta_i
  LifeOrigin origin = LifeOrigin::assumed;
  bool operator==(const FlakeLife&) const = default;
};

struct InterpolatablePaint {
  struct PaintPart {
    PaintIdentity identity;
    AnalyticPaint analytic;
    std::span<const std::uint32_t> cluster_begin;  ///< rows + 1: first cluster of each row in `clusters`
    std::span<const QuantisedCuboid> clusters;     ///< all rows, all levels
    std::span<const std::uint8_t> tuple_cluster;   ///< per tuple: index within the row's clusters
    FlakeLife life;
  };

  std::vector<PaintPart> paints;               ///< 1 to max_paints
  SliceLayout layout;                          ///< empty where no paint of the pack has flakes
  std::uint16_t level_count = 0;               ///< mip levels; the last one is 1 x 1 texel
  float texel_mm = 0.0f;                       ///< edge of a level-0 texel on the paint
  std::uint32_t level0_texels = 0;             ///< texels per edge of a level-0 slice (480)
  LabRange range;                              ///< of all quantised corners, of pi * Xi under D65
  std::span<const std::uint32_t> tuple_begin;  ///< rows + 1: first tuple of each row
  std::span<const std::uint32_t> mass;         ///< per tuple; the masses of one row sum to row_mass
  std::uint32_t row_mass = 0;                  ///< the same for all rows, [1, 2^30]
  std::uint64_t random_seed = 0;               ///< of the random textures: nothing derivable is stored

  [[nodiscard]] int row_count() const { return level_count * layout.slice_count(); }
  /// Random cells per angle bin along theta_h and theta_i; 0: one cell for all angles. The mean over the paints whose
  /// life is measured (else over all), the same at all weights: cells that grew with a weight would exchange the
  /// flakes while a customer drags.
  [[nodiscard]] std::array<double, 2> flake_cells_per_bin() const;
};

/// One number per paint for each group; every group sums to 1. Beyond [0, 1] is extrapolation.
struct Weights {
  std::vector<double> base;             ///< diffuse, lobes, coat, colour table
  std::vector<double> flake_lightness;  ///< L of the flakes
  std::vector<double> flake_colour;     ///< a and b of the flakes
  /// How far a and b of the flakes are taken out, [0, 1]; 1: white flakes (Golla & Klein 2018, 4.4 and Figure 5).
  double flake_white = 0.0;
  /// The same weights in all three groups.
  [[nodiscard]] static Weights uniform(const std::vector<double>& w) { return {w, w, w, 0.0}; }
  bool operator==(const Weights&) const = default;
};

}  // namespace lackwerk::core
