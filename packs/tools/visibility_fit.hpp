// What a vertex sees, boiled down to nine bytes.
//
// Why it exists: core ES 2.0 has room for a few numbers per vertex, not for a map of the directions its surroundings
// block. The fit is a quadratic in the direction (packs/scene.hpp: Visibility), least squares over one fixed set of
// directions around the normal, in the normal's own frame, where its matrix is the same for every vertex; the result is
// turned into the scene's axes. Pure functions over values; a VisibilityFit is read-only after it was made: any thread.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "packs/scene.hpp"

namespace lackwerk::packs {

/// Axes around a unit normal, orthonormal and right-handed. Continuous in the normal but at (0, 0, -1), which only
/// faces the floor.
struct NormalFrame {
  glm::dvec3 tangent, bitangent, normal;
};
[[nodiscard]] NormalFrame frame_around(const glm::dvec3& normal);

/// The nine numbers a Visibility stands for, in its order.
[[nodiscard]] std::array<double, 9> visibility_coefficients(const Visibility& visibility);

/// The nearest Visibility to nine numbers; each is clamped to [-2, 127/64].
[[nodiscard]] Visibility quantised_visibility(const std::array<double, 9>& coefficients);

class VisibilityFit {
 public:
  struct Ray {
    glm::dvec3 direction;  ///< unit, in the normal's frame, z > 0
    double share;          ///< of a cosine-weighted mean over the hemisphere; the shares sum to one
  };

  /// `rays` in [1, 65536]; less than 64 are a sketch. Directions are spread evenly with a density of cosine +
  /// grazing_share.
  explicit VisibilityFit(int rays);

  [[nodiscard]] const std::vector<Ray>& rays() const { return rays_; }

  /// `seen`: how open each ray's direction is, [0, 1]. All ones give open_visibility exactly. What the clamp to [0, 1]
  /// mends by itself is not counted as an error: directions where the fit overshoots in the right direction are taken
  /// as met, and the fit is repeated.
  [[nodiscard]] Visibility fit(std::span<const float> seen, const NormalFrame& frame) const;

 private:
  std::vector<Ray> rays_;
  std::vector<std::array<float, 9>> basis_;   ///< per ray, mean square 1 over the sphere
  std::vector<std::array<float, 9>> solver_;  ///< per ray: what its value adds to each coefficient
};

}  // namespace lackwerk::packs
