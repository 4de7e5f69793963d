// The dealer's pages: plain, readable, one glance.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Tiles of kind body.
constexpr int page_body = 0, value_body = 1, message_body = 2;

/// One line of a page: a label and what it is, or a heading, or small print.
struct Row {
  enum class Kind : std::uint8_t { fact, heading, note };
  Kind kind = Kind::fact;
  std::string label, value;
  bool alarming = false;
  bool spoken = false;  ///< a fact's value, a heading's label: in the interface's language, not the machine's
};

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " · ") + word;
  return out;
}

std::string milliseconds(double ms) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.1f ms", ms);
  return buffer.data();
}

Text outcome_text(ImportedFile::Outcome outcome) {
  switch (outcome) {
    case ImportedFile::Outcome::stored:
      return Text::stored;
    case ImportedFile::Outcome::already_there:
      return Text::already_there;
    case ImportedFile::Outcome::refused:
      break;
  }
  return Text::refused;
}

/// Local date and minute, as every dealer reads them.
std::string clock_text(std::int64_t time_s) {
  const std::time_t time = time_s;
  std::tm local{};
  std::array<char, 32> out{};
  if (localtime_r(&time, &local) == nullptr) return {};
  return {out.data(), std::strftime(out.data(), out.size(), "%Y-%m-%d %H:%M", &local)};
}

void add_import_rows(const Look& look, const ImportReport& report, std::vector<Row>& rows) {
  rows.push_back(
      {Row::Kind::heading, std::string(look.text(Text::last_stick)), clock_text(report.time_s), false, true});
  if (!report.error.empty()) rows.push_back({Row::Kind::note, report.error, "", true});
  for (const ImportedFile& file : report.files) {
    rows.push_back({Row::Kind::fact, file.file, std::string(look.text(outcome_text(file.outcome))),
                    file.outcome == ImportedFile::Outcome::refused});
    if (!file.error.empty()) rows.push_back({Row::Kind::note, file.error, "", false});
  }
}

std::vector<Row> pack_rows(const Look& look, const Status& status) {
  std::vector<Row> rows;
  for (const PackStatus& pack : status.packs) {
    rows.push_back({Row::Kind::heading, pack.id,
                    text_with(Text::serial, look.model.language, static_cast<long long>(pack.serial)), false});
    rows.push_back({Row::Kind::note, joined(pack.paints), "", false});
    rows.push_back({Row::Kind::note, pack.file, "", false});
    if (!pack.is_signed) rows.push_back({Row::Kind::note, std::string(look.text(Text::unsigned_pack)), "", true});
  }
  if (rows.empty()) rows.push_back({Row::Kind::note, std::string(look.text(Text::no_packs)), "", false});
  if (look.dealer->import) add_import_rows(look, *look.dealer->import, rows);
  return rows;
}

std::vector<Row> status_rows(const Look& look, const Status& status) {
  const auto fact = [&](Text what, std::string value) {
    return Row{Row::Kind::fact, std::string(look.text(what)), std::move(value), false};
  };
  const OutputMode& mode = status.mode;
  std::string size = std::to_string(mode.panel_px[0]) + " × " + std::to_string(mode.panel_px[1]);
  if (mode.refresh_hz > 0.0) size += ", " + std::to_string(std::lround(mode.refresh_hz)) + " Hz";
  std::vector<Row> rows{
      fact(Text::state, std::string(state_text(status.state, look.model.language))),
      fact(Text::output, status.platform + (mode.connector.empty() ? "" : ", " + mode.connector)),
      fact(Text::mode, size),
      fact(Text::renderer, status.renderer),
      fact(Text::quality, status.resting ? std::string(look.text(Text::still)) : status.quality),
      fact(Text::frame_time, milliseconds(status.frame_ms)),
  };
  if (status.latency.count > 0) rows.push_back(fact(Text::response_time, milliseconds(status.latency.median_ms)));
  return rows;
}

