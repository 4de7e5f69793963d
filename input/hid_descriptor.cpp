#include "input/hid_descriptor.hpp"

#include <cstdio>
#include <limits>

namespace lackwerk::input {
namespace {

// Item prefix, 6.2.2.2: two bits of size (3 means four bytes), two of type, four of tag.
constexpr std::uint8_t long_item = 0xfe;
enum ItemType : std::uint8_t { main_item = 0, global_item = 1, local_item = 2 };

// 6.2.2.4
enum MainTag : std::uint8_t { tag_input = 8, tag_output = 9, tag_collection = 10, tag_feature = 11, tag_end = 12 };
constexpr std::uint32_t collection_application = 1;
constexpr std::uint32_t flag_constant = 1u << 0, flag_variable = 1u << 1, flag_relative = 1u << 2, flag_wrap = 1u << 3,
                        flag_null = 1u << 6;

// 6.2.2.7
enum GlobalTag : std::uint8_t {
  tag_usage_page = 0,
  tag_logical_min = 1,
  tag_logical_max = 2,
  tag_physical_min = 3,
  tag_physical_max = 4,
  tag_unit_exponent = 5,
  tag_unit = 6,
  tag_report_size = 7,
  tag_report_id = 8,
  tag_report_count = 9,
  tag_push = 10,
  tag_pop = 11,
};

// 6.2.2.8
enum LocalTag : std::uint8_t { tag_usage = 0, tag_usage_min = 1, tag_usage_max = 2, tag_delimiter = 10 };

/// An item's data, kept in both readings: which one holds may depend on an item that follows.
struct Number {
  std::uint32_t raw = 0;
  std::int32_t number = 0;
};

struct Item {
  std::uint8_t type = 0;
  std::uint8_t tag = 0;
  std::size_t size = 0;
  Number data;
};

struct Globals {
  std::uint16_t page = 0;
  Number logical_min, logical_max, physical_min, physical_max;
  int unit_exponent = 0;
  std::uint32_t unit = 0;
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
  std::uint8_t report_id = 0;
};

/// A local usage before its page is known: short ones take the page in force at the main item.
struct LocalUsage {
  std::uint32_t value = 0;
  std::uint32_t count = 1;
  bool extended = false;
};

struct Locals {
  std::vector<LocalUsage> usages;
  std::optional<Item> minimum;
  bool delimited = false;
  bool delimiter_used = false;
};

Number number_of(std::span<const std::uint8_t> data) {
  std::uint32_t raw = 0;
  for (std::size_t k = 0; k < data.size(); ++k) raw |= std::uint32_t{data[k]} << (8 * k);
  const auto bits = static_cast<unsigned>(8 * data.size());
  if (bits == 0 || bits == 32) return {raw, static_cast<std::int32_t>(raw)};
  const std::uint32_t sign = 1u << (bits - 1);
  return {raw, static_cast<std::int32_t>((raw ^ sign) - sign)};
}

/// 5.8: if the minimum is negative, both are signed; otherwise the maximum is unsigned (real devices write 255 as FF).
std::pair<std::int64_t, std::int64_t> range_of(Number least, Number most) {
  if (least.number < 0) return {least.number, most.number};
  return {least.raw, most.raw};
}

class Parser {
 public:
  explicit Parser(std::string device) : device_(std::move(device)) {}

  Result<HidDescriptor> parse(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return bad("the report descriptor is empty");
    if (bytes.size() > max_descriptor_bytes) return bad("the report descriptor is longer than 4096 bytes");
    while (offset_ < bytes.size()) {
      const auto rest = bytes.subspan(offset_);
      std::size_t length = 0;
      if (rest[0] == long_item) {
        length = rest.size() < 3 ? rest.size() + 1 : std::size_t{3} + rest[1];
      } else {
        length = 1 + item_bytes(rest[0]);
      }
      if (length > rest.size()) {
        if (depth_ == 0 && !out_.applications.empty()) break;  // padding after the last collection
        return bad("an item is cut off");
      }
      if (rest[0] != long_item) {
        const auto data = rest.subspan(1, length - 1);
        const Item item{static_cast<std::uint8_t>((rest[0] >> 2) & 3), static_cast<std::uint8_t>(rest[0] >> 4),
                        data.size(), number_of(data)};
        if (const auto error = take(item)) return *error;
      }
      offset_ += length;
    }
    if (depth_ != 0) return bad("a collection is never closed");
    for (const auto& field : out_.fields) out_.numbered |= field.report_id != 0;
    for (const auto& [report, bits] : out_.report_bits) out_.numbered |= report.second != 0;
    return std::move(out_);
  }

