// HID report descriptors: which bits of a report mean what.
//
// Why it exists: a knob nobody has heard of still says in its descriptor what can be turned and pressed, so one parser
// serves every device. Source: Device Class Definition for HID 1.11, 6.2.2 (usb.org). The bytes come from a stranger's
// device: every count is bounded before memory is taken. Values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::input {

/// Bounds. The kernel's own are 4096 bytes a descriptor and 16 KiB a report; no knob comes near.
inline constexpr std::size_t max_descriptor_bytes = 4096;
inline constexpr std::uint32_t max_report_bits = 8 * 4096;
inline constexpr std::size_t max_usages_per_field = 1024;
inline constexpr std::size_t max_fields = 1024;
inline constexpr std::size_t max_push_depth = 16;
inline constexpr std::size_t max_collection_depth = 32;

/// What a control is for (HID Usage Tables 1.3).
struct HidUsage {
  std::uint16_t page = 0;
  std::uint16_t id = 0;
  friend bool operator==(const HidUsage&, const HidUsage&) = default;
};

/// Usages first to first + count - 1 of one page; count >= 1.
struct HidUsageRange {
  HidUsage first;
  std::uint32_t count = 1;
};

enum class HidReportKind { input, output, feature };

/// One main item: `count` values of `bit_size` bits each, one after the other.
struct HidField {
  HidReportKind kind = HidReportKind::input;
  std::uint8_t report_id = 0;    ///< 0: the device numbers no reports
  std::uint32_t bit_offset = 0;  ///< of the first value, in the report after its id byte
  std::uint32_t bit_size = 0;    ///< 1 to 32
  std::uint32_t count = 0;       ///< >= 1
  std::vector<HidUsageRange> usages;
  std::int64_t logical_min = 0;  ///< <= logical_max; values are signed when this is negative
  std::int64_t logical_max = 0;
  std::int64_t physical_min = 0;  ///< both 0: as the logical range (6.2.2.7)
  std::int64_t physical_max = 0;
  std::uint32_t unit = 0;  ///< nibbles of 6.2.2.7; 0x14: degrees, 0x12: radians
  int unit_exponent = 0;   ///< power of ten, -8 to 7
  bool variable = false;   ///< one value per usage; otherwise an array of indices into the usages
  bool relative = false;
  bool wrap = false;        ///< an absolute value that goes round
  bool null_state = false;  ///< values outside the logical range mean "no data"
  HidUsage application;     ///< of the outermost collection of type Application; 0/0: none
};

struct HidDescriptor {
  bool numbered = false;         ///< reports begin with their id
  std::vector<HidField> fields;  ///< data only, no padding, in order of appearance
  std::vector<HidUsage> applications;
  /// Declared length of each report in bits, without the id byte.
  std::map<std::pair<HidReportKind, std::uint8_t>, std::uint32_t> report_bits;
};

/// Parses a descriptor of at most max_descriptor_bytes. `device` is used in errors, whose field is the byte offset.
///
/// Real devices are sloppy; these pass: reserved and unknown items, anything after the last collection that is not a
/// whole item (padding), long items, a usage range whose end lies before its start (dropped), more usages than values,
/// alternatives between delimiters (the first counts), and a field that cannot be read (a logical range that is empty,
/// or more than 32 bits a value) is left out while its bits are counted. Anything else that breaks the grammar is
/// refused: cut items, unbalanced collections or pops, report id 0, and whatever exceeds the bounds above.
[[nodiscard]] Result<HidDescriptor> parse_hid_descriptor(std::span<const std::uint8_t> bytes,
                                                         const std::string& device);

/// The usage of value `index` of a field, or for an array of entry `index` of its usages. Variable fields with fewer
/// usages than values repeat the last one (6.2.2.8); nothing without usages or beyond an array's.
[[nodiscard]] std::optional<HidUsage> usage_at(const HidField& field, std::uint64_t index);

}  // namespace lackwerk::input
