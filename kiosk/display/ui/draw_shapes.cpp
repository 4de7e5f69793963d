#include "kiosk/display/ui/draw_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace lackwerk::kiosk::ui {
namespace {
constexpr double pi = std::numbers::pi;
}

void set_colour(cairo_t* cr, const Colour& colour) {
  cairo_set_source_rgba(cr, colour.r, colour.g, colour.b, colour.a);
}

void add_stop(cairo_pattern_t* pattern, double at, const Colour& colour) {
  cairo_pattern_add_color_stop_rgba(pattern, at, colour.r, colour.g, colour.b, colour.a);
}

void rounded_path(cairo_t* cr, const Rect& rect, double radius) {
  const double r = std::max(0.0, std::min({radius, rect.width / 2.0, rect.height / 2.0}));
  const double right = rect.x + rect.width, bottom = rect.y + rect.height;
  cairo_new_sub_path(cr);
  cairo_arc(cr, right - r, rect.y + r, r, -pi / 2.0, 0.0);
  cairo_arc(cr, right - r, bottom - r, r, 0.0, pi / 2.0);
  cairo_arc(cr, rect.x + r, bottom - r, r, pi / 2.0, pi);
  cairo_arc(cr, rect.x + r, rect.y + r, r, pi, 1.5 * pi);
  cairo_close_path(cr);
}

