// Values in HID reports: from bits to numbers and back.
//
// Why it exists: fields begin at any bit, have any width to 32 and any sign, and the report may be shorter than its
// descriptor promises. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "input/hid_descriptor.hpp"

namespace lackwerk::input {

/// Declared bytes of a report without its id byte; 0 where the descriptor has no such report.
[[nodiscard]] std::size_t hid_report_bytes(const HidDescriptor& descriptor, HidReportKind kind, std::uint8_t id);

/// An input report as it came from the device, taken apart.
struct HidReport {
  std::uint8_t id = 0;
  std::span<const std::uint8_t> payload;  ///< without the id byte; at least the declared bytes
};

/// Splits off the id where the device numbers its reports. Nothing where the report is empty, unknown, or shorter than
/// declared: half a report has no meaning, and a value made of missing bits is worse than none. Longer ones pass: some
/// transports pad.
[[nodiscard]] std::optional<HidReport> split_input_report(const HidDescriptor& descriptor,
                                                          std::span<const std::uint8_t> bytes);

/// Value `index` of a field, sign-extended when the field is signed. Nothing when the payload ends before it or the
/// field has fewer values.
[[nodiscard]] std::optional<std::int64_t> read_hid_value(const HidField& field, std::span<const std::uint8_t> payload,
                                                         std::uint32_t index = 0);

/// Writes value `index`, cut to the field's width; false, and nothing written, when it does not fit into the payload.
bool write_hid_value(const HidField& field, std::span<std::uint8_t> payload, std::uint32_t index, std::int64_t value);

}  // namespace lackwerk::input
