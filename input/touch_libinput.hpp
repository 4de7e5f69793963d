// Touches from real devices, by libinput in udev mode.
//
// Why it exists: libinput knows the protocols, quirks and calibration of touch screens, and its udev mode hears of
// devices that come and go (its path mode does not). Devices are opened by whoever has the right to: a seat manager or
// the process itself. The kernel lifts the button of a mouse or tablet that is unplugged some milliseconds before it
// says that the device is gone: that end looks like a hand's (fingers of touch screens are cancelled). The kiosk's
// thread only.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/error.hpp"
#include "input/touch_feed.hpp"

namespace lackwerk::input {

/// How device nodes are opened and given back. Neither may throw.
struct DeviceAccess {
  std::function<int(const std::string& path, int flags)> open;  ///< flags of open(2); a descriptor or -errno
  std::function<void(int fd)> close;
};

/// By open(2) and close(2), with the process's own rights.
[[nodiscard]] DeviceAccess direct_access();

/// `seat`: udev's name of it, "seat0". Finding no device is no error. Errors: udev does not answer.
[[nodiscard]] Result<std::unique_ptr<TouchFeed>> open_libinput(const std::string& seat, DeviceAccess access);

}  // namespace lackwerk::input
