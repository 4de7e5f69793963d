// Fuzz target: a stranger's report descriptor and whatever reports follow.
//
// Input: one byte of settings, two bytes of descriptor length (little-endian), the descriptor, then reports, each with
// one byte of length before it. Whatever comes: no sanitizer finding, every control finite and in bounds, and no button
// held once the device is gone.
// By hand, from the root folder:
//   clang++ -std=c++20 -O1 -g -ffp-contract=off -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -I. \
//     tests/fuzz/hid_fuzz.cpp input/hid_descriptor.cpp input/hid_report.cpp input/hid_knob.cpp input/knob.cpp \
//     input/knob_layout.cpp input/knob_settings.cpp -o hid_fuzz && ./hid_fuzz NEW_FOLDER tests/fuzz/corpus/hid
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "input/hid_knob.hpp"

using lackwerk::input::Control;
using lackwerk::input::ControlKind;
using lackwerk::input::HidKnob;
using lackwerk::input::KnobProfile;
using lackwerk::input::KnobTuning;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

KnobTuning tuning_of(std::uint8_t settings) {
  constexpr std::array<KnobProfile, 5> profiles{KnobProfile::automatic, KnobProfile::generic, KnobProfile::surface_dial,
                                                KnobProfile::powermate, KnobProfile::spacemouse};
  constexpr std::array<const char*, 4> axes{"", "x", "ry", "rz"};
  KnobTuning tuning;
  tuning.profile = profiles.at(settings % profiles.size());
  tuning.axis = axes.at((settings >> 3) & 3);
  tuning.invert = (settings & 0x20) != 0;
  tuning.acceleration = (settings & 0x40) != 0 ? 2.0 : 0.5;
  tuning.counts_per_turn = (settings & 0x80) != 0 ? 7.0 : 0.0;
  return tuning;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> rest(data, size);
  if (rest.size() < 3) return 0;
  const KnobTuning tuning = tuning_of(rest[0]);
  const std::size_t length = rest[1] | (std::size_t{rest[2]} << 8);
  rest = rest.subspan(3);
  if (length > rest.size()) return 0;
  auto knob = HidKnob::make(rest.first(length), "fuzz", tuning);
  if (!knob) return 0;
  rest = rest.subspan(length);

  // The device's setting, as reading and sending it back would do.
  if (const auto resolution = knob->resolution()) {
    std::vector<std::uint8_t> payload(resolution->payload_bytes);
    knob->use_resolution(payload);
    knob->set_resolution(payload);
    knob->use_resolution(payload);
  }

  std::vector<Control> out;
  std::array<int, lackwerk::input::max_knob_buttons> held{};
  const auto look = [&](double now_ms, std::size_t limit) {
    out.clear();
    knob->knob().take(now_ms, limit, out);
    require(out.size() <= limit);
    for (const auto& control : out) {
      require(control.values.size() == 1 && std::isfinite(control.values[0]));
      if (control.kind == ControlKind::turn) continue;
      const auto number = static_cast<std::size_t>(control.values[0]);
      held.at(number) += control.kind == ControlKind::press ? 1 : -1;
      require(held.at(number) == 0 || held.at(number) == 1);
    }
  };
  std::uint64_t now_us = 1'000'000;
  while (!rest.empty()) {
    const std::size_t bytes = rest[0];
    rest = rest.subspan(1);
    if (bytes > rest.size()) break;
    knob->report(rest.first(bytes), now_us);
    rest = rest.subspan(bytes);
    now_us += 1 + 997 * bytes;
    if (bytes % 3 == 0) look(static_cast<double>(now_us) / 1000.0, 5);
  }
  knob->reset(now_us);
  while (knob->knob().has_pending()) look(static_cast<double>(now_us) / 1000.0, lackwerk::input::max_controls_a_read);
  for (const int count : held) require(count == 0);
  return 0;
}
