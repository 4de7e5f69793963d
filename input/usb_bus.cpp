#include "input/usb_bus.hpp"

#include <libusb.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "input/hid_descriptor.hpp"
#include "input/knob_settings.hpp"
#include "input/udev_monitor.hpp"

namespace lackwerk::input {
namespace {

// HID 1.11, 6.2.1 and 7.
constexpr std::uint8_t descriptor_hid = 0x21, descriptor_report = 0x22;
constexpr std::uint8_t request_get_descriptor = 0x06, request_get_report = 0x01, request_set_report = 0x09,
                       request_set_idle = 0x0a;
constexpr std::uint8_t standard_in = 0x81, class_in = 0xa1, class_out = 0x21;
constexpr std::uint16_t report_type_feature = 0x0300;

constexpr unsigned control_timeout_ms = 1000;
/// Transfers under way at a time, so that a fast device meets a waiting one at every poll.
constexpr std::size_t transfers_at_once = 4;
/// As many reports wait as in the kernel's hidraw; then the device is not asked until somebody has read.
constexpr std::size_t max_waiting_reports = 64;
constexpr int event_period_ms = 250;
/// Interrupt packets of USB 2 and 3 hold at most 1024 bytes; a report longer than one packet is no knob's.
constexpr int max_packet_bytes = 1024;

/// A HID interface on a USB device.
struct Interface {
  int number = 0;
  std::uint8_t in_endpoint = 0;
  int packet_bytes = 0;
  std::uint16_t descriptor_bytes = 0;
};

/// "/sys/bus/usb/devices/1-2.1:1.0/driver" exists when a driver has the interface.
bool has_driver(libusb_device* device, int configuration, int number) {
  std::array<std::uint8_t, 7> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  if (count <= 0) return true;  // a root hub
  std::string path = "/sys/bus/usb/devices/" + std::to_string(libusb_get_bus_number(device));
  for (int k = 0; k < count; ++k) path += (k == 0 ? "-" : ".") + std::to_string(ports.at(static_cast<std::size_t>(k)));
  path += ":" + std::to_string(configuration) + "." + std::to_string(number) + "/driver";
  return access(path.c_str(), F_OK) == 0;
}

/// Length of the report descriptor by the HID descriptor in an interface's extra bytes; 0: not said.
std::uint16_t report_descriptor_bytes(std::span<const unsigned char> extra) {
  while (extra.size() >= 2 && extra[0] >= 2 && extra[0] <= extra.size()) {
    // bLength, bDescriptorType, bcdHID, bCountryCode, bNumDescriptors, then type and length of the first.
    if (extra[1] == descriptor_hid && extra[0] >= 9 && extra[6] == descriptor_report)
      return static_cast<std::uint16_t>(extra[7] | (extra[8] << 8));
    extra = extra.subspan(extra[0]);
  }
  return 0;
}

/// The first alternate setting of an interface as a HID interface, if it is one that can be read.
std::optional<Interface> hid_interface(const libusb_interface& what) {
  if (what.num_altsetting < 1 || what.altsetting[0].bInterfaceClass != LIBUSB_CLASS_HID) return std::nullopt;
  const libusb_interface_descriptor& setting = what.altsetting[0];
  Interface out;
  out.number = setting.bInterfaceNumber;
  out.descriptor_bytes =
      report_descriptor_bytes({setting.extra, static_cast<std::size_t>(std::max(setting.extra_length, 0))});
  for (int k = 0; k < setting.bNumEndpoints; ++k) {
    const libusb_endpoint_descriptor& endpoint = setting.endpoint[k];
    const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
    if (!in || (endpoint.bmAttributes & 3) != LIBUSB_TRANSFER_TYPE_INTERRUPT) continue;
    out.in_endpoint = endpoint.bEndpointAddress;
    out.packet_bytes = endpoint.wMaxPacketSize & 0x7ff;
    break;
  }
  if (out.in_endpoint == 0 || out.packet_bytes < 1 || out.packet_bytes > max_packet_bytes) return std::nullopt;
  if (out.descriptor_bytes == 0 || out.descriptor_bytes > max_descriptor_bytes) return std::nullopt;
  return out;
}

HidFault fault_of(int code, const std::string& path) {
  const bool gone = code == LIBUSB_ERROR_NO_DEVICE || code == LIBUSB_ERROR_NOT_FOUND;
  return {gone, path + ": " + (gone ? "it is gone" : libusb_error_name(code)),
          code == LIBUSB_ERROR_ACCESS ? "install 70-lackwerk.rules for udev; it is tried again" : ""};
}

/// An opened device with one claimed interface; gives both back.
class Claim {
 public:
  static tl::expected<std::unique_ptr<Claim>, HidFault> make(libusb_device* device, const Interface& interface,
                                                             const std::string& path) {
    libusb_device_handle* handle = nullptr;
    if (const int code = libusb_open(device, &handle); code != 0) return tl::unexpected<HidFault>(fault_of(code, path));
    std::unique_ptr<Claim> out(new Claim(handle, interface));
    // Without detaching anything: a driver that came in between keeps it (LIBUSB_ERROR_BUSY).
    if (const int code = libusb_claim_interface(handle, interface.number); code != 0)
      return tl::unexpected<HidFault>(fault_of(code, path));
    out->claimed_ = true;
    return out;
  }
  ~Claim() {
    if (claimed_) libusb_release_interface(handle_, interface_.number);
    libusb_close(handle_);
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  [[nodiscard]] libusb_device_handle* handle() const { return handle_; }
  [[nodiscard]] const Interface& interface() const { return interface_; }
  int control(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::span<std::uint8_t> bytes) {
    return libusb_control_transfer(handle_, type, request, value, static_cast<std::uint16_t>(interface_.number),
                                   bytes.data(), static_cast<std::uint16_t>(bytes.size()), control_timeout_ms);
  }

 private:
  Claim(libusb_device_handle* handle, const Interface& interface) : handle_(handle), interface_(interface) {}
  libusb_device_handle* handle_;
  Interface interface_;
  bool claimed_ = false;
};

class UsbHidDevice : public HidDevice {
 public:
  explicit UsbHidDevice(std::unique_ptr<Claim> claim) : claim_(std::move(claim)) {
    const Interface& interface = claim_->interface();
    // Report changes only; devices that know no idle rate refuse, and that is fine (7.2.4).
    claim_->control(class_out, request_set_idle, 0, {});
    for (auto& slot : slots_) {
      slot.buffer.resize(static_cast<std::size_t>(interface.packet_bytes));
      slot.owner = this;
      slot.transfer = libusb_alloc_transfer(0);
      if (slot.transfer == nullptr) continue;
      libusb_fill_interrupt_transfer(slot.transfer, claim_->handle(), interface.in_endpoint, slot.buffer.data(),
                                     interface.packet_bytes, completed, &slot, 0);
      const std::lock_guard lock(mutex_);
      submit(slot);
    }
    const std::lock_guard lock(mutex_);
    if (under_way_ == 0) gone_ = true;
  }

