// USB HID interfaces that no kernel driver has: libusb itself.
//
// Why it exists: some kernels are built without usbhid or hidraw, some devices are on usbhid's ignore list (PowerMate),
// and an integrator may have unbound one. Only interfaces of class HID without a driver are ever touched: nothing is
// detached, so no keyboard and no hidraw knob is taken away from anybody. See hid_bus.hpp for who owns it and which
// thread may call what; it runs libusb's event thread, which ends with it.
#pragma once

#include <memory>

#include "core/error.hpp"
#include "input/hid_bus.hpp"

namespace lackwerk::input {

/// The kernel binds its driver shortly after a device appears: look again after this pause before claiming it.
inline constexpr int usb_settle_ms = 1000;

/// The bus of all driverless HID interfaces; an error when there is no USB or it may not be used.
[[nodiscard]] Result<std::unique_ptr<HidBus>> open_usb_bus();

}  // namespace lackwerk::input
