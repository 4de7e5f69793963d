#include "kiosk/display/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lackwerk::kiosk {
namespace {

using ui::Widget;

struct Name {
  const char* name;
  Widget widget;
};
constexpr std::array<Name, 21> names = {{{"car", Widget::car},           {"pad", Widget::pad},
                                         {"swatch", Widget::swatch},     {"swatch_about", Widget::swatch_about},
                                         {"sparkle", Widget::sparkle},   {"hue", Widget::hue},
                                         {"beyond", Widget::beyond},     {"sparkle_lock", Widget::sparkle_lock},
                                         {"hue_lock", Widget::hue_lock}, {"light", Widget::light},
                                         {"dimmer", Widget::dimmer},     {"time", Widget::time},
                                         {"compare", Widget::compare},   {"take_home", Widget::take_home},
                                         {"close", Widget::close},       {"countdown", Widget::countdown},
                                         {"pin_key", Widget::pin_key},   {"page", Widget::page},
                                         {"action", Widget::action},     {"step_down", Widget::step_down},
                                         {"step_up", Widget::step_up}}};

bool is_slider(Widget widget) {
  return widget == Widget::sparkle || widget == Widget::hue || widget == Widget::beyond || widget == Widget::dimmer ||
         widget == Widget::time;
}

tl::unexpected<Error> missing(const input::TouchTarget& target, const char* what) {
  std::string text = "@" + target.name;
  for (std::size_t k = 0; k < target.values.size(); ++k)
    text += (k == 0 ? ":" : ",") + std::to_string(target.values[k]);
  return fail("", "input script", "'" + text + "' " + what, "kiosk/display/targets.hpp has the names");
}

ui::Place within(const ui::Rect& rect, double x, double y) {
  return {rect.x + x * rect.width, rect.y + y * rect.height};
}

/// The nearest of a grid of places that the interface leaves to the car.
std::optional<ui::Place> place_on_car(const std::vector<ui::Item>& items, const ui::Surface& surface, ui::Screen screen,
                                      ui::Place wanted) {
  constexpr int cells = 32;
  std::optional<ui::Place> best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](ui::Place place) {
    if (ui::item_at(items, screen, place).widget != Widget::car) return;
    const double away = std::hypot(place[0] - wanted[0], place[1] - wanted[1]);
    if (away >= least) return;
    least = away;
    best = place;
  };
  consider(wanted);
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      consider({(x + 0.5) / cells * surface.size_px[0], (y + 0.5) / cells * surface.size_px[1]});
  return best;
}

}  // namespace

const char* widget_name(ui::Widget widget) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const Name& n) { return n.widget == widget; });
  return found != names.end() ? found->name : "none";
}

std::optional<ui::Widget> widget_of(std::string_view name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const Name& n) { return name == n.name; });
  return found != names.end() ? std::optional(found->widget) : std::nullopt;
}

const char* screen_name(ui::Screen screen) {
  switch (screen) {
    case ui::Screen::attract:
      return "attract";
    case ui::Screen::show:
      return "show";
    case ui::Screen::take_home:
      return "take_home";
    case ui::Screen::about:
      return "about";
    case ui::Screen::pin:
      return "pin";
    case ui::Screen::dealer:
      break;
  }
  return "dealer";
}

Result<ui::Place> target_place(const input::TouchTarget& target, const ui::Surface& surface, const ui::Content& content,
                               const ui::Model& model) {
  const ui::Rect picture{0.0, 0.0, static_cast<double>(surface.size_px[0]), static_cast<double>(surface.size_px[1])};
  const auto value = [&](std::size_t k, double otherwise) {
    return k < target.values.size() ? std::clamp(target.values[k], 0.0, 1.0) : otherwise;
  };
  const ui::Place middle = within(picture, value(0, 0.5), value(1, 0.5));
  if (target.name == "picture") return middle;
  const std::vector<ui::Item> items = ui::layout(surface, content, model);
  const bool is_puck = target.name == "puck";
  const auto widget = is_puck ? std::optional(Widget::pad) : widget_of(target.name);
  if (!widget) return missing(target, "is no target");
  if (*widget == Widget::car) {
    if (const auto place = place_on_car(items, surface, model.screen, middle)) return *place;
    return missing(target, "is not on the screen");
  }
  const bool has_index = *widget != Widget::pad && !is_slider(*widget) && !target.values.empty();
  if (has_index && (target.values[0] != std::floor(target.values[0]) || std::abs(target.values[0]) > 1e6))
    return missing(target, "has no whole number");
  const auto item = ui::find_item(items, *widget, has_index ? static_cast<int>(target.values[0]) : 0);
  if (!item) return missing(target, "is not on the screen");
  if (*widget == Widget::pad) {
    const ui::Rect field = ui::pad_field(surface, item->rect);
    return is_puck ? within(field, model.puck[0], model.puck[1]) : within(field, value(0, 0.5), value(1, 0.5));
  }
  if (is_slider(*widget)) return ui::slider_track(surface, *item, model.language).at(value(0, 0.5));
  return item->rect.centre();
}

}  // namespace lackwerk::kiosk
