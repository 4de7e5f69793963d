#include "input/hid_report.hpp"

namespace lackwerk::input {
namespace {

/// Where value `index` begins, or nothing when it does not lie within `bytes`.
std::optional<std::uint64_t> bit_of(const HidField& field, std::uint32_t index, std::size_t bytes) {
  if (index >= field.count || field.bit_size == 0 || field.bit_size > 32) return std::nullopt;
  const std::uint64_t first = field.bit_offset + std::uint64_t{index} * field.bit_size;
  if (first + field.bit_size > 8 * std::uint64_t{bytes}) return std::nullopt;
  return first;
}

}  // namespace

std::size_t hid_report_bytes(const HidDescriptor& descriptor, HidReportKind kind, std::uint8_t id) {
  const auto found = descriptor.report_bits.find({kind, id});
  return found == descriptor.report_bits.end() ? 0 : (found->second + 7) / 8;
}

std::optional<HidReport> split_input_report(const HidDescriptor& descriptor, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return std::nullopt;
  HidReport report;
  report.payload = bytes;
  if (descriptor.numbered) {
    report.id = bytes[0];
    report.payload = bytes.subspan(1);
  }
  const std::size_t declared = hid_report_bytes(descriptor, HidReportKind::input, report.id);
  if (declared == 0 || report.payload.size() < declared) return std::nullopt;
  return report;
}

std::optional<std::int64_t> read_hid_value(const HidField& field, std::span<const std::uint8_t> payload,
                                           std::uint32_t index) {
  const auto first = bit_of(field, index, payload.size());
  if (!first) return std::nullopt;
  // 32 bits at any offset touch at most five bytes.
  std::uint64_t window = 0;
  for (std::uint64_t byte = *first / 8, k = 0; 8 * byte < *first + field.bit_size; ++byte, ++k)
    window |= std::uint64_t{payload[byte]} << (8 * k);
  const std::uint64_t value = (window >> (*first % 8)) & ((std::uint64_t{1} << field.bit_size) - 1);
  const std::uint64_t sign = std::uint64_t{1} << (field.bit_size - 1);
  if (field.logical_min >= 0) return static_cast<std::int64_t>(value);
  return static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
}

bool write_hid_value(const HidField& field, std::span<std::uint8_t> payload, std::uint32_t index, std::int64_t value) {
  const auto first = bit_of(field, index, payload.size());
  if (!first) return false;
  for (std::uint32_t bit = 0; bit < field.bit_size; ++bit) {
    const std::uint64_t at = *first + bit;
    const auto mask = static_cast<std::uint8_t>(1u << (at % 8));
    if (((static_cast<std::uint64_t>(value) >> bit) & 1) != 0)
      payload[at / 8] = static_cast<std::uint8_t>(payload[at / 8] | mask);
    else
      payload[at / 8] = static_cast<std::uint8_t>(payload[at / 8] & ~mask);
  }
  return true;
}

}  // namespace lackwerk::input
