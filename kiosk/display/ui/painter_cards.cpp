// Take home, about, the dealer's number pad, the countdown.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kiosk/display/ui/painter_parts.hpp"
#include "kiosk/display/ui/qr.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Tiles of kind card.
constexpr int plain_card = 0, countdown_card = 1;

/// Draws one text after another downwards.
class Lines {
 public:
  Lines(const Look& look, cairo_t* cr, const Rect& box) : look_(look), cr_(cr), box_(box) {}
  void put(std::string_view words, TextStyle style, double gap_after) {
    if (words.empty() || box_.height < style.size_px) return;
    style.from_top = true;
    const Rect drawn = look_.fonts.draw(cr_, words, style, box_);
    skip(drawn.height + gap_after * look_.m.text);
  }
  void skip(double px) {
    box_.y += px;
    box_.height -= px;
  }
  [[nodiscard]] const Rect& box() const { return box_; }

 private:
  const Look& look_;
  cairo_t* cr_;
  Rect box_;
};

void draw_close(const Look& look, cairo_t* cr) {
  if (const auto close = find_item(look.arrangement.items, Widget::close))
    draw_button(look, cr, *close, Icon::close, false);
}

void draw_qr(const Look& look, cairo_t* cr, const Rect& box) {
  const auto code = qr_of(look.model.mix_code);
  if (!code) return;
  const int modules = code->side + 2 * quiet_zone;
  const double module = std::floor(box.width / modules);
  if (module < 1.0) return;
  // Whole pixels a module; the rest of the box stays glass.
  const double side = module * modules;
  const double x = std::round(box.x + (box.width - side) / 2.0), y = std::round(box.y + (box.height - side) / 2.0);
  rounded_path(cr, {x, y, side, side}, 2.0 * module);
  set_colour(cr, {1.0, 1.0, 1.0});
  cairo_fill(cr);
  set_colour(cr, {0.0, 0.0, 0.0});
  cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE);
  for (int row = 0; row < code->side; ++row)
    for (int column = 0; column < code->side; ++column)
      if (code->is_dark(column, row))
        cairo_rectangle(cr, x + (column + quiet_zone) * module, y + (row + quiet_zone) * module, module, module);
  cairo_fill(cr);
  cairo_set_antialias(cr, CAIRO_ANTIALIAS_DEFAULT);
}

void draw_about(const Look& look, cairo_t* cr, const Rect& body, std::size_t paint) {
  const PaintFacts& facts = look.content.paints[paint];
  const double disc = 1.5 * look.m.swatch, gap = 1.5 * look.m.margin;
  const Rect at = look.leading(body, disc);
  const SwatchView picture = look.picture_of_paint(paint);
  const Place centre{at.centre()[0], body.y + disc / 2.0};
  draw_shadow(cr, centre, disc / 2.0, 0.12 * disc);
  draw_swatch(cr, centre, disc / 2.0, picture.rgb, picture.edge_px, {facts.srgb[0], facts.srgb[1], facts.srgb[2]});

  const Rect words = look.after(body, disc + gap);
  // The close button stands beside the title.
  const Rect beside = look.leading(words, words.width - 0.8 * look.m.target);
  TextStyle title = look.style(1.7, Weight::light);
  title.lines = 2;
  const double title_height = look.fonts.measure(facts.identity.name, title, beside.width)[1];
  title.from_top = title_height > disc;
  look.fonts.draw(cr, facts.identity.name, title, {beside.x, body.y, beside.width, std::max(disc, title_height)});

  Lines lines(look, cr, words);
  lines.skip(std::max(disc, title_height) + 1.2 * look.m.text);
  struct Row {
    Text what;
    core::Provenance provenance;
  };
  const std::array<Row, 3> rows{{{Text::colour_and_gloss, facts.identity.lobes},
                                 {Text::flakes, facts.identity.flakes},
                                 {Text::clear_coat, facts.identity.coat}}};
  const double column = std::min(0.48 * words.width, 13.0 * look.m.text), height = std::round(2.0 * look.m.text);
  for (const Row& row : rows) {
    if (row.what == Text::flakes && !look.content.has_flakes) continue;
    const Rect line{lines.box().x, lines.box().y, lines.box().width, height};
    look.fonts.draw(cr, look.text(row.what), look.style(1.0, Weight::regular, quiet), look.leading(line, column));
    look.fonts.draw(cr, provenance_text(row.provenance, look.model.language), look.style(1.0, Weight::medium),
                    look.after(line, column));
    lines.skip(height);
  }
  lines.skip(0.8 * look.m.text);
  TextStyle source = look.style(0.9, Weight::regular, quiet);
  source.lines = 3;
  if (!facts.identity.source.empty())
    lines.put(std::string(look.text(Text::source)) + ": " + facts.identity.source, source, 0.0);
}

}  // namespace

