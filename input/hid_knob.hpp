// One HID device as a knob: its reports in, controls out.
//
// Why it exists: it joins descriptor, layout and feel, and remembers what reports only imply (the last position of an
// absolute dial, which key was down). Pure state, no device; hidraw, libusb and tests feed it. Whoever shares one
// between threads locks it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "input/hid_descriptor.hpp"
#include "input/knob.hpp"
#include "input/knob_layout.hpp"

namespace lackwerk::input {

class HidKnob {
 public:
  /// Makes one from a report descriptor, or says why the device is no knob (an Error without remedy: nothing is wrong).
  [[nodiscard]] static Result<HidKnob> make(std::span<const std::uint8_t> descriptor, const std::string& name,
                                            const KnobTuning& tuning);

  /// One input report, with its id byte where the device numbers them. Malformed ones change nothing.
  void report(std::span<const std::uint8_t> bytes, std::uint64_t time_us);

  /// The feature report with which the device's counts a revolution are read and set; nothing where it has none.
  struct Resolution {
    std::uint8_t report_id = 0;
    std::size_t payload_bytes = 0;
  };
  [[nodiscard]] std::optional<Resolution> resolution() const;
  /// The finest resolution written into the payload of that feature report as it was read from the device; everything
  /// else in it stays.
  void set_resolution(std::span<std::uint8_t> payload) const;
  /// Tells the knob what a feature report, read from or accepted by the device, says.
  void use_resolution(std::span<const std::uint8_t> payload);

  /// The device was opened anew: positions are unknown, nothing is held.
  void reset(std::uint64_t time_us);
  [[nodiscard]] Knob& knob() { return knob_; }
  [[nodiscard]] const Knob& knob() const { return knob_; }
  [[nodiscard]] const KnobLayout& layout() const { return layout_; }
  /// Longest input report in bytes with its id.
  [[nodiscard]] std::size_t max_report_bytes() const;

 private:
  HidKnob(HidDescriptor descriptor, KnobLayout layout, const std::string& name, const KnobTuning& tuning);
  void move(std::size_t axis, std::int64_t value, std::uint64_t time_us);
  [[nodiscard]] bool is_on(const KnobSwitch& what, std::span<const std::uint8_t> payload) const;

  HidDescriptor descriptor_;
  KnobLayout layout_;
  KnobTuning tuning_;
  Knob knob_;
  std::vector<std::optional<std::int64_t>> positions_;  ///< of absolute axes
  std::vector<bool> on_;                                ///< of switches
};

}  // namespace lackwerk::input
