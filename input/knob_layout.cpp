#include "input/knob_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "input/knob.hpp"

namespace lackwerk::input {
namespace {

// HID Usage Tables 1.3.
constexpr std::uint16_t page_desktop = 0x01, page_button = 0x09, page_consumer = 0x0c, page_digitizer = 0x0d;
constexpr HidUsage pointer{page_desktop, 0x01}, mouse{page_desktop, 0x02}, joystick{page_desktop, 0x04},
    game_pad{page_desktop, 0x05}, keyboard{page_desktop, 0x06}, keypad{page_desktop, 0x07},
    multi_axis{page_desktop, 0x08};
constexpr HidUsage slider{page_desktop, 0x36}, dial{page_desktop, 0x37}, wheel{page_desktop, 0x38},
    resolution_multiplier{page_desktop, 0x48};
constexpr std::uint16_t first_axis = 0x30, last_axis = 0x35;  // X, Y, Z, Rx, Ry, Rz
constexpr HidUsage volume{page_consumer, 0xe0}, volume_up{page_consumer, 0xe9}, volume_down{page_consumer, 0xea},
    mute{page_consumer, 0xe2}, play_pause{page_consumer, 0xcd};

// Units, 6.2.2.7: system in the lowest nibble, exponent of length or angle in the next.
constexpr std::uint32_t unit_radians = 0x12, unit_degrees = 0x14;

/// Values of one field that are looked at: no knob has more switches in one.
constexpr std::uint32_t max_values = 256;
/// Two of each button and key: some devices have the same one in several reports.
constexpr std::size_t max_knob_switches = 2 * (max_knob_buttons + 4);

bool is_pen_or_touch(HidUsage u) { return u.page == page_digitizer && u.id >= 0x01 && u.id <= 0x06; }

const char* somebody_elses(HidUsage application) {
  if (application == pointer || application == mouse) return "a mouse";
  if (application == keyboard || application == keypad) return "a keyboard";
  if (application == joystick || application == game_pad) return "a joystick";
  if (is_pen_or_touch(application)) return "a pen or touch device";
  return nullptr;
}

bool turns(HidUsage usage) { return usage == dial || usage == wheel || usage == slider || usage == volume; }

/// Counts of a revolution by the field's unit, or 0.
double counts_by_unit(const HidField& field) {
  if (field.unit != unit_degrees && field.unit != unit_radians) return 0.0;
  const double revolution = field.unit == unit_degrees ? 360.0 : 2.0 * std::numbers::pi;
  const bool as_logical = field.physical_min == 0 && field.physical_max == 0;
  const double logical = static_cast<double>(field.logical_max - field.logical_min);
  const double physical = as_logical ? logical : static_cast<double>(field.physical_max - field.physical_min);
  const double angle = physical * std::pow(10.0, field.unit_exponent);
  return angle > 0.0 && logical > 0.0 ? revolution * logical / angle : 0.0;
}

std::optional<KnobAxis::Kind> kind_of(const HidField& field, HidUsage usage) {
  if (field.relative) return KnobAxis::Kind::relative;
  if (field.logical_max == field.logical_min) return std::nullopt;
  return field.wrap || usage == dial ? KnobAxis::Kind::wrapping : KnobAxis::Kind::sliding;
}

double counts_of(const HidField& field, KnobAxis::Kind kind, const KnobTuning& tuning) {
  if (tuning.counts_per_turn > 0.0) return tuning.counts_per_turn;
  const double range = static_cast<double>(field.logical_max - field.logical_min);
  if (kind == KnobAxis::Kind::wrapping) return range + 1.0;
  if (kind == KnobAxis::Kind::sliding) return range;
  if (const double counts = counts_by_unit(field); counts > 0.0) return counts;
  return known_counts_per_turn(tuning.profile);
}

/// Number of a multi-axis usage in the order in which an unnamed axis is chosen: the twist first.
int preference(HidUsage usage) {
  constexpr std::array<std::uint16_t, 6> order{0x35, 0x30, 0x31, 0x32, 0x33, 0x34};
  return static_cast<int>(std::find(order.begin(), order.end(), usage.id) - order.begin());
}

bool is_named(HidUsage usage, std::string_view name) {
  constexpr std::array<std::string_view, 6> names{"x", "y", "z", "rx", "ry", "rz"};
  return names.at(usage.id - first_axis) == name;
}

/// The entry of an array's usages that is `wanted`, or nothing.
std::optional<std::int64_t> entry_of(const HidField& field, HidUsage wanted) {
  std::int64_t before = 0;
  for (const auto& range : field.usages) {
    if (range.first.page == wanted.page && wanted.id >= range.first.id &&
        static_cast<std::uint32_t>(wanted.id - range.first.id) < range.count)
      return before + (wanted.id - range.first.id);
    before += range.count;
  }
  return std::nullopt;
}

class Builder {
 public:
  Builder(const HidDescriptor& descriptor, const KnobTuning& tuning)
      : descriptor_(descriptor), tuning_(tuning), forced_(tuning.profile != KnobProfile::automatic) {}

  KnobLayout build() {
    for (const auto& application : descriptor_.applications)
      if (const char* what = somebody_elses(application); what != nullptr && !forced_)
        out_.refused = std::string("it is ") + what;
    for (std::size_t k = 0; k < descriptor_.fields.size(); ++k) add_axes(k);
    if (stick_ && out_.axes.size() < max_knob_axes) out_.axes.push_back(*stick_);
    add_volume_keys();
    if (out_.axes.empty() && !volume_keys_) {
      out_.switches.clear();
      if (out_.refused.empty()) out_.refused = "nothing on it turns";
      return std::move(out_);
    }
    add_buttons();
    find_resolution();
    return std::move(out_);
  }

