// The flakes of one virtual paint sample: where they lie, how they tilt, how large they are.
//
// Why it exists: all slices of a capture photograph the same flakes, so that a flake persists from slice to slice as
// in a real sample. A value, read-only after making; any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "packs/tools/recipe.hpp"

namespace lackwerk::packs {

struct Flake {
  glm::vec3 normal;  ///< unit
  float x = 0.0f;    ///< centre, in texels, [0, edge)
  float y = 0.0f;
  float radius = 0.0f;  ///< of the footprint seen along the paint's normal, in texels
};

struct FlakePopulation {
  std::vector<Flake> flakes;  ///< sorted by rising tilt
  double roughness = 0.0;     ///< m of the lobe the tilts were drawn from
  double coverage = 0.0;      ///< footprints / area, as drawn

  /// Half-open index range of all flakes with a tilt in [lo, hi] radians, and perhaps some more.
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  [[nodiscard]] Range tilts_between(double lo, double hi) const;
};

/// How many flakes a recipe needs on `area_mm2`.
[[nodiscard]] double expected_flakes(const FlakeRecipe& recipe, double area_mm2);

/// Draws `count` flakes on a square of `edge` texels. Tilt, azimuth and size come from a three-dimensional
/// low-discrepancy sequence, so that every window of tilts holds its share of flakes and of area; places are random
/// (independent, uniform). Same arguments, same flakes.
[[nodiscard]] FlakePopulation draw_flakes(const FlakeRecipe& recipe, double roughness, std::size_t count,
                                          std::uint32_t edge, float texel_mm, std::uint64_t seed);

/// Density of flake normals per solid angle, over footprints: D(theta) cos(theta) / pi for Beckmann's D.
[[nodiscard]] double tilt_density(double roughness, double cos_tilt);

/// Area of the part of a disc around (0, 0) that lies left of x and below y.
[[nodiscard]] double disc_corner_area(double radius, double x, double y);

}  // namespace lackwerk::packs