 private:
  using Bad = std::optional<tl::unexpected<Error>>;

  static std::size_t item_bytes(std::uint8_t prefix) { return (prefix & 3) == 3 ? 4 : prefix & 3; }

  [[nodiscard]] tl::unexpected<Error> bad(const std::string& what) const {
    return fail(device_, "byte " + std::to_string(offset_), what, "the device cannot be used");
  }

  Bad take(const Item& item) {
    switch (item.type) {
      case main_item:
        return take_main(item);
      case global_item:
        return take_global(item);
      case local_item:
        return take_local(item);
      default:
        return std::nullopt;  // reserved
    }
  }

  Bad take_main(const Item& item) {
    Bad error;
    switch (item.tag) {
      case tag_input:
        error = add_field(HidReportKind::input, item.data.raw);
        break;
      case tag_output:
        error = add_field(HidReportKind::output, item.data.raw);
        break;
      case tag_feature:
        error = add_field(HidReportKind::feature, item.data.raw);
        break;
      case tag_collection:
        error = open_collection(item.data.raw);
        break;
      case tag_end:
        if (depth_ == 0) return bad("a collection is closed that was never opened");
        --depth_;
        if (depth_ < application_depth_) {
          application_ = {};
          application_depth_ = 0;
        }
        break;
      default:
        break;
    }
    locals_ = {};
    return error;
  }

  Bad open_collection(std::uint32_t type) {
    if (depth_ == max_collection_depth) return bad("more than 32 collections inside one another");
    ++depth_;
    if (type != collection_application || application_depth_ != 0) return std::nullopt;
    const auto usages = resolved_usages();
    application_ = usages.empty() ? HidUsage{} : usages.front().first;
    application_depth_ = depth_;
    if (out_.applications.size() < max_fields) out_.applications.push_back(application_);
    return std::nullopt;
  }

  Bad take_global(const Item& item) {
    const auto [raw, number] = item.data;
    switch (item.tag) {
      case tag_usage_page:
        globals_.page = static_cast<std::uint16_t>(raw);
        break;
      case tag_logical_min:
        globals_.logical_min = item.data;
        break;
      case tag_logical_max:
        globals_.logical_max = item.data;
        break;
      case tag_physical_min:
        globals_.physical_min = item.data;
        break;
      case tag_physical_max:
        globals_.physical_max = item.data;
        break;
      case tag_unit_exponent:
        // A nibble's two's complement; some write the whole signed byte instead.
        globals_.unit_exponent =
            raw <= 0xf ? (static_cast<int>(raw) ^ 8) - 8 : (number < -8 || number > 7 ? 0 : number);
        break;
      case tag_unit:
        globals_.unit = raw;
        break;
      case tag_report_size:
        globals_.report_size = raw;
        break;
      case tag_report_count:
        globals_.report_count = raw;
        break;
      case tag_report_id:
        if (raw == 0 || raw > 255) return bad("report id " + std::to_string(raw) + " is not one of 1 to 255");
        globals_.report_id = static_cast<std::uint8_t>(raw);
        break;
      case tag_push:
        if (stack_.size() == max_push_depth) return bad("more than 16 pushes");
        stack_.push_back(globals_);
        break;
      case tag_pop:
        if (stack_.empty()) return bad("a pop without a push");
        globals_ = stack_.back();
        stack_.pop_back();
        break;
      default:
        break;
    }
    return std::nullopt;
  }

