#include "kiosk/display/ui/draw_icons.hpp"

#include <cmath>
#include <numbers>

#include "kiosk/display/ui/draw_shapes.hpp"

namespace lackwerk::kiosk::ui {
namespace {

constexpr double pi = std::numbers::pi;
/// Of lines, in the icons' own square, which reaches from -1 to 1: 1.6 px at 24 px.
constexpr double line = 0.135;

void segment(cairo_t* cr, double x0, double y0, double x1, double y1) {
  cairo_move_to(cr, x0, y0);
  cairo_line_to(cr, x1, y1);
}
void circle(cairo_t* cr, double x, double y, double r) {
  cairo_new_sub_path(cr);
  cairo_arc(cr, x, y, r, 0.0, 2.0 * pi);
}

/// Four points, the sides drawn in: light on a flake.
void star(cairo_t* cr, double x, double y, double r) {
  const double in = 0.13 * r;
  cairo_move_to(cr, x, y - r);
  cairo_curve_to(cr, x + in, y - in, x + in, y - in, x + r, y);
  cairo_curve_to(cr, x + in, y + in, x + in, y + in, x, y + r);
  cairo_curve_to(cr, x - in, y + in, x - in, y + in, x - r, y);
  cairo_curve_to(cr, x - in, y - in, x - in, y - in, x, y - r);
  cairo_close_path(cr);
}
void sparkle(cairo_t* cr) {
  star(cr, -0.18, 0.12, 0.8);
  star(cr, 0.62, -0.6, 0.36);
  cairo_fill(cr);
}

void droplet(cairo_t* cr) {
  const auto outline = [cr] {
    cairo_move_to(cr, 0.0, -0.92);
    cairo_curve_to(cr, 0.3, -0.45, 0.62, -0.1, 0.62, 0.3);
    cairo_arc(cr, 0.0, 0.3, 0.62, 0.0, pi);
    cairo_curve_to(cr, -0.62, -0.1, -0.3, -0.45, 0.0, -0.92);
    cairo_close_path(cr);
  };
  outline();
  cairo_stroke(cr);
  // Filled from below, as a colour that is given to the flakes.
  cairo_save(cr);
  cairo_rectangle(cr, -1.0, 0.22, 2.0, 1.0);
  cairo_clip(cr);
  outline();
  cairo_fill(cr);
  cairo_restore(cr);
}

/// A stem that bends, with a leaf to either side.
void sprout(cairo_t* cr) {
  cairo_move_to(cr, 0.0, 0.92);
  cairo_curve_to(cr, 0.06, 0.5, 0.06, 0.2, 0.0, -0.05);
  cairo_stroke(cr);
  const auto leaf = [cr](double side, double from_y, double reach, double rise) {
    cairo_move_to(cr, 0.0, from_y);
    cairo_curve_to(cr, 0.05 * side, from_y - 0.9 * rise, 0.5 * side * reach, from_y - 1.05 * rise, side * reach,
                   from_y - rise);
    cairo_curve_to(cr, side * reach, from_y - 0.35 * rise, 0.55 * side * reach, from_y + 0.08, 0.0, from_y);
    cairo_close_path(cr);
  };
  leaf(1.0, -0.02, 0.82, 0.8);
  cairo_fill(cr);
  leaf(-1.0, 0.3, 0.72, 0.6);
  cairo_stroke(cr);
}

/// An arrow that leaves a circle.
void beyond(cairo_t* cr) {
  cairo_arc(cr, -0.22, 0.22, 0.66, -0.1 * pi, 1.6 * pi);
  cairo_stroke(cr);
  segment(cr, -0.22, 0.22, 0.8, -0.8);
  segment(cr, 0.3, -0.82, 0.82, -0.82);
  segment(cr, 0.82, -0.82, 0.82, -0.3);
  cairo_stroke(cr);
}

void lock(cairo_t* cr, bool open) {
  rounded_path(cr, {-0.58, -0.08, 1.16, 0.9}, 0.16);
  cairo_stroke(cr);
  if (open) {
    // The shackle has swung out.
    cairo_move_to(cr, 0.36, -0.08);
    cairo_line_to(cr, 0.36, -0.45);
    cairo_arc(cr, 0.7, -0.45, 0.34, pi, 2.0 * pi);
    cairo_line_to(cr, 1.04, -0.28);
  } else {
    cairo_move_to(cr, -0.34, -0.08);
    cairo_line_to(cr, -0.34, -0.45);
    cairo_arc(cr, 0.0, -0.45, 0.34, pi, 2.0 * pi);
    cairo_line_to(cr, 0.34, -0.08);
  }
  cairo_stroke(cr);
}

/// A soft box on the ceiling and what it sends down.
void soft_box(cairo_t* cr) {
  rounded_path(cr, {-0.82, -0.72, 1.64, 0.5}, 0.12);
  cairo_fill_preserve(cr);
  cairo_stroke(cr);
  for (const double x : {-0.5, 0.0, 0.5}) segment(cr, x, 0.12, 1.35 * x, 0.78);
  cairo_stroke(cr);
}

void sun(cairo_t* cr) {
  circle(cr, 0.0, 0.0, 0.4);
  cairo_fill_preserve(cr);
  cairo_stroke(cr);
  for (int k = 0; k < 8; ++k) {
    const double x = std::cos(k * pi / 4.0), y = std::sin(k * pi / 4.0);
    segment(cr, 0.68 * x, 0.68 * y, 0.94 * x, 0.94 * y);
  }
  cairo_stroke(cr);
}

/// The sun on the horizon, its light to the sides and up.
void evening(cairo_t* cr) {
  cairo_arc(cr, 0.0, 0.3, 0.44, pi, 2.0 * pi);
  cairo_close_path(cr);
  cairo_fill_preserve(cr);
  cairo_stroke(cr);
  segment(cr, -0.94, 0.62, 0.94, 0.62);
  for (const double angle : {1.1, 1.5, 1.9}) {
    const double x = std::cos(angle * pi), y = std::sin(angle * pi);
    segment(cr, 0.7 * x, 0.3 + 0.7 * y, 0.96 * x, 0.3 + 0.96 * y);
  }
  cairo_stroke(cr);
}

void moon(cairo_t* cr) {
  // A disc of radius 0.8 less one that is moved by 0.5 to the upper right; both meet where their chord says.
  const double r = 0.8, d = 0.5, chord = std::acos(d / 2.0 / r), away = -pi / 4.0;
  cairo_arc_negative(cr, 0.0, 0.0, r, away - chord, away + chord);
  cairo_arc(cr, d * std::cos(away), d * std::sin(away), r, away + pi - chord, away + pi + chord);
  cairo_close_path(cr);
  cairo_stroke(cr);
}

/// Two halves of one picture.
void compare(cairo_t* cr) {
  rounded_path(cr, {-0.9, -0.62, 1.8, 1.24}, 0.18);
  cairo_stroke(cr);
  segment(cr, 0.0, -0.9, 0.0, 0.9);
  cairo_stroke(cr);
  cairo_save(cr);
  cairo_rectangle(cr, 0.0, -1.0, 1.0, 2.0);
  cairo_clip(cr);
  rounded_path(cr, {-0.9, -0.62, 1.8, 1.24}, 0.18);
  cairo_fill(cr);
  cairo_restore(cr);
}

void qr(cairo_t* cr) {
  for (const Place corner : {Place{-0.85, -0.85}, Place{0.19, -0.85}, Place{-0.85, 0.19}}) {
    rounded_path(cr, {corner[0], corner[1], 0.66, 0.66}, 0.08);
    cairo_stroke(cr);
    cairo_rectangle(cr, corner[0] + 0.23, corner[1] + 0.23, 0.2, 0.2);
    cairo_fill(cr);
  }
  for (const Place dot :
       {Place{0.15, 0.15}, Place{0.47, 0.47}, Place{0.73, 0.15}, Place{0.15, 0.73}, Place{0.73, 0.73}})
    cairo_rectangle(cr, dot[0], dot[1], 0.2, 0.2);
  cairo_fill(cr);
}

void info(cairo_t* cr) {
  circle(cr, 0.0, 0.0, 0.88);
  cairo_stroke(cr);
  segment(cr, 0.0, -0.02, 0.0, 0.44);
  cairo_stroke(cr);
  circle(cr, 0.0, -0.42, 0.8 * line);
  cairo_fill(cr);
}

/// A pointing finger; its tip is the middle of the upper edge.
void hand(cairo_t* cr) {
  cairo_move_to(cr, -0.2, 0.28);
  cairo_line_to(cr, -0.2, -0.78);
  cairo_arc(cr, -0.02, -0.78, 0.18, pi, 2.0 * pi);
  cairo_line_to(cr, 0.16, -0.16);
  cairo_curve_to(cr, 0.16, -0.42, 0.46, -0.4, 0.46, -0.12);
  cairo_curve_to(cr, 0.48, -0.34, 0.76, -0.3, 0.76, -0.02);
  cairo_line_to(cr, 0.76, 0.36);
  cairo_curve_to(cr, 0.76, 0.8, 0.52, 0.96, 0.16, 0.96);
  cairo_curve_to(cr, -0.22, 0.96, -0.34, 0.8, -0.5, 0.52);
  cairo_line_to(cr, -0.74, 0.14);
  cairo_curve_to(cr, -0.86, -0.08, -0.6, -0.22, -0.44, -0.04);
  cairo_close_path(cr);
}

void erase(cairo_t* cr) {
  cairo_move_to(cr, -0.95, 0.0);
  cairo_line_to(cr, -0.4, -0.6);
  cairo_line_to(cr, 0.9, -0.6);
  cairo_line_to(cr, 0.9, 0.6);
  cairo_line_to(cr, -0.4, 0.6);
  cairo_close_path(cr);
  segment(cr, 0.0, -0.25, 0.5, 0.25);
  segment(cr, 0.0, 0.25, 0.5, -0.25);
  cairo_stroke(cr);
}

/// The signs that are a few lines.
void strokes(cairo_t* cr, Icon icon) {
  if (icon == Icon::close) {
    segment(cr, -0.6, -0.6, 0.6, 0.6);
    segment(cr, -0.6, 0.6, 0.6, -0.6);
  } else if (icon == Icon::check) {
    cairo_move_to(cr, -0.75, 0.05);
    cairo_line_to(cr, -0.2, 0.6);
    cairo_line_to(cr, 0.8, -0.55);
  } else {
    segment(cr, -0.7, 0.0, 0.7, 0.0);
    if (icon == Icon::plus) segment(cr, 0.0, -0.7, 0.0, 0.7);
  }
  cairo_stroke(cr);
}

}  // namespace

void draw_icon(cairo_t* cr, Icon icon, Place centre, double size, const Colour& colour) {
  cairo_save(cr);
  cairo_translate(cr, centre[0], centre[1]);
  cairo_scale(cr, size / 2.0, size / 2.0);
  cairo_new_path(cr);
  set_colour(cr, colour);
  cairo_set_line_width(cr, line);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  switch (icon) {
    case Icon::sparkle:
      sparkle(cr);
      break;
    case Icon::droplet:
      droplet(cr);
      break;
    case Icon::beyond:
      beyond(cr);
      break;
    case Icon::lock_open:
    case Icon::lock_closed:
      lock(cr, icon == Icon::lock_open);
      break;
    case Icon::soft_box:
      soft_box(cr);
      break;
    case Icon::sun:
      sun(cr);
      break;
    case Icon::evening:
      evening(cr);
      break;
    case Icon::moon:
      moon(cr);
      break;
    case Icon::sprout:
      sprout(cr);
      break;
    case Icon::compare:
      compare(cr);
      break;
    case Icon::qr:
      qr(cr);
      break;
    case Icon::info:
      info(cr);
      break;
    case Icon::hand:
      hand(cr);
      set_colour(cr, {0.05, 0.055, 0.06, 0.72});
      cairo_fill_preserve(cr);
      set_colour(cr, colour);
      cairo_stroke(cr);
      break;
    case Icon::erase:
      erase(cr);
      break;
    case Icon::close:
    case Icon::check:
    case Icon::minus:
    case Icon::plus:
      strokes(cr, icon);
      break;
  }
  cairo_restore(cr);
}

}  // namespace lackwerk::kiosk::ui
