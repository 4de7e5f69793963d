// The edge to HID devices: who is there, open one, read its reports.
//
// Why it exists: hidraw nodes, USB interfaces without a driver and a test's imagination are three buses with one
// behaviour, so that the logic above them (threads, retries, unplugging) is written and tested once. Whoever makes a
// bus owns it and destroys it after every device opened through it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace lackwerk::input {

/// A place where a HID device is, for as long as it is plugged in.
struct HidNode {
  std::string key;   ///< identity of this plugging, unique on its bus
  std::string path;  ///< what a person would look for: "/dev/hidraw0", "usb 1-2.1 interface 0"
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string name;  ///< as the device gives it, not cleaned
};

/// Why a device could not be used just now.
struct HidFault {
  bool for_good = false;  ///< trying again is pointless: it is gone, or a driver has it
  std::string what;
  std::string remedy;
};

/// An opened device; closed by its destructor. One thread.
class HidDevice {
 public:
  virtual ~HidDevice() = default;
  HidDevice() = default;
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;

  /// Waits at most `timeout_ms` for an input report and copies it. Its length; 0: none came; -1: the device is gone.
  virtual int read(std::span<std::uint8_t> report, int timeout_ms) = 0;
  /// Reads a feature report; bytes[0] is its id going in. True when all of `bytes` was filled.
  virtual bool get_feature(std::span<std::uint8_t> bytes) = 0;
  /// Sends a feature report, id first.
  virtual bool set_feature(std::span<const std::uint8_t> bytes) = 0;
};

class HidBus {
 public:
  virtual ~HidBus() = default;
  HidBus() = default;
  HidBus(const HidBus&) = delete;
  HidBus& operator=(const HidBus&) = delete;

  // For one thread, never blocking:
  /// Appends the descriptors that become readable when nodes come or go.
  virtual void add_descriptors(std::vector<int>& out) const = 0;
  /// True when nodes may have come or gone since the last call.
  virtual bool changed() = 0;
  /// The nodes there are now. A node that went and came back between two calls has another key.
  [[nodiscard]] virtual std::vector<HidNode> list() = 0;

  // For any thread, and may take a while:
  [[nodiscard]] virtual tl::expected<std::vector<std::uint8_t>, HidFault> report_descriptor(const HidNode& node) = 0;
  [[nodiscard]] virtual tl::expected<std::unique_ptr<HidDevice>, HidFault> open(const HidNode& node) = 0;
};

}  // namespace lackwerk::input
