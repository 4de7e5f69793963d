// Which parts of a material lights cut from an environment can show, and which must be looked up in it.
//
// Why it exists: a cut into l lights shows a lobe that is sharper than the gaps between them as black with dots. What
// lights give and what the prefiltered environment gives of one part add up to 1, so that no energy is counted twice or
// lost. Pure functions; any thread.
#pragma once

#include <array>
#include <span>

#include "core/directional_albedo.hpp"
#include "core/environment.hpp"
#include "core/paint.hpp"

namespace lackwerk::gles {

/// Share in [0, 1] that the lights give of each part, in the order of core::PaintTerm; the environment gives the rest.
using LightShares = std::array<float, core::paint_term_count>;

/// How many even parts of the sphere the lights are worth: (sum of A)^2 / (sum of A^2) over the areas A of the
/// directions nearest to each. In [1, count]. A median cut puts most lights where it is bright; what lies between the
/// few others is what a lobe must bridge.
[[nodiscard]] double effective_parts(std::span<const core::EnvironmentLight> lights);

/// Of one lobe. A lobe of Beckmann roughness m mirrors directions with a density that peaks at 1 / (4 pi m^2): it
/// covers 4 pi m^2 steradians, its standard deviation is sqrt(2) m along either axis. Seen by it, lights on a lattice
/// with 4 pi / parts each (a gap of g = sqrt(4 pi / parts)) ripple by 4 exp(-2 pi^2 2 m^2 / g^2) = 4 exp(-pi m^2 parts)
/// of their mean: 17 % where the lobe covers one part, 0.7 % where it covers two. The border lies at share_border
/// parts, m = sqrt(share_border / parts); within half an octave of m to either side lights and environment are mixed,
/// so that a morph shows no step. `m` outside the coat, > 0; `parts` as effective_parts gives them.
[[nodiscard]] float light_share(double m, double parts);
inline constexpr double share_border = 2.0;

/// Of a material. `flake_m`: core::flake_roughness, 1 without flakes. The diffuse part
/// is a lobe that peaks at 1 / pi: as wide as one of m = 1/2.
[[nodiscard]] LightShares light_shares(const core::AnalyticPaint& paint, double flake_m, double parts);

}  // namespace lackwerk::gles
