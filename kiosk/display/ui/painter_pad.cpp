// The paint pad: glass with the paints' colours in it, swatches, their names, the puck, and the hand that hints.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "kiosk/display/ui/paint_pad.hpp"
#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Cells along the pad's edge of the coarse picture of its mixes; Cairo smooths between them.
constexpr int field_cells = 28;
/// Of the paints' display values: colours that are seen, and dark enough that names on them keep their contrast (white
/// paint over white: 0.36, luminance 0.106, where `text` has 6:1).
constexpr double field_gain = 0.38;
constexpr double field_alpha = 0.7;

Place on_field(const Rect& field, Place place) {
  return {field.x + std::clamp(place[0], 0.0, 1.0) * field.width,
          field.y + std::clamp(place[1], 0.0, 1.0) * field.height};
}

/// What each place of the pad would mix, as a dim glow.
CairoSurface field_picture(const Look& look, const Rect& pad, const Rect& field) {
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, field_cells, field_cells));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return {};
  unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  const std::vector<PaintFacts>& paints = look.content.paints;
  for (int y = 0; y < field_cells; ++y)
    for (int x = 0; x < field_cells; ++x) {
      const double px = pad.x + (x + 0.5) / field_cells * pad.width, py = pad.y + (y + 0.5) / field_cells * pad.height;
      const Place place{(px - field.x) / field.width, (py - field.y) / field.height};
      const std::vector<double> weights = pad_weights(look.model.swatches, place);
      std::array<double, 3> mix{};
      for (std::size_t k = 0; k < std::min(weights.size(), paints.size()); ++k)
        for (std::size_t c = 0; c < 3; ++c) mix[c] += weights[k] * paints[k].srgb[c];
      std::uint32_t pixel = 0;
      for (const double value : mix)
        pixel =
            (pixel << 8U) | static_cast<std::uint32_t>(std::lround(255.0 * field_gain * std::clamp(value, 0.0, 1.0)));
      std::memcpy(rows + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4, &pixel,
                  sizeof pixel);
    }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void draw_field(const Look& look, cairo_t* cr, const Rect& pad, const Rect& field) {
  const CairoSurface picture = field_picture(look, pad, field);
  if (!picture) return;
  cairo_save(cr);
  rounded_path(cr, pad, corner(look));
  cairo_clip(cr);
  cairo_translate(cr, pad.x, pad.y);
  cairo_scale(cr, pad.width / field_cells, pad.height / field_cells);
  cairo_set_source_surface(cr, picture.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_BILINEAR);
  cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD);
  cairo_paint_with_alpha(cr, field_alpha);
  cairo_restore(cr);
}

void paint_glass(const Look& look, const Rect& pad, const Rect& field) {
  const Model& model = look.model;
  const bool focused = model.focus == Widget::pad;
  const bool slider = model.swatches.size() == 2;
  // While a swatch is moved, its colours are not chased: a pad that is drawn in every frame costs more than the frame.
  const bool coloured = model.swatch_held < 0;
  Key key(look.base, focused, coloured, look.content.paints.size());
  if (coloured || slider)
    for (const Place& place : model.swatches) key.add(place[0]).add(place[1]);
  if (coloured)
    for (const PaintFacts& paint : look.content.paints)
      for (const double value : paint.srgb) key.add(value);
  look.tiles.show(TileKind::pad, 0, key, focused ? grown(pad, halo(look)) : pad, [&](cairo_t* cr) {
    draw_glass(cr, pad, corner(look), glass, look.line);
    if (coloured) draw_field(look, cr, pad, field);
    if (slider)
      draw_line(cr, on_field(field, model.swatches[0]), on_field(field, model.swatches[1]), 2.0 * look.line, track);
    if (focused) draw_focus(cr, pad, corner(look), 4.0 * look.line, halo(look));
  });
}

/// The name under a swatch with the small "i"; as wide as it is, below its disc as far as the pad goes.
void paint_label(const Look& look, const Item& item, const Rect& pad, Place disc) {
  const auto paint = static_cast<std::size_t>(item.index);
  if (paint >= look.content.paints.size()) return;
  const std::string_view name = short_name(look.content.paints[paint].identity.name);
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  const TextStyle style = look.style(0.86, now.pressed || now.focused ? Weight::medium : Weight::regular,
                                     now.focused ? accent : text_colour);
  const double icon = std::round(0.86 * look.m.text), gap = std::round(0.4 * look.m.text);
  const double side = std::ceil(0.2 * look.m.text);
  const double text_width = std::ceil(look.size_of(name, style, item.rect.width - icon - gap - 2.0 * side)[0]) + 1.0;
  const double width = text_width + gap + icon + 2.0 * side;
  const double least = pad.x + 0.5 * look.m.margin, most = pad.x + pad.width - 0.5 * look.m.margin - width;
  const Rect rect =
      whole({std::clamp(disc[0] - width / 2.0, least, std::max(least, most)), item.rect.y, width, item.rect.height});
  look.tiles.show(TileKind::label, item.index, Key(look.base, name, now.pressed, now.focused), rect, [&](cairo_t* cr) {
    const Rect inner = shrunk({rect.x, rect.y, rect.width, rect.height}, side);
    look.fonts.draw(cr, name, style, {look.leading(inner, text_width).x, rect.y, text_width, rect.height});
    const Rect end = look.after(inner, inner.width - icon);
    draw_icon(cr, Icon::info, middle_px({end.x, rect.y, icon, rect.height}), icon, now.focused ? accent : quiet);
  });
}

