// Shapes the interface is drawn of, on a Cairo context in the picture's pixels.
//
// Why it exists: glass, discs and knobs look alike everywhere. Draws only; owns nothing; one thread a context.
#pragma once

#include <cairo.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/theme.hpp"

namespace lackwerk::kiosk::ui {

struct CairoDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_pattern_t* pattern) const { cairo_pattern_destroy(pattern); }
};
using CairoContext = std::unique_ptr<cairo_t, CairoDeleter>;
using CairoSurface = std::unique_ptr<cairo_surface_t, CairoDeleter>;
using CairoPattern = std::unique_ptr<cairo_pattern_t, CairoDeleter>;

void set_colour(cairo_t* cr, const Colour& colour);
void add_stop(cairo_pattern_t* pattern, double at, const Colour& colour);

void rounded_path(cairo_t* cr, const Rect& rect, double radius);
/// A panel of dark glass with a hair of light along its edge, `line` px wide.
void draw_glass(cairo_t* cr, const Rect& rect, double radius, const Colour& fill, double line);
/// A bright outline with a glow outwards of `glow` px.
void draw_focus(cairo_t* cr, const Rect& rect, double radius, double line, double glow);
/// A soft round shadow below a disc.
void draw_shadow(cairo_t* cr, Place centre, double radius, double blur);
void draw_ring(cairo_t* cr, Place centre, double radius, double line, const Colour& colour);
void draw_disc(cairo_t* cr, Place centre, double radius, const Colour& colour);
void draw_line(cairo_t* cr, Place from, Place to, double line, const Colour& colour);
/// A line whose colour runs through `colours`.
void draw_gradient_line(cairo_t* cr, Place from, Place to, double line, std::span<const Colour> colours);

/// A glossy disc of a paint. `rgb`: square picture of it, `edge_px` a side, or empty for `mean`.
void draw_swatch(cairo_t* cr, Place centre, double radius, std::span<const std::uint8_t> rgb, int edge_px,
                 const Colour& mean);

/// An opaque picture of RGB rows; none if it is not `width` x `height`.
[[nodiscard]] CairoSurface picture_of(std::span<const std::uint8_t> rgb, int width, int height);

}  // namespace lackwerk::kiosk::ui
