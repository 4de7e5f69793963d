// A map as 64 directional lights.
//
// Why it exists: flakes and the table chi need single directions of light; a weak machine can afford four of them, the
// still picture 64. Pure function; any thread.
#pragma once

#include <vector>

#include "core/analysis/environment_filter.hpp"
#include "core/environment.hpp"

namespace lackwerk::core {

/// Median cut (after Debevec 2006): six times every part of the sphere is halved across the longest axis of its light
/// (the first principal axis of directions, weighted by luminance), where half the luminance lies on either side. On
/// directions instead of on a lat-long rectangle, so that no seam or pole cuts a lamp in two. A part that is one texel
/// is halved in strength. Gives environment_light_count lights in the tree's order whose radiances sum to 1/pi times
/// the map's integral over the sphere. Every direction is where its part's luminance has its centre.
/// `halvings`, in [0, 16]: another number of lights, 2^halvings; what an Environment holds takes the usual six.
[[nodiscard]] std::vector<EnvironmentLight> median_cut(const OctahedralImage& map, int halvings = 6);

}  // namespace lackwerk::core
