// The sizes everything of the interface is made of, from the surface alone.
//
// Why it exists: layout, painter and their tests must agree on how large a finger, a margin and a line of text are.
// Values; any thread.
#pragma once

#include "kiosk/display/ui/layout.hpp"

namespace lackwerk::kiosk::ui {

struct Metrics {
  double width = 0.0, height = 0.0;  ///< of the surface, px
  double edge = 0.0;                 ///< the shorter of them
  double target = 0.0;               ///< side of a touch target, px
  double margin = 0.0;               ///< around and between panels
  double text = 0.0;                 ///< size of ordinary text, px (Pango's absolute size)
  double swatch = 0.0;               ///< diameter of a swatch's disc
  double label = 0.0;                ///< height of the name under it
  bool portrait = false;
};

[[nodiscard]] Metrics metrics_of(const Surface& surface);

/// Whole pixels, never empty.
[[nodiscard]] Rect whole(const Rect& rect);
/// The smallest rectangle around the same centre that is at least `side` both ways, moved into the surface.
[[nodiscard]] Rect at_least(const Rect& rect, double side, const Metrics& metrics);
[[nodiscard]] inline Rect shrunk(const Rect& rect, double by) {
  return {rect.x + by, rect.y + by, rect.width - 2.0 * by, rect.height - 2.0 * by};
}

}  // namespace lackwerk::kiosk::ui