void paint_swatch(const Look& look, const Item& item, Place disc) {
  const auto paint = static_cast<std::size_t>(item.index);
  if (paint >= look.content.paints.size()) return;
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  const bool lifted = look.model.swatch_held == item.index;
  const SwatchView picture = look.picture_of_paint(paint);
  const double radius = look.m.swatch / 2.0 * (lifted || now.focused ? 1.1 : 1.0);
  const double room = std::ceil(0.5 * look.m.swatch * 0.36);
  const double side = look.m.swatch + 2.0 * room;
  const Rect rect = whole({disc[0] - side / 2.0, disc[1] - side / 2.0, side, side});
  const std::array<double, 3>& mean = look.content.paints[paint].srgb;
  const Key key(look.base, picture.version, mean[0], mean[1], mean[2], lifted, now.focused);
  look.tiles.show(TileKind::swatch, item.index, key, rect, [&](cairo_t* cr) {
    const Place centre = rect.centre();
    draw_shadow(cr, centre, radius, (lifted ? 0.9 : 0.6) * room);
    draw_swatch(cr, centre, radius, picture.rgb, picture.edge_px, {mean[0], mean[1], mean[2]});
    if (now.focused) draw_ring(cr, centre, radius + 2.0 * look.line, 4.0 * look.line, accent);
  });
}

void paint_puck(const Look& look, const Rect& field) {
  const Model& model = look.model;
  const bool focused = model.focus == Widget::pad;
  const double side = 2.0 * std::round(0.76 * look.m.swatch);
  const Place at = on_field(field, model.puck);
  const Rect rect{std::round(at[0] - side / 2.0), std::round(at[1] - side / 2.0), side, side};
  look.tiles.show(TileKind::puck, 0, Key(look.base, model.puck_held, focused), rect, [&](cairo_t* cr) {
    const Place centre = rect.centre();
    const double radius = 0.58 * look.m.swatch, line = 2.5 * look.line;
    const Colour colour = focused ? accent : text_colour;
    // A glow to both sides of the ring; what is below stays as it is.
    const double reach = side / 2.0 - radius;
    const CairoPattern glow(
        cairo_pattern_create_radial(centre[0], centre[1], radius - reach, centre[0], centre[1], radius + reach));
    const double strength = model.puck_held ? 0.42 : 0.24;
    add_stop(glow.get(), 0.0, colour.with(0.0));
    add_stop(glow.get(), 0.4, colour.with(0.35 * strength));
    add_stop(glow.get(), 0.5, colour.with(strength));
    add_stop(glow.get(), 0.6, colour.with(0.35 * strength));
    add_stop(glow.get(), 1.0, colour.with(0.0));
    draw_ring(cr, centre, radius, 3.0 * line, {0.0, 0.0, 0.0, 0.28});
    cairo_set_source(cr, glow.get());
    cairo_arc(cr, centre[0], centre[1], radius + reach, 0.0, 7.0);
    cairo_fill(cr);
    draw_ring(cr, centre, radius, model.puck_held ? 1.3 * line : line, colour);
  });
}

}  // namespace

void paint_pad(const Look& look) {
  const auto pad_item = find_item(look.arrangement.items, Widget::pad);
  if (!pad_item) return;
  const Rect pad = pad_item->rect, field = pad_field(look.surface, pad);
  paint_glass(look, pad, field);
  const std::size_t paints = std::min(look.model.swatches.size(), look.content.paints.size());
  const auto disc = [&](int index) {
    const auto k = static_cast<std::size_t>(index);
    return k < paints ? on_field(field, look.model.swatches[k]) : field.centre();
  };
  for (const Item& item : look.arrangement.items)
    if (item.widget == Widget::swatch_about) paint_label(look, item, pad, disc(item.index));
  for (const Item& item : look.arrangement.items)
    if (item.widget == Widget::swatch) paint_swatch(look, item, disc(item.index));
  if (paints > 1) paint_puck(look, field);
  paint_hint(look);
}

void paint_hint(const Look& look) {
  const auto hint = look.arrangement.find(Part::hint);
  if (!hint) return;
  look.tiles.show(TileKind::hint, 0, look.base, *hint,
                  [&](cairo_t* cr) { draw_icon(cr, Icon::hand, hint->centre(), hint->width, text_colour); });
}

}  // namespace lackwerk::kiosk::ui