  ~UsbHidDevice() override {
    std::unique_lock lock(mutex_);
    closing_ = true;
    for (auto& slot : slots_)
      if (slot.under_way) libusb_cancel_transfer(slot.transfer);
    // Each comes back through completed(), on libusb's thread, which outlives every device.
    changed_.wait(lock, [&] { return under_way_ == 0; });
    for (auto& slot : slots_)
      if (slot.transfer != nullptr) libusb_free_transfer(slot.transfer);
  }

  int read(std::span<std::uint8_t> report, int timeout_ms) override {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [&] { return gone_ || !reports_.empty(); });
    if (reports_.empty()) return gone_ ? -1 : 0;
    const auto bytes = std::move(reports_.front());
    reports_.pop_front();
    for (auto& slot : slots_)
      if (slot.parked && reports_.size() < max_waiting_reports) submit(slot);
    const std::size_t size = std::min(bytes.size(), report.size());
    std::copy_n(bytes.begin(), size, report.begin());
    return static_cast<int>(size);
  }

  bool get_feature(std::span<std::uint8_t> bytes) override {
    const std::uint8_t id = bytes[0];
    const auto value = static_cast<std::uint16_t>(report_type_feature | id);
    // A device that numbers its reports sends the id with them; another one does not.
    const auto body = id == 0 ? bytes.subspan(1) : bytes;
    return claim_->control(class_in, request_get_report, value, body) == static_cast<int>(body.size());
  }

