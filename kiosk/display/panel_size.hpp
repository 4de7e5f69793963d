// How dense a panel's pixels are, from what it says of its size.
//
// Why it exists: touch targets are millimetres, and what monitors say of theirs is often nothing or nonsense. Pure; any
// thread.
#pragma once

#include <array>

namespace lackwerk::kiosk {

inline constexpr double least_dpi = 30.0, most_dpi = 600.0;

/// Pixels per inch of a panel of `panel_px` that says it is `panel_mm` large; 0: nothing, or nothing to believe:
/// - a side of 0 or less;
/// - 16 x 9, 16 x 10 and ten or a hundred times that: TVs write the shape of their picture in the place of its size;
/// - pixels that are more than a tenth longer than wide, or wider than long: then the size is of another thing, or the
///   mode is not the panel's own;
/// - less than 30 or more than 600 dpi, which no kiosk has.
[[nodiscard]] double panel_dpi(std::array<int, 2> panel_px, std::array<int, 2> panel_mm);

}  // namespace lackwerk::kiosk
