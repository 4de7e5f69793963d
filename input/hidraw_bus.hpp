// HID devices with a hidraw node: hidapi for reading, udev for coming and going, sysfs for report descriptors.
//
// Why it exists: hidapi 0.13 knows neither hot-plug nor report descriptors; udev and sysfs do. See hid_bus.hpp for who
// owns it and which thread may call what.
#pragma once

#include <memory>

#include "core/error.hpp"
#include "input/hid_bus.hpp"

namespace lackwerk::input {

/// The bus of all hidraw nodes; an error when udev cannot be asked. No node at all is a normal state.
[[nodiscard]] Result<std::unique_ptr<HidBus>> open_hidraw_bus();

}  // namespace lackwerk::input
