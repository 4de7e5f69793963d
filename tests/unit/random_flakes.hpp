// Seeded random flakes for tests: small paints whose clusters look like those of slices, and whose spans stay alive.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "core/analysis/interpolation.hpp"

namespace lackwerk::core::testing {

/// Uniform in [lo, hi).
inline double uniform(std::mt19937& random, double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(random()) / 4294967296.0);
}

/// Three slices, two levels.
inline FlakeFrame small_frame() { return {SliceLayout{3, {0, 2, 3}}, 2, 0.02f, 16, 42}; }

inline LabCuboid random_box(std::mt19937& random, std::uint32_t count) {
  LabCuboid box;
  const double extent[3][2] = {{0.0, 250.0}, {-40.0, 40.0}, {-40.0, 40.0}};
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = static_cast<float>(uniform(random, extent[axis][0], extent[axis][1]));
    box.hi[axis] = box.lo[axis] + static_cast<float>(random() % 4 == 0 ? 0.0 : uniform(random, 0.0, 12.0));
  }
  box.count = count;
  return box;
}

/// Clusters with heavy-tailed counts that sum to `texels` (at least one each).
inline std::vector<LabCuboid> random_clusters(std::mt19937& random, std::size_t clusters, std::uint32_t texels) {
  std::vector<LabCuboid> row;
  std::uint32_t left = texels - static_cast<std::uint32_t>(clusters);
  for (std::size_t c = 0; c < clusters; ++c) {
    const std::uint32_t share = c + 1 == clusters ? left : static_cast<std::uint32_t>(uniform(random, 0.0, 0.5) * left);
    left -= share;
    row.push_back(random_box(random, 1 + share));
  }
  return row;
}

inline std::vector<ClusteredPaint> random_paints(std::mt19937& random, std::size_t paints, const FlakeFrame& frame,
                                                 std::size_t clusters, std::uint32_t texels = 10000) {
  std::vector<ClusteredPaint> out(paints);
  for (std::size_t k = 0; k < paints; ++k) {
    out[k].identity.name = "paint " + std::to_string(k);
    const int rows = frame.level_count * frame.layout.slice_count();
    for (int row = 0; row < rows; ++row) out[k].rows.push_back(random_clusters(random, clusters, texels));
  }
  return out;
}

/// The built paints, or a failed test and nothing.
inline InterpolatableData build_or_fail(const std::vector<ClusteredPaint>& paints, const FlakeFrame& frame,
                                        int threads = 1) {
  auto built = build_interpolatable(paints, frame, threads);
  if (!built) {
    ADD_FAILURE() << built.error().line();
    return {};
  }
  return std::move(*built);
}

inline std::vector<double> corner_weights(std::size_t paints, std::size_t k) {
  std::vector<double> weights(paints, 0.0);
  weights[k] = 1.0;
  return weights;
}

}  // namespace lackwerk::core::testing