/// "ready, 127 events"; a device of which nothing was heard is said to be what it is.
std::string device_text(const Look& look, const input::DeviceStatus& device) {
  std::string out(state_text(device.state, look.model.language));
  if (device.heard == 0 && device.state != "ready") return out;
  out += mix_words(look.model.language).list_separator;
  out += device.heard == 1 ? std::string(look.text(Text::one_event))
                           : text_with(Text::events, look.model.language, static_cast<long long>(device.heard));
  return out;
}

std::vector<Row> device_rows(const Look& look, const Status& status) {
  std::vector<Row> rows;
  for (const input::DeviceStatus& device : status.devices) {
    rows.push_back({Row::Kind::fact, device.name, device_text(look, device), device.state != "ready", true});
    if (!device.detail.empty()) rows.push_back({Row::Kind::note, device.detail, "", false});
  }
  if (rows.empty()) rows.push_back({Row::Kind::note, std::string(look.text(Text::no_devices)), "", false});
  return rows;
}

std::vector<Row> error_rows(const Look& look, const std::vector<std::string>& log) {
  std::vector<Row> rows;
  rows.reserve(log.size() + 1);
  for (const std::string& line : log) rows.push_back({Row::Kind::note, line, "", false});
  if (rows.empty()) rows.push_back({Row::Kind::note, std::string(look.text(Text::no_errors)), "", false});
  return rows;
}

std::vector<Row> rows_of(const Look& look) {
  if (look.dealer == nullptr) return {};
  switch (look.model.dealer.page) {
    case DealerPage::packs:
      return pack_rows(look, look.dealer->status);
    case DealerPage::status:
      return status_rows(look, look.dealer->status);
    case DealerPage::devices:
      return device_rows(look, look.dealer->status);
    case DealerPage::errors:
      return error_rows(look, look.dealer->log);
    case DealerPage::screen:
    case DealerPage::options:
      break;
  }
  return {};
}

void draw_rows(const Look& look, cairo_t* cr, const Rect& box, const std::vector<Row>& rows) {
  const double text = look.m.text, column = std::min(0.46 * box.width, 20.0 * text);
  double y = box.y;
  bool first = true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    // A note belongs to the line above it.
    const bool note_follows = k + 1 < rows.size() && rows[k + 1].kind == Row::Kind::note;
    TextStyle style = look.style(1.05);
    if (row.kind == Row::Kind::heading) style = look.style(1.25, Weight::medium);
    if (row.kind == Row::Kind::note) {
      style = look.style(0.95, Weight::regular, first ? text_colour : quiet);
      style.lines = 2;
    }
    if (row.kind == Row::Kind::heading && !first) y += text;
    style.from_top = true;
    // Names, paths and figures of the machine.
    style.machine_text = !(row.spoken && row.kind == Row::Kind::heading);
    const double left = box.y + box.height - y;
    const Rect line{box.x, y, box.width, left};
    const double split = row.kind == Row::Kind::fact ? column : box.width - std::min(11.0 * text, 0.45 * box.width);
    const bool two = !row.value.empty();
    const Rect label = two ? look.leading(line, split - text) : line;
    const double height = look.fonts.measure(row.label, style, label.width)[1];
    if (height > left) return;  // the page is full
    if (row.kind == Row::Kind::fact) style.colour = quiet;
    look.fonts.draw(cr, row.label, style, label);
    if (two) {
      TextStyle value = style;
      value.colour = row.alarming ? accent : text_colour;
      value.machine_text = !(row.spoken && row.kind == Row::Kind::fact);
      if (row.kind == Row::Kind::heading) value.align = Align::trailing;
      look.fonts.draw(cr, row.value, value, look.after(line, split));
    }
    y += height + (note_follows && row.kind != Row::Kind::note ? 0.3 : 0.8) * text;
    first = false;
  }
}

