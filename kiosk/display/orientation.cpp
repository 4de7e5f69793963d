#include "kiosk/display/orientation.hpp"

namespace lackwerk::kiosk {

std::optional<Rotation> rotation_of(int degrees) {
  switch (degrees) {
    case 0:
      return Rotation::none;
    case 90:
      return Rotation::quarter;
    case 180:
      return Rotation::half;
    case 270:
      return Rotation::three_quarters;
    default:
      return std::nullopt;
  }
}

int degrees_of(Rotation rotation) { return 90 * static_cast<int>(rotation); }

Point picture_point(Rotation rotation, Point panel) {
  const auto [x, y] = panel;
  switch (rotation) {
    case Rotation::quarter:  // the picture's upper left corner stands at the panel's upper right one
      return {y, 1.0 - x};
    case Rotation::half:
      return {1.0 - x, 1.0 - y};
    case Rotation::three_quarters:
      return {1.0 - y, x};
    case Rotation::none:
      break;
  }
  return panel;
}

Point panel_point(Rotation rotation, Point picture) {
  // A turn is undone by the turn that completes the circle.
  const auto inverse = static_cast<Rotation>((4 - static_cast<int>(rotation)) % 4);
  return picture_point(inverse, picture);
}

std::array<int, 2> picture_size(Rotation rotation, std::array<int, 2> panel_px) {
  const bool sideways = rotation == Rotation::quarter || rotation == Rotation::three_quarters;
  return sideways ? std::array<int, 2>{panel_px[1], panel_px[0]} : panel_px;
}

}  // namespace lackwerk::kiosk