  Bad take_local(const Item& item) {
    switch (item.tag) {
      case tag_delimiter:
        locals_.delimited = item.data.raw == 1;
        locals_.delimiter_used = false;
        return std::nullopt;
      case tag_usage:
        return add_usage({item.data.raw, 1, item.size == 4});
      case tag_usage_min:
        locals_.minimum = item;
        return std::nullopt;
      case tag_usage_max: {
        if (!locals_.minimum) return std::nullopt;
        const Item least = *locals_.minimum;
        locals_.minimum.reset();
        const std::uint32_t first = least.data.raw;
        const bool extended = least.size == 4;
        // A short end of an extended start lies on the same page.
        const std::uint32_t last = extended && item.size < 4 ? (first & 0xffff0000u) | item.data.raw : item.data.raw;
        if (last < first || (first >> 16) != (last >> 16)) return std::nullopt;
        return add_usage({first, last - first + 1, extended});
      }
      default:
        return std::nullopt;
    }
  }

  Bad add_usage(LocalUsage usage) {
    if (locals_.delimited && locals_.delimiter_used) return std::nullopt;
    locals_.delimiter_used = locals_.delimited;
    if (locals_.usages.size() == max_usages_per_field) return bad("more than 1024 usages for one field");
    locals_.usages.push_back(usage);
    return std::nullopt;
  }

  [[nodiscard]] std::vector<HidUsageRange> resolved_usages() const {
    std::vector<HidUsageRange> out;
    out.reserve(locals_.usages.size());
    for (const auto& usage : locals_.usages) {
      const auto page = usage.extended ? static_cast<std::uint16_t>(usage.value >> 16) : globals_.page;
      out.push_back({{page, static_cast<std::uint16_t>(usage.value)}, usage.count});
    }
    return out;
  }

  Bad add_field(HidReportKind kind, std::uint32_t flags) {
    const std::uint64_t wanted = std::uint64_t{globals_.report_size} * globals_.report_count;
    auto& bits = out_.report_bits[{kind, globals_.report_id}];
    if (wanted > max_report_bits - bits) return bad("a report is longer than 4096 bytes");
    const std::uint32_t offset = bits;
    bits += static_cast<std::uint32_t>(wanted);
    if (wanted == 0 || (flags & flag_constant) != 0 || globals_.report_size > 32) return std::nullopt;
    const auto [least, most] = range_of(globals_.logical_min, globals_.logical_max);
    if (least > most) return std::nullopt;
    if (out_.fields.size() == max_fields) return bad("more than 1024 fields");
    const auto [physical_least, physical_most] = range_of(globals_.physical_min, globals_.physical_max);
    HidField field;
    field.kind = kind;
    field.report_id = globals_.report_id;
    field.bit_offset = offset;
    field.bit_size = globals_.report_size;
    field.count = globals_.report_count;
    field.usages = resolved_usages();
    field.logical_min = least;
    field.logical_max = most;
    field.physical_min = physical_least;
    field.physical_max = physical_most;
    field.unit = globals_.unit;
    field.unit_exponent = globals_.unit_exponent;
    field.variable = (flags & flag_variable) != 0;
    field.relative = (flags & flag_relative) != 0;
    field.wrap = (flags & flag_wrap) != 0;
    field.null_state = (flags & flag_null) != 0;
    field.application = application_;
    out_.fields.push_back(std::move(field));
    return std::nullopt;
  }

  std::string device_;
  std::size_t offset_ = 0;
  std::size_t depth_ = 0;
  std::size_t application_depth_ = 0;  ///< depth at which the present application collection was opened; 0: none
  HidUsage application_;
  Globals globals_;
  Locals locals_;
  std::vector<Globals> stack_;
  HidDescriptor out_;
};

}  // namespace

Result<HidDescriptor> parse_hid_descriptor(std::span<const std::uint8_t> bytes, const std::string& device) {
  return Parser(device).parse(bytes);
}

std::optional<HidUsage> usage_at(const HidField& field, std::uint64_t index) {
  for (const auto& range : field.usages) {
    if (index < range.count)
      return HidUsage{range.first.page, static_cast<std::uint16_t>(range.first.id + static_cast<std::uint32_t>(index))};
    index -= range.count;
  }
  if (!field.variable || field.usages.empty()) return std::nullopt;
  const auto& last = field.usages.back();
  return HidUsage{last.first.page, static_cast<std::uint16_t>(last.first.id + (last.count - 1))};
}

}  // namespace lackwerk::input
