// Which devices there are, and what comes and goes: udev, or its in-memory twin.
//
// Why it exists: knobs, dials and monitors are all plugged and pulled while the kiosk runs, and hidapi has no hot-plug.
// Events come after udev's rules have run, so that a node has its final permissions (mostly: another process may still
// be at it). Whoever makes a monitor owns it; one thread calls it.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::input {

/// A device, or what happened to it.
struct DeviceEvent {
  enum class Action {
    present,  ///< it was there when the list was made
    added,
    removed,
    changed,
    bound,    ///< a kernel driver took it
    unbound,  ///< a kernel driver let go of it
    lost,     ///< events were lost, the rest of this one is empty: make a new list
  };
  Action action = Action::present;
  std::string subsystem;  ///< "hidraw", "input", "drm", "usb"
  std::string type;       ///< "usb_interface" and the like; often empty
  std::string system;     ///< folder in /sys: the identity of the device
  std::string node;       ///< "/dev/hidraw0"; empty where there is none
  /// Of the HID device it belongs to, if any: folder in /sys, "BUS:VENDOR:PRODUCT" in hexadecimal, and its name.
  std::string hid_system;
  std::string hid_id;
  std::string hid_name;
  std::map<std::string, std::string> properties;  ///< those that were asked for and exist
};

class DeviceMonitor {
 public:
  virtual ~DeviceMonitor() = default;
  DeviceMonitor() = default;
  DeviceMonitor(const DeviceMonitor&) = delete;
  DeviceMonitor& operator=(const DeviceMonitor&) = delete;

  /// Readable when read() has something.
  [[nodiscard]] virtual int descriptor() const = 0;
  /// Every device of the subsystems there is now, at most max_listed_devices.
  [[nodiscard]] virtual std::vector<DeviceEvent> list() = 0;
  /// Appends what has happened, at most max_device_events a call; more stays readable. Never blocks.
  virtual void read(std::vector<DeviceEvent>& out) = 0;
};

inline constexpr std::size_t max_listed_devices = 1024;
inline constexpr std::size_t max_device_events = 64;

/// Watches subsystems through udev. `properties`: udev properties to copy into the events ("HOTPLUG").
[[nodiscard]] Result<std::unique_ptr<DeviceMonitor>> watch_devices(const std::vector<std::string>& subsystems,
                                                                   const std::vector<std::string>& properties = {});

/// The twin: devices are what a test says.
class MemoryDeviceMonitor : public DeviceMonitor {
 public:
  MemoryDeviceMonitor();
  ~MemoryDeviceMonitor() override;
  void add(DeviceEvent device);
  void remove(const std::string& system);
  /// An event as it is, without effect on the list.
  void tell(DeviceEvent event);

  [[nodiscard]] int descriptor() const override { return signal_; }
  [[nodiscard]] std::vector<DeviceEvent> list() override { return devices_; }
  void read(std::vector<DeviceEvent>& out) override;

 private:
  int signal_ = -1;
  std::vector<DeviceEvent> devices_;
  std::deque<DeviceEvent> events_;
};

}  // namespace lackwerk::input
