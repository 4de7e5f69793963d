// Keeps the light of a mix of paints the same at every mip level.
//
// Why it exists: corners blend in Lab, which is not linear in light. A flake and the dark around it, blended and then
// averaged, are less bright than their averages blended, so that the farther mip levels of a mix would shine brighter
// than the near ones: 1 % in the flash of the demo's even mix, 12 to 46 % beside it. Zooming must not change the light.
// Level 0 says what is right (Golla & Klein 2018, 4.2, blend the slices themselves); the boxes of the others are scaled
// to its mean luminance. Pure functions over values; any thread.
#pragma once

#include <span>

#include "core/interpolatable_paint.hpp"

namespace lackwerk::core {

/// How much of the correction a mix gets, from its weights of lightness: 0 at the paints themselves, which stay as they
/// are bit for bit, 1 from 5 % of another paint on, linear between.
[[nodiscard]] double balance_strength(std::span<const double> lightness);

/// Mean luminance (Y of CIE 1931, white 1) of one row's boxes. `lo`, `hi`: their L on the grid of `range`, not rounded;
/// `mass`: one a box. Simpson's rule along L, which is exact above the toe of Lab and close in it.
[[nodiscard]] double mean_luminance(std::span<const float> lo, std::span<const float> hi,
                                    std::span<const std::uint32_t> mass, const LabRange& range);

/// Multiplies light by a gain, in Lab on the grid of a range: above the toe L + 16, a and b scale by its cube root; in
/// the toe L scales by the gain itself. Continuous and rising in L, the identity at gain 1.
struct LabGain {
  float factor = 1.0f, lightness_offset = 0.0f;
  float toe_factor = 1.0f, toe_offset = 0.0f;
  bool brighter = false;
  std::array<float, 2> colour_offset{};  ///< a, b

  LabGain(double gain, const LabRange& range);
  [[nodiscard]] float lightness(float q) const {
    const float above = factor * q + lightness_offset, toe = toe_factor * q + toe_offset;
    return brighter ? (above < toe ? above : toe) : (above > toe ? above : toe);
  }
  /// `axis`: 0 for a, 1 for b.
  [[nodiscard]] float colour(float q, std::size_t axis) const { return factor * q + colour_offset[axis]; }
};

/// The gain for a row of mean luminance `row` whose slice has `level0` at level 0. 1 where both are too dark to see;
/// in [1/4, 4] always, and so bounded under any extrapolation.
[[nodiscard]] double row_gain(double level0, double row, double strength);

}  // namespace lackwerk::core
