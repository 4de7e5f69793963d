#include "input/hid_knob.hpp"

#include <algorithm>
#include <cmath>

#include "input/hid_report.hpp"

namespace lackwerk::input {
namespace {

/// Values of an array that are looked at: nobody holds more keys down.
constexpr std::uint32_t max_array_values = 64;

}  // namespace

Result<HidKnob> HidKnob::make(std::span<const std::uint8_t> descriptor, const std::string& name,
                              const KnobTuning& tuning) {
  const auto built_in = built_in_descriptor(tuning.profile);
  auto parsed = parse_hid_descriptor(built_in.empty() ? descriptor : std::span<const std::uint8_t>(built_in), name);
  if (!parsed) return tl::unexpected<Error>(parsed.error());
  auto layout = knob_layout(*parsed, tuning);
  if (!layout.refused.empty()) return fail(name, "", layout.refused);
  return HidKnob(std::move(*parsed), std::move(layout), name, tuning);
}

HidKnob::HidKnob(HidDescriptor descriptor, KnobLayout layout, const std::string& name, const KnobTuning& tuning)
    : descriptor_(std::move(descriptor)),
      layout_(std::move(layout)),
      tuning_(tuning),
      knob_(name, tuning),
      positions_(layout_.axes.size()),
      on_(layout_.switches.size()) {}

std::size_t HidKnob::max_report_bytes() const {
  std::size_t most = 0;
  for (const auto& [report, bits] : descriptor_.report_bits)
    if (report.first == HidReportKind::input) most = std::max<std::size_t>(most, (bits + 7) / 8);
  return most + (descriptor_.numbered ? 1 : 0);
}

void HidKnob::report(std::span<const std::uint8_t> bytes, std::uint64_t time_us) {
  const auto report = split_input_report(descriptor_, bytes);
  if (!report) return;
  for (std::size_t k = 0; k < layout_.axes.size(); ++k) {
    const HidField& field = descriptor_.fields[layout_.axes[k].field];
    if (field.report_id != report->id) continue;
    if (const auto value = read_hid_value(field, report->payload, layout_.axes[k].index)) move(k, *value, time_us);
  }
  for (std::size_t k = 0; k < layout_.switches.size(); ++k) {
    const KnobSwitch& what = layout_.switches[k];
    if (descriptor_.fields[what.field].report_id != report->id) continue;
    const bool on = is_on(what, report->payload);
    if (on == on_[k]) continue;
    on_[k] = on;
    if (what.role != KnobSwitch::Role::button) {
      if (on) knob_.step(what.number, what.role == KnobSwitch::Role::clockwise ? 1.0 : -1.0, time_us);
      continue;
    }
    // Several switches may be one button (Mute and Play/Pause): it is down while any of them is.
    bool down = on;
    for (std::size_t j = 0; j < layout_.switches.size(); ++j)
      down |=
          on_[j] && layout_.switches[j].role == KnobSwitch::Role::button && layout_.switches[j].number == what.number;
    knob_.button(what.number, down, time_us);
  }
}

void HidKnob::move(std::size_t axis, std::int64_t value, std::uint64_t time_us) {
  const KnobAxis& what = layout_.axes[axis];
  const HidField& field = descriptor_.fields[what.field];
  const bool inside = value >= field.logical_min && value <= field.logical_max;
  const auto turned = [&](double counts) {
    if (what.counts_per_turn > 0.0)
      knob_.turn(axis, counts / what.counts_per_turn, time_us);
    else
      knob_.step(axis, counts, time_us);
  };
  switch (what.kind) {
    case KnobAxis::Kind::relative:
      if (inside || !field.null_state) turned(static_cast<double>(value));
      return;
    case KnobAxis::Kind::stick: {
      const double middle = 0.5 * (static_cast<double>(field.logical_min) + static_cast<double>(field.logical_max));
      const double half = 0.5 * static_cast<double>(field.logical_max - field.logical_min);
      // Devices that flag their deflection as relative send it again and again (SpaceNavigator).
      if (inside || !field.null_state)
        knob_.deflect(axis, (static_cast<double>(value) - middle) / half, field.relative, time_us);
      return;
    }
    default:
      break;
  }
  if (!inside) return;  // no position
  auto& position = positions_[axis];
  if (position) {
    std::int64_t way = value - *position;
    if (what.kind == KnobAxis::Kind::wrapping) {
      // The shorter way round.
      const std::int64_t round = field.logical_max - field.logical_min + 1;
      if (2 * way > round) way -= round;
      if (2 * way < -round) way += round;
    }
    turned(static_cast<double>(way));
  }
  position = value;
}

bool HidKnob::is_on(const KnobSwitch& what, std::span<const std::uint8_t> payload) const {
  const HidField& field = descriptor_.fields[what.field];
  if (field.variable) return read_hid_value(field, payload, what.index).value_or(0) != 0;
  for (std::uint32_t index = 0; index < std::min(field.count, max_array_values); ++index)
    if (read_hid_value(field, payload, index) == what.array_value) return true;
  return false;
}

std::optional<HidKnob::Resolution> HidKnob::resolution() const {
  if (!layout_.resolution || tuning_.counts_per_turn > 0.0) return std::nullopt;
  const std::uint8_t id = descriptor_.fields[*layout_.resolution].report_id;
  return Resolution{id, hid_report_bytes(descriptor_, HidReportKind::feature, id)};
}

void HidKnob::set_resolution(std::span<std::uint8_t> payload) const {
  if (!layout_.resolution) return;
  const HidField& field = descriptor_.fields[*layout_.resolution];
  write_hid_value(field, payload, 0, field.logical_max);
}

void HidKnob::use_resolution(std::span<const std::uint8_t> payload) {
  if (!layout_.resolution) return;
  const auto counts = read_hid_value(descriptor_.fields[*layout_.resolution], payload);
  if (!counts || *counts < 1) return;
  for (auto& axis : layout_.axes)
    if (axis.kind == KnobAxis::Kind::relative) axis.counts_per_turn = static_cast<double>(*counts);
}

void HidKnob::reset(std::uint64_t time_us) {
  std::fill(positions_.begin(), positions_.end(), std::nullopt);
  std::fill(on_.begin(), on_.end(), false);
  knob_.let_go(time_us);
}

}  // namespace lackwerk::input
