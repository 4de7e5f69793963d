// A touch screen's calibration from four touches: the affine map that brings what it reports to what is meant.
//
// Why it exists: some panels report places that are shifted, scaled or mirrored; a dealer mends that with a finger.
// Pure; any thread.
#pragma once

#include <optional>
#include <vector>

#include "input/touch_settings.hpp"
#include "kiosk/display/orientation.hpp"

namespace lackwerk::kiosk {

/// Somebody who misses the crosses by more than this on the average (root of the mean square, parts of the panel) meant
/// something else.
inline constexpr double most_calibration_residual = 0.05;
/// Length of either axis and area, after over before: beyond these it is no correction of a panel.
inline constexpr double least_calibration_scale = 0.5, most_calibration_scale = 2.0;

/// The map with the least squares of `map(reported) - meant`, both in parts of the panel, at least three not on a line.
/// Nothing: too few, on a line, not finite, too far off, or no plausible panel.
[[nodiscard]] std::optional<input::CalibrationMatrix> fit_calibration(const std::vector<Point>& reported,
                                                                      const std::vector<Point>& meant);
/// `then` after `first`.
[[nodiscard]] input::CalibrationMatrix composed(const input::CalibrationMatrix& then,
                                                const input::CalibrationMatrix& first);
[[nodiscard]] Point calibrated(const input::CalibrationMatrix& matrix, Point point);

inline constexpr input::CalibrationMatrix no_calibration{1.0, 0.0, 0.0, 0.0, 1.0, 0.0};

}  // namespace lackwerk::kiosk
