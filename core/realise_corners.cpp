#include "core/realise_corners.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/check.hpp"
#include "core/lanes.hpp"
#include "core/level_balance.hpp"

namespace lackwerk::core {
namespace {

static_assert(std::endian::native == std::endian::little, "min and max are stored as one 32-bit word");

/// A box on the 16-bit grid, not rounded: lanes L, a, b, and one that holds nothing.
struct Box {
  Four lo, hi;
};

/// One paint's clusters of one row, times their weights.
using WeightedClusters = std::array<Box, max_clusters_per_row>;

void weigh_clusters(std::span<const QuantisedCuboid> clusters, float lightness, float colour, WeightedClusters& out) {
  const Four weights{lightness, colour, colour, 0.0f};
  Box* to = out.data();
  for (const QuantisedCuboid& cuboid : clusters) {
    std::array<std::uint32_t, 3> word;  // each axis: min in the low half, max in the high half
    std::memcpy(word.data(), &cuboid, sizeof word);
    const FourWords words{word[0], word[1], word[2], 0};
    to->lo = weights * to_floats(words & 0xffffu);
    to->hi = weights * to_floats(words >> 16);
    ++to;
  }
}

/// Blended boxes of one row.
struct RowBoxes {
  std::array<Box, max_tuples_per_row> box;
  std::array<float, max_tuples_per_row> lightness_lo, lightness_hi;  ///< L once more, side by side
};

/// Number of paints as a constant, so that the sum of a tuple stays in registers.
template <std::size_t paints>
void blend_row(const std::array<WeightedClusters, max_paints>& weighted,
               const std::array<const std::uint8_t*, max_paints>& cluster_of, std::size_t tuples, RowBoxes& out) {
  for (std::size_t t = 0; t < tuples; ++t) {
    Box sum = weighted[0][cluster_of[0][t]];
    for (std::size_t k = 1; k < paints; ++k) {
      const Box& other = weighted[k][cluster_of[k][t]];
      sum.lo += other.lo;
      sum.hi += other.hi;
    }
    out.box[t] = sum;
    out.lightness_lo[t] = sum.lo[0];
    out.lightness_hi[t] = sum.hi[0];
  }
}

/// What happens to a row's corners between blending and rounding: the balance of levels (level_balance.hpp), then
/// colour taken out. L goes through the upper or lower one of two lines; a and b have one line, written twice.
struct RowLines {
  Four above = all(1.0f), above_offset{}, toe = all(1.0f), toe_offset{};
  bool brighter = false;
  Four kept = all(1.0f), added{};
  bool used = false;  ///< false: corners stay as they were blended, to the bit

  void balance(double gain, const LabRange& range) {
    const LabGain lines(gain, range);
    above = all(lines.factor);
    toe = Four{lines.toe_factor, lines.factor, lines.factor, lines.factor};
    above_offset = Four{lines.lightness_offset, lines.colour_offset[0], lines.colour_offset[1], 0.0f};
    toe_offset = Four{lines.toe_offset, lines.colour_offset[0], lines.colour_offset[1], 0.0f};
    brighter = lines.brighter;
    used = true;
  }

  /// a and b scaled by 1 - white. Scaling about a = b = 0 commutes with the balance, and L stays, so that luminance
  /// does too. A grid whose range leaves 0 out gives the nearest it has.
  void whiten(double white, const LabRange& range) {
    const auto rest = static_cast<float>(1.0 - white);
    kept = Four{1.0f, rest, rest, 0.0f};
    for (int c = 1; c < 3; ++c) {
      const double span = static_cast<double>(range.hi[c]) - static_cast<double>(range.lo[c]);
      // The grid's number for 0; a range without width has only one colour anyway.
      const double zero = span > 0.0 ? -static_cast<double>(range.lo[c]) / span * 65535.0 : 0.0;
      added[c] = static_cast<float>(white * zero);
    }
    used = true;
  }

