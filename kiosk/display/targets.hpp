// What a script may touch by name, and where that is now.
//
// Why it exists: a tour must work on every size and in every language, and the system's tests must find what they want
// to touch: names instead of places. One table of names for scripts and status.json. Pure; any thread.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "input/script.hpp"
#include "kiosk/display/ui/content.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

/// As in ui::Widget: "swatch", "sparkle_lock", ...
[[nodiscard]] const char* widget_name(ui::Widget widget);
[[nodiscard]] std::optional<ui::Widget> widget_of(std::string_view name);

/// "attract", "show", "take_home", "about", "pin", "dealer".
[[nodiscard]] const char* screen_name(ui::Screen screen);

/// Where a target is, in pixels of the picture:
/// - picture:X,Y and X Y: there, in [0, 1] of the picture;
/// - car[:X,Y]: the place nearest to that (0.5,0.5) where the car answers, not the interface;
/// - pad[:X,Y]: in [0, 1] of the pad's field; puck: the puck;
/// - sparkle, hue, beyond, dimmer[:P]: position P (0.5) of the slider;
/// - every other widget's name[:INDEX]: its middle; index 0 if it is left out.
/// Error: no such name, or it is not on the screen.
[[nodiscard]] Result<ui::Place> target_place(const input::TouchTarget& target, const ui::Surface& surface,
                                             const ui::Content& content, const ui::Model& model);

}  // namespace lackwerk::kiosk