void draw_glass(cairo_t* cr, const Rect& rect, double radius, const Colour& fill, double line) {
  rounded_path(cr, rect, radius);
  set_colour(cr, fill);
  cairo_fill(cr);
  const Rect inner{rect.x + line / 2.0, rect.y + line / 2.0, rect.width - line, rect.height - line};
  rounded_path(cr, inner, radius - line / 2.0);
  // Light falls from above: the edge is brightest there.
  const CairoPattern edge(cairo_pattern_create_linear(0.0, rect.y, 0.0, rect.y + rect.height));
  add_stop(edge.get(), 0.0, hairline.with(1.6 * hairline.a));
  add_stop(edge.get(), 1.0, hairline.with(0.5 * hairline.a));
  cairo_set_source(cr, edge.get());
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

void draw_focus(cairo_t* cr, const Rect& rect, double radius, double line, double glow) {
  constexpr int steps = 6;
  for (int k = steps; k >= 1; --k) {
    const double out = glow * k / steps;
    rounded_path(cr, {rect.x - out / 2.0, rect.y - out / 2.0, rect.width + out, rect.height + out}, radius + out / 2.0);
    set_colour(cr, accent.with(0.09));
    cairo_set_line_width(cr, line + out);
    cairo_stroke(cr);
  }
  rounded_path(cr, rect, radius);
  set_colour(cr, accent);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

void draw_shadow(cairo_t* cr, Place centre, double radius, double blur) {
  const double y = centre[1] + 0.25 * blur;
  const CairoPattern soft(
      cairo_pattern_create_radial(centre[0], y, std::max(0.0, radius - blur), centre[0], y, radius + blur));
  add_stop(soft.get(), 0.0, shadow);
  add_stop(soft.get(), 0.5, shadow.with(0.4 * shadow.a));
  add_stop(soft.get(), 1.0, shadow.with(0.0));
  cairo_set_source(cr, soft.get());
  cairo_arc(cr, centre[0], y, radius + blur, 0.0, 2.0 * pi);
  cairo_fill(cr);
}

void draw_ring(cairo_t* cr, Place centre, double radius, double line, const Colour& colour) {
  cairo_new_sub_path(cr);
  cairo_arc(cr, centre[0], centre[1], radius, 0.0, 2.0 * pi);
  set_colour(cr, colour);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

void draw_disc(cairo_t* cr, Place centre, double radius, const Colour& colour) {
  cairo_new_sub_path(cr);
  cairo_arc(cr, centre[0], centre[1], radius, 0.0, 2.0 * pi);
  set_colour(cr, colour);
  cairo_fill(cr);
}

void draw_line(cairo_t* cr, Place from, Place to, double line, const Colour& colour) {
  cairo_move_to(cr, from[0], from[1]);
  cairo_line_to(cr, to[0], to[1]);
  set_colour(cr, colour);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

void draw_gradient_line(cairo_t* cr, Place from, Place to, double line, std::span<const Colour> colours) {
  if (colours.empty()) return;
  const CairoPattern run(cairo_pattern_create_linear(from[0], from[1], to[0], to[1]));
  const double last = std::max<double>(1.0, static_cast<double>(colours.size() - 1));
  for (std::size_t k = 0; k < colours.size(); ++k) add_stop(run.get(), static_cast<double>(k) / last, colours[k]);
  cairo_move_to(cr, from[0], from[1]);
  cairo_line_to(cr, to[0], to[1]);
  cairo_set_source(cr, run.get());
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(cr, line);
  cairo_stroke(cr);
}

CairoSurface picture_of(std::span<const std::uint8_t> rgb, int width, int height) {
  if (width <= 0 || height <= 0 || rgb.size() != 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return {};
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return {};
  unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  std::size_t at = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, at += 3) {
      const std::uint32_t pixel =
          (static_cast<std::uint32_t>(rgb[at]) << 16U) | (static_cast<std::uint32_t>(rgb[at + 1]) << 8U) | rgb[at + 2];
      std::memcpy(rows + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4, &pixel,
                  sizeof pixel);
    }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void draw_swatch(cairo_t* cr, Place centre, double radius, std::span<const std::uint8_t> rgb, int edge_px,
                 const Colour& mean) {
  cairo_save(cr);
  cairo_new_sub_path(cr);
  cairo_arc(cr, centre[0], centre[1], radius, 0.0, 2.0 * pi);
  cairo_clip_preserve(cr);
  const CairoSurface picture = picture_of(rgb, edge_px, edge_px);
  if (picture) {
    const double scale = 2.0 * radius / edge_px;
    cairo_save(cr);
    cairo_translate(cr, centre[0] - radius, centre[1] - radius);
    cairo_scale(cr, scale, scale);
    cairo_set_source_surface(cr, picture.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_GOOD);
    cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD);
    cairo_fill(cr);
    cairo_restore(cr);
  } else {
    // As a ball of this paint would look under a soft light: the colour, falling off downwards.
    const CairoPattern ball(cairo_pattern_create_radial(centre[0] - 0.3 * radius, centre[1] - 0.4 * radius,
                                                        0.1 * radius, centre[0], centre[1], 1.15 * radius));
    const auto lit = [&](double gain, double add) {
      return Colour{std::min(1.0, mean.r * gain + add), std::min(1.0, mean.g * gain + add),
                    std::min(1.0, mean.b * gain + add)};
    };
    add_stop(ball.get(), 0.0, lit(1.0, 0.16));
    add_stop(ball.get(), 0.35, lit(1.0, 0.0));
    add_stop(ball.get(), 1.0, lit(0.42, 0.0));
    cairo_set_source(cr, ball.get());
    cairo_fill(cr);
  }
  // The clear coat's reflection of a soft box above.
  cairo_new_path(cr);
  const CairoPattern gloss(cairo_pattern_create_linear(0.0, centre[1] - radius, 0.0, centre[1]));
  add_stop(gloss.get(), 0.0, {1.0, 1.0, 1.0, 0.28});
  add_stop(gloss.get(), 1.0, {1.0, 1.0, 1.0, 0.02});
  cairo_save(cr);
  cairo_translate(cr, centre[0], centre[1] - 0.5 * radius);
  cairo_scale(cr, 0.76 * radius, 0.42 * radius);
  cairo_arc(cr, 0.0, 0.0, 1.0, 0.0, 2.0 * pi);
  cairo_restore(cr);
  cairo_set_source(cr, gloss.get());
  cairo_fill(cr);
  cairo_restore(cr);
  const double line = std::max(1.0, radius / 24.0);
  draw_ring(cr, centre, radius - line / 2.0, line, {1.0, 1.0, 1.0, 0.34});
}

}  // namespace lackwerk::kiosk::ui
