#include "input/hidraw_bus.hpp"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>

#include "input/hid_descriptor.hpp"
#include "input/udev_monitor.hpp"

namespace lackwerk::input {
namespace {

const char* const rules_remedy = "install 70-lackwerk.rules for udev; it is tried again";

class HidrawDevice : public HidDevice {
 public:
  explicit HidrawDevice(hid_device* device) : device_(device) {}
  ~HidrawDevice() override { hid_close(device_); }

  int read(std::span<std::uint8_t> report, int timeout_ms) override {
    return hid_read_timeout(device_, report.data(), report.size(), timeout_ms);
  }

  bool get_feature(std::span<std::uint8_t> bytes) override {
    return hid_get_feature_report(device_, bytes.data(), bytes.size()) == static_cast<int>(bytes.size());
  }

  bool set_feature(std::span<const std::uint8_t> bytes) override {
    return hid_send_feature_report(device_, bytes.data(), bytes.size()) == static_cast<int>(bytes.size());
  }

 private:
  hid_device* device_;
};

class HidrawBus : public HidBus {
 public:
  explicit HidrawBus(std::unique_ptr<DeviceMonitor> monitor) : monitor_(std::move(monitor)) { list_anew(); }
  ~HidrawBus() override { hid_exit(); }

  void add_descriptors(std::vector<int>& out) const override { out.push_back(monitor_->descriptor()); }

  bool changed() override {
    std::vector<DeviceEvent> events;
    monitor_->read(events);
    for (const auto& event : events) {
      // A full list costs some 0.2 ms a device, too much for the kiosk's thread at every event.
      if (event.action == DeviceEvent::Action::lost) {
        list_anew();
        continue;
      }
      std::erase_if(nodes_, [&](const HidNode& node) { return node.key == event.system; });
      if (event.action != DeviceEvent::Action::removed) add(event);
    }
    return !events.empty();
  }

  [[nodiscard]] std::vector<HidNode> list() override { return nodes_; }

  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, HidFault> report_descriptor(const HidNode& node) override {
    const std::string path = node.key + "/device/report_descriptor";
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return tl::unexpected<HidFault>(fault(errno, path));
    std::vector<std::uint8_t> bytes(max_descriptor_bytes + 1);  // one too long is seen as such
    std::size_t size = 0;
    ssize_t got = 0;
    do {
      got = ::read(file, bytes.data() + size, bytes.size() - size);
      if (got > 0) size += static_cast<std::size_t>(got);
    } while ((got > 0 && size < bytes.size()) || (got < 0 && errno == EINTR));
    const int code = got < 0 ? errno : 0;
    ::close(file);
    if (code != 0) return tl::unexpected<HidFault>(fault(code, path));
    bytes.resize(size);
    return bytes;
  }

  [[nodiscard]] tl::expected<std::unique_ptr<HidDevice>, HidFault> open(const HidNode& node) override {
    // hidapi keeps the reason of a failure in one place for all threads, and initialises itself on the first call.
    const std::lock_guard lock(mutex_);
    errno = 0;
    if (hid_device* device = hid_open_path(node.path.c_str()); device != nullptr)
      return std::make_unique<HidrawDevice>(device);
    // hidapi does not hand out the error's number, and errno has passed through its clean-up: ask anew.
    const int code = ::access(node.path.c_str(), R_OK | W_OK) != 0 ? errno : EIO;
    return tl::unexpected<HidFault>(fault(code, node.path));
  }

 private:
  static HidFault fault(int code, const std::string& path) {
    const bool gone = code == ENOENT || code == ENODEV || code == ENXIO || code == ENOTDIR;
    return {gone, path + ": " + (gone ? "it is gone" : std::strerror(code)),
            code == EACCES || code == EPERM ? rules_remedy : ""};
  }

  void list_anew() {
    nodes_.clear();
    for (const auto& device : monitor_->list()) add(device);
  }

  void add(const DeviceEvent& device) {
    if (device.node.empty() || nodes_.size() >= max_listed_devices) return;
    HidNode node{device.system, device.node, 0, 0, device.hid_name};
    unsigned bus = 0, vendor = 0, product = 0;
    // "0003:0000077D:00000410"
    if (std::sscanf(device.hid_id.c_str(), "%x:%x:%x", &bus, &vendor, &product) == 3) {
      node.vendor = static_cast<std::uint16_t>(vendor);
      node.product = static_cast<std::uint16_t>(product);
    }
    nodes_.push_back(std::move(node));
  }

  std::unique_ptr<DeviceMonitor> monitor_;
  std::vector<HidNode> nodes_;  ///< as the events so far leave it
  std::mutex mutex_;
};

}  // namespace

Result<std::unique_ptr<HidBus>> open_hidraw_bus() {
  auto monitor = watch_devices({"hidraw"});
  if (!monitor) return tl::unexpected<Error>(monitor.error());
  return std::make_unique<HidrawBus>(std::move(*monitor));
}

}  // namespace lackwerk::input