void draw_tab(const Look& look, cairo_t* cr, const Item& item) {
  const bool open = static_cast<int>(look.model.dealer.page) == item.index;
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  draw_emphasis(look, cr, item);
  TextStyle style =
      look.style(1.05, open ? Weight::medium : Weight::regular, open || now.focused ? text_colour : quiet);
  const double inset = look.m.portrait ? 0.0 : look.m.margin;
  if (look.m.portrait) style.align = Align::centre;
  const Rect words = look.after(item.rect, inset);
  look.fonts.draw(cr, page_text(static_cast<DealerPage>(item.index), look.model.language), style,
                  look.leading(words, words.width - 0.4 * inset));
  if (!open) return;
  const double thick = 3.0 * look.line;
  Rect bar = look.leading(item.rect, thick);
  bar.y += 0.25 * item.rect.height;
  bar.height *= 0.5;
  if (look.m.portrait)
    bar = {item.rect.x + 0.25 * item.rect.width, item.rect.y + item.rect.height - 2.0 * thick, 0.5 * item.rect.width,
           thick};
  rounded_path(cr, bar, thick / 2.0);
  set_colour(cr, accent);
  cairo_fill(cr);
}

/// A row that can be touched: what it does, and how it stands.
void draw_choice(const Look& look, cairo_t* cr, const Item& item, std::string_view label, std::string_view value,
                 bool on) {
  draw_emphasis(look, cr, item);
  draw_line(cr, {item.rect.x, item.rect.y + item.rect.height},
            {item.rect.x + item.rect.width, item.rect.y + item.rect.height}, look.line, hairline);
  const Rect inner{item.rect.x + look.m.text, item.rect.y, item.rect.width - 2.0 * look.m.text, item.rect.height};
  const double room = value.empty() ? 0.0 : 7.0 * look.m.text;
  look.fonts.draw(cr, label, look.style(1.05), look.leading(inner, inner.width - room));
  if (value.empty()) return;
  TextStyle style = look.style(1.05, Weight::medium, on ? accent : quiet);
  style.align = Align::trailing;
  look.fonts.draw(cr, value, style, look.after(inner, inner.width - room));
}

void draw_action(const Look& look, cairo_t* cr, const Item& item) {
  const DealerModel& dealer = look.model.dealer;
  const auto state = [&](bool on) { return look.text(on ? Text::on : Text::off); };
  if (dealer.page == DealerPage::screen) {
    const bool calibrate = item.index == static_cast<int>(ScreenAction::calibrate);
    draw_choice(look, cr, item, look.text(calibrate ? Text::calibrate : Text::test_pattern), {}, false);
    return;
  }
  switch (static_cast<OptionAction>(item.index)) {
    case OptionAction::beyond:
      draw_choice(look, cr, item, look.text(Text::beyond), state(dealer.beyond_allowed), dealer.beyond_allowed);
      break;
    case OptionAction::language:
      draw_choice(look, cr, item, look.text(Text::language), look.text(Text::own_name), true);
      break;
    case OptionAction::reduced_motion:
      draw_choice(look, cr, item, look.text(Text::reduced_motion), state(dealer.reduced_motion), dealer.reduced_motion);
      break;
  }
}

void draw_items(const Look& look, cairo_t* cr) {
  for (const Item& item : look.arrangement.items) {
    if (item.widget == Widget::close) draw_button(look, cr, item, Icon::close, false);
    if (item.widget == Widget::page) draw_tab(look, cr, item);
    if (item.widget == Widget::action) draw_action(look, cr, item);
    if (item.widget == Widget::step_down) draw_button(look, cr, item, Icon::minus, false);
    if (item.widget == Widget::step_up) draw_button(look, cr, item, Icon::plus, false);
  }
}