  [[nodiscard]] Four applied(Four corner) const {
    const Four one = above * corner + above_offset, two = toe * corner + toe_offset;
    return kept * (brighter ? least(one, two) : most(one, two)) + added;
  }
};

/// Rounds to the 16-bit grid. Where extrapolation turned a box inside out, it has shrunk to its middle: that keeps
/// min <= max, is continuous in the weights and leaves upright boxes untouched to the bit.
void round_row(const RowBoxes& row, const RowLines& lines, std::size_t tuples, QuantisedCuboid* out) {
  const auto on_grid = [](Four value) {  // to the nearest: what is cut is never negative
    const Four rounded = least(most(value, all(0.0f)), all(65535.0f)) + all(0.5f);
    return __builtin_convertvector(__builtin_convertvector(rounded, FourInts), FourWords);
  };
  for (std::size_t t = 0; t < tuples; ++t) {
    Four lo = row.box[t].lo, hi = row.box[t].hi;
    if (lines.used) {
      lo = lines.applied(lo);
      hi = lines.applied(hi);
    }
    const Four middle = all(0.5f) * (lo + hi);
    const FourWords words = on_grid(least(lo, middle)) | on_grid(most(hi, middle)) << 16;
    std::memcpy(out[t].q.data(), &words, sizeof out[t].q);
  }
}

/// Far beyond any useful extrapolation; keeps every sum below finite.
float bounded(double weight) { return static_cast<float>(std::clamp(weight, -1e6, 1e6)); }

std::size_t widest_row(const InterpolatablePaint& paint) {
  std::size_t width = 0;
  for (std::size_t row = 0; row + 1 < paint.tuple_begin.size(); ++row)
    width = std::max<std::size_t>(width, paint.tuple_begin[row + 1] - paint.tuple_begin[row]);
  check_at_most(width, static_cast<std::size_t>(max_tuples_per_row), "tuples of a row");
  return width;
}

template <std::size_t paints>
void realise_rows(const InterpolatablePaint& paint, const Weights& weights, std::size_t first, std::size_t last,
                  RealisedPaint& out) {
  const auto width = static_cast<std::size_t>(out.width);
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  const double strength = balance_strength(weights.flake_lightness);
  const double white = std::clamp(weights.flake_white, 0.0, 1.0);
  std::array<WeightedClusters, max_paints> weighted;
  RowBoxes boxes;
  for (std::size_t row = first; row < last; ++row) {
    const std::size_t begin = paint.tuple_begin[row];
    const std::size_t tuples = paint.tuple_begin[row + 1] - begin;
    std::array<const std::uint8_t*, max_paints> cluster_of{};
    for (std::size_t k = 0; k < paints; ++k) {
      const auto& part = paint.paints[k];
      const std::size_t clusters = part.cluster_begin[row + 1] - part.cluster_begin[row];
      check_at_most(clusters, static_cast<std::size_t>(max_clusters_per_row), "clusters of a row");
      weigh_clusters(part.clusters.subspan(part.cluster_begin[row], clusters), bounded(weights.flake_lightness[k]),
                     bounded(weights.flake_colour[k]), weighted[k]);
      cluster_of[k] = part.tuple_cluster.data() + begin;
    }
    blend_row<paints>(weighted, cluster_of, tuples, boxes);
    RowLines lines;
    if (strength > 0.0) {
      const double own =
          mean_luminance(std::span(boxes.lightness_lo).first(tuples), std::span(boxes.lightness_hi).first(tuples),
                         paint.mass.subspan(begin, tuples), paint.range);
      if (row < slices)
        out.level0_luminance[row] = own;
      else
        lines.balance(row_gain(out.level0_luminance[row % slices], own, strength), paint.range);
    }
    if (white > 0.0) lines.whiten(white, paint.range);
    QuantisedCuboid* to = out.corners.data() + row * width;
    round_row(boxes, lines, tuples, to);
    std::fill(to + tuples, to + width, QuantisedCuboid{});
  }
}

/// The rows of levels [first, last).
void realise_level_rows(const InterpolatablePaint& paint, const Weights& weights, int first, int last,
                        RealisedPaint& out) {
  using Rows = void (*)(const InterpolatablePaint&, const Weights&, std::size_t, std::size_t, RealisedPaint&);
  static constexpr std::array<Rows, max_paints> rows_of = {realise_rows<1>, realise_rows<2>, realise_rows<3>,
                                                           realise_rows<4>, realise_rows<5>};
  check_at_most(std::size_t{1}, paint.paints.size(), "paints of a pack");
  check_at_most(last, static_cast<int>(paint.level_count), "levels of a pack");
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  rows_of[paint.paints.size() - 1](paint, weights, static_cast<std::size_t>(first) * slices,
                                   static_cast<std::size_t>(last) * slices, out);
}

}  // namespace

void realise_level0(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out) {
  const std::size_t width = widest_row(paint);
  out.width = static_cast<int>(width);
  out.corners.resize(static_cast<std::size_t>(paint.row_count()) * width);
  out.level0_luminance.assign(static_cast<std::size_t>(paint.layout.slice_count()), 0.0);
  if (paint.row_count() > 0) realise_level_rows(paint, weights, 0, 1, out);
}

void realise_levels(const InterpolatablePaint& paint, const Weights& weights, int first, int last, RealisedPaint& out) {
  check_at_most(1, first, "level 0 is realised on its own");
  if (paint.row_count() > 0 && first < last) realise_level_rows(paint, weights, first, last, out);
}

}  // namespace lackwerk::core