 private:
  void add_axes(std::size_t k) {
    const HidField& field = descriptor_.fields[k];
    if (field.kind != HidReportKind::input || !field.variable) return;
    const bool sticks = field.application == multi_axis ||
                        (forced_ && (field.application == joystick || field.application == game_pad));
    for (std::uint32_t index = 0; index < std::min(field.count, max_values); ++index) {
      const auto usage = usage_at(field, index);
      if (!usage) return;
      if (sticks && usage->page == page_desktop && usage->id >= first_axis && usage->id <= last_axis) {
        consider_stick({KnobAxis::Kind::stick, k, index, *usage, 0.0});
      } else if (turns(*usage) && out_.axes.size() < max_knob_axes) {
        if (const auto kind = kind_of(field, *usage))
          out_.axes.push_back({*kind, k, index, *usage, counts_of(field, *kind, tuning_)});
      }
    }
  }

  /// Of all the axes of a multi-axis device one turns: one hand moves all six at once.
  void consider_stick(const KnobAxis& axis) {
    const HidField& field = descriptor_.fields[axis.field];
    if (field.logical_max == field.logical_min) return;
    if (!tuning_.axis.empty() && !is_named(axis.usage, tuning_.axis)) return;
    if (!stick_ || preference(axis.usage) < preference(stick_->usage)) stick_ = axis;
  }

  void add_switch(const KnobSwitch& what) {
    if (out_.switches.size() < max_knob_switches) out_.switches.push_back(what);
  }

  /// What a usage does as a key of the volume kind, if it is one.
  static std::optional<KnobSwitch::Role> volume_key(HidUsage usage) {
    if (usage == volume_up) return KnobSwitch::Role::clockwise;
    if (usage == volume_down) return KnobSwitch::Role::anticlockwise;
    return std::nullopt;
  }

  void add_volume_keys() {
    const std::size_t axis = out_.axes.size();
    if (axis == max_knob_axes) return;
    for (std::size_t k = 0; k < descriptor_.fields.size(); ++k)
      for_each_switch(k, [&](HidUsage usage, std::uint32_t index, std::int64_t array_value) {
        if (const auto role = volume_key(usage)) add_switch({*role, axis, k, index, array_value});
      });
    volume_keys_ = !out_.switches.empty();
  }

  void add_buttons() {
    for (std::size_t k = 0; k < descriptor_.fields.size(); ++k)
      for_each_switch(k, [&](HidUsage usage, std::uint32_t index, std::int64_t array_value) {
        const bool button = usage.page == page_button && usage.id >= 1 && usage.id <= max_knob_buttons;
        if (button)
          add_switch({KnobSwitch::Role::button, std::size_t{usage.id} - 1, k, index, array_value});
        else if (volume_keys_ && (usage == mute || usage == play_pause))
          add_switch({KnobSwitch::Role::button, 0, k, index, array_value});
      });
  }

  /// Calls `what` for every usage of an input field that could be a switch of ours.
  template <class What>
  void for_each_switch(std::size_t k, const What& what) {
    const HidField& field = descriptor_.fields[k];
    if (field.kind != HidReportKind::input) return;
    if (field.variable) {
      for (std::uint32_t index = 0; index < std::min(field.count, max_values); ++index)
        if (const auto usage = usage_at(field, index)) what(*usage, index, 0);
      return;
    }
    const auto try_entry = [&](HidUsage usage) {
      if (const auto entry = entry_of(field, usage)) what(usage, 0, field.logical_min + *entry);
    };
    for (const HidUsage usage : {volume_up, volume_down, mute, play_pause}) try_entry(usage);
    for (std::uint16_t number = 1; number <= max_knob_buttons; ++number) try_entry({page_button, number});
  }

  /// A mouse's multiplier is a factor of 1 to 16; one whose range is hundreds of counts is a dial's resolution.
  void find_resolution() {
    const bool has_dial = std::any_of(out_.axes.begin(), out_.axes.end(), [](const KnobAxis& axis) {
      return axis.usage == dial && axis.kind == KnobAxis::Kind::relative;
    });
    if (!has_dial) return;
    for (std::size_t k = 0; k < descriptor_.fields.size(); ++k) {
      const HidField& field = descriptor_.fields[k];
      if (field.kind == HidReportKind::feature && field.variable && field.logical_max >= 100 &&
          usage_at(field, 0) == resolution_multiplier)
        out_.resolution = k;
    }
  }

  const HidDescriptor& descriptor_;
  const KnobTuning& tuning_;
  bool forced_;
  bool volume_keys_ = false;
  std::optional<KnobAxis> stick_;
  KnobLayout out_;
};

}  // namespace

KnobLayout knob_layout(const HidDescriptor& descriptor, const KnobTuning& tuning) {
  return Builder(descriptor, tuning).build();
}

std::vector<std::uint8_t> built_in_descriptor(KnobProfile profile) {
  if (profile != KnobProfile::powermate) return {};
  return {
      0x05, 0x01, 0x09, 0x0e, 0xa1, 0x01,                          // System Multi-Axis Controller
      0x05, 0x09, 0x09, 0x01, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01,  // button 1, one bit
      0x95, 0x01, 0x81, 0x02, 0x95, 0x07, 0x81, 0x03,              // and seven of padding
      0x05, 0x01, 0x09, 0x37, 0x15, 0x81, 0x25, 0x7f, 0x75, 0x08,  // dial, -127 to 127, one byte
      0x95, 0x01, 0x81, 0x06, 0xc0,                                // relative
  };
}

}  // namespace lackwerk::input
