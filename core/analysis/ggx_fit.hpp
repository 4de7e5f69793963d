// One GGX lobe that stands for all lobes of a paint, with its energy kept: what game engines can draw.
//
// Why it exists: engines know one lobe per surface, GGX (Walter et al. 2007), and no clear coat that bends directions.
// Kneiphof et al. 2018, 3.2, fit it at normal view (n = o), where engines filter their environments. There everything
// is a function of one angle, so integrals are sums along a line: no samples, no noise. (Their eq. 12 with N samples
// of f is not stable below m = tan(asin(1 / eta) / 2) / sqrt(ln N), 0.13 for an index of 1.5 and 10,000 samples: f has
// not the tails of GGX. That is the paper's "not stable for very small roughness"; ggx_fit_test.cpp shows it. What is
// left is least_engine_alpha.) core/directional_albedo.hpp merges Beckmann lobes per viewing angle for our own renderer
// and shares no formula with this. Pure functions; any thread.
//
// Reflectances are radiance factors (pi f), directions and names those of paint_model.glsl.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>

#include "core/paint.hpp"

namespace lackwerk::core {

/// Mean flakes, the radiance factor at (theta_h, theta_i), radians inside the coat. Empty: none.
using MeanFlakes = std::function<glm::dvec3(double theta_h, double theta_i)>;

/// pi D V of a GGX lobe with unit reflectance: the radiance factor before Fresnel. alpha in (0, 1], cosines in (0, 1].
/// D = alpha^2 / (pi nh^4 (alpha^2 + tan_h^2)^2); V = G / (4 iz oz) with the height-correlated masking of Smith (Heitz
/// 2014, eq. 99), as Unity, three.js and the glTF sample viewer have it. At normal view it is the separable form too.
[[nodiscard]] double ggx_factor(double alpha, double tan_h, double nh, double iz, double oz);

/// An engine computes in 32 bits and finds D from n.h, which near 1 has steps of 2^-24: 1 - (n.h)^2 is known to about
/// 2^-23, and alpha^2 stands beside it. Measured over 200,000 random frames the root mean square error of D is 1.3e-7 /
/// alpha^2 (12 % at 0.001, 0.8 % at 0.004): above one per cent below this. Engines' own limits lie just beside it:
/// Unity 0.002, Filament 0.0020, three.js 0.0028.
inline constexpr double least_engine_alpha = 3.6e-3;

/// Nodes over the logarithm of tan(theta_h), 14 wide: 0.01 apart, where the narrowest feature (exp(-t^2/m^2)) is 1
/// wide. What fewer would do: knob "ggx_samples" of `lackwerk report`.
inline constexpr int ggx_nodes = 1536;

/// Whether roughness and scale mean anything.
enum class GgxOutcome {
  fitted,
  no_lobe,     ///< nothing specular: scale 0, alpha 1
  too_narrow,  ///< the best alpha lies below least_engine_alpha; alpha is that limit, the energy is kept
  too_wide,    ///< the best alpha is 1 or would lie beyond; alpha is 1, the energy is kept
};
[[nodiscard]] const char* outcome_name(GgxOutcome outcome);  ///< "fitted", "no lobe", "too narrow", "too wide"

struct GgxFit {
  GgxOutcome outcome = GgxOutcome::no_lobe;
  double alpha = 1.0;        ///< [least_engine_alpha, 1]; glTF's and Unity's roughness is its root
  glm::dvec3 lobes{0.0};     ///< scale of the GGX lobe that carries the lobes' energy, per channel, >= 0
  glm::dvec3 flakes{0.0};    ///< the same of the mean flakes
  glm::dvec3 energy{0.0};    ///< reflectance of lobes and flakes at normal view, through the coat: what was kept
  double error = 0.0;        ///< root of KN's eq. 10 over the same of f alone (f-hat = 0): 0 is a perfect fit
  double least_alpha = 0.0;  ///< where the error alone is least, not limited below: what `too_narrow` is judged by
  [[nodiscard]] glm::dvec3 scale() const { return lobes + flakes; }
};

/// Fits by Kneiphof et al. 2018, eq. 10 (weights p ~ f, both with the cosine), on the luminance of the channels; the
/// scale s = integral of f over integral of f-hat (eq. 11 is printed upside down) per channel. Without chi: that is
/// filtered apart (their 3.3). Any paint inside the limits of AnalyticPaint.
/// How the engine's coat weakens its lobe: `clearcoat` empty, (1 - F(i)) (1 - F(o)) of the paint's own coat (their eq.
/// 9); a factor, 1 - clearcoat_fresnel(o, factor), on the way out alone, as KHR_materials_clearcoat does.
/// `nodes`, at least 2: directions of light along the line, see ggx_nodes.
[[nodiscard]] GgxFit fit_ggx(const AnalyticPaint& paint, const MeanFlakes& flakes = {},
                             std::optional<double> clearcoat = {}, int nodes = ggx_nodes);

/// A narrow Beckmann lobe of roughness m below an index eta is best met by alpha = narrow_lobe_ratio eta m (without
/// scale the problem has one solution; m eta below 0.02 is narrow to 1e-3).
inline constexpr double narrow_lobe_ratio = 0.9321;
/// The Beckmann roughness of a single lobe below which the fit is `too_narrow`.
[[nodiscard]] constexpr double least_stable_roughness(double refraction_ior) {
  return least_engine_alpha / (narrow_lobe_ratio * refraction_ior);
}

/// Schlick's coat of KHR_materials_clearcoat, whose index is always 1.5, that mirrors at normal incidence as `ior` does
/// (the extension's factor, at most 1: an index above 1.5 cannot be shown).
[[nodiscard]] double clearcoat_factor(double ior);
/// What that coat mirrors at this cosine.
[[nodiscard]] double clearcoat_fresnel(double cosine, double factor);

}  // namespace lackwerk::core