  bool set_feature(std::span<const std::uint8_t> bytes) override {
    std::vector<std::uint8_t> copy(bytes.begin() + (bytes[0] == 0 ? 1 : 0), bytes.end());
    const auto value = static_cast<std::uint16_t>(report_type_feature | bytes[0]);
    return claim_->control(class_out, request_set_report, value, copy) == static_cast<int>(copy.size());
  }

 private:
  struct Slot {
    UsbHidDevice* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::vector<std::uint8_t> buffer;
    bool under_way = false;
    bool parked = false;  ///< waits for somebody to read
  };

  /// Under the lock.
  void submit(Slot& slot) {
    slot.parked = false;
    slot.under_way = !gone_ && !closing_ && libusb_submit_transfer(slot.transfer) == 0;
    under_way_ += slot.under_way ? 1 : 0;
    gone_ |= !slot.under_way;
  }

  static void LIBUSB_CALL completed(libusb_transfer* transfer) {
    auto& slot = *static_cast<Slot*>(transfer->user_data);
    slot.owner->finish(slot);
  }

  void finish(Slot& slot) {
    const std::lock_guard lock(mutex_);
    slot.under_way = false;
    --under_way_;
    if (slot.transfer->status == LIBUSB_TRANSFER_COMPLETED) {
      if (slot.transfer->actual_length > 0)
        reports_.emplace_back(slot.buffer.begin(), slot.buffer.begin() + slot.transfer->actual_length);
      slot.parked = reports_.size() >= max_waiting_reports;
      if (!slot.parked && !closing_) submit(slot);
    } else {
      gone_ = true;  // unplugged, stalled or cancelled: opened anew if it is still there
    }
    changed_.notify_all();
  }

  std::unique_ptr<Claim> claim_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Slot, transfers_at_once> slots_;
  std::deque<std::vector<std::uint8_t>> reports_;
  std::size_t under_way_ = 0;
  bool gone_ = false;
  bool closing_ = false;
};

class UsbBus : public HidBus {
 public:
  UsbBus(libusb_context* context, int signal, std::unique_ptr<DeviceMonitor> drivers)
      : context_(context), signal_(signal), drivers_(std::move(drivers)) {}

  /// Starts the event thread and asks for hot-plug events.
  bool start() {
    try {
      events_ = std::thread([this] { handle_events(); });
    } catch (const std::system_error&) {
      return false;
    }
    if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0)
      libusb_hotplug_register_callback(context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                                       LIBUSB_HOTPLUG_NO_FLAGS, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                                       LIBUSB_HOTPLUG_MATCH_ANY, plugged, this, nullptr);
    return true;
  }

  ~UsbBus() override {
    stop_ = true;
    libusb_interrupt_event_handler(context_);
    if (events_.joinable()) events_.join();
    libusb_exit(context_);
    close(signal_);
  }

  void add_descriptors(std::vector<int>& out) const override {
    out.push_back(signal_);
    if (drivers_) out.push_back(drivers_->descriptor());
  }

  bool changed() override {
    eventfd_t told = 0;
    bool any = eventfd_read(signal_, &told) == 0;
    if (!drivers_) return any;
    // libusb does not tell when a driver takes an interface or lets go of it; udev does.
    std::vector<DeviceEvent> events;
    drivers_->read(events);
    for (const auto& event : events)
      any |= event.action == DeviceEvent::Action::bound || event.action == DeviceEvent::Action::unbound ||
             event.action == DeviceEvent::Action::lost;
    return any;
  }

  [[nodiscard]] std::vector<HidNode> list() override {
    std::vector<HidNode> out;
    for_each_interface(
        [&](libusb_device*, const libusb_device_descriptor& device, const Interface&, const std::string& key) {
          // Its name is a string descriptor, and reading that would need the device opened.
          out.push_back({key, "usb " + key, device.idVendor, device.idProduct,
                         "USB HID " + device_id(device.idVendor, device.idProduct)});
          return false;
        });
    return out;
  }

  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, HidFault> report_descriptor(const HidNode& node) override {
    auto claim = claim_node(node);
    if (!claim) return tl::unexpected<HidFault>(claim.error());
    std::vector<std::uint8_t> bytes((*claim)->interface().descriptor_bytes);
    const int size = (*claim)->control(standard_in, request_get_descriptor, descriptor_report << 8, bytes);
    if (size < 0) return tl::unexpected<HidFault>(fault_of(size, node.path));
    bytes.resize(static_cast<std::size_t>(size));
    return bytes;
  }

