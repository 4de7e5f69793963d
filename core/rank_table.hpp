// From a random rank to a tuple: the inverse CDF of each row, as the texture the shader reads.
//
// Why it exists: 500 even steps (Golla & Klein 2018, 3.2) cannot hold p < 0.002, and rare clusters are the sparkle.
// Two changes keep one fetch and the order of ranks (which an alias table would lose): the rank is stored warped,
// v = 1 - sqrt(1 - u), so that steps get fine where L is high; and each step says where inside it the next three
// tuples begin. Pure function; any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

inline constexpr int rank_table_steps = 256;

/// One step of the table: v in [s, s+1)/rank_table_steps, f = fract(v * steps) in [0, 1).
/// tuple = first + (f >= t1/255) + (f >= t2/255) + (f >= t3/255); 255 means "not within this step" (f < 1 always).
struct RankStep {
  std::uint8_t first = 0;
  std::uint8_t t1 = 255, t2 = 255, t3 = 255;
  bool operator==(const RankStep&) const = default;
};
static_assert(sizeof(RankStep) == 4);

/// row_count() rows of rank_table_steps entries: an RGBA8 texture as it stands.
[[nodiscard]] std::vector<RankStep> build_rank_table(const InterpolatablePaint& paint);

/// The tuple of warped rank v in [0, 1), as the shader finds it.
[[nodiscard]] inline int tuple_of_rank(const RankStep* row, double v) {
  const double scaled = v * rank_table_steps;
  const int step = static_cast<int>(scaled);
  const double f = scaled - step;
  const RankStep& entry = row[step];
  return entry.first + (f >= entry.t1 / 255.0 ? 1 : 0) + (f >= entry.t2 / 255.0 ? 1 : 0) +
         (f >= entry.t3 / 255.0 ? 1 : 0);
}

}  // namespace lackwerk::core
