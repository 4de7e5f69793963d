// HID knobs as a source of controls, on any bus.
//
// Why it exists: opening a device, asking it for a setting and reading it can each take seconds (a radio asleep, a
// permission not yet given), and the kiosk's one thread must not wait for any of it. So each device has a thread of its
// own that opens it, sets it up, reads it, and tries again after a fault until it is unplugged. What it reads goes into
// the device's Knob under a lock, merged and bounded there; an eventfd wakes the kiosk.
// The kiosk's thread owns this object; its destructor joins every thread (within the read time-out, or the few seconds
// that a feature report over radio may take).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "input/device_text.hpp"
#include "input/hid_bus.hpp"
#include "input/knob_settings.hpp"
#include "input/source.hpp"

namespace lackwerk::input {

/// Devices read at the same time; more of them wait until one goes.
inline constexpr std::size_t max_knob_devices = 16;

struct HidKnobsOptions {
  int read_timeout_ms = 250;    ///< how long a reader waits before it looks whether it shall end
  int settle_ms = 0;            ///< pause before a new device is touched
  int first_retry_ms = 50;      ///< pause after the first fault; doubles with each
  int longest_retry_ms = 5000;  ///< until here
  /// A device silent for longer may have slept and forgotten its settings: they are sent again at its next report.
  /// Older BlueZ removes the node of a sleeping Surface Dial, newer keeps it (notes in udev-hid-bpf's program for it).
  std::uint64_t asleep_after_us = 60'000'000;
  /// CLOCK_MONOTONIC in microseconds; any thread.
  std::function<std::uint64_t()> clock_us;
};

class HidKnobs : public Source {
 public:
  HidKnobs(std::unique_ptr<HidBus> bus, const KnobSettings& settings, HidKnobsOptions options = {});
  ~HidKnobs() override;

  void add_descriptors(std::vector<int>& out) const override;
  void read(double now_ms, std::vector<Control>& out) override;
  [[nodiscard]] double wake_at_ms() const override;
  void add_devices(std::vector<DeviceStatus>& out) const override;
  void take_notices(std::vector<Notice>& out) override;

  /// Threads not yet joined.
  [[nodiscard]] std::size_t threads() const;

 private:
  struct Port;
  struct Shared;

  void compare();
  void start(Port& port);
  void collect(double now_ms, std::vector<Control>& out);
  void reap();

  std::unique_ptr<HidBus> bus_;
  KnobSettings settings_;
  HidKnobsOptions options_;
  std::unique_ptr<Shared> shared_;            ///< what the readers' threads see of this object
  std::vector<std::unique_ptr<Port>> ports_;  ///< in the order of plugging
  std::set<std::string> present_;             ///< keys of the last list
  std::vector<DeviceStatus> gone_;
  std::size_t turn_ = 0;  ///< whose controls are handed out first
  double start_again_ms_ = never_ms;
  Notices notices_;
};

}  // namespace lackwerk::input
