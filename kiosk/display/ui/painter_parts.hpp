// What the painter's screens share: everything a drawing function needs to know, and the few pieces that stand on more
// than one screen.
//
// Why it exists: each screen has its own file. Values and references for the length of one paint(); one thread.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "kiosk/display/ui/arrangement.hpp"
#include "kiosk/display/ui/draw_icons.hpp"
#include "kiosk/display/ui/fonts.hpp"
#include "kiosk/display/ui/strings.hpp"
#include "kiosk/display/ui/tiles.hpp"

namespace lackwerk::kiosk::ui {

struct SwatchPicture {
  int edge_px = 0;
  std::vector<std::uint8_t> rgb;
  std::uint64_t version = 0;  ///< rises with every new picture
};
struct SwatchView {
  int edge_px = 0;
  std::span<const std::uint8_t> rgb;
  std::uint64_t version = 0;
};

/// Sizes of texts by what was measured: shaping costs more than looking up.
using Measured = std::map<std::uint64_t, std::array<double, 2>>;

struct Look {
  const Surface& surface;
  const Content& content;
  const Model& model;
  const DealerFacts* dealer;
  const Arrangement& arrangement;
  Metrics m;
  Key base;     ///< what every tile depends on: surface and language
  double line;  ///< of edges and icons' company, px: whole, 1 at 720
  const std::vector<SwatchPicture>& swatches;
  Fonts& fonts;
  TileStore& tiles;
  Measured& measured;

  [[nodiscard]] std::string_view text(Text what) const { return ui::text(what, model.language); }
  [[nodiscard]] bool mirrored() const { return right_to_left(model.language); }
  [[nodiscard]] TextStyle style(double size, Weight weight = Weight::regular, Colour colour = text_colour) const {
    TextStyle out;
    out.size_px = size * m.text;
    out.weight = weight;
    out.colour = colour;
    return out;
  }
  /// Within one line; remembered.
  [[nodiscard]] std::array<double, 2> size_of(std::string_view words, const TextStyle& style, double width) const;
  /// Empty where there is none yet.
  [[nodiscard]] SwatchView picture_of_paint(std::size_t paint) const {
    if (paint >= swatches.size()) return {};
    return {swatches[paint].edge_px, swatches[paint].rgb, swatches[paint].version};
  }
  /// Leading part of a box, and what is left; sides by the direction of writing.
  [[nodiscard]] Rect leading(const Rect& box, double width) const {
    return {mirrored() ? box.x + box.width - width : box.x, box.y, width, box.height};
  }
  [[nodiscard]] Rect after(const Rect& box, double width) const {
    return {mirrored() ? box.x : box.x + width, box.y, box.width - width, box.height};
  }
};

/// How a control is shown now.
struct Emphasis {
  bool pressed = false;
  bool focused = false;  ///< by a knob
  bool dim = false;      ///< a knob has focused something else
};
[[nodiscard]] Emphasis emphasis_of(const Model& model, Widget widget, int index);
/// A key of how all these items are shown.
[[nodiscard]] Key emphasis_key(const Model& model, std::span<const Item> items);
/// The items that answer to one of `widgets`.
[[nodiscard]] std::vector<Item> items_of(const Arrangement& arrangement, std::span<const Widget> widgets);

/// Room around a panel for a focused control's glow.
[[nodiscard]] double halo(const Look& look);
[[nodiscard]] double corner(const Look& look);
[[nodiscard]] Rect grown(const Rect& rect, double by);
[[nodiscard]] Place middle_px(const Rect& rect);

/// An icon in its item, with what emphasis asks for. `on`: the choice that holds.
void draw_button(const Look& look, cairo_t* cr, const Item& item, Icon icon, bool on);
/// The tint under a finger and the ring of a focused item.
void draw_emphasis(const Look& look, cairo_t* cr, const Item& item);

void paint_attract(const Look& look);
void paint_show(const Look& look);
void paint_pad(const Look& look);
/// The hand that shows what to do, on top of what it shows.
void paint_hint(const Look& look);
void paint_compare(const Look& look);
void paint_take_home(const Look& look);
void paint_about(const Look& look);
void paint_pin(const Look& look);
void paint_dealer(const Look& look);
void paint_toast(const Look& look);
void paint_countdown(const Look& look);

}  // namespace lackwerk::kiosk::ui
