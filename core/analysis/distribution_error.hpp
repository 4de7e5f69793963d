// How far a clustered slice is from the texels it came from.
//
// Why it exists: the number of clusters is a knob, and its error is the 1-Wasserstein distance in Lab between texels
// and their reconstruction, a mixture of uniform cuboids. The exact distance between 230,400 points and a continuous
// mixture is out of reach; two bounds around it are not. Pure; any thread.
//
// Upper: a transport plan that stays inside clusters. In each, texels and box are halved together (texels at their
// median along the box's longest side, box in the middle) down to single texels; a texel then pays the root mean
// square distance to its share of the box (Jensen). Any plan bounds from above. Bias: for texels that really are
// uniform it reports the grain of n random points, about side n^(-1/3) a cluster (measured), and never flatters.
// Lower: projections never lengthen a path, so the distance of the L, a or b distributions (exact on the line, with a
// test function of slope +-1 on a grid) bounds from below. For mostly grey slices the two are close.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "core/analysis/flake_clusters.hpp"

namespace lackwerk::core {

/// Both in Lab units, 0 <= lower <= W1 <= upper (upper is an estimate of that bound where texels were left out).
struct WassersteinBounds {
  double lower = 0.0;
  double upper = 0.0;
};

/// `clusters` must be the partition of exactly these texels (cluster_texels's answer: each texel in one box, counts
/// matching; anything else aborts). `stored`, if not empty, are the same clusters as they are reconstructed (quantised
/// boxes, in the same order; their counts are not read). Clusters of more texels than `most_texels` are judged by an
/// even selection.
[[nodiscard]] WassersteinBounds wasserstein1_bounds(std::span<const glm::vec3> texels_lab,
                                                    std::span<const LabCuboid> clusters,
                                                    std::span<const LabCuboid> stored = {},
                                                    std::size_t most_texels = 4096);

/// The upper bound alone.
[[nodiscard]] double wasserstein1_lab(std::span<const glm::vec3> texels_lab, std::span<const LabCuboid> clusters,
                                      std::span<const LabCuboid> stored = {}, std::size_t most_texels = 4096);

}  // namespace lackwerk::core
