// Dials that a kernel driver turns into input events: REL_DIAL, REL_WHEEL, REL_HWHEEL without a mouse around them.
//
// Why it exists: the PowerMate has a kernel driver of its own and no hidraw node, and boards with a rotary encoder on
// GPIO pins (rotary-encoder, gpio-keys) look the same. Plain reads of struct input_event, non-blocking, on the kiosk's
// thread: there is nothing to wait for. Dials that also have a hidraw node belong to HidKnobs and are left alone.
// The kiosk's thread owns it and everything in it.
#pragma once

#include <linux/input-event-codes.h>

#include <bitset>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "input/device_text.hpp"
#include "input/hid_bus.hpp"
#include "input/knob.hpp"
#include "input/knob_settings.hpp"
#include "input/source.hpp"
#include "input/udev_monitor.hpp"

namespace lackwerk::input {

using EvdevKeys = std::bitset<KEY_CNT>;

/// What an input device says of itself.
struct EvdevInfo {
  std::string name;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::bitset<REL_CNT> relative;
  EvdevKeys keys;
  bool has_hidraw = false;  ///< its HID device has a hidraw node
};

/// The edge to input devices; the twin in the tests answers with pipes. One thread, nothing blocks.
class EvdevBus {
 public:
  virtual ~EvdevBus() = default;
  EvdevBus() = default;
  EvdevBus(const EvdevBus&) = delete;
  EvdevBus& operator=(const EvdevBus&) = delete;

  [[nodiscard]] virtual DeviceMonitor& monitor() = 0;
  [[nodiscard]] virtual const DeviceMonitor& monitor() const = 0;
  /// Without opening it.
  [[nodiscard]] virtual EvdevInfo describe(const DeviceEvent& device) = 0;
  /// A non-blocking descriptor of input events, which the caller closes.
  [[nodiscard]] virtual tl::expected<int, HidFault> open(const DeviceEvent& device) = 0;
  /// Keys held now; nothing when that cannot be asked.
  [[nodiscard]] virtual std::optional<EvdevKeys> held(int descriptor) = 0;
};

/// The bus of udev's input devices.
[[nodiscard]] Result<std::unique_ptr<EvdevBus>> open_evdev_bus();

/// Why a device is no dial; empty: it is one.
[[nodiscard]] std::string not_a_dial(const EvdevInfo& info, const KnobTuning& tuning);

class EvdevDials : public Source {
 public:
  EvdevDials(std::unique_ptr<EvdevBus> bus, const KnobSettings& settings);
  ~EvdevDials() override;

  void add_descriptors(std::vector<int>& out) const override;
  void read(double now_ms, std::vector<Control>& out) override;
  [[nodiscard]] double wake_at_ms() const override;
  void add_devices(std::vector<DeviceStatus>& out) const override;
  void take_notices(std::vector<Notice>& out) override;

 private:
  struct Dial;

  void follow(double now_ms);
  void list_anew(double now_ms);
  void consider(const DeviceEvent& device, double now_ms);
  void try_open(Dial& dial, double now_ms);
  bool read_events(Dial& dial, std::uint64_t now_us);
  void close(Dial& dial, std::uint64_t now_us);

  std::unique_ptr<EvdevBus> bus_;
  KnobSettings settings_;
  std::vector<std::unique_ptr<Dial>> dials_;
  bool listed_ = false;
  Notices notices_;
};

}  // namespace lackwerk::input
