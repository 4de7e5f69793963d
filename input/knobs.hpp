// Every way in which something that turns can be plugged in.
//
// Why it exists: the kiosk asks for knobs, not for hidraw, libusb and evdev. Called once, by the kiosk's thread, which
// owns what it gets.
#pragma once

#include <memory>
#include <vector>

#include "input/knob_settings.hpp"
#include "input/source.hpp"

namespace lackwerk::input {

/// The sources the settings allow. A way that cannot be opened is left out and named in `problems`; no device at all is
/// a normal state, and devices may come later.
[[nodiscard]] std::vector<std::unique_ptr<Source>> open_knobs(const KnobSettings& settings,
                                                              std::vector<Notice>& problems);

}  // namespace lackwerk::input
