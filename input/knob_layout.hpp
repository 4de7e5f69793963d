// What can be turned and pressed on a HID device.
//
// Why it exists: between a descriptor (fields of bits) and a knob (motion, switches) lies a judgement: which usages
// turn, what one revolution is, and which devices are somebody else's (mice, keyboards, touch screens). It stands here,
// once. Values; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input/hid_descriptor.hpp"
#include "input/knob_settings.hpp"

namespace lackwerk::input {

/// A value that turns.
struct KnobAxis {
  enum class Kind {
    relative,  ///< counts since the last report
    wrapping,  ///< a position that goes round
    sliding,   ///< a position between two stops; its whole range is one revolution
    stick,     ///< a deflection that springs back: turns while it lasts
  };
  Kind kind = Kind::relative;
  std::size_t field = 0;    ///< in HidDescriptor::fields
  std::uint32_t index = 0;  ///< value in the field
  HidUsage usage;
  /// Counts of one revolution; 0: unknown, one count is one detent. Not used by sticks.
  double counts_per_turn = 0.0;
};

/// A value that is on or off.
struct KnobSwitch {
  enum class Role { button, clockwise, anticlockwise };
  Role role = Role::button;
  std::size_t number = 0;  ///< of the button; of the axis for the others
  std::size_t field = 0;
  std::uint32_t index = 0;       ///< of a variable field
  std::int64_t array_value = 0;  ///< of an array: on while one of its values is this one
};

struct KnobLayout {
  std::vector<KnobAxis> axes;        ///< at most max_knob_axes with those that only switches turn
  std::vector<KnobSwitch> switches;  ///< buttons and keys that turn
  /// A feature by which the device is told how many counts a revolution shall have: index of its field.
  std::optional<std::size_t> resolution;
  /// Why the device is left alone; empty: it is a knob.
  std::string refused;
};

/// Judges a descriptor. Turnable are Dial, Wheel, Slider (Generic Desktop), Volume and its increment and decrement keys
/// (Consumer), and of a multi-axis controller the one axis `tuning` names. Pressable are buttons 1 to 32, and Mute or
/// Play/Pause as button 0 of a device with volume keys. Haptics, screen positions and vendor fields are ignored.
/// That makes a knob of the media keys of a keyboard or headset that have an interface of their own; `ignore` helps.
/// A device with an application collection of a mouse, keyboard, joystick or digitizer is refused unless
/// tuning.profile is not automatic.
[[nodiscard]] KnobLayout knob_layout(const HidDescriptor& descriptor, const KnobTuning& tuning);

/// The descriptor of a device whose reports are known while its own descriptor is not to be relied on; empty for other
/// profiles. PowerMate: button in byte 0, signed motion in byte 1 (Linux, drivers/input/misc/powermate.c).
[[nodiscard]] std::vector<std::uint8_t> built_in_descriptor(KnobProfile profile);

}  // namespace lackwerk::input
