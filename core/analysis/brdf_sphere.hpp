// Two BRDFs on a sphere under one fixed set of lights, and how different they look.
//
// Why it exists: a log error is no colour. A fit is judged as people will judge it: by CIEDE2000 over a picture. The
// sphere is seen from far away; its three lamps, discs of 4 degrees' radius, show what paints differ in: the peak and
// the flop around it at two angles of incidence, and grazing light from behind. Pure functions; any thread;
// deterministic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/analysis/brdf_table.hpp"

namespace lackwerk::core {

struct SphereLight {
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit, towards the light; the eye is at +z, y is up
  double irradiance = 0.0;              ///< on a surface that faces it, white
};
/// The fixed set: lamps 40, 60 and 115 degrees from the eye, of irradiance 0.6, 0.25 and 0.15 in all.
[[nodiscard]] std::vector<SphereLight> sphere_lights();

/// Linear sRGB, rows from the top; pixels beside the sphere are not in `mask` and black.
struct SpherePicture {
  int edge = 0;  ///< pixels, [2, 4096]; the sphere fills it
  std::vector<glm::vec3> pixels;
  std::vector<std::uint8_t> mask;
};
/// Radiance times pi: a white diffuser facing light of irradiance 1 shows 1.
[[nodiscard]] SpherePicture shade_brdf_sphere(const Brdf& brdf, int edge);

/// Shown as a display does: scaled so that one pixel of a hundred of `a` is beyond white, then clipped.
struct SphereComparison {
  SpherePicture a, b;      ///< scaled, not clipped
  std::vector<float> map;  ///< CIEDE2000 a pixel, -1 beside the sphere
  std::size_t pixels = 0;
  double mean = 0.0, p95 = 0.0, max = 0.0;  ///< of CIEDE2000; p95 is nearest-rank
};
[[nodiscard]] SphereComparison compare_on_sphere(const Brdf& a, const Brdf& b, int edge);

/// What `brdf` would have given the instrument that filled `table`: the same cells, the same holes. Compared through
/// the same interpolation, measured and fitted differ by the fit alone.
[[nodiscard]] BrdfTable measured_like(const BrdfTable& table, const Brdf& brdf);

/// A table as a BRDF; `instead` answers where the table has holes all round. Both must outlive what is returned.
[[nodiscard]] Brdf table_brdf(const BrdfTable& table, const Brdf& instead);

}  // namespace lackwerk::core
