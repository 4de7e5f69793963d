#include "packs/tools/car/wheels.hpp"

#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

namespace lackwerk::packs::car {

namespace {

constexpr int tyre_segments = 60;
constexpr int rim_segments = 72;

/// Points of a circle arc, angles in degrees, 0 along +radius, 90 along +y.
void add_arc(std::vector<Vec2>& profile, Vec2 centre, double radius, double from_deg, double to_deg, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / steps) * 3.14159265358979 / 180.0;
    profile.push_back(centre + Vec2{std::cos(a), std::sin(a)} * radius);
  }
}

Patch build_tyre(const WheelLayout& layout, const WheelShape& shape) {
  const double tread = layout.tyre_radius_mm;
  const double width = layout.tyre_width_mm;
  constexpr double shoulder_mm = 26.0;
  constexpr double groove_depth_mm = 7.0;
  constexpr double groove_half_mm = 4.5;
  std::vector<Vec2> profile;
  // Outer flank: bead, rim protector, bulging side wall, lettering step, shoulder.
  profile.push_back({shape.rim_radius_mm - 8.0, -16.0});
  profile.push_back({shape.rim_radius_mm - 2.0, -7.0});
  profile.push_back({shape.rim_radius_mm + 5.0, -3.5});
  profile.push_back({shape.rim_radius_mm + 14.0, -2.5});
  profile.push_back({shape.rim_radius_mm + 22.0, -0.6});
  profile.push_back({shape.rim_radius_mm + 34.0, 0.0});
  profile.push_back({shape.rim_radius_mm + 48.0, -2.0});
  profile.push_back({shape.rim_radius_mm + 57.0, -5.5});
  add_arc(profile, {tread - shoulder_mm, -shoulder_mm - 8.0}, shoulder_mm, 68.0, 8.0, 5);
  // Tread with circumferential grooves, slightly crowned.
  for (const double at : {0.34, 0.66}) {
    const double y = -width * at;
    profile.push_back({tread, y + groove_half_mm});
    profile.push_back({tread - groove_depth_mm, y + groove_half_mm * 0.8});
    profile.push_back({tread - groove_depth_mm, y - groove_half_mm * 0.8});
    profile.push_back({tread, y - groove_half_mm});
  }
  add_arc(profile, {tread - shoulder_mm, -width + shoulder_mm + 8.0}, shoulder_mm, -8.0, -68.0, 4);
  profile.push_back({shape.rim_radius_mm + 40.0, -width});
  profile.push_back({shape.rim_radius_mm - 8.0, -width + 14.0});
  constexpr double crease_deg = 38.0;
  return with_normals(revolve(profile, tyre_segments), crease_deg);
}

Patch build_barrel(const WheelLayout& layout, const WheelShape& shape) {
  const double r = shape.rim_radius_mm;
  // From the inner end of the barrel outward, then over the flange.
  std::vector<Vec2> profile{{r - 26.0, -layout.tyre_width_mm + 20.0},
                            {r - 30.0, -150.0},
                            {r - 26.0, -60.0},
                            {r - 19.0, -34.0},
                            {r - 15.0, -20.0},
                            {r - 13.0, -13.0},
                            {r - 11.0, -8.5},
                            {r - 8.5, -6.0},
                            {r - 5.5, -5.2},
                            {r - 2.5, -5.6},
                            {r - 0.5, -7.5},
                            {r, -11.0}};
  constexpr double crease_deg = 35.0;
  return with_normals(revolve(profile, rim_segments), crease_deg);
}

/// One blade, running outward along +z, leaning to `side` (-1 or +1).
Patch build_blade(const WheelShape& s, double side) {
  constexpr int stations = 10;
  constexpr int around = 8;
  const auto station = [&](int i, int j) {
    const double t = static_cast<double>(i) / (stations - 1);
    const double ease = t * t * (3.0 - 2.0 * t);
    const double radius = s.spoke_hub_radius_mm + (s.spoke_end_radius_mm - s.spoke_hub_radius_mm) * t;
    const double face = s.spoke_hub_y_mm + (s.spoke_end_y_mm - s.spoke_hub_y_mm) * std::pow(t, 1.6);
    // Waisted in the middle, widening into the rim: cast metal, not a plank.
    const double flare = 9.0 * std::pow(t, 9.0) + 7.0 * std::pow(1.0 - t, 5.0);
    const double half =
        s.spoke_hub_half_width_mm + (s.spoke_end_half_width_mm - s.spoke_hub_half_width_mm) * ease + flare;
    const double depth = s.spoke_depth_hub_mm + (s.spoke_depth_end_mm - s.spoke_depth_hub_mm) * t;
    const double middle = side * (s.spoke_hub_gap_mm + (s.spoke_end_gap_mm - s.spoke_hub_gap_mm) * t);
    const double b = s.spoke_bevel_mm;
    const std::array<Vec2, around> section{Vec2{-half + b, 0.0},
                                           Vec2{-half + b * 0.3, -b * 0.35},
                                           Vec2{-half - 1.0, -b * 1.6},
                                           Vec2{-half - 4.0, -depth},
                                           Vec2{half + 4.0, -depth},
                                           Vec2{half + 1.0, -b * 1.6},
                                           Vec2{half - b * 0.3, -b * 0.35},
                                           Vec2{half - b, 0.0}};
    const Vec2 q = section[static_cast<std::size_t>(j % around)];
    return Vec3{middle + q.x, face + q.y, radius};
  };
  const Patch blade = reversed(grid(stations, around + 1, station));
  constexpr double crease_deg = 34.0;
  return with_normals(blade, crease_deg);
}

