// The attract screen, and all of a visitor's screen but the pad.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {
namespace {

struct SliderLook {
  Widget widget;
  Icon icon;
  double position;
  bool follows;  ///< the pad: its lock is closed
};

std::array<SliderLook, 5> sliders_of(const Model& model) {
  return {{{Widget::sparkle, Icon::sparkle, model.sparkle, !model.sparkle_free},
           {Widget::hue, Icon::droplet, model.hue, !model.hue_free},
           {Widget::beyond, Icon::beyond, model.beyond, false},
           {Widget::dimmer, Icon::moon, model.dimmer, false},
           {Widget::time, Icon::sprout, model.time, false}}};
}

Colour colour_of(const PaintFacts& paint, double alpha = 1.0) {
  return {paint.srgb[0], paint.srgb[1], paint.srgb[2], alpha};
}

/// Points of light that grow: calm to lively.
void draw_sparkle_track(const Look& look, cairo_t* cr, const Track& along, double alpha) {
  constexpr int points = 13;
  for (int k = 0; k < points; ++k) {
    const double t = static_cast<double>(k) / (points - 1);
    draw_disc(cr, along.at(t), look.line * (0.8 + 1.4 * t), text_colour.with(alpha * (0.35 + 0.65 * t)));
  }
}

/// Where the slider of time stands at each scan: what was measured, and not grown between.
void draw_scans(const Look& look, cairo_t* cr, const Track& along, double alpha) {
  const ScanFacts& scans = *look.content.scans;
  const double span = scans.times.back() - scans.times.front(), half = 0.13 * look.m.target;
  for (const double time : scans.times) {
    const Place at = along.at((time - scans.times.front()) / span);
    draw_line(cr, {at[0], at[1] - half}, {at[0], at[1] + half}, look.line, text_colour.with(0.75 * alpha));
  }
}

void draw_track(const Look& look, cairo_t* cr, Widget widget, const Track& along, double alpha) {
  const double line = 2.0 * look.line;
  if (widget == Widget::sparkle) return draw_sparkle_track(look, cr, along, alpha);
  if (widget == Widget::time && look.content.scans) draw_scans(look, cr, along, alpha);
  std::vector<Colour> colours;
  if (widget == Widget::hue) {
    // White flakes, then each paint's colour.
    colours.push_back(Colour{1.0, 1.0, 1.0, alpha});
    for (const PaintFacts& paint : look.content.paints) colours.push_back(colour_of(paint, alpha));
  } else if (widget == Widget::dimmer) {
    colours = {Colour{1.0, 1.0, 1.0, 0.85 * alpha}, Colour{1.0, 1.0, 1.0, 0.16 * alpha}};
  } else {
    colours = {Colour{1.0, 1.0, 1.0, 0.3 * alpha}, accent.with(0.9 * alpha)};
  }
  draw_gradient_line(cr, along.from, along.to, widget == Widget::hue ? 2.0 * line : line, colours);
}

void draw_slider(const Look& look, cairo_t* cr, const Item& item, const SliderLook& slider) {
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  if (now.focused) draw_emphasis(look, cr, item);
  const double alpha = now.dim ? dimmed : 1.0;
  const Rect head = look.leading(item.rect, 0.95 * look.m.target);
  Colour colour = now.focused ? accent : text_colour;
  colour.a = alpha;
  draw_icon(cr, slider.icon, middle_px(head), std::round((now.focused ? 0.52 : 0.42) * look.m.target), colour);
  draw_track(look, cr, item.widget, slider_track(look.surface, item, look.model.language),
             alpha * (slider.follows ? 0.7 : 1.0));
}

/// The knob of a slider: full where it is the visitor's, a ring where it follows the pad.
void paint_knob(const Look& look, const Item& item, const SliderLook& slider) {
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  const Place at = slider_track(look.surface, item, look.model.language).at(std::clamp(slider.position, 0.0, 1.0));
  const double side = 2.0 * std::round(0.36 * look.m.target);
  const Rect rect{std::round(at[0] - side / 2.0), std::round(at[1] - side / 2.0), side, side};
  const Key key(look.base, slider.follows, now.pressed, now.focused);
  look.tiles.show(
      TileKind::knob, static_cast<int>(item.widget), key, rect,
      [&](cairo_t* cr) {
        const Place centre = rect.centre();
        double radius = (slider.follows ? 0.15 : 0.2) * look.m.target;
        if (now.pressed || now.focused) radius += 0.05 * look.m.target;
        draw_shadow(cr, centre, radius, 0.16 * side);
        const Colour colour = now.focused ? accent : text_colour;
        if (slider.follows) {
          draw_disc(cr, centre, radius, {0.1, 0.105, 0.115});
          draw_ring(cr, centre, radius, 2.0 * look.line, colour);
        } else {
          draw_disc(cr, centre, radius, colour);
        }
      },
      now.dim ? static_cast<float>(dimmed) : 1.0f);
}

constexpr std::array slider_widgets{Widget::sparkle, Widget::hue, Widget::beyond, Widget::sparkle_lock,
                                    Widget::hue_lock};
constexpr std::array light_widgets{Widget::light, Widget::dimmer};
constexpr std::array time_widgets{Widget::time};
constexpr std::array dock_widgets{Widget::compare, Widget::take_home};

/// Tiles of kind panel.
constexpr int slider_panel = 0, light_panel = 1, dock_panel = 2, name_panel = 4, time_panel = 5;

void draw_control(const Look& look, cairo_t* cr, const Item& item) {
  constexpr std::array light_icons{Icon::soft_box, Icon::sun, Icon::evening};
  const Model& model = look.model;
  for (const SliderLook& slider : sliders_of(model))
    if (slider.widget == item.widget) return draw_slider(look, cr, item, slider);
  switch (item.widget) {
    case Widget::sparkle_lock:
      return draw_button(look, cr, item, model.sparkle_free ? Icon::lock_open : Icon::lock_closed, model.sparkle_free);
    case Widget::hue_lock:
      return draw_button(look, cr, item, model.hue_free ? Icon::lock_open : Icon::lock_closed, model.hue_free);
    case Widget::light:
      return draw_button(look, cr, item, light_icons[static_cast<std::size_t>(std::clamp(item.index, 0, 2))],
                         item.index == model.light);
    case Widget::compare:
      return draw_button(look, cr, item, Icon::compare, model.nearest.has_value());
    case Widget::take_home:
      return draw_button(look, cr, item, Icon::qr, false);
    default:
      return;
  }
}

/// Glass with its controls: one tile, for what is on it changes rarely; knobs are tiles of their own.
void paint_panel(const Look& look, int index, const Rect& rect, std::span<const Widget> widgets, const Key& state) {
  const std::vector<Item> items = items_of(look.arrangement, widgets);
  bool focused = false;
  for (const Item& item : items) focused = focused || emphasis_of(look.model, item.widget, item.index).focused;
  const Rect tile = focused ? grown(rect, halo(look)) : rect;
  look.tiles.show(TileKind::panel, index, Key(look.base, state, emphasis_key(look.model, items)), tile,
                  [&](cairo_t* cr) {
                    draw_glass(cr, rect, corner(look), glass, look.line);
                    for (const Item& item : items) draw_control(look, cr, item);
                  });
  for (const Item& item : items)
    for (const SliderLook& slider : sliders_of(look.model))
      if (slider.widget == item.widget) paint_knob(look, item, slider);
}

Rect bounds(std::span<const Item> items) {
  Rect out = items.front().rect;
  for (const Item& item : items) {
    const double right = std::max(out.x + out.width, item.rect.x + item.rect.width);
    const double bottom = std::max(out.y + out.height, item.rect.y + item.rect.height);
    out.x = std::min(out.x, item.rect.x);
    out.y = std::min(out.y, item.rect.y);
    out.width = right - out.x;
    out.height = bottom - out.y;
  }
  return out;
}

void paint_dock(const Look& look) {
  const auto dock = look.arrangement.find(Part::dock_glass);
  if (dock) return paint_panel(look, dock_panel, *dock, dock_widgets, Key(look.model.nearest.has_value()));
  // Buttons that stand alone, each on its own glass.
  int index = dock_panel;
  for (const Widget& widget : dock_widgets) {
    const std::vector<Item> items = items_of(look.arrangement, {&widget, 1});
    if (!items.empty()) paint_panel(look, index, bounds(items), {&widget, 1}, Key(look.model.nearest.has_value()));
    ++index;
  }
}

void paint_name(const Look& look) {
  const auto rect = look.arrangement.find(Part::mix_name);
  if (!rect || look.model.mix_name.empty()) return;
  const auto dock = look.arrangement.find(Part::dock_glass);
  const bool on_dock = dock && dock->contains(rect->centre());
  if (!on_dock)
    look.tiles.show(TileKind::panel, name_panel, look.base, *rect,
                    [&](cairo_t* cr) { draw_glass(cr, *rect, corner(look), glass, look.line); });
  TextStyle style = look.style(1.0);
  style.align = Align::centre;
  style.lines = 2;
  const std::string words = set_mix_name(look.model.mix_name, look.model.language);
  // The text's own lines, no more: this tile is drawn anew in every frame of a drag.
  const double height = std::min(rect->height, std::ceil(2.6 * look.m.text));
  const double side = std::round(0.5 * look.m.text);
  const Rect box = whole({rect->x + side, rect->y + (rect->height - height) / 2.0, rect->width - 2.0 * side, height});
  look.tiles.show(TileKind::name, 0, Key(look.base, words), box,
                  [&](cairo_t* cr) { look.fonts.draw(cr, words, style, box); });
}

/// The slider of time: what grows, and when it is.
void paint_series(const Look& look) {
  const auto glass_rect = look.arrangement.find(Part::time_glass), words = look.arrangement.find(Part::time_words);
  if (!glass_rect || !words || !look.content.scans) return;
  const ScanFacts& scans = *look.content.scans;
  Key series(scans.name);
  for (const double time : scans.times) series.add(time);
  paint_panel(look, time_panel, *glass_rect, time_widgets, series);
  char number[32];
  std::snprintf(number, sizeof number, "%.1f", scans.time_at(std::clamp(look.model.time, 0.0, 1.0)));
  const std::string now = std::string(number) + (scans.time_unit.empty() ? "" : " ") + scans.time_unit;
  TextStyle figure = look.style(1.2, Weight::medium);
  figure.align = Align::trailing;
  figure.machine_text = true;
  // Wide enough for any time, so that the tile stays where it is.
  const double width = std::min(words->width / 2.0, 16.0 * look.m.text);
  const Rect name = whole(look.leading(*words, words->width - width));
  const Rect time = whole(look.after(*words, words->width - width));
  TextStyle style = look.style(1.0);
  look.tiles.show(TileKind::label, 0, Key(look.base, scans.name), name,
                  [&](cairo_t* cr) { look.fonts.draw(cr, scans.name, style, name); });
  look.tiles.show(TileKind::name, 0, Key(look.base, now), time,
                  [&](cairo_t* cr) { look.fonts.draw(cr, now, figure, time); });
}

/// Four corners around the picture: the knob turns the car.
void paint_brackets(const Look& look) {
  if (look.model.focus != Widget::car) return;
  const double side = std::round(1.2 * look.m.target), inset = look.m.margin / 2.0;
  for (int k = 0; k < 4; ++k) {
    const bool right = k % 2 == 1, low = k / 2 == 1;
    const Rect rect =
        whole({right ? look.m.width - inset - side : inset, low ? look.m.height - inset - side : inset, side, side});
    look.tiles.show(TileKind::bracket, k, look.base, rect, [&](cairo_t* cr) {
      const double line = 4.0 * look.line;
      cairo_rectangle(cr, rect.x, rect.y, side, side);
      cairo_clip(cr);
      // A part of a rounded frame that is larger than the tile.
      const Rect frame{right ? rect.x - 2.0 * side : rect.x, low ? rect.y - 2.0 * side : rect.y, 3.0 * side,
                       3.0 * side};
      draw_focus(cr, shrunk(frame, 3.0 * line), corner(look), line, 2.0 * line);
    });
  }
}

/// A few words on a pill, small and at the side: the maker's, or that nobody vouches for the paints.
void paint_mark(const Look& look) {
  const bool warns = !look.content.is_vouched;
  TextStyle style = look.style(0.8);
  style.spacing_em = warns ? 0.0 : 0.42;
  style.machine_text = !warns;
  style.align = Align::centre;
  const std::string_view word =
      warns ? look.text(look.content.scans ? Text::unsigned_scans : Text::unsigned_pack) : "LACKWERK";
  const double height = std::round(2.6 * look.m.text);
  const double width = std::ceil(look.size_of(word, style, 0.0)[0]) + height;
  const double x = look.mirrored() ? look.m.width - look.m.margin - width : look.m.margin;
  const Rect rect = whole({x, look.m.margin, width, height});
  look.tiles.show(TileKind::overlay, 0, Key(look.base, warns), rect, [&](cairo_t* cr) {
    draw_glass(cr, rect, height / 2.0, glass, look.line);
    // The last letter's spacing does not count.
    look.fonts.draw(cr, word, style,
                    {rect.x + style.spacing_em * style.size_px / 2.0, rect.y, rect.width, rect.height});
  });
}

/// A sign of a touch and a few words, below the car.
void paint_invitation(const Look& look) {
  TextStyle style = look.style(1.2, Weight::light);
  const std::string_view words = look.text(Text::touch_to_begin);
  const double height = look.m.target, side = std::round(0.5 * height), icon = height;
  const double text_width =
      std::ceil(look.size_of(words, style, look.m.width - 2.0 * look.m.margin - icon - side)[0]) + 1.0;
  const double width = icon + text_width + side;
  const Rect rect = whole({(look.m.width - width) / 2.0, look.m.height - 1.6 * look.m.margin - height, width, height});
  look.tiles.show(TileKind::overlay, 1, Key(look.base, words), rect, [&](cairo_t* cr) {
    draw_glass(cr, rect, height / 2.0, glass, look.line);
    const Place centre = middle_px(look.leading(rect, icon));
    const double r = 0.3 * height;
    draw_disc(cr, centre, 0.26 * r, accent);
    draw_ring(cr, centre, 0.62 * r, 1.5 * look.line, accent.with(0.8));
    draw_ring(cr, centre, r, 1.5 * look.line, accent.with(0.35));
    look.fonts.draw(cr, words, style, look.leading(look.after(rect, icon), text_width));
  });
}

}  // namespace

void paint_attract(const Look& look) {
  paint_mark(look);
  paint_invitation(look);
}

void paint_show(const Look& look) {
  const Model& model = look.model;
  if (!look.content.is_vouched) paint_mark(look);
  if (model.nearest) paint_compare(look);
  if (const auto rect = look.arrangement.find(Part::light_glass))
    paint_panel(look, light_panel, *rect, light_widgets, Key(model.light));
  if (const auto rect = look.arrangement.find(Part::slider_glass)) {
    Key state(model.sparkle_free, model.hue_free);
    for (const PaintFacts& paint : look.content.paints)
      for (const double value : paint.srgb) state.add(value);
    paint_panel(look, slider_panel, *rect, slider_widgets, state);
  }
  if (look.content.scans) {
    paint_series(look);
    paint_hint(look);
  } else {
    paint_dock(look);
    paint_name(look);
    paint_pad(look);
  }
  paint_brackets(look);
}

}  // namespace lackwerk::kiosk::ui
