// Coarse alignment of a scan to its predecessor: iterative closest points.
//
// Why it exists: between two scans the plant was carried to the scanner anew (Golla 2021, 4.3.1). Pure; any thread.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace lackwerk::core {

/// x -> rotation * x + shift.
struct RigidMotion {
  glm::dmat3 rotation{1.0};
  glm::dvec3 shift{0.0};

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& x) const { return rotation * x + shift; }
};

struct AlignOptions {
  int starts = 8;  ///< turns about the vertical axis to begin from, the first of 0 degrees, beside where the scan is
  int up = 2;      ///< the vertical axis: 0, 1 or 2
  /// The plant stands: where both scans end in a stem below, it only turns about its foot; where one does not, about
  /// the vertical axis, and moves. False: any motion, so that leaves, which have most of the points, lie nearest; they
  /// may tilt the plant when they droop.
  bool stands = false;
  int most_iterations = 60;   ///< of each start
  double overlap = 0.7;       ///< the part of the pairs, nearest first, that is believed: the rest has grown
  std::size_t sample = 3000;  ///< points of the moving scan that are paired
};

struct Alignment {
  RigidMotion motion;
  double rms = 0.0;  ///< of the believed pairs, after the motion
  int iterations = 0;
  int start = 0;  ///< the one that won; 0: from where the scan was
};

/// Where the plant stands: the mean of the lowest tenth of its height, if that is no wider than a quarter of the scan's
/// extent, so a stem; else nothing. `up`: 0, 1 or 2.
[[nodiscard]] std::optional<glm::dvec3> foot_of(std::span<const glm::dvec3> points, int up);

/// The motion of `moving` that brings it nearest to `fixed`: Besl & McKay 1992 with trimmed pairs (Chetverikov 2002),
/// from several turns about the vertical axis through the feet of plants that stand (else the centroids), and from
/// where the scans are; the least rms wins, the first on a draw. Fewer than three points on either side: no motion.
[[nodiscard]] Alignment align(std::span<const glm::dvec3> moving, std::span<const glm::dvec3> fixed,
                              const AlignOptions& options);

}  // namespace lackwerk::core
