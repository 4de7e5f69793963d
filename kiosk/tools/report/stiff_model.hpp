// Stiff cases of the paint model: narrow lobes, grazing angles, extreme indices, in long double, double, float and
// emulated 16 bits, over the eight published paints and paints made to hurt.
//
// Why it exists: the model's text runs where 16 bits are all there is, and a highlight that turns black at grazing view
// is seen by everybody. Free functions; any thread.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/paint.hpp"
#include "kiosk/tools/report/findings.hpp"

namespace lackwerk::report {

/// A light and a viewing direction over the normal (0, 0, 1), exact in 16 bits, so that every precision gets the same.
struct DirectionPair {
  glm::dvec3 light, eye;
  std::string where;  ///< "light 60, half vector 0.5 at 90 degrees"
};

/// Pairs around the mirror direction, where lobes are steep: lights from the normal to `limit_deg`, half vectors tilted
/// by 0 to 40 degrees to all sides. Both directions stay within `limit_deg` of the normal.
[[nodiscard]] std::vector<DirectionPair> direction_pairs(double limit_deg, bool quick);

/// The eight paints of Guenther et al. (2005), Table 1, as printed and under a real coat. Error: a recipe is missing.
[[nodiscard]] Result<std::vector<std::pair<std::string, core::AnalyticPaint>>> published_paints();

enum class ModelPrecision { long_double, double_float, single_float, half };
/// The model's radiance factor of one paint at one pair.
[[nodiscard]] glm::dvec3 model_factor(const core::AnalyticPaint& paint, const DirectionPair& at,
                                      ModelPrecision precision);

/// The same by the formulas of Guenther et al. 2005 eq. 1 and Kneiphof et al. 2018 eq. 6 written plainly, in long
/// double.
[[nodiscard]] glm::dvec3 plain_factor(const core::AnalyticPaint& paint, const DirectionPair& at);

/// CIEDE2000 between two radiance factors as a display shows them under a light that shows white as white: times the
/// cosine of incidence, each channel ends at 1.
[[nodiscard]] double shown_difference(const glm::dvec3& one, const glm::dvec3& two, double cosine);

void add_stiff_model(bool quick, Findings& findings);

}  // namespace lackwerk::report
