#include "input/udev_monitor.hpp"

#include <libudev.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

namespace lackwerk::input {
namespace {

struct Unref {
  void operator()(udev* p) const { udev_unref(p); }
  void operator()(udev_device* p) const { udev_device_unref(p); }
  void operator()(udev_enumerate* p) const { udev_enumerate_unref(p); }
  void operator()(udev_monitor* p) const { udev_monitor_unref(p); }
};
template <class T>
using Handle = std::unique_ptr<T, Unref>;

/// Room for a burst of events (a hub with everything on it): the default of some 200 KiB overruns at about 100.
constexpr int receive_buffer_bytes = 4 << 20;

std::string text(const char* value) { return value == nullptr ? std::string() : std::string(value); }

DeviceEvent::Action action_of(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, DeviceEvent::Action>, 6> words{
      {{"add", DeviceEvent::Action::added},
       {"remove", DeviceEvent::Action::removed},
       {"bind", DeviceEvent::Action::bound},
       {"unbind", DeviceEvent::Action::unbound},
       {"online", DeviceEvent::Action::added},
       {"offline", DeviceEvent::Action::removed}}};
  for (const auto& [name, action] : words)
    if (name == word) return action;
  return DeviceEvent::Action::changed;
}

class UdevMonitor : public DeviceMonitor {
 public:
  UdevMonitor(Handle<udev> context, Handle<udev_monitor> monitor, std::vector<std::string> subsystems,
              std::vector<std::string> properties)
      : context_(std::move(context)),
        monitor_(std::move(monitor)),
        subsystems_(std::move(subsystems)),
        properties_(std::move(properties)) {}

  [[nodiscard]] int descriptor() const override { return udev_monitor_get_fd(monitor_.get()); }

  [[nodiscard]] std::vector<DeviceEvent> list() override {
    std::vector<DeviceEvent> out;
    const Handle<udev_enumerate> enumerate(udev_enumerate_new(context_.get()));
    if (!enumerate) return out;
    for (const auto& subsystem : subsystems_) udev_enumerate_add_match_subsystem(enumerate.get(), subsystem.c_str());
    if (udev_enumerate_scan_devices(enumerate.get()) < 0) return out;
    udev_list_entry* entry = udev_enumerate_get_list_entry(enumerate.get());
    for (; entry != nullptr && out.size() < max_listed_devices; entry = udev_list_entry_get_next(entry)) {
      const Handle<udev_device> device(udev_device_new_from_syspath(context_.get(), udev_list_entry_get_name(entry)));
      if (device) out.push_back(describe(device.get(), DeviceEvent::Action::present));
    }
    return out;
  }

  void read(std::vector<DeviceEvent>& out) override {
    for (std::size_t count = 0; count < max_device_events; ++count) {
      errno = 0;
      const Handle<udev_device> device(udev_monitor_receive_device(monitor_.get()));
      if (!device) {
        // The kernel says once that the buffer ran over; what it held of later events is still to come.
        if (errno == ENOBUFS) {
          out.emplace_back().action = DeviceEvent::Action::lost;
          continue;
        }
        return;
      }
      out.push_back(describe(device.get(), action_of(text(udev_device_get_action(device.get())))));
    }
  }

 private:
  DeviceEvent describe(udev_device* device, DeviceEvent::Action action) const {
    DeviceEvent out;
    out.action = action;
    out.subsystem = text(udev_device_get_subsystem(device));
    out.type = text(udev_device_get_devtype(device));
    out.system = text(udev_device_get_syspath(device));
    out.node = text(udev_device_get_devnode(device));
    // The parent belongs to the device: it is not ours to release.
    if (udev_device* hid = udev_device_get_parent_with_subsystem_devtype(device, "hid", nullptr); hid != nullptr) {
      out.hid_system = text(udev_device_get_syspath(hid));
      out.hid_id = text(udev_device_get_property_value(hid, "HID_ID"));
      out.hid_name = text(udev_device_get_property_value(hid, "HID_NAME"));
    }
    for (const auto& name : properties_)
      if (const char* value = udev_device_get_property_value(device, name.c_str()); value != nullptr)
        out.properties[name] = value;
    return out;
  }

  Handle<udev> context_;
  Handle<udev_monitor> monitor_;
  std::vector<std::string> subsystems_;
  std::vector<std::string> properties_;
};

}  // namespace

Result<std::unique_ptr<DeviceMonitor>> watch_devices(const std::vector<std::string>& subsystems,
                                                     const std::vector<std::string>& properties) {
  const auto refused = [](const char* what) {
    return fail("udev", "", std::string(what) + ": " + std::strerror(errno == 0 ? ENOMEM : errno),
                "allow AF_NETLINK sockets and do not use PrivateNetwork=");
  };
  errno = 0;
  Handle<udev> context(udev_new());
  if (!context) return refused("no context");
  Handle<udev_monitor> monitor(udev_monitor_new_from_netlink(context.get(), "udev"));
  if (!monitor) return refused("no monitor");
  for (const auto& subsystem : subsystems)
    if (udev_monitor_filter_add_match_subsystem_devtype(monitor.get(), subsystem.c_str(), nullptr) < 0)
      return refused("no filter");
  // Needs privileges on some kernels; without them the default has to do, and overruns are noticed.
  udev_monitor_set_receive_buffer_size(monitor.get(), receive_buffer_bytes);
  if (udev_monitor_enable_receiving(monitor.get()) < 0) return refused("no events");
  return std::make_unique<UdevMonitor>(std::move(context), std::move(monitor), subsystems, properties);
}

MemoryDeviceMonitor::MemoryDeviceMonitor() : signal_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

MemoryDeviceMonitor::~MemoryDeviceMonitor() {
  if (signal_ >= 0) close(signal_);
}

void MemoryDeviceMonitor::add(DeviceEvent device) {
  device.action = DeviceEvent::Action::present;
  devices_.push_back(device);
  device.action = DeviceEvent::Action::added;
  tell(std::move(device));
}

void MemoryDeviceMonitor::remove(const std::string& system) {
  const auto found =
      std::find_if(devices_.begin(), devices_.end(), [&](const DeviceEvent& d) { return d.system == system; });
  if (found == devices_.end()) return;
  DeviceEvent event = *found;
  devices_.erase(found);
  event.action = DeviceEvent::Action::removed;
  tell(std::move(event));
}

void MemoryDeviceMonitor::tell(DeviceEvent event) {
  events_.push_back(std::move(event));
  eventfd_write(signal_, 1);
}

void MemoryDeviceMonitor::read(std::vector<DeviceEvent>& out) {
  for (std::size_t count = 0; count < max_device_events && !events_.empty(); ++count) {
    out.push_back(std::move(events_.front()));
    events_.pop_front();
  }
  eventfd_t told = 0;
  if (events_.empty()) eventfd_read(signal_, &told);
}

}  // namespace lackwerk::input