void paint_calibration(const Look& look) {
  const auto cross = look.arrangement.find(Part::cross), title = look.arrangement.find(Part::title);
  if (!cross || !title) return;
  look.tiles.show(TileKind::overlay, 5, look.base, *cross, [&](cairo_t* cr) {
    const Place c = cross->centre();
    draw_disc(cr, c, cross->width / 2.0, glass);
    draw_line(cr, {c[0], cross->y + look.line}, {c[0], cross->y + cross->height - look.line}, look.line, text_colour);
    draw_line(cr, {cross->x + look.line, c[1]}, {cross->x + cross->width - look.line, c[1]}, look.line, text_colour);
    draw_ring(cr, c, 0.22 * cross->width, look.line, accent);
  });
  TextStyle words = look.style(1.2);
  words.align = Align::centre;
  const std::string_view how = look.text(Text::calibrate_how);
  const double width = std::ceil(look.size_of(how, words, title->width)[0]) + 4.0 * look.m.text;
  const Rect rect = whole({title->centre()[0] - width / 2.0, title->y, width, title->height});
  look.tiles.show(TileKind::overlay, 6, look.base, rect, [&](cairo_t* cr) {
    draw_glass(cr, rect, corner(look), card_glass, look.line);
    look.fonts.draw(cr, how, words, rect);
  });
}

void paint_pattern_exit(const Look& look) {
  const auto item = find_item(look.arrangement.items, Widget::action, static_cast<int>(ScreenAction::test_pattern));
  if (!item) return;
  const Key key(look.base, emphasis_key(look.model, {&*item, 1}));
  look.tiles.show(TileKind::overlay, 7, key, item->rect, [&](cairo_t* cr) {
    draw_glass(cr, item->rect, corner(look), card_glass, look.line);
    draw_emphasis(look, cr, *item);
    TextStyle words = look.style(1.1);
    words.align = Align::centre;
    look.fonts.draw(cr, look.text(Text::back), words, item->rect);
  });
}

}  // namespace

void paint_dealer(const Look& look) {
  const DealerModel& dealer = look.model.dealer;
  if (dealer.calibration_step >= 0) return paint_calibration(look);
  if (dealer.test_pattern) return paint_pattern_exit(look);
  const auto card = look.arrangement.find(Part::card), title = look.arrangement.find(Part::title);
  if (!card || !title) return;
  const Key key(look.base, dealer.page, dealer.beyond_allowed, dealer.reduced_motion,
                emphasis_key(look.model, look.arrangement.items));
  look.tiles.show(TileKind::card, 0, key, *card, [&](cairo_t* cr) {
    draw_glass(cr, *card, corner(look), card_glass, look.line);
    look.fonts.draw(cr, page_text(dealer.page, look.model.language), look.style(1.7, Weight::light), *title);
    draw_items(look, cr);
  });
  if (const auto value = look.arrangement.find(Part::value)) {
    const long percent = std::lround(100.0 * dealer.brightness);
    look.tiles.show(TileKind::body, value_body, Key(look.base, percent), *value, [&](cairo_t* cr) {
      const Rect inner = look.after(*value, look.m.text);
      look.fonts.draw(cr, look.text(Text::brightness), look.style(1.05),
                      look.leading(inner, inner.width - 5.0 * look.m.text));
      TextStyle number = look.style(1.05, Weight::medium);
      number.align = Align::trailing;
      number.machine_text = true;
      look.fonts.draw(cr, std::to_string(percent) + " %", number, look.after(inner, inner.width - 5.0 * look.m.text));
    });
  }
  const auto body = look.arrangement.find(Part::body);
  if (!body) return;
  if (dealer.page == DealerPage::screen) {
    if (!dealer.calibration_failed) return;
    look.tiles.show(TileKind::body, message_body, look.base, *body, [&](cairo_t* cr) {
      TextStyle words = look.style(1.0, Weight::regular, accent);
      words.lines = 2;
      words.from_top = true;
      look.fonts.draw(cr, look.text(Text::calibration_failed), words,
                      {body->x + look.m.text, body->y + look.m.text, body->width - 2.0 * look.m.text,
                       std::max(1.0, body->height - look.m.text)});
    });
    return;
  }
  const std::vector<Row> rows = rows_of(look);
  Key text_key(look.base);
  for (const Row& row : rows) text_key.add(row.kind).add(row.label).add(row.value).add(row.alarming);
  look.tiles.show(TileKind::body, page_body, text_key, *body, [&](cairo_t* cr) { draw_rows(look, cr, *body, rows); });
}

}  // namespace lackwerk::kiosk::ui