void paint_take_home(const Look& look) {
  const auto card = look.arrangement.find(Part::card), qr = look.arrangement.find(Part::qr),
             body = look.arrangement.find(Part::body);
  if (!card || !qr || !body) return;
  const Key key(look.base, look.model.mix_code, look.model.mix_name, emphasis_key(look.model, look.arrangement.items));
  look.tiles.show(TileKind::card, plain_card, key, *card, [&](cairo_t* cr) {
    draw_glass(cr, *card, corner(look), card_glass, look.line);
    draw_qr(look, cr, *qr);
    const bool beside = body->y < qr->y + qr->height;
    TextStyle title = look.style(1.9, Weight::light), name = look.style(1.1, Weight::medium),
              how = look.style(0.95, Weight::regular, quiet), code = look.style(0.75, Weight::regular, quiet);
    name.lines = beside ? 4 : 2;
    how.lines = beside ? 5 : 2;
    code.lines = beside ? 4 : 2;
    code.machine_text = true;
    // The close button stands beside the title; the code rests on the body's lower edge.
    Lines lines(look, cr, *body);
    lines.skip(beside ? 0.5 * look.m.text : 0.0);
    if (beside) {
      const Rect first = look.leading(lines.box(), body->width - 0.4 * look.m.target);
      Lines heading(look, cr, first);
      heading.put(look.text(Text::take_home_title), title, 1.0);
      lines.skip(heading.box().y - first.y);
    }
    lines.put(set_mix_name(look.model.mix_name, look.model.language), name, 1.0);
    lines.put(look.text(Text::take_home_how), how, 1.0);
    const double code_height = look.fonts.measure(look.model.mix_code, code, body->width)[1];
    const double room = lines.box().height - code_height;
    if (beside && room > 0.0) lines.skip(room);
    lines.put(look.model.mix_code, code, 0.0);
    draw_close(look, cr);
  });
}

void paint_about(const Look& look) {
  const auto card = look.arrangement.find(Part::card), body = look.arrangement.find(Part::body);
  const auto paint = static_cast<std::size_t>(std::max(0, look.model.about_paint));
  if (!card || !body || paint >= look.content.paints.size()) return;
  const core::PaintIdentity& identity = look.content.paints[paint].identity;
  Key key(look.base, paint, identity.name, identity.source, identity.lobes, identity.flakes, identity.coat);
  key.add(look.picture_of_paint(paint).version).add(look.content.has_flakes);
  key.add(emphasis_key(look.model, look.arrangement.items));
  for (const double value : look.content.paints[paint].srgb) key.add(value);
  look.tiles.show(TileKind::card, plain_card, key, *card, [&](cairo_t* cr) {
    draw_glass(cr, *card, corner(look), card_glass, look.line);
    draw_about(look, cr, *body, paint);
    draw_close(look, cr);
  });
}

