// Colours of a paint at the angles where spectrophotometers measure, and how far two paints are apart there.
//
// Why it exists: measurements, fits and maps are judged by the numbers paint shops use. Pure functions over values; any
// thread.
//
// Angles: ASTM E2194 (metal flakes) asks for 15, 45 and 110 degrees from the mirror direction under light at 45
// degrees; six-angle instruments add -15, 25 and 75, with which they serve E2539 (interference pigments) too.
// Twelve-angle instruments have six more under light at 15 degrees, with -15 and 15 from E2539 among them.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lackwerk::core {

/// One geometry in the plane of incidence.
struct MeasuringAngle {
  double light_deg = 45.0;      ///< from the normal, [0, 90)
  double aspecular_deg = 15.0;  ///< from the mirror direction towards the light; negative: beyond the mirror direction
  bool operator==(const MeasuringAngle&) const = default;
};

/// The twelve standard angles: 15as45 25as45 45as45 75as45 110as45 -15as45, then -45as15 -30as15 -15as15 15as15 45as15
/// 80as15. The first six are those of six-angle instruments.
[[nodiscard]] std::span<const MeasuringAngle> standard_angles();

/// "15as45": 15 degrees from the mirror direction, lit at 45 degrees.
[[nodiscard]] std::string angle_name(const MeasuringAngle& angle);

/// A BRDF without its cosine, 1/sr, linear sRGB, that may not know all directions.
using PartialBrdf = std::function<std::optional<glm::dvec3>(const glm::dvec3& in, const glm::dvec3& out)>;

/// CIE Lab (D65, 2 degrees) of the radiance factor pi f; nothing where the BRDF does not know, or the eye would be
/// below the horizon.
[[nodiscard]] std::optional<glm::dvec3> colour_at(const PartialBrdf& brdf, const MeasuringAngle& angle);

/// A colour and where it was seen.
struct AngleColour {
  MeasuringAngle angle;
  glm::dvec3 lab{0.0};  ///< CIE Lab, D65, 2 degrees, of the radiance factor
};

struct AngleDifference {
  MeasuringAngle angle;
  glm::dvec3 lab_a{0.0}, lab_b{0.0};
  double ciede2000 = 0.0;
};
struct AngleComparison {
  std::vector<AngleDifference> angles;  ///< in the order of the first list
  double mean = 0.0;                    ///< of CIEDE2000; 0 without angles
  std::size_t worst = 0;                ///< index of the largest (the first of equals)
};

/// Compares what both lists have: angles within 0.05 degrees of each other are the same.
[[nodiscard]] AngleComparison compare_angles(std::span<const AngleColour> a, std::span<const AngleColour> b);

}  // namespace lackwerk::core
