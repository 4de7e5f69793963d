// A realised mix in a paint shop's numbers: its colour at the standard angles, and how lively its flakes are.
//
// Why it exists: customers compare a mix with measured paints, dealers speak of CIEDE2000 at 15, 45 and 110 degrees
// from the mirror direction (ASTM E2539, light at 45 degrees). Pure; any thread.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "core/interpolatable_paint.hpp"
#include "core/paint_textures.hpp"

namespace lackwerk::core {

/// Aspecular angles, degrees from the mirror direction towards the light, light at 45 degrees.
inline constexpr std::array<double, 3> shop_angles_deg{15.0, 45.0, 110.0};

/// CIE Lab (D65, 2 degrees) of the radiance factor pi f, lobes and mean flakes, under the coat, at shop_angles_deg.
[[nodiscard]] std::array<glm::dvec3, 3> shop_colours(const InterpolatablePaint& paint, const Weights& weights);

/// The same of a paint that is realised already. `textures`: its mean_textures (level0_paint.hpp).
[[nodiscard]] std::array<glm::dvec3, 3> shop_colours(const InterpolatablePaint& paint, const AnalyticPaint& analytic,
                                                     const PaintTextures& textures);

/// CIEDE2000 between two of these, angle by angle.
[[nodiscard]] std::array<double, 3> shop_differences(const std::array<glm::dvec3, 3>& a,
                                                     const std::array<glm::dvec3, 3>& b);

/// Spread of the flakes' lightness in a mix: the standard deviation of L over all flakes of the slice nearest to the
/// mirror direction, level 0; Lab units, 0 without flakes.
[[nodiscard]] double liveliness(const InterpolatablePaint& paint, const Weights& weights);

}  // namespace lackwerk::core
