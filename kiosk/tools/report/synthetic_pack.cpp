#include "kiosk/tools/report/synthetic_pack.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lackwerk::report {
namespace {

constexpr std::uint32_t edge_texels = 480;
constexpr int levels = 9;

/// [0, 1), the same on every machine (the standard's distributions are not).
float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) / 16777216.0f; }

/// A flake-like cluster: most are dark and small, few are bright; its colour follows its lightness.
core::LabCuboid cluster(std::mt19937& random, float hue) {
  const float rare = uniform(random);
  const float lightness = 400.0f * rare * rare * rare;
  const glm::vec3 lo(lightness, 0.1f * hue * lightness + 20.0f * uniform(random), -20.0f * uniform(random));
  const glm::vec3 size(4.0f + 0.1f * lightness * uniform(random), 6.0f * uniform(random), 6.0f * uniform(random));
  return {lo, lo + size, 1};
}

}  // namespace

Result<core::InterpolatableData> synthetic_pack(std::size_t paints, int clusters) {
  const core::FlakeFrame frame{core::axf_layout(), levels, 0.05f, edge_texels, 1};
  std::mt19937 random(7);
  std::vector<core::ClusteredPaint> made(paints);
  for (std::size_t k = 0; k < paints; ++k) {
    core::ClusteredPaint& paint = made[k];
    paint.identity.name = "synthetic " + std::to_string(k);
    const float hue = static_cast<float>(k) - 2.0f;
    for (std::uint32_t edge = edge_texels, level = 0; level<levels; ++level, edge = edge> 1 ? edge / 2 : 1) {
      const std::uint32_t texels = edge * edge;
      for (int slice = 0; slice < frame.layout.slice_count(); ++slice) {
        const auto count = static_cast<int>(std::min<std::uint32_t>(texels, static_cast<std::uint32_t>(clusters)));
        std::vector<core::LabCuboid> row;
        row.reserve(static_cast<std::size_t>(count));
        // Heavy-tailed counts that match no other paint's, so that tuples are as many as they can be.
        std::uint32_t left = texels - static_cast<std::uint32_t>(count);
        for (int c = 0; c < count; ++c) {
          row.push_back(cluster(random, hue));
          const std::uint32_t share =
              c + 1 == count ? left : static_cast<std::uint32_t>(0.5f * uniform(random) * static_cast<float>(left));
          row.back().count += share;
          left -= share;
        }
        paint.rows.push_back(std::move(row));
      }
    }
  }
  return core::build_interpolatable(made, frame, 2);
}

}  // namespace lackwerk::report
