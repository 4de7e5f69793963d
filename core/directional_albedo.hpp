// How much of an even environment each part of a paint shows, by viewing angle: the tables behind prefiltered light.
//
// Why it exists: a moving picture cannot integrate the environment at every pixel. It takes, for each part of the paint
// (diffuse, three lobes, mean flakes), the radiance of the environment filtered with that lobe's roughness, times this
// part's directional albedo at the viewing angle: Fresnel, masking, chi, the coat's losses and the bending of
// directions are all in the number (the split of Karis 2013, per lobe and per colour channel, for lobes below a coat as
// in Kneiphof et al. 2018). Pure functions over values; the output is the caller's and is reused; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "core/paint_textures.hpp"

namespace lackwerk::core {

/// Columns over the viewing cosine c: column k stands for sqrt(c) = (k + 0.5) / columns, because all the bending of
/// these curves is near grazing.
inline constexpr int albedo_columns = 32;
/// Parts of a paint, in the order of the rows.
enum class PaintTerm : std::uint8_t { diffuse = 0, lobe0 = 1, lobe1 = 2, lobe2 = 3, flakes = 4 };
inline constexpr int paint_term_count = 5;

struct AlbedoRow {
  /// Radiance shown under an environment of radiance 1, linear sRGB, >= 0.
  std::array<glm::vec3, albedo_columns> albedo{};
  /// Where the light that is shown comes from on average: along mix(n, r, lean), r the mirrored view direction. [0, 1]
  std::array<float, albedo_columns> lean{};
  /// How far that light is spread: the environment level whose directions have the same mean resultant length.
  std::array<float, albedo_columns> level{};
  std::array<float, albedo_columns> resultant{};  ///< that length, (0, 1]
  bool operator==(const AlbedoRow&) const = default;
};
/// What rows were made of.
struct AlbedoSource {
  struct Part {
    Lobe lobe;  ///< the diffuse part has s alone, the flakes m
    double coat_ior = 1.0, refraction_ior = 1.0;
    bool operator==(const Part&) const = default;
  };
  std::array<bool, paint_term_count> known{};
  std::array<std::optional<Part>, paint_term_count> parts;
  int table_size = 0;
  float chi_scale = 1.0f, bins_per_rad = 0.0f;
  std::vector<std::uint8_t> chi, mean;  ///< as in PaintTextures
  double flake_m = 1.0;                 ///< flake_roughness
};

struct AlbedoTable {
  std::array<AlbedoRow, paint_term_count> rows{};
  AlbedoSource source;  ///< so that only those rows are made again whose part of the paint has changed
  [[nodiscard]] AlbedoRow& operator[](std::size_t term) { return rows[term]; }
  [[nodiscard]] const AlbedoRow& operator[](std::size_t term) const { return rows[term]; }
};

/// Integrates all parts by a fixed rank-1 lattice of directions drawn from each lobe: about a millisecond, and a
/// seventh of it where the flakes' weights alone have changed since `out` was made.
/// `paint` and `textures` describe the flakes (may be without any).
void directional_albedo(const InterpolatablePaint& paint, const AnalyticPaint& analytic, const PaintTextures& textures,
                        AlbedoTable& out);
/// The same for a material without table and flakes.
void directional_albedo(const AnalyticPaint& analytic, AlbedoTable& out);

/// All lobes and the flakes as one: albedos summed, so that no energy is lost, directions and spreads weighted by them.
/// The one fitted lobe of Kneiphof et al. 2018, but for each viewing angle anew; its error is the price of one look-up.
[[nodiscard]] AlbedoRow merged_lobes(const AlbedoTable& table);

/// Beckmann roughness that spreads directions as the mean flakes do: m^2 = E[tan^2 theta_h] weighted by
/// mu(theta_h, 0) cos(theta_h) sin(theta_h). 1 without flakes.
[[nodiscard]] double flake_roughness(const InterpolatablePaint& paint, const PaintTextures& textures);

}  // namespace lackwerk::core
