#include "kiosk/display/ui/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kiosk/display/ui/arrangement.hpp"

namespace lackwerk::kiosk::ui {
namespace {

double distance_squared(Place a, Place b) {
  const double dx = a[0] - b[0], dy = a[1] - b[1];
  return dx * dx + dy * dy;
}

bool stands_on_pad(Widget widget) { return widget == Widget::swatch || widget == Widget::swatch_about; }

/// Labels of the picture's halves, which do not change sides.
bool names_half(Part part) {
  return part == Part::divider || part == Part::compare_left || part == Part::compare_right || part == Part::cross;
}

/// For two lines of headline and two of reason: over the car at the top, below the lights; at the lower edge of cards,
/// whose titles are at the top.
Rect toast_place(const Metrics& m, Screen screen) {
  const double width = std::min(m.width - 2.0 * m.margin, std::max(0.9 * m.edge, 30.0 * m.text));
  const double height = 7.2 * m.text;
  const bool over_car = screen == Screen::attract || screen == Screen::show;
  const double y = over_car ? 1.5 * m.margin + m.target : m.height - 1.5 * m.margin - height;
  return whole({(m.width - width) / 2.0, std::max(0.0, y), width, std::min(height, m.height)});
}

void mirror(Rect& rect, double width) { rect.x = width - rect.x - rect.width; }

/// Right to left, everything changes sides as a whole; what stands on the pad keeps its place there, for paints have no
/// direction of reading, and digits are in the same order everywhere.
void mirror(Arrangement& arrangement, double width) {
  std::optional<Rect> pad;
  for (const Item& item : arrangement.items)
    if (item.widget == Widget::pad) pad = item.rect;
  const double moved = pad ? width - 2.0 * pad->x - pad->width : 0.0;
  for (Item& item : arrangement.items) {
    if (stands_on_pad(item.widget)) {
      item.rect.x += moved;
      item.touch.x = std::clamp(item.touch.x + moved, 0.0, width - item.touch.width);
    } else if (item.widget != Widget::pin_key) {
      mirror(item.rect, width);
      mirror(item.touch, width);
    }
  }
  for (Piece& piece : arrangement.pieces) {
    if (piece.part == Part::hint && pad)
      piece.rect.x += moved;
    else if (!names_half(piece.part))
      mirror(piece.rect, width);
  }
}

}  // namespace

std::optional<Rect> Arrangement::find(Part part) const {
  for (const Piece& piece : pieces)
    if (piece.part == part) return piece.rect;
  return std::nullopt;
}

Arrangement arrange(const Surface& surface, const Content& content, const Model& model) {
  Arrangement out;
  if (model.asleep) return out;
  const Metrics metrics = metrics_of(surface);
  if (model.screen == Screen::attract || model.screen == Screen::show)
    arrange_show(metrics, surface, content, model, out);
  else
    arrange_card(metrics, surface, model, out);
  if (model.toast) out.pieces.push_back({Part::toast, 0, toast_place(metrics, model.screen)});
  if (model.countdown_s) {
    // Over everything: any touch stays. In portrait above the middle, clear of the mix's name.
    const double side = std::round(0.36 * metrics.edge);
    const double middle = (metrics.portrait ? 0.34 : 0.5) * metrics.height;
    const Rect card = whole({(metrics.width - 1.5 * side) / 2.0, middle - side / 2.0, 1.5 * side, side});
    out.items.push_back({Widget::countdown, 0, card, {0.0, 0.0, metrics.width, metrics.height}});
  }
  if (model.language == Language::arabic) mirror(out, metrics.width);
  return out;
}

std::vector<Item> layout(const Surface& surface, const Content& content, const Model& model) {
  return arrange(surface, content, model).items;
}

Item item_at(const std::vector<Item>& items, Screen screen, Place px) {
  const Item* found = nullptr;
  for (const Item& item : items) {
    if (!item.touch.contains(px)) continue;
    const bool rival = found != nullptr && stands_on_pad(found->widget) && stands_on_pad(item.widget);
    if (rival && distance_squared(px, found->rect.centre()) <= distance_squared(px, item.rect.centre())) continue;
    found = &item;
  }
  if (found != nullptr) return *found;
  if (screen == Screen::attract || screen == Screen::show) return {Widget::car, 0, {}, {}};
  return {};
}

std::optional<Item> find_item(const std::vector<Item>& items, Widget widget, int index) {
  for (const Item& item : items)
    if (item.widget == widget && item.index == index) return item;
  return std::nullopt;
}

Rect pad_field(const Surface& surface, const Rect& pad) {
  const Metrics m = metrics_of(surface);
  const double side = m.swatch / 2.0 + m.margin / 2.0;
  return {pad.x + side, pad.y + side, std::max(1.0, pad.width - 2.0 * side),
          std::max(1.0, pad.height - 2.0 * side - m.label)};
}

Track slider_track(const Surface& surface, const Item& slider, Language language) {
  const Metrics m = metrics_of(surface);
  // An icon of 0.8 targets at the beginning, half a knob of 0.25 at either end.
  const double y = slider.rect.centre()[1];
  const double begin = 1.05 * m.target, end = 0.35 * m.target;
  const Rect& r = slider.rect;
  if (language == Language::arabic) return {{r.x + r.width - begin, y}, {r.x + end, y}};
  return {{r.x + begin, y}, {r.x + r.width - end, y}};
}

double Track::position(Place px) const {
  const double dx = to[0] - from[0], dy = to[1] - from[1];
  const double length_squared = dx * dx + dy * dy;
  if (length_squared <= 0.0) return 0.0;
  return std::clamp(((px[0] - from[0]) * dx + (px[1] - from[1]) * dy) / length_squared, 0.0, 1.0);
}

Place Track::at(double position) const {
  return {from[0] + position * (to[0] - from[0]), from[1] + position * (to[1] - from[1])};
}

std::vector<Place> first_places(std::size_t paints) {
  if (paints == 0) return {};
  if (paints == 1) return {{0.5, 0.5}};
  if (paints == 2) return {{0.0, 0.5}, {1.0, 0.5}};
  // The first at the top, then clockwise. A ring that fills the field, with the middle of its bounds in the field's.
  std::vector<Place> places;
  for (std::size_t k = 0; k < paints; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(paints);
    places.push_back({0.5 + 0.5 * std::sin(angle), 0.5 - 0.5 * std::cos(angle)});
  }
  double lowest = 0.0;
  for (const Place& place : places) lowest = std::max(lowest, place[1]);
  for (Place& place : places) place[1] = std::clamp(place[1] + (1.0 - lowest) / 2.0, 0.0, 1.0);
  return places;
}

Place calibration_cross(const Surface& surface, int step) {
  // An eighth in from the corners: far apart for accuracy, away from the rim where panels are worst.
  constexpr std::array<Place, calibration_steps> crosses{
      {{0.125, 0.125}, {0.875, 0.125}, {0.875, 0.875}, {0.125, 0.875}}};
  const Place part = crosses[static_cast<std::size_t>(std::clamp(step, 0, calibration_steps - 1))];
  return {std::floor(part[0] * surface.size_px[0]) + 0.5, std::floor(part[1] * surface.size_px[1]) + 0.5};
}

}  // namespace lackwerk::kiosk::ui
