// The one event type that every input becomes: touch, knobs, recorded and scripted input.
//
// Why it exists: the kiosk's state machine must not know what a customer turned or touched. Values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lackwerk::input {

enum class ControlKind {
  weights,          ///< values: one weight per paint, for all groups
  base,             ///< values: one weight per paint, for lobes, diffuse and colour table only
  flake_lightness,  ///< values: one weight per paint, L of the flakes only
  flake_colour,     ///< values: one weight per paint, a and b of the flakes only
  flake_white,      ///< values: [0, 1], how far the flakes' a and b are taken out
  camera,           ///< name: a camera of the scene
  orbit,            ///< values: azimuth and elevation to add, degrees
  zoom,             ///< values: factor on the distance to the target, > 0
  light,            ///< values: number of the mood, 0 to 2
  dimmer,           ///< values: [0, 1], day to showroom night
  time,             ///< values: [0, 1], from the first scan to the last
  turn,             ///< values: detents, positive clockwise; fractions after acceleration. name: the knob
  press,            ///< values: number of the button, the main one is 0. name: the knob
  release,          ///< as press
  touch_down,       ///< values: x, y in [0, 1] from the upper left corner of the panel as it is built; contact: which
                    ///< finger
  touch_move,       ///< as touch_down
  touch_up,         ///< contact only
  touch_cancel,     ///< contact only: forget that finger, nothing was meant (its device is gone)
};

struct Control {
  ControlKind kind = ControlKind::weights;
  std::vector<double> values{};
  std::string name{};
  int contact = 0;            ///< finger, unique among those that touch at this time, over all devices
  std::uint64_t time_us = 0;  ///< CLOCK_MONOTONIC when the device reported it; 0: unknown
};

}  // namespace lackwerk::input
