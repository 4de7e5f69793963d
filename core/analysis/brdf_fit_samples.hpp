// What a fit of a BRDF is given: single values of reflectance, whatever instrument they came from.
//
// Why it exists: whole tables (a million cells) and spectrophotometers (six angles) go through one fit. Here values
// become points with everything about their geometry that no parameter changes, in the measure the fit minimises.
// Values; any thread.
//
// The measure: y = pi f sqrt(i_z o_z), the radiance factor times the geometric mean of the cosines (f times one cosine,
// as light falls on a surface, but the same for both ways round), and errors are ln(dark + y) - ln(dark + measured).
// Guenther et al. 2005, eq. 2, take |ln(C / D)|, which has no value for zeros and lets black noise weigh like the peak;
// `dark` bounds that: what cannot be seen, plus a fiftieth of the value's largest channel. The latter because a channel
// far below the others is not seen beside them, and because real colours outside sRGB come with channels cut to 0.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/brdf_table.hpp"

namespace lackwerk::core {

/// One measured value. Directions are unit vectors, z = normal, both with z > 0.
struct BrdfSample {
  glm::dvec3 in{0.0, 0.0, 1.0}, out{0.0, 0.0, 1.0};
  glm::dvec3 rgb{0.0};    ///< f without cosine, 1/sr, linear sRGB, D65; each finite and >= 0
  double weight = 1.0;    ///< >= 0; 0: does not count
  glm::dvec3 known{0.0};  ///< part of f that is not to be fitted and is added to the model (mean flakes), 1/sr
};

/// Radiance factor below which nothing is seen: a tenth of a unit of L* (L* = 903.3 Y near black, CIE 15:2004).
inline constexpr double fit_dark = 0.1 / 903.3;
/// Part of a value's largest channel below which its other channels do not count. sRGB's own matrix sends 2 % of red
/// into Z: less changes no hue.
inline constexpr double fit_dark_part = 0.02;

/// Directions more than 87 degrees from the normal do not count: there, one degree of misalignment halves a cosine.
inline constexpr double fit_min_cosine = 0.0523359562429;

/// Where in the hemispheres a value lies. Grazing comes before the others.
enum class FitRegion : std::uint8_t {
  peak,           ///< half vector within 3 degrees: four times a clear coat's m (0.013 = 0.75 degrees)
  near_specular,  ///< within 20 degrees: where metallic paints flop
  diffuse,        ///< beyond
  grazing         ///< light or eye more than 75 degrees from the normal
};
inline constexpr int fit_region_count = 4;
[[nodiscard]] const char* fit_region_name(FitRegion region);

/// A sample as the fit uses it.
struct FitPoint {
  double tan_h = 0.0, nh = 1.0, ho = 1.0, iz = 1.0, oz = 1.0;  ///< as Geometry of paint_model.glsl
  double theta_h = 0.0, theta_d = 0.0;                         ///< radians; theta_d as it stands in chi: clamped
  double schlick = 0.0;                                        ///< (1 - h.o)^5
  double scale = 1.0;                                          ///< sqrt(i_z o_z)
  glm::dvec3 target{0.0};                                      ///< y
  glm::dvec3 known{0.0};                                       ///< its known part
  double dark = fit_dark;                                      ///< of this target
  glm::dvec3 chi{1.0};                                         ///< colour that stands before diffuse part and lobes
  double weight = 1.0;
  FitRegion region = FitRegion::diffuse;
};

/// The geometry alone; the rest is left at its defaults. Both directions above the horizon.
[[nodiscard]] FitPoint fit_point(const glm::dvec3& in, const glm::dvec3& out);
/// The same with target, known part (both f, 1/sr) and `dark`.
[[nodiscard]] FitPoint fit_point(const BrdfSample& sample);

struct FitPoints {
  std::vector<FitPoint> points;
  std::size_t masked = 0;  ///< samples that cannot count: not finite, negative, below fit_min_cosine, weight 0
};
[[nodiscard]] FitPoints fit_points(std::span<const BrdfSample> samples);

/// About `count` cells of a table, the same number from each row of theta_h (the rows are fine at the peak, so the peak
/// gets its share), spread over theta_d and phi_d by a Kronecker sequence (Roberts 2018, "The unreasonable
/// effectiveness of quasirandom sequences"). Holes, cells below fit_min_cosine and those marked in `filled` (guesses;
/// empty: none) are passed over. Deterministic.
[[nodiscard]] std::vector<BrdfSample> table_samples(const BrdfTable& table, std::uint32_t count,
                                                    const std::vector<std::uint8_t>& filled = {});

}  // namespace lackwerk::core
