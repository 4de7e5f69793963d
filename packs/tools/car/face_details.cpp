#include "packs/tools/car/face_details.hpp"

#include <cmath>
#include <cstddef>

namespace lackwerk::packs::car {

namespace {

/// Millimetres.
struct FaceShape {
  int grille_bars = 7;
  double bar_depth_mm = 13.0;  ///< behind the surface
  double bar_half_height_mm = 5.0;
  double bar_length_mm = 26.0;  ///< front to back
  double bright_half_height_mm = 1.6;
  double fin_half_width_mm = 6.0;
  double aerial_x_mm = -770.0;
  double aerial_length_mm = 150.0;
  double aerial_height_mm = 42.0;
};

constexpr int wide_stations = 25;  // of a bar across the whole nose

/// Where the body's skin is met looking along x from far in front (`forward` = 1) or behind (-1).
Vec3 skin_along_x(const BodyField& body, double y, double z, double forward) {
  double inside = 1500.0 * forward;
  double outside = 2600.0 * forward;
  constexpr int halvings = 30;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (body.value({middle, y, z}) < 0.0 ? inside : outside) = middle;
  }
  return {inside, y, z};
}

/// Half the width of an outline in the end view at height z.
double half_width_at(const Outline& outline, double z) {
  double inside = 0.0;
  double outside = 1000.0;
  constexpr int halvings = 30;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (outline.distance({middle, z}) < 0.0 ? inside : outside) = middle;
  }
  return inside;
}

/// A bar across the nose at height z that follows the skin; its section is a rounded wedge.
Patch bar(const BodyField& body, double z, Vec2 y_range, int stations, double depth, double half_height,
          double length) {
  const std::array<Vec2, 7> section{
      Vec2{-length, -half_height * 0.6}, Vec2{-4.0, -half_height}, Vec2{-1.0, -half_height * 0.7},  Vec2{0.0, 0.0},
      Vec2{-1.0, half_height * 0.7},     Vec2{-4.0, half_height},  Vec2{-length, half_height * 0.6}};
  const Patch strip = grid(stations, static_cast<int>(section.size()), [&](int r, int c) {
    const double y = y_range.x + (y_range.y - y_range.x) * r / (stations - 1);
    const Vec2 q = section[static_cast<std::size_t>(c)];
    return skin_along_x(body, y, z, 1.0) + Vec3{q.x - depth, 0.0, q.y};
  });
  constexpr double smooth_deg = 50.0;
  return with_normals(strip, smooth_deg);
}

/// Blades in the intakes at the corners of the bumper.
void add_intake_blades(FacePatches& face, const BodyField& body, const Outline& intake) {
  constexpr int blades = 4;
  double low = 1e9;
  double high = -1e9;
  for (const Vec2& p : intake.points()) {
    low = std::fmin(low, p.y);
    high = std::fmax(high, p.y);
  }
  for (int i = 1; i <= blades; ++i) {
    const double z = low + (high - low) * i / (blades + 1.0);
    // The outline's extent at this height, by walking across it.
    double from = 1e9;
    double to = -1e9;
    constexpr int reach_mm = 1000;
    for (int y_mm = 0; y_mm < reach_mm; ++y_mm) {
      const double y = y_mm;
      if (intake.distance({y, z}) >= 0.0) continue;
      from = std::fmin(from, y);
      to = std::fmax(to, y);
    }
    const Patch left = bar(body, z, {from, to}, 7, 22.0, 5.0, 34.0);
    append(face.trim, left);
    append(face.trim, mirrored_y(left));
  }
}

void add_grille(FacePatches& face, const BodyField& body, const GraphicsShape& graphics, const FaceShape& s) {
  const Outline grille(graphics.grille);
  const double low = graphics.grille[2].at.y;
  const double high = graphics.grille[0].at.y;
  for (int i = 0; i < s.grille_bars; ++i) {
    const double z = low + (high - low) * (i + 1.0) / (s.grille_bars + 1.0);
    const double half = half_width_at(grille, z) - graphics.grille_frame_mm;
    append(face.trim,
           bar(body, z, {-half, half}, wide_stations, s.bar_depth_mm, s.bar_half_height_mm, s.bar_length_mm));
    append(face.bright, bar(body, z, {-half, half}, wide_stations, s.bar_depth_mm - 1.5, s.bright_half_height_mm, 4.0));
  }
  const Outline low_intake(graphics.low_intake);
  const double middle_z = 0.5 * (graphics.low_intake[0].at.y + graphics.low_intake[1].at.y);
  const double low_half = half_width_at(low_intake, middle_z);
  append(face.trim, bar(body, middle_z, {-low_half, low_half}, wide_stations, 20.0, 6.0, 40.0));
  add_intake_blades(face, body, Outline(graphics.side_intake));
}

void add_tail(FacePatches& face, const BodyField& body, const GraphicsShape& graphics, const FaceShape& s) {
  constexpr double fin_z_mm = 345.0;
  for (const double y : {-420.0, -250.0, -84.0, 84.0, 250.0, 420.0}) {
    const Vec3 root = skin_along_x(body, y, fin_z_mm, -1.0);
    append(face.trim, rounded_box(root + Vec3{50.0, 0.0, -14.0}, {56.0, s.fin_half_width_mm, 42.0}, 5.0));
  }
  const double plate_z = 0.5 * (graphics.plate_recess[0].at.y + graphics.plate_recess[1].at.y);
  const Vec3 plate = skin_along_x(body, 0.0, plate_z, -1.0);
  append(face.trim, rounded_box(plate + Vec3{14.0, 0.0, 0.0}, {7.0, 258.0, 55.0}, 4.0));
}

/// The shark fin on the roof.
Patch build_aerial(const BodyField& body, const FaceShape& s) {
  double roof = 1200.0;
  constexpr int halvings = 18;  // 200 mm to below a micrometre
  double step = 200.0;
  for (int k = 0; k < halvings; ++k, step *= 0.5) {
    if (body.value({s.aerial_x_mm, 0.0, roof + step}) < 0.0) roof += step;
  }
  constexpr int stations = 15;
  constexpr int around = 11;
  const Patch fin = grid(stations, around, [&](int r, int c) {
    const double t = static_cast<double>(r) / (stations - 1);  // 0 at the tail, 1 at the tip of the nose
    const double side = 2.0 * c / (around - 1) - 1.0;
    const double height = s.aerial_height_mm * std::pow(1.0 - t, 0.75) * (1.0 - 0.25 * std::pow(1.0 - t, 8.0));
    const double half_width = 26.0 * std::sqrt(std::fmax(0.0, 1.0 - std::pow(t, 3.0)));
    const double x = s.aerial_x_mm + s.aerial_length_mm * (t - 0.5);
    const double up = std::pow(std::fmax(0.0, 1.0 - std::pow(std::abs(side), 1.6)), 1.1);
    const double slope = 0.16;  // of the roof here
    return Vec3{x - 30.0 * up * (1.0 - t), -side * half_width, roof - 8.0 + slope * (x - s.aerial_x_mm) + height * up};
  });
  constexpr double smooth_deg = 60.0;
  return with_normals(reversed(fin), smooth_deg);
}

}  // namespace

FacePatches build_face_details(const BodyField& body, const GraphicsShape& graphics) {
  const FaceShape shape;
  FacePatches face;
  add_grille(face, body, graphics, shape);
  add_tail(face, body, graphics, shape);
  append(face.paint, build_aerial(body, shape));
  return face;
}

}  // namespace lackwerk::packs::car
