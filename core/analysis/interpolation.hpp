// Makes paints mixable: transports the flake clusters of 1 to 5 paints onto each other, row by row.
//
// Why it exists: it is the build step behind core::InterpolatablePaint (Golla & Klein 2018, 4.1 and 4.3), done once
// when a pack is made. The result owns its memory and hands out the read-only view that realise() takes. Deterministic:
// the same bytes for any number of threads. Threads live only inside the call.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/analysis/flake_clusters.hpp"
#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

/// One paint going in. `rows` holds the clusters of each slice and mip level, row = level * slice_count + slice, all
/// rows, none empty; or nothing at all for a plain paint, which then counts as black (Xi = 0) in every row.
struct ClusteredPaint {
  PaintIdentity identity;
  AnalyticPaint analytic;
  std::vector<std::vector<LabCuboid>> rows;  ///< Lab of pi * Xi under D65; counts are texels, >= 1
  FlakeLife life;
};

/// What all paints of a pack share.
struct FlakeFrame {
  SliceLayout layout;               ///< empty only if no paint has rows
  std::uint16_t level_count = 0;    ///< mip levels
  float texel_mm = 0.0f;            ///< edge of a level-0 texel
  std::uint32_t level0_texels = 0;  ///< texels per edge of a level-0 slice
  std::uint64_t random_seed = 0;
};

/// An InterpolatablePaint with its memory. Fields as there.
struct InterpolatableData {
  struct Part {
    PaintIdentity identity;
    AnalyticPaint analytic;
    std::vector<std::uint32_t> cluster_begin;
    std::vector<QuantisedCuboid> clusters;
    std::vector<std::uint8_t> tuple_cluster;
    FlakeLife life;
  };
  std::vector<Part> parts;
  FlakeFrame frame;
  LabRange range;
  std::vector<std::uint32_t> tuple_begin;
  std::vector<std::uint32_t> mass;
  std::uint32_t row_mass = 0;

  /// Spans into this object: valid while it lives unchanged (moving it is fine).
  [[nodiscard]] InterpolatablePaint view() const;
};

/// Builds the tuples. Per row: corners go to the pack's 16-bit grid first (so that plan and pack agree), counts become
/// masses that sum to the same row_mass for every paint (largest remainder; none becomes 0), then each paint is
/// transported from the realisation, at equal weights, of those before it. Tuples are sorted by L at equal weights.
///
/// `threads` >= 1 share the rows, the calling one among them; only that one calls `progress` (if given), with rising
/// fractions up to 1. Errors name the row (and paint): no paint or more than five, wrong number of rows, an empty row,
/// a box inside out or not finite, a count of 0, more than 250 clusters or 256 tuples in a row.
[[nodiscard]] Result<InterpolatableData> build_interpolatable(const std::vector<ClusteredPaint>& paints,
                                                              const FlakeFrame& frame, int threads,
                                                              const std::function<void(double)>& progress = {});

}  // namespace lackwerk::core
