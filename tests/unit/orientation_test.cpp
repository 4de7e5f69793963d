// One transform for pixels and touch, at four angles.
#include "kiosk/display/orientation.hpp"

#include <gtest/gtest.h>

#include <array>

namespace lackwerk::test {
namespace {

using kiosk::Point;
using kiosk::Rotation;

constexpr std::array rotations = {Rotation::none, Rotation::quarter, Rotation::half, Rotation::three_quarters};

void expect_near(const Point& a, const Point& b) {
  EXPECT_NEAR(a[0], b[0], 1e-15);
  EXPECT_NEAR(a[1], b[1], 1e-15);
}

TEST(Orientation, DegreesAreFourWords) {
  for (int k = 0; k < 4; ++k) {
    const auto rotation = kiosk::rotation_of(90 * k);
    ASSERT_TRUE(rotation);
    EXPECT_EQ(*rotation, rotations[static_cast<std::size_t>(k)]);
    EXPECT_EQ(kiosk::degrees_of(*rotation), 90 * k);
  }
  for (const int degrees : {-90, 1, 45, 91, 360, 450}) EXPECT_FALSE(kiosk::rotation_of(degrees)) << degrees;
}

TEST(Orientation, CornersGoClockwise) {
  // The picture's upper left corner, then where on the panel it must stand.
  const std::array<Point, 4> stands_at = {Point{0, 0}, Point{1, 0}, Point{1, 1}, Point{0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    SCOPED_TRACE(90 * k);
    expect_near(kiosk::panel_point(rotations[k], {0, 0}), stands_at[k]);
    // and its upper right one is the next
    expect_near(kiosk::panel_point(rotations[k], {1, 0}), stands_at[(k + 1) % 4]);
    expect_near(kiosk::panel_point(rotations[k], {1, 1}), stands_at[(k + 2) % 4]);
    expect_near(kiosk::panel_point(rotations[k], {0, 1}), stands_at[(k + 3) % 4]);
  }
}

TEST(Orientation, ThereAndBack) {
  for (const Rotation rotation : rotations)
    for (double x = -0.25; x <= 1.25; x += 0.125)
      for (double y = 0.0; y <= 1.0; y += 0.25) {
        expect_near(kiosk::panel_point(rotation, kiosk::picture_point(rotation, {x, y})), {x, y});
        expect_near(kiosk::picture_point(rotation, kiosk::panel_point(rotation, {x, y})), {x, y});
      }
}

TEST(Orientation, FourQuartersAreNone) {
  Point p = {0.125, 0.75};
  for (int k = 0; k < 4; ++k) p = kiosk::picture_point(Rotation::quarter, p);
  expect_near(p, {0.125, 0.75});
  expect_near(kiosk::picture_point(Rotation::quarter, kiosk::picture_point(Rotation::quarter, p)),
              kiosk::picture_point(Rotation::half, p));
}

TEST(Orientation, AFingerMeetsThePixelUnderIt) {
  // Pixel (i, j) of a 1080 x 1920 picture on a 1920 x 1080 panel: its centre, touched, is its centre again in pixels.
  const std::array<int, 2> panel = {1920, 1080};
  for (const Rotation rotation : rotations) {
    const auto picture = kiosk::picture_size(rotation, panel);
    for (const auto& [i, j] : {std::pair(0, 0), {picture[0] - 1, 0}, {0, picture[1] - 1}, {17, 301}}) {
      const Point shown = kiosk::panel_point(rotation, {(i + 0.5) / picture[0], (j + 0.5) / picture[1]});
      // a touch screen reports whole panel pixels
      const auto column = static_cast<int>(shown[0] * panel[0]), row = static_cast<int>(shown[1] * panel[1]);
      const Point touched = kiosk::picture_point(rotation, {(column + 0.5) / panel[0], (row + 0.5) / panel[1]});
      EXPECT_EQ(static_cast<int>(touched[0] * picture[0]), i);
      EXPECT_EQ(static_cast<int>(touched[1] * picture[1]), j);
    }
  }
}

TEST(Orientation, EdgesChangePlacesAtQuarterTurns) {
  const std::array<int, 2> panel = {1920, 1080}, turned = {1080, 1920};
  EXPECT_EQ(kiosk::picture_size(Rotation::none, panel), panel);
  EXPECT_EQ(kiosk::picture_size(Rotation::quarter, panel), turned);
  EXPECT_EQ(kiosk::picture_size(Rotation::half, panel), panel);
  EXPECT_EQ(kiosk::picture_size(Rotation::three_quarters, panel), turned);
}

}  // namespace
}  // namespace lackwerk::test
