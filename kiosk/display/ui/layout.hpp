// Where everything of the interface is: one function from a model to rectangles.
//
// Why it exists: what is seen and what is touched must be the same places, in landscape and portrait, at every size, in
// both directions of writing. Behaviour asks what lies under a finger, the painter draws into the same rectangles.
// Pure; any thread.
#pragma once

#include <optional>
#include <vector>

#include "kiosk/display/ui/content.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk::ui {

/// Pixels of the picture, from its upper left corner.
struct Rect {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  [[nodiscard]] bool contains(Place px) const {
    return px[0] >= x && px[0] < x + width && px[1] >= y && px[1] < y + height;
  }
  [[nodiscard]] Place centre() const { return {x + width / 2.0, y + height / 2.0}; }
  bool operator==(const Rect&) const = default;
};

struct Item {
  Widget widget = Widget::none;
  int index = 0;
  Rect rect;   ///< what is drawn
  Rect touch;  ///< what answers: at least least_touch_mm both ways
};

inline constexpr double least_touch_mm = 12.0;

/// What there is to see and touch on the model's screen, lowest first. Never empty areas, never outside the surface.
/// Sizes grow with the surface's shorter edge and never let a touch target fall below least_touch_mm (on surfaces with
/// room for it: at least 90 mm along the shorter edge; below, targets share what there is).
[[nodiscard]] std::vector<Item> layout(const Surface& surface, const Content& content, const Model& model);

/// The topmost item whose touch area holds the point; swatches and their names win by distance to their centre.
/// Widget::car where there is nothing else on attract and show, Widget::none elsewhere.
[[nodiscard]] Item item_at(const std::vector<Item>& items, Screen screen, Place px);

/// The first item of a kind.
[[nodiscard]] std::optional<Item> find_item(const std::vector<Item>& items, Widget widget, int index = 0);

/// The part of the pad that places are fractions of: swatches on its border stay whole. `pad`: the item's rect.
[[nodiscard]] Rect pad_field(const Surface& surface, const Rect& pad);
/// The line a slider's knob runs along. Right-to-left languages mirror it: `from` is then the right end.
struct Track {
  Place from{}, to{};                             ///< pixels of the positions 0 and 1
  [[nodiscard]] double position(Place px) const;  ///< nearest, clamped to [0, 1]
  [[nodiscard]] Place at(double position) const;
};
[[nodiscard]] Track slider_track(const Surface& surface, const Item& slider, Language language);

/// Where the swatches stand when a visit begins: 1: the middle; 2: the ends of a line; more: a ring.
[[nodiscard]] std::vector<Place> first_places(std::size_t paints);

inline constexpr int calibration_steps = 4;
/// Where the dealer is to touch for this step of a calibration, [0, 3], in pixels: the middle of a cross.
[[nodiscard]] Place calibration_cross(const Surface& surface, int step);

}  // namespace lackwerk::kiosk::ui
