// What kiosk.toml may say about a touch screen.
//
// Why it exists: the file is read in the kiosk, the screen in input; both need these few values and nothing else of
// each other. Values; any thread.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace lackwerk::input {

/// First two rows of a 3x3 matrix on positions in [0, 1], row by row, as libinput takes it from udev's
/// LIBINPUT_CALIBRATION_MATRIX: x' = m0 x + m1 y + m2, y' = m3 x + m4 y + m5.
using CalibrationMatrix = std::array<double, 6>;

/// Finite, and not everything falls onto one line.
[[nodiscard]] bool is_usable(const CalibrationMatrix& matrix);

struct TouchSettings {
  /// "222a:0001" (vendor and product) or a part of the device's name, letters' case ignored; empty: every device.
  std::string match;
  std::string output;  ///< connector it lies on, "HDMI-A-1"; empty: as udev says (WL_OUTPUT), else the kiosk's
  std::optional<CalibrationMatrix> calibration;  ///< instead of udev's; nothing: udev's
  bool operator==(const TouchSettings&) const = default;
};

/// Entries of this kind in one file.
inline constexpr std::size_t max_touch_settings = 16;

}  // namespace lackwerk::input
