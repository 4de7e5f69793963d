// The interface's icons, drawn as lines and areas at any size.
//
// Why it exists: a showroom's visitors read no words; the same few signs stand on buttons, sliders and cards. Draws
// only; one thread a context.
#pragma once

#include <cairo.h>

#include <cstdint>

#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/theme.hpp"

namespace lackwerk::kiosk::ui {

enum class Icon : std::uint8_t {
  sparkle,
  droplet,
  beyond,
  lock_open,
  lock_closed,
  soft_box,
  sun,
  evening,
  moon,
  sprout,
  compare,
  qr,
  close,
  info,
  hand,
  minus,
  plus,
  erase,
  check,
};

/// Within the square of side `size` around `centre`.
void draw_icon(cairo_t* cr, Icon icon, Place centre, double size, const Colour& colour);

}  // namespace lackwerk::kiosk::ui
