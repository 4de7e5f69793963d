// Comparing: the line between mix and nearest paint, and what is on either side.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {

void paint_compare(const Look& look) {
  const Nearest& nearest = *look.model.nearest;
  const auto divider = look.arrangement.find(Part::divider);
  const auto left = look.arrangement.find(Part::compare_left), right = look.arrangement.find(Part::compare_right);
  if (!divider || !left || !right) return;
  look.tiles.show(TileKind::overlay, 2, look.base, *divider, [&](cairo_t* cr) {
    cairo_rectangle(cr, divider->x, divider->y, divider->width, divider->height);
    set_colour(cr, {1.0, 1.0, 1.0, 0.75});
    cairo_fill(cr);
  });
  const double side = std::round(look.m.text);
  const TextStyle caption = look.style(0.86, Weight::regular, quiet);
  const double row = std::round(1.6 * look.m.text);
  const std::string_view mine = look.text(Text::your_mix);
  const double mine_width = std::ceil(look.size_of(mine, caption, left->width - 2.0 * side)[0]) + 2.0 * side + 1.0;
  const Rect mine_rect = whole({left->x + left->width - mine_width, left->y, mine_width, row + side});
  look.tiles.show(TileKind::overlay, 3, look.base, mine_rect, [&](cairo_t* cr) {
    draw_glass(cr, mine_rect, corner(look), glass, look.line);
    TextStyle style = caption;
    style.align = Align::centre;
    style.colour = text_colour;
    look.fonts.draw(cr, mine, style, mine_rect);
  });
  const auto paint = static_cast<std::size_t>(std::max(0, nearest.paint));
  const std::string_view name =
      paint < look.content.paints.size() ? short_name(look.content.paints[paint].identity.name) : std::string_view();
  Key key(look.base, name);
  for (const double difference : nearest.ciede2000) key.add(std::lround(10.0 * difference));
  look.tiles.show(TileKind::overlay, 4, key, *right, [&](cairo_t* cr) {
    draw_glass(cr, *right, corner(look), glass, look.line);
    Rect box = shrunk(*right, side);
    look.fonts.draw(cr, look.text(Text::nearest_paint), caption, {box.x, box.y - 0.2 * side, box.width, row});
    look.fonts.draw(cr, name, look.style(1.05, Weight::medium), {box.x, box.y + row - 0.3 * side, box.width, row});
    // Three figures over their angles, and the formula they are by.
    constexpr std::array<std::string_view, 3> angles{"15°", "45°", "110°"};
    const double column = std::round(3.3 * look.m.text), figure_height = std::round(1.7 * look.m.text);
    const Rect figures{box.x, box.y + 2.2 * row, box.width, figure_height};
    const double angle_y = figures.y + figures.height, angle_height = std::round(1.2 * look.m.text);
    for (std::size_t k = 0; k < 3; ++k) {
      const Rect cell = look.leading(look.after(figures, static_cast<double>(k) * column), column);
      const long tenths = std::lround(10.0 * nearest.ciede2000[k]);
      TextStyle figure = look.style(1.2, Weight::light);
      figure.machine_text = true;
      look.fonts.draw(cr, std::to_string(tenths / 10) + "." + std::to_string(tenths % 10), figure, cell);
      TextStyle angle = look.style(0.8, Weight::regular, quiet);
      angle.machine_text = true;
      look.fonts.draw(cr, angles[k], angle, {cell.x, angle_y, cell.width, angle_height});
    }
    TextStyle formula = look.style(0.8, Weight::regular, quiet);
    formula.align = Align::trailing;
    const Rect rest = look.after(figures, 3.0 * column);
    look.fonts.draw(cr, look.text(Text::colour_difference), formula, {rest.x, angle_y, rest.width, angle_height});
  });
}

}  // namespace lackwerk::kiosk::ui
