// Octahedral pictures in float, and what a rough mirror makes of them.
//
// Why it exists: the builder of an environment works here in full precision before anything becomes bytes. Values;
// the functions share their work among threads of their own and return when all are done; the result does not depend
// on how many there were.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "core/analysis/environment_latlong.hpp"

namespace lackwerk::core {

/// A square octahedral map of linear radiances with a border of one texel that repeats its neighbours across the fold.
struct OctahedralImage {
  explicit OctahedralImage(int edge);
  /// x, y in [-1, edge]: -1 and edge are the border.
  [[nodiscard]] glm::vec3& at(int x, int y);
  [[nodiscard]] const glm::vec3& at(int x, int y) const;
  /// Copies the border from the inside. The square's sides are folded at their middles: what lies beyond (u, v) = (0,
  /// v) is what lies inside of (0, 1 - v); all four corners are -z.
  void wrap_border();
  [[nodiscard]] glm::vec3 filtered(double u, double v) const;  ///< linear between texels; u, v in [0, 1]

  int edge;
  std::vector<glm::vec3> texels;  ///< (edge + 2)^2, border included
};

/// Solid angle of texel (x, y), steradians (2 x 2 midpoints; the sum of a 64 x 64 map is 4 pi to 1e-4).
[[nodiscard]] double texel_solid_angle(int edge, int x, int y);

/// Means of `radiance` over the texels, by solid angle, from samples x samples directions each.
[[nodiscard]] OctahedralImage resampled(const Radiance& radiance, int edge, int samples);

/// The map and its halvings (means by solid angle) down to 8 texels an edge; the first is the map itself.
[[nodiscard]] std::vector<OctahedralImage> halvings(OctahedralImage image);

/// Weight of light from an angle theta off the mirrored direction, for a Beckmann lobe of roughness m at normal view,
/// not normalised. With n = o = r the half vector lies at theta / 2 and h.o = n.h, so lobe_shape (paint_model.glsl)
/// times n.l is D(theta / 2) min(1, 2 cos theta) / cos theta * cos theta = D(theta / 2) min(1, 2 cos theta), and 0
/// below the horizon. It depends on the angle between r and l alone: every level keeps the light of the whole sphere.
[[nodiscard]] double beckmann_weight(double theta_rad, double m);

/// The mean of the map around every texel's direction under that weight. `source`: halvings of the map.
[[nodiscard]] OctahedralImage beckmann_filtered(const std::vector<OctahedralImage>& source, double m, int edge);

/// Calls work(row) once for each row in [0, count) from several threads.
void for_each_row(int count, const std::function<void(int)>& work);

}  // namespace lackwerk::core
