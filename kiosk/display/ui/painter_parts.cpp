#include "kiosk/display/ui/painter_parts.hpp"

#include <algorithm>
#include <cmath>

namespace lackwerk::kiosk::ui {

std::array<double, 2> Look::size_of(std::string_view words, const TextStyle& style, double width) const {
  // More texts than the interface ever shows at once: they are of mixes long gone.
  constexpr std::size_t most = 256;
  if (measured.size() > most) measured.clear();
  const Key key(base, words, style.size_px, style.weight, style.spacing_em, style.lines, width);
  const auto known = measured.find(key.value());
  if (known != measured.end()) return known->second;
  return measured.emplace(key.value(), fonts.measure(words, style, width)).first->second;
}

Emphasis emphasis_of(const Model& model, Widget widget, int index) {
  Emphasis out;
  out.pressed = model.pressed == widget && model.pressed_index == index;
  out.focused = model.focus == widget && model.focus_index == index;
  out.dim = model.focus != Widget::none && !out.focused;
  return out;
}

Key emphasis_key(const Model& model, std::span<const Item> items) {
  Key key;
  for (const Item& item : items) {
    const Emphasis now = emphasis_of(model, item.widget, item.index);
    key.add(item.widget).add(item.index).add(now.pressed).add(now.focused).add(now.dim);
  }
  return key;
}

std::vector<Item> items_of(const Arrangement& arrangement, std::span<const Widget> widgets) {
  std::vector<Item> out;
  for (const Item& item : arrangement.items)
    if (std::find(widgets.begin(), widgets.end(), item.widget) != widgets.end()) out.push_back(item);
  return out;
}

double halo(const Look& look) { return std::ceil(0.4 * look.m.margin); }
double corner(const Look& look) { return 0.36 * look.m.target; }
Rect grown(const Rect& rect, double by) {
  return {rect.x - by, rect.y - by, rect.width + 2.0 * by, rect.height + 2.0 * by};
}
Place middle_px(const Rect& rect) { return {std::round(rect.centre()[0]), std::round(rect.centre()[1])}; }

void draw_emphasis(const Look& look, cairo_t* cr, const Item& item) {
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  const Rect inner = shrunk(item.rect, 0.06 * look.m.target);
  const double radius = corner(look) - 0.06 * look.m.target;
  if (now.pressed) {
    rounded_path(cr, inner, radius);
    set_colour(cr, pressed_tint);
    cairo_fill(cr);
  }
  if (now.focused) draw_focus(cr, inner, radius, 3.0 * look.line, halo(look));
}

void draw_button(const Look& look, cairo_t* cr, const Item& item, Icon icon, bool on) {
  const Emphasis now = emphasis_of(look.model, item.widget, item.index);
  draw_emphasis(look, cr, item);
  Colour colour = on || now.focused ? accent : text_colour;
  if (now.dim) colour.a = dimmed;
  const double size = std::round((now.focused ? 0.56 : 0.44) * look.m.target);
  draw_icon(cr, icon, middle_px(item.rect), size, colour);
}

}  // namespace lackwerk::kiosk::ui
