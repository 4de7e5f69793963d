// How the panel is mounted: one transform for pixels and touch.
//
// Why it exists: a portrait totem is a landscape panel turned by 90 degrees. If the picture and the touches went
// through two formulas, they would differ on one of them one day. Pure values; any thread.
#pragma once

#include <array>
#include <optional>

namespace lackwerk::kiosk {

/// Clockwise turn of the picture on the panel, as somebody standing before it sees it.
enum class Rotation { none, quarter, half, three_quarters };

/// 0, 90, 180 or 270 degrees; anything else: nothing.
[[nodiscard]] std::optional<Rotation> rotation_of(int degrees);
[[nodiscard]] int degrees_of(Rotation rotation);

/// Points and sizes, [0, 1] or px. x to the right, y down.
using Point = std::array<double, 2>;

/// From the panel as it is built to the picture as it is seen, both in [0, 1] from their upper left corner.
/// A picture point p is shown at the panel point q when picture_point(q) = p.
[[nodiscard]] Point picture_point(Rotation rotation, Point panel);
/// The inverse.
[[nodiscard]] Point panel_point(Rotation rotation, Point picture);
/// Size of the picture on a panel of this size: edges change places at a quarter turn.
[[nodiscard]] std::array<int, 2> picture_size(Rotation rotation, std::array<int, 2> panel_px);

}  // namespace lackwerk::kiosk
