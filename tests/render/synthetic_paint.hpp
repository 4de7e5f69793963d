// Two invented paints with flakes in the form a pack holds, without captures or transport.
//
// Why it exists: render tests need every texture filled with plausible numbers, quickly and always the same. Owns the
// memory behind the spans; do not move it once made. Test code.
#pragma once

#include <cstdint>
#include <vector>

#include "core/interpolatable_paint.hpp"

namespace lackwerk::test {

struct PaintOptions {
  bool flakes = true;
  bool table = true;
  bool coat = true;
  int lobes = 3;
  float texel_mm = 0.6f;
};

class SyntheticPaint {
 public:
  explicit SyntheticPaint(const PaintOptions& options = {});
  SyntheticPaint(const SyntheticPaint&) = delete;
  SyntheticPaint& operator=(const SyntheticPaint&) = delete;
  [[nodiscard]] const core::InterpolatablePaint& get() const { return paint_; }

 private:
  struct Storage {
    std::vector<std::uint32_t> cluster_begin{0};
    std::vector<core::QuantisedCuboid> clusters;
    std::vector<std::uint8_t> tuple_cluster;
  };
  void add_flakes(const PaintOptions& options);

  core::InterpolatablePaint paint_;
  Storage storage_[2];
  std::vector<std::uint32_t> tuple_begin_{0};
  std::vector<std::uint32_t> mass_;
};

/// (1 - t) of the first paint and t of the second, in all groups.
[[nodiscard]] inline core::Weights mix(double t) { return core::Weights::uniform({1.0 - t, t}); }

}  // namespace lackwerk::test
