// How the flake slices of one paint lie in the (theta_h, theta_i) plane.
//
// Why it exists: captures, packs, realisation and shader must agree on which texture belongs to which angles. Same
// layout as AxF's CarPaint2: `slice = lut[bin_i] + bin_h`, valid while it is < lut[bin_i + 1]. A value; any thread.
//
// A slice is a node, not a cell: slice (bin_i, bin_h) was lit and seen at theta_i = bin_i * 90 deg / num_theta and
// theta_h = bin_h * 90 deg / num_theta, so that (0, 0) is the exact mirror geometry and neighbours blend bilinearly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace lackwerk::core {

struct SliceLayout {
  std::uint16_t num_theta = 0;     ///< bins per 90 degrees, for both angles (AxF: num_thetaF)
  std::vector<std::uint16_t> lut;  ///< one more entry than rows; lut.back() is the number of slices

  [[nodiscard]] int rows() const { return lut.empty() ? 0 : static_cast<int>(lut.size()) - 1; }
  [[nodiscard]] int slice_count() const { return lut.empty() ? 0 : lut.back(); }
  [[nodiscard]] double bin_width_rad() const { return std::numbers::pi / 2.0 / num_theta; }

  /// The slice at a node, or nothing where the table is empty (its flakes are 0 there).
  [[nodiscard]] std::optional<int> slice_at(int bin_h, int bin_i) const {
    if (bin_h < 0 || bin_i < 0 || bin_i >= rows()) return std::nullopt;
    const int slice = lut[static_cast<std::size_t>(bin_i)] + bin_h;
    if (slice >= lut[static_cast<std::size_t>(bin_i) + 1]) return std::nullopt;
    return slice;
  }

  struct Node {
    int bin_h = 0;
    int bin_i = 0;
  };
  /// The node of a slice. `slice` must be in [0, slice_count()).
  [[nodiscard]] Node node_of(int slice) const {
    int bin_i = 0;
    while (slice >= lut[static_cast<std::size_t>(bin_i) + 1]) ++bin_i;
    return {slice - lut[static_cast<std::size_t>(bin_i)], bin_i};
  }

  bool operator==(const SliceLayout&) const = default;
};

/// The layout real AxF files have: num_theta = 12, rows 8 8 8 8 8 7 6 5 4 3 2, 67 slices (min(8, 12 - bin_i)).
[[nodiscard]] inline SliceLayout axf_layout() {
  SliceLayout layout{12, {0}};
  for (int bin_i = 0; bin_i < 11; ++bin_i) {
    const int row = 12 - bin_i < 8 ? 12 - bin_i : 8;
    layout.lut.push_back(static_cast<std::uint16_t>(layout.lut.back() + row));
  }
  return layout;
}

/// Whether light can meet the angles (theta_h, theta_i), radians, below a coat of this index: inside, every direction
/// is within the critical angle of the normal. Both directions lie lowest in the plane across that of n and h, where
/// each has the cosine cos(theta_h) cos(theta_i).
[[nodiscard]] inline bool reachable_below_coat(double theta_h, double theta_i, double index) {
  const double critical_cosine = std::sqrt(1.0 - 1.0 / (index * index));
  return std::cos(theta_h) * std::cos(theta_i) >= critical_cosine;
}

/// The nodes of `layout` that pictures can read below a coat of this index (>= 1): those that can be reached, and their
/// neighbours, which blend into the cells between. Rows keep their order and start at bin_h = 0.
[[nodiscard]] inline SliceLayout reachable_layout(const SliceLayout& layout, double index) {
  SliceLayout kept{layout.num_theta, {0}};
  for (int bin_i = 0; bin_i < layout.rows(); ++bin_i) {
    int count = 0;
    // A node is read where the cell below it, whose lowest corner is (bin_h - 1, bin_i - 1), can be reached.
    while (layout.slice_at(count, bin_i) &&
           reachable_below_coat(std::max(count - 1, 0) * layout.bin_width_rad(),
                                std::max(bin_i - 1, 0) * layout.bin_width_rad(), index))
      ++count;
    kept.lut.push_back(static_cast<std::uint16_t>(kept.lut.back() + count));
  }
  while (kept.rows() > 1 && kept.lut[kept.lut.size() - 2] == kept.lut.back()) kept.lut.pop_back();
  return kept;
}

}  // namespace lackwerk::core
