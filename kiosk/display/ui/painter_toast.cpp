// The short notice of what came of a stick.
#include <algorithm>
#include <cmath>
#include <string>

#include "kiosk/display/ui/painter_parts.hpp"

namespace lackwerk::kiosk::ui {
namespace {

std::string listed(const std::vector<std::string>& names, Language language) {
  std::string out;
  for (const std::string& name : names)
    out += (out.empty() ? std::string() : std::string(mix_words(language).list_separator)) + name;
  return out;
}

struct Notice {
  std::string headline, detail;
  bool alarming = false;
};

/// Good news first; what was refused is said in any case.
Notice notice_of(const Toast& toast, Language language) {
  Notice out;
  const std::string refused = text_with(Text::packs_refused, language, toast.refused);
  if (!toast.stored.empty())
    out.headline = text_with(Text::new_paints, language, listed(toast.stored, language));
  else if (toast.refused > 0)
    out.headline = refused;
  else if (!toast.known.empty())
    out.headline = text_with(Text::known_paints, language, listed(toast.known, language));
  else
    out.headline = text(Text::nothing_came, language);
  out.alarming = toast.stored.empty() && (toast.refused > 0 || toast.known.empty());
  // The machine's words keep their direction.
  constexpr const char *isolate = "\u2068", *end_isolate = "\u2069";
  if (!toast.stored.empty() && toast.refused > 0) out.detail = refused + (toast.reason.empty() ? "" : ": ");
  if (!toast.reason.empty()) out.detail += isolate + toast.reason + end_isolate;
  return out;
}

}  // namespace

void paint_toast(const Look& look) {
  const auto place = look.arrangement.find(Part::toast);
  if (!place || !look.model.toast) return;
  const Notice notice = notice_of(*look.model.toast, look.model.language);
  TextStyle headline = look.style(1.25, Weight::medium, notice.alarming ? accent : text_colour);
  headline.align = Align::centre;
  headline.lines = 2;
  headline.from_top = true;
  TextStyle detail = look.style(0.95, Weight::regular, quiet);
  detail.align = Align::centre;
  detail.lines = 2;
  detail.from_top = true;
  // As high as its words, within its place.
  const double side = 1.2 * look.m.text, gap = 0.4 * look.m.text;
  const double width = place->width - 2.0 * side;
  const double first = look.size_of(notice.headline, headline, width)[1];
  const double second = notice.detail.empty() ? 0.0 : look.size_of(notice.detail, detail, width)[1] + gap;
  const double height = std::min(place->height, std::ceil(first + second + 1.6 * look.m.text));
  // On cards it stands on its place's lower edge.
  const bool low = place->centre()[1] > look.m.height / 2.0;
  const Rect rect = whole({place->x, low ? place->y + place->height - height : place->y, place->width, height});
  look.tiles.show(
      TileKind::overlay, 8, Key(look.base, notice.headline, notice.detail, notice.alarming), rect, [&](cairo_t* cr) {
        draw_glass(cr, rect, corner(look), card_glass, look.line);
        const double y = rect.y + (rect.height - first - second) / 2.0;
        look.fonts.draw(cr, notice.headline, headline, {rect.x + side, y, width, first});
        if (notice.detail.empty()) return;
        look.fonts.draw(cr, notice.detail, detail,
                        {rect.x + side, y + first + gap, width, std::max(1.0, rect.y + rect.height - y - first - gap)});
      });
}

}  // namespace lackwerk::kiosk::ui
