// Directions drawn in proportion to a Beckmann lobe or a cosine, each with its density.
//
// Why it exists: the integrator divides by these densities, so each stands beside its sampler and is tested against it
// by itself. Directions are unit vectors away from the surface; densities are per steradian. Pure functions; any
// thread.
//
// A lobe lives inside the clear coat. Half vectors are drawn as Guenther et al. 2005, 5.2 say: theta =
// atan(m sqrt(-ln(1 - u))), whose density is exactly D cos(theta) / pi with their D = exp(-tan^2/m^2) / (m^2 cos^4).
// The mirrored direction has 1 / (4 h.o) of that, and leaving the coat spreads it: with sin_out = eta sin_in a solid
// angle grows by d omega_out / d omega_in = eta^2 cos_in / cos_out.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace lackwerk::core {

/// Two unit vectors that complete n to a right-handed frame (Duff et al. 2017).
struct ReferenceFrame {
  glm::dvec3 x, y, z;
  explicit ReferenceFrame(const glm::dvec3& n);
  [[nodiscard]] glm::dvec3 to_world(const glm::dvec3& v) const { return x * v.x + y * v.y + z * v.z; }
};

/// D cos / pi at a half vector with cosine `cos_h` (0 for <= 0) and Beckmann roughness m > 0.
[[nodiscard]] double half_vector_pdf(double cos_h, double m);

/// A half vector around +z. u in [0, 1)^2.
[[nodiscard]] glm::dvec3 sample_half_vector(const glm::dvec2& u, double m);

/// The direction inside a coat of index eta >= 1.
[[nodiscard]] glm::dvec3 refracted_in(const glm::dvec3& d, const glm::dvec3& n, double eta);
/// The direction outside; nothing where the coat reflects totally.
[[nodiscard]] std::optional<glm::dvec3> refracted_out(const glm::dvec3& d, const glm::dvec3& n, double eta);

/// A lobe of roughness m as seen from o (outside): everything that does not depend on the direction drawn.
class LobeSampler {
 public:
  /// n.o > 0; eta >= 1 is the index that bends directions.
  LobeSampler(const glm::dvec3& n, const glm::dvec3& o, double eta);

  /// A direction outside, or nothing where the mirrored one points down or cannot leave the coat.
  [[nodiscard]] std::optional<glm::dvec3> sample(const glm::dvec2& u, double m) const;

  /// What densities of all lobes share for one direction: find it once, then ask for each m.
  struct Target {
    double cos_h = 0.0;     ///< of the half vector inside
    double jacobian = 0.0;  ///< from half vectors inside to directions outside
  };
  [[nodiscard]] Target target(const glm::dvec3& i) const;
  [[nodiscard]] static double pdf(const Target& target, double m) {
    return half_vector_pdf(target.cos_h, m) * target.jacobian;
  }

 private:
  ReferenceFrame frame_;
  glm::dvec3 inside_;  ///< o in the coat
  double eta_;
};

/// A direction with density n.i / pi.
[[nodiscard]] glm::dvec3 sample_cosine(const ReferenceFrame& frame, const glm::dvec2& u);

}  // namespace lackwerk::core
