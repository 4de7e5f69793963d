// The virtual goniometer: a recipe is painted as explicit mirror flakes and photographed at every slice's angles.
//
// Why it exists: no measured flake BTF may be shipped, so the demo's flakes are simulated, and say so. The capture it
// makes is the same kind of thing a real instrument gives: lobes and one HDR picture of the same flakes per angle pair.
// Pure functions over values; `measure` uses threads that end with the call and gives the same bytes for any number.
//
// Physics (derivation in docs/capture.md). Flake normals are drawn by Guenther et al. 2005, 5.2, over the flakes'
// footprints, so their density per solid angle is D cos(theta) / pi. A source of radiance L fills a cone of half angle
// alpha around the light direction; a flake shines with R L where the eye's direction, mirrored at the flake, meets the
// cone. With coverage c, E = L pi sin^2(alpha) i_z and dw_i = 4 (h.o) dw_h the mean is
//     f = c R D G / (4 pi i_z o_z),   so   R = 4 share s F chi / coverage   gives exactly   share * (broad lobe).
// The 4 of the half-vector's Jacobian stays in R: the lobe keeps its printed pi.
// G is taken as partial occlusion: a flake's seen footprint is G (h.o) / (h_z o_z) times its footprint along n.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "packs/tools/capture.hpp"
#include "packs/tools/recipe.hpp"

namespace lackwerk::packs {

struct GoniometerSettings {
  std::uint32_t edge_texels = 480;  ///< per slice edge, [1, 4096]; the pictures repeat without a seam
  float texel_mm = 0.05f;           ///< [0.005, 1]
  std::uint64_t seed = 1;           ///< of the flakes' places
  int threads = 2;                  ///< [1, 64]; no effect on the result
  /// Half angle of the source seen from the paint. 6.5 degrees let a flake shine over 6.5 degrees of theta_h at
  /// theta_i = 0 (a half vector moves half as far as the mirrored direction): the 6 to 7 degrees that Rump et al. 2008
  /// measured.
  double source_radius_rad = 6.5 * std::numbers::pi / 180.0;
  /// Divides each slice by the chance excess of shining flakes in this finite sample (a few percent where hundreds
  /// shine), so that BRDF + mean meets the recipe at every slice. Off: the sample as drawn.
  bool even_out = true;
};

/// Called after each slice, one call at a time, from any of the threads.
using MeasureProgress = std::function<void(int done, int total)>;

/// Angles of one picture, radians, inside the coat; theta_h + theta_i < pi/2 or so: beyond, flakes are black.
struct PictureAngles {
  double theta_h = 0.0;
  double theta_i = 0.0;
};

/// Pictures of one sample of the recipe's flakes at any angles. Errors as for measure(), and a recipe without flakes.
[[nodiscard]] Result<std::vector<FlakeSlice>> photographs(const Recipe& recipe, const GoniometerSettings& settings,
                                                          std::span<const PictureAngles> angles);

/// Photographs a recipe. Without flakes the capture has lobes and table only. Errors: settings out of range, more than
/// 30 million flakes, a flake that would mirror more than it gets (R > 1 in a channel: names the coverage needed).
/// The lobes of the capture are lowered: BRDF + mean flakes is the recipe. The flakes' angular life is measured at fine
/// angle steps on a smaller sample (flake_life.hpp).
[[nodiscard]] Result<Capture> measure(const Recipe& recipe, const GoniometerSettings& settings = {},
                                      const MeasureProgress& progress = {});

}  // namespace lackwerk::packs
