// The kiosk's input devices, opened as the configuration says.
//
// Why it exists: the loop wants sources, whatever they are; touch screens alone need to know which panel they lie on
// and when the seat is lost. No device at all is a normal state. The kiosk's thread.
#pragma once

#include <memory>
#include <vector>

#include "input/source.hpp"
#include "input/touch.hpp"
#include "kiosk/display/config.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/output/seat.hpp"

namespace lackwerk::kiosk {

struct Devices {
  std::vector<std::unique_ptr<input::Source>> sources;
  input::TouchScreens* touch = nullptr;  ///< one of the sources, or null
};

/// Touch screens and knobs. What cannot be opened is logged and left out. `seat` must outlive the sources.
[[nodiscard]] Devices open_devices(const Config& config, Seat& seat, Log& log);

}  // namespace lackwerk::kiosk