void paint_pin(const Look& look) {
  const auto card = look.arrangement.find(Part::card), title = look.arrangement.find(Part::title),
             digits = look.arrangement.find(Part::digits);
  if (!card || !title || !digits) return;
  const PinModel& pin = look.model.pin;
  look.tiles.show(TileKind::card, plain_card, Key(look.base, emphasis_key(look.model, look.arrangement.items)), *card,
                  [&](cairo_t* cr) {
                    draw_glass(cr, *card, corner(look), card_glass, look.line);
                    look.fonts.draw(cr, look.text(Text::dealer), look.style(1.4, Weight::light), *title);
                    draw_close(look, cr);
                    for (const Item& item : look.arrangement.items) {
                      if (item.widget != Widget::pin_key) continue;
                      if (item.index >= 10) {
                        draw_button(look, cr, item, item.index == 10 ? Icon::erase : Icon::check, item.index == 11);
                        continue;
                      }
                      const Emphasis now = emphasis_of(look.model, item.widget, item.index);
                      draw_emphasis(look, cr, item);
                      const double radius = 0.42 * std::min(item.rect.width, item.rect.height);
                      draw_ring(cr, item.rect.centre(), radius, look.line, track.with(0.22));
                      TextStyle digit = look.style(1.6, Weight::light, now.focused ? accent : text_colour);
                      digit.align = Align::centre;
                      look.fonts.draw(cr, std::to_string(item.index), digit, item.rect);
                    }
                  });
  const Key key(look.base, pin.digits, pin.attempts_left, std::ceil(pin.locked_s), pin.refused);
  look.tiles.show(TileKind::body, 0, key, *digits, [&](cairo_t* cr) {
    TextStyle words = look.style(0.95, Weight::regular, quiet);
    words.align = Align::centre;
    words.lines = 2;
    if (pin.locked_s > 0.0 || (pin.refused && pin.digits == 0)) {
      words.colour = accent;
      const auto seconds = static_cast<long long>(std::ceil(pin.locked_s));
      const std::string line = pin.locked_s > 0.0
                                   ? text_with(Text::pin_locked, look.model.language, seconds)
                                   : text_with(Text::pin_refused, look.model.language, pin.attempts_left);
      look.fonts.draw(cr, line, words, *digits);
      return;
    }
    if (pin.digits <= 0) {
      look.fonts.draw(cr, look.text(Text::pin_prompt), words, *digits);
      return;
    }
    constexpr int most = 12;
    const int shown = std::min(pin.digits, most);
    const double step = std::min(1.6 * look.m.text, digits->width / most);
    for (int k = 0; k < shown; ++k)
      draw_disc(cr, {digits->centre()[0] + (k - 0.5 * (shown - 1)) * step, digits->centre()[1]}, 0.3 * look.m.text,
                text_colour);
  });
}

void paint_countdown(const Look& look) {
  const auto item = find_item(look.arrangement.items, Widget::countdown);
  if (!item || !look.model.countdown_s) return;
  const Rect card = item->rect;
  const double seconds = std::max(0.0, std::ceil(*look.model.countdown_s));
  const double whole_s = std::max(look.model.countdown_whole_s, 1.0);
  look.tiles.show(TileKind::card, countdown_card, Key(look.base, seconds, whole_s), card, [&](cairo_t* cr) {
    draw_glass(cr, card, corner(look), card_glass, look.line);
    const double radius = 0.27 * card.height, line = 4.0 * look.line;
    const Place centre{card.centre()[0], card.y + 0.42 * card.height};
    draw_ring(cr, centre, radius, line, track.with(0.16));
    const double turn = 6.283185307179586 * std::min(1.0, seconds / whole_s), top = -1.5707963267948966;
    cairo_new_sub_path(cr);
    cairo_arc_negative(cr, centre[0], centre[1], radius, top, top - turn);
    set_colour(cr, accent);
    cairo_set_line_width(cr, line);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    if (turn > 0.0) cairo_stroke(cr);
    TextStyle number = look.style(1.0, Weight::light);
    number.size_px = 0.24 * card.height;
    number.align = Align::centre;
    look.fonts.draw(cr, std::to_string(static_cast<int>(std::min(seconds, 9999.0))), number,
                    {card.x, centre[1] - radius, card.width, 2.0 * radius});
    TextStyle words = look.style(1.15);
    words.align = Align::centre;
    look.fonts.draw(
        cr, look.text(Text::touch_to_stay), words,
        {card.x + look.m.text, card.y + 0.76 * card.height, card.width - 2.0 * look.m.text, 0.18 * card.height});
  });
}

}  // namespace lackwerk::kiosk::ui
