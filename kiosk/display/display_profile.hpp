// What the panel makes of a pixel: its primaries, white and tone curve, and the way from the picture's sRGB to it.
//
// Why it exists: measured colour ends at the frame buffer unless somebody says what the panel shows. The profile comes
// from kiosk.toml (chromaticities and a curve) or from an ICC file; the present pass applies it. Values; any thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::kiosk {

/// CIE 1931 chromaticity.
struct Chromaticity {
  double x = 0.0, y = 0.0;
  bool operator==(const Chromaticity&) const = default;
};

/// A display: linear light of the panel = primaries times curve of the pixel, per channel.
struct DisplayProfile {
  Chromaticity red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06};  ///< IEC 61966-2-1
  Chromaticity white{0.3127, 0.3290};                                 ///< D65
  /// Per channel (all three the same if only one was given): light in [0, 1] of the pixel values k/(n-1), rising, n in
  /// [2, 4096]. Empty: the sRGB curve.
  std::array<std::vector<double>, 3> curves;
  std::string source = "sRGB";  ///< for the log: "kiosk.toml", or the ICC file and its description

  /// sRGB to the panel as it is: the present pass then copies.
  [[nodiscard]] bool is_srgb() const;
  bool operator==(const DisplayProfile&) const = default;
};

/// A power curve, exponent in [1, 4], of `n` points.
[[nodiscard]] std::vector<double> power_curve(double exponent, int n = 256);

/// The pixel value in [0, 1] at which a channel (0 red, 1 green, 2 blue) gives this much light: the curve's inverse.
/// Light the curve does not reach gives the nearer end. The profile must have passed check_profile().
[[nodiscard]] double pixel_of_light(const DisplayProfile& profile, int channel, double light);

/// Reads an ICC display profile of the matrix and curve kind. Errors: not a profile, not RGB, tables only (remedy: make
/// a matrix profile), larger than 16 MiB, or check_profile() refuses it. A video card table in it (vcgt) is left out,
/// and `source` says so.
[[nodiscard]] Result<DisplayProfile> read_icc(const std::string& path);

/// Checks that the profile is a display: primaries not on one line, white inside them, curves rising and finite.
[[nodiscard]] Result<void> check_profile(const DisplayProfile& profile, const std::string& file);

/// Linear sRGB to the panel's linear RGB, row major. White maps to the panel's white: the customer adapts to the panel
/// (relative colorimetric, Bradford), so that grey stays grey at full brightness.
[[nodiscard]] std::array<double, 9> panel_from_srgb(const DisplayProfile& profile);

/// A colour counts as lost when a channel's light is this far outside [0, 1]: half an 8-bit step beyond white; below
/// black what the other two channels drown.
inline constexpr double gamut_tolerance = 0.005;

/// Share of the given linear sRGB colours ([0, 1]^3) that the panel cannot show: a channel below -tolerance or above
/// 1 + tolerance. Worst channel excess too.
struct GamutLoss {
  double share = 0.0;
  double worst = 0.0;
};
[[nodiscard]] GamutLoss gamut_loss(const DisplayProfile& profile, const std::vector<std::array<double, 3>>& colours,
                                   double tolerance = gamut_tolerance);

}  // namespace lackwerk::kiosk
