#include "packs/tools/car/interior.hpp"

#include <cmath>
#include <cstddef>

namespace lackwerk::packs::car {

namespace {

/// Millimetres, car axes.
struct InteriorShape {
  double deck_z_mm = 872.0;  ///< everything below is a flat black deck
  double seat_y_mm = 365.0;
  double front_seat_x_mm = -130.0;
  double rear_seat_x_mm = -1010.0;
  double back_lean = 0.36;  ///< x per z
  double dash_top_z_mm = 965.0;
  double wheel_x_mm = 395.0;
  double wheel_z_mm = 965.0;
  double wheel_radius_mm = 182.0;
};

/// Leans a block backwards around its own foot.
Patch leaning(const Patch& block, double lean, double foot_z) {
  return transformed(block, [=](const Vec3& p) { return Vec3{p.x - lean * (p.z - foot_z), p.y, p.z}; });
}

void add_seat(Patch& to, const InteriorShape& s, double x, double y, double half_width, double top_z) {
  const double foot = s.deck_z_mm - 60.0;
  const double middle = 0.5 * (foot + top_z);
  append(to, leaning(rounded_box({x, y, middle}, {62.0, half_width, top_z - middle}, 55.0), s.back_lean, foot));
  const double head_z = top_z + 88.0;
  append(to, leaning(rounded_box({x + 14.0, y, head_z}, {46.0, 0.52 * half_width, 78.0}, 40.0), s.back_lean, foot));
}

Patch build_steering_wheel(const InteriorShape& s) {
  constexpr int around = 40;
  constexpr int tube = 8;
  constexpr double tube_radius_mm = 15.0;
  constexpr double tilt = 0.42;  // x per unit of the wheel's own up direction
  constexpr double pi = 3.14159265358979323846;
  const Patch ring = grid(around + 1, tube + 1, [&](int r, int c) {
    const double a = 2.0 * pi * (r % around) / around;
    const double b = 2.0 * pi * (c % tube) / tube;
    const double radius = s.wheel_radius_mm + tube_radius_mm * std::cos(b);
    const double up = radius * std::cos(a);
    return Vec3{s.wheel_x_mm + tilt * up + tube_radius_mm * std::sin(b), s.seat_y_mm + radius * std::sin(a),
                s.wheel_z_mm + up * 0.92};
  });
  constexpr double smooth_deg = 80.0;
  Patch wheel = with_normals(ring, smooth_deg);
  append(wheel, rounded_box({s.wheel_x_mm + 20.0, s.seat_y_mm, s.wheel_z_mm - 10.0}, {22.0, 165.0, 26.0}, 20.0));
  return wheel;
}

}  // namespace

Patch build_interior() {
  const InteriorShape s;
  Patch inside;
  // Deck: a plate from bulkhead to tail, as wide as the doors let it.
  constexpr int rows = 14;
  constexpr int columns = 9;
  constexpr double front_x_mm = 1010.0;
  constexpr double rear_x_mm = -2050.0;
  Patch deck = grid(rows, columns, [&](int r, int c) {
    const double t = static_cast<double>(r) / (rows - 1);
    const double x = rear_x_mm + (front_x_mm - rear_x_mm) * t;
    const double half = 775.0 - 130.0 * std::pow(std::abs(2.0 * t - 1.0), 4.0);
    return Vec3{x, half * (2.0 * c / (columns - 1) - 1.0), s.deck_z_mm};
  });
  deck.normals.assign(deck.positions.size(), Vec3{0.0, 0.0, 1.0});
  append(inside, deck);
  for (const double side : {-1.0, 1.0}) {
    add_seat(inside, s, s.front_seat_x_mm, side * s.seat_y_mm, 250.0, 1150.0);
    add_seat(inside, s, s.rear_seat_x_mm, side * s.seat_y_mm, 290.0, 1075.0);
  }
  const double dash_middle_z = s.dash_top_z_mm - 90.0;
  append(inside, rounded_box({690.0, 0.0, dash_middle_z}, {150.0, 690.0, 80.0}, 60.0));
  append(inside, rounded_box({545.0, 0.0, s.dash_top_z_mm - 10.0}, {14.0, 170.0, 62.0}, 12.0));  // screen
  append(inside, rounded_box({120.0, 0.0, s.deck_z_mm}, {420.0, 110.0, 40.0}, 35.0));            // console
  append(inside, rounded_box({-1500.0, 0.0, s.deck_z_mm + 10.0}, {330.0, 560.0, 50.0}, 40.0));   // parcel shelf
  append(inside, build_steering_wheel(s));
  return inside;
}

}  // namespace lackwerk::packs::car
