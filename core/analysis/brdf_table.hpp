// A measured isotropic BRDF: a table over the half and the difference angles, with holes.
//
// Why it exists: measurements come as grids over their own coordinates (MERL's bins, RGL's warped squares,
// photographs); fits, colour maps and comparisons want one form that resolves a sharp peak and says where nothing was
// measured. Rusinkiewicz's half and difference vectors (1998), theta_h non-linear as in MERL (Matusik et al. 2003;
// Guenther et al. 2005, section 4): cells are finest at the peak. Values; any thread.
//
// Conventions: directions are unit vectors in the frame of the surface, z = normal, both away from it, z >= 0. Values
// are the BRDF without the cosine, 1/sr, linear sRGB under D65 (D65 white reflects 1/pi per channel when diffuse).
// Isotropic and reciprocal: phi_d lies in [0, pi).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace lackwerk::core {

/// Any isotropic BRDF without its cosine: unit directions to the light and to the eye, 1/sr, linear sRGB.
using Brdf = std::function<glm::dvec3(const glm::dvec3& in, const glm::dvec3& out)>;

/// Rusinkiewicz's angles, radians: theta_h and theta_d in [0, pi/2], phi_d in [0, pi).
struct HalfAngles {
  double theta_h = 0.0, theta_d = 0.0, phi_d = 0.0;
};
struct DirectionPair {
  glm::dvec3 in{0.0, 0.0, 1.0}, out{0.0, 0.0, 1.0};
};

/// Of two unit directions, neither below the horizon. theta_h = 0 and theta_d = 0 leave phi_d free: 0 is returned.
[[nodiscard]] HalfAngles half_angles(const glm::dvec3& in, const glm::dvec3& out);
/// The directions of these angles, half vector in the xz plane; one of them may lie below the horizon (z < 0): such
/// cells exist in the table and mean nothing.
[[nodiscard]] DirectionPair directions(const HalfAngles& angles);

/// Neither direction is below the horizon.
[[nodiscard]] inline bool is_above(const DirectionPair& pair) { return pair.in.z >= 0.0 && pair.out.z >= 0.0; }

/// Numbers of cells; the three of every MERL file.
struct BrdfTableSize {
  std::uint32_t theta_h = 90, theta_d = 90, phi_d = 180;
  [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(theta_h) * theta_d * phi_d; }
  bool operator==(const BrdfTableSize&) const = default;
};

class BrdfTable {
 public:
  /// All holes. Each number in [2, 512].
  explicit BrdfTable(BrdfTableSize size = {});

  [[nodiscard]] const BrdfTableSize& size() const { return size_; }
  /// Middle of a cell: theta_h = ((i + 1/2) / n)^2 * pi/2, theta_d = (j + 1/2) / n * pi/2, phi_d = (k + 1/2) / n * pi.
  [[nodiscard]] HalfAngles middle(std::size_t cell) const;
  /// Index of the cell in which these angles lie: ((i * n_d) + j) * n_p + k.
  [[nodiscard]] std::size_t cell_of(const HalfAngles& angles) const;

  /// Empty: a hole. Otherwise finite and >= 0.
  [[nodiscard]] std::optional<glm::vec3> value(std::size_t cell) const;
  void set(std::size_t cell, const glm::vec3& value);
  void clear(std::size_t cell);
  [[nodiscard]] std::size_t holes() const;  ///< among the cells whose middle has both directions above the horizon

  /// Between the middles of cells, linear in the three grid coordinates (phi_d wraps), holes left out and the rest
  /// renormalised; empty where all neighbours are holes.
  [[nodiscard]] std::optional<glm::dvec3> at(const glm::dvec3& in, const glm::dvec3& out) const;

 private:
  BrdfTableSize size_;
  std::vector<glm::vec3> values_;  ///< NaN in red: a hole
};

/// Samples any BRDF at the middles; cells with a direction below the horizon stay holes, and so do values that are not
/// finite. Negative ones (noise) become 0.
[[nodiscard]] BrdfTable tabulate(const Brdf& brdf, BrdfTableSize size = {});

/// The mean of f(in, out) and f(out, in): a measurement is reciprocal only up to its errors.
[[nodiscard]] Brdf reciprocal(Brdf brdf);

/// Fills every hole whose directions are above the horizon from its neighbours (in log, weights by distance in the
/// half-vector grid), so that at() never misses there: for grazing pairs between middles that all lie below the
/// horizon, those are filled too. A table of holes only stays one. Returns how many were filled. `filled`, if given, is
/// marked per cell: a filled value is a guess, and fits give it no weight.
std::size_t fill_holes(BrdfTable& table, std::vector<std::uint8_t>* filled = nullptr);

/// Pairs of directions spread evenly over the table's grid (so that the peak has its part), both within 75 degrees of
/// the normal: where to compare BRDFs. The same ones for the same count.
[[nodiscard]] std::vector<DirectionPair> grid_pairs(std::size_t count);

/// What a table says of itself, over directions of light at some angles: albedo (energy, should be <= 1) and the worst
/// relative difference between f(in, out) and f(out, in) (reciprocity; 0 by construction for a table, and the figure of
/// interest for whatever it was sampled from).
struct BrdfHealth {
  std::vector<double> theta_in_deg;  ///< angles of the light
  std::vector<glm::dvec3> albedo;    ///< per angle
  double worst_reciprocity = 0.0;    ///< of |a - b| / max(a, b) over pairs where both are above 1e-3 of the mean
  double mean_reciprocity = 0.0;
  double p95_reciprocity = 0.0;
  /// Sum of |a - b| over sum of max(a, b), over pairs even in the table's own grid: what the error amounts to where the
  /// light is, while the three above count the darkest pair as much as the brightest.
  double weighted_reciprocity = 0.0;
  std::size_t pairs = 0;  ///< that the three were taken over; both directions within 75 degrees
};
[[nodiscard]] BrdfHealth health(const Brdf& brdf, std::uint32_t samples_per_angle = 4096);

}  // namespace lackwerk::core