Patch build_hub(const WheelShape& s) {
  const double y = s.spoke_hub_y_mm;
  const std::vector<Vec2> profile{{34.0, y - 6.0},
                                  {36.0, y + 1.0},
                                  {40.0, y + 2.0},
                                  {s.hub_radius_mm - 14.0, y + 0.5},
                                  {s.hub_radius_mm - 6.0, y - 3.0},
                                  {s.hub_radius_mm, y - 14.0},
                                  {s.hub_radius_mm + 2.0, y - 60.0}};
  constexpr double crease_deg = 40.0;
  return with_normals(revolve(profile, 36), crease_deg);
}

Patch build_disc(const WheelShape& s) {
  const double y = s.disc_y_mm;
  const std::vector<Vec2> profile{{40.0, y + 22.0},
                                  {88.0, y + 22.0},
                                  {92.0, y + 16.0},
                                  {94.0, y + 1.0},
                                  {100.0, y},
                                  {s.disc_radius_mm - 2.0, y},
                                  {s.disc_radius_mm, y - 2.0},
                                  {s.disc_radius_mm, y - 30.0}};
  constexpr double crease_deg = 30.0;
  return with_normals(revolve(profile, 48), crease_deg);
}

/// The sheet behind the brake: without it the lit room shows through the spokes of the far wheel, where the floor's
/// mirror image looks up under the car.
Patch build_dust_shield(const WheelShape& s) {
  constexpr double behind_disc_mm = 34.0;  // clear of the disc's own 30 mm
  constexpr double sheet_mm = 3.0;
  constexpr double gap_mm = 32.0;  // to the barrel's narrowest ring, which it nearly touches
  const double y = s.disc_y_mm - behind_disc_mm, edge = s.rim_radius_mm - gap_mm;
  const std::vector<Vec2> profile{{30.0, y}, {edge, y}, {edge, y - sheet_mm}, {30.0, y - sheet_mm}};
  constexpr double crease_deg = 30.0;
  return with_normals(revolve(profile, 36), crease_deg);
}

Patch build_caliper(const WheelShape& s) {
  // An arc around the disc's edge, behind the axle (the car's front is +x; calipers look best at the trailing side).
  constexpr int steps = 14;
  constexpr double half_angle_deg = 34.0;
  const std::vector<Vec2> section{{118.0, -36.0}, {116.0, 24.0}, {124.0, 32.0},
                                  {188.0, 34.0},  {206.0, 22.0}, {208.0, -36.0}};
  Patch caliper = grid(steps + 1, static_cast<int>(section.size()), [&](int i, int j) {
    const double t = 2.0 * i / steps - 1.0;
    const double a = (-90.0 - half_angle_deg * t) * 3.14159265358979 / 180.0;
    const double taper = 1.0 - 0.18 * std::pow(std::abs(t), 6.0);
    const Vec2 q = section[static_cast<std::size_t>(j)];
    return Vec3{q.x * std::sin(a), s.disc_y_mm + q.y * taper, q.x * std::cos(a)};
  });
  constexpr double crease_deg = 40.0;
  return with_normals(caliper, crease_deg);
}

}  // namespace

WheelPatches build_wheel(const WheelLayout& layout, const WheelShape& shape) {
  WheelPatches wheel;
  wheel.tyre = build_tyre(layout, shape);
  wheel.rim = build_barrel(layout, shape);
  append(wheel.rim, build_hub(shape));
  append(wheel.rim, build_disc(shape));
  append(wheel.rim, build_dust_shield(shape));
  for (int pair = 0; pair < shape.spoke_pairs; ++pair) {
    const double angle = 360.0 * pair / shape.spoke_pairs;
    for (const double side : {-1.0, 1.0}) append(wheel.rim, rotated_about_y(build_blade(shape, side), angle));
  }
  wheel.caliper = build_caliper(shape);
  const double y = shape.spoke_hub_y_mm;
  const std::vector<Vec2> cap{{0.0, y + 3.0}, {20.0, y + 2.4}, {30.0, y + 1.0}, {35.0, y - 3.0}};
  constexpr double smooth_deg = 60.0;
  wheel.cap = with_normals(revolve(cap, 28), smooth_deg);
  return wheel;
}

}  // namespace lackwerk::packs::car
