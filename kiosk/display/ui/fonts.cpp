#include "kiosk/display/ui/fonts.hpp"

#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>

#include "kiosk/display/ui/draw_shapes.hpp"
#include "kiosk/display/ui/strings.hpp"

namespace lackwerk::kiosk::ui {
namespace {

/// Inter has no Arabic: Pango takes each run from the first family that has it.
constexpr const char* families = "Inter,DejaVu Sans,sans-serif";

PangoWeight pango_weight(Weight weight) {
  switch (weight) {
    case Weight::light:
      return PANGO_WEIGHT_LIGHT;
    case Weight::regular:
      break;
    case Weight::medium:
      return PANGO_WEIGHT_MEDIUM;
  }
  return PANGO_WEIGHT_NORMAL;
}

/// BCP 47 tags, for shaping and line breaks.
const char* tag(Language language) {
  switch (language) {
    case Language::english:
      break;
    case Language::german:
      return "de";
    case Language::arabic:
      return "ar";
  }
  return "en";
}

double px(int pango_units) { return pango_units_to_double(pango_units); }

}  // namespace

void Fonts::Unref::operator()(PangoContext* context) const { g_object_unref(context); }
void Fonts::Unref::operator()(PangoLayout* layout) const { g_object_unref(layout); }

Fonts::~Fonts() = default;

Result<std::unique_ptr<Fonts>> Fonts::create() {
  // Cairo's default map belongs to Pango and is not given back.
  PangoFontMap* map = pango_cairo_font_map_get_default();
  PangoFontFamily** found = nullptr;
  int count = 0;
  if (map != nullptr) pango_font_map_list_families(map, &found, &count);
  g_free(found);
  std::unique_ptr<Fonts> fonts(new Fonts);
  if (count > 0) {
    fonts->context_.reset(pango_font_map_create_context(map));
    const std::unique_ptr<PangoFontDescription, decltype(&pango_font_description_free)> wanted(
        pango_font_description_from_string(families), &pango_font_description_free);
    PangoFont* font = pango_font_map_load_font(map, fonts->context_.get(), wanted.get());
    if (font == nullptr) count = 0;
    if (font != nullptr) g_object_unref(font);
  }
  if (count == 0) return fail("fonts", "", "the system has no font", "install fonts-inter and fonts-dejavu-core");
  // Sizes are whole pixels of ours and the panel may stand on its side: no hinting, no subpixel colours.
  const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> options(
      cairo_font_options_create(), &cairo_font_options_destroy);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(fonts->context_.get(), options.get());
  pango_context_set_round_glyph_positions(fonts->context_.get(), FALSE);
  fonts->layout_.reset(pango_layout_new(fonts->context_.get()));
  fonts->set_language(Language::english);
  return fonts;
}

void Fonts::set_language(Language language) {
  language_ = language;
  pango_context_set_language(context_.get(), pango_language_from_string(tag(language)));
}

void Fonts::prepare(std::string_view text, const TextStyle& style, double width) {
  const bool from_right = right_to_left(language_) && !style.machine_text;
  pango_context_set_base_dir(context_.get(), from_right ? PANGO_DIRECTION_RTL : PANGO_DIRECTION_LTR);
  pango_layout_context_changed(layout_.get());
  PangoLayout* layout = layout_.get();
  const std::unique_ptr<PangoFontDescription, decltype(&pango_font_description_free)> font(
      pango_font_description_new(), &pango_font_description_free);
  pango_font_description_set_family_static(font.get(), families);
  pango_font_description_set_weight(font.get(), pango_weight(style.weight));
  pango_font_description_set_absolute_size(font.get(), style.size_px * PANGO_SCALE);
  pango_layout_set_font_description(layout, font.get());
  pango_layout_set_auto_dir(layout, FALSE);
  pango_layout_set_text(layout, text.data(), static_cast<int>(text.size()));
  pango_layout_set_width(layout, width > 0.0 ? static_cast<int>(width * PANGO_SCALE) : -1);
  pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_END);
  pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
  // Negative: lines of a paragraph.
  pango_layout_set_height(layout, -std::max(1, style.lines));
  // Without automatic direction Pango's left is left.
  const bool begins_right = right_to_left(language_);
  PangoAlignment align = PANGO_ALIGN_CENTER;
  if (style.align == Align::leading) align = begins_right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_LEFT;
  if (style.align == Align::trailing) align = begins_right ? PANGO_ALIGN_LEFT : PANGO_ALIGN_RIGHT;
  pango_layout_set_alignment(layout, align);
  PangoAttrList* attributes = nullptr;
  if (style.spacing_em != 0.0 && !from_right) {
    attributes = pango_attr_list_new();
    pango_attr_list_insert(
        attributes, pango_attr_letter_spacing_new(static_cast<int>(style.spacing_em * style.size_px * PANGO_SCALE)));
  }
  pango_layout_set_attributes(layout, attributes);
  if (attributes != nullptr) pango_attr_list_unref(attributes);
}

Rect Fonts::draw(cairo_t* cr, std::string_view text, const TextStyle& style, const Rect& box) {
  if (text.empty() || box.width < 1.0) return {box.x, box.y, 0.0, 0.0};
  prepare(text, style, box.width);
  PangoRectangle logical{};
  pango_layout_get_extents(layout_.get(), nullptr, &logical);
  const double height = px(logical.height);
  const double y = style.from_top ? box.y : box.y + (box.height - height) / 2.0;
  set_colour(cr, style.colour);
  cairo_move_to(cr, box.x, std::round(y));
  pango_cairo_show_layout(cr, layout_.get());
  return {box.x + px(logical.x), y, px(logical.width), height};
}

std::array<double, 2> Fonts::measure(std::string_view text, const TextStyle& style, double width) {
  prepare(text, style, width);
  PangoRectangle logical{};
  pango_layout_get_extents(layout_.get(), nullptr, &logical);
  return {px(logical.width), px(logical.height)};
}

}  // namespace lackwerk::kiosk::ui