  [[nodiscard]] tl::expected<std::unique_ptr<HidDevice>, HidFault> open(const HidNode& node) override {
    auto claim = claim_node(node);
    if (!claim) return tl::unexpected<HidFault>(claim.error());
    return std::make_unique<UsbHidDevice>(std::move(*claim));
  }

 private:
  /// Calls `what` with every HID interface that no driver has, until it returns true. Any thread.
  template <class What>
  void for_each_interface(const What& what) {
    libusb_device** devices = nullptr;
    const ssize_t count = libusb_get_device_list(context_, &devices);
    bool done = false;
    for (ssize_t k = 0; k < count && !done; ++k) {
      libusb_device_descriptor device{};
      libusb_config_descriptor* configuration = nullptr;
      if (libusb_get_device_descriptor(devices[k], &device) != 0) continue;
      if (libusb_get_active_config_descriptor(devices[k], &configuration) != 0) continue;
      for (int j = 0; j < configuration->bNumInterfaces && !done; ++j) {
        const auto interface = hid_interface(configuration->interface[j]);
        if (!interface || has_driver(devices[k], configuration->bConfigurationValue, interface->number)) continue;
        // The address is new with every plugging.
        const std::string key = "bus " + std::to_string(libusb_get_bus_number(devices[k])) + " address " +
                                std::to_string(libusb_get_device_address(devices[k])) + " interface " +
                                std::to_string(interface->number);
        done = what(devices[k], device, *interface, key);
      }
      libusb_free_config_descriptor(configuration);
    }
    if (count >= 0) libusb_free_device_list(devices, 1);
  }

  tl::expected<std::unique_ptr<Claim>, HidFault> claim_node(const HidNode& node) {
    tl::expected<std::unique_ptr<Claim>, HidFault> out =
        tl::unexpected<HidFault>({true, node.path + ": it is gone, or a kernel driver has it", ""});
    for_each_interface([&](libusb_device* device, const libusb_device_descriptor&, const Interface& interface,
                           const std::string& key) {
      if (key != node.key) return false;
      out = Claim::make(device, interface, node.path);
      return true;
    });
    return out;
  }

  void handle_events() {
    while (!stop_) {
      timeval timeout{0, event_period_ms * 1000};
      const int code = libusb_handle_events_timeout_completed(context_, &timeout, nullptr);
      if (code != 0 && code != LIBUSB_ERROR_INTERRUPTED && code != LIBUSB_ERROR_TIMEOUT)
        std::this_thread::sleep_for(std::chrono::milliseconds(event_period_ms));
    }
  }

  static int LIBUSB_CALL plugged(libusb_context*, libusb_device*, libusb_hotplug_event, void* bus) {
    eventfd_write(static_cast<UsbBus*>(bus)->signal_, 1);
    return 0;
  }

  libusb_context* context_;
  int signal_;
  std::unique_ptr<DeviceMonitor> drivers_;
  std::atomic<bool> stop_ = false;
  std::thread events_;
};

}  // namespace

Result<std::unique_ptr<HidBus>> open_usb_bus() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0)
    return fail("usb", "", std::string("libusb does not start: ") + libusb_error_name(code),
                "is there a USB controller, and is /dev/bus/usb visible?");
  const int signal = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (signal < 0) {
    libusb_exit(context);
    return fail("usb", "", "no eventfd");
  }
  // Without udev's word on drivers, plugging still works.
  auto drivers = watch_devices({"usb"});
  auto bus = std::make_unique<UsbBus>(context, signal, drivers ? std::move(*drivers) : nullptr);
  if (!bus->start()) return fail("usb", "", "no thread for libusb's events");
  return bus;
}

}  // namespace lackwerk::input
