// How knobs shall feel, as `kiosk.toml` gives it.
//
// Why it exists: a dealer swaps a knob for another one with twice the clicks and wants the same feel; that is
// configuration. Values; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lackwerk::input {

/// What is known of a device beyond its descriptor.
enum class KnobProfile {
  automatic,     ///< by vendor and product; an unknown device is `generic`, and only if it is no mouse or the like
  generic,       ///< by the descriptor alone, whatever else the device is (a mouse wheel, a keyboard's volume wheel)
  surface_dial,  ///< Microsoft Surface Dial: the counts of a turn are a setting of the device and are sent to it
  powermate,     ///< Griffin PowerMate: 94 counts a turn
  spacemouse,    ///< 3Dconnexion: six axes that say how far, not how much; the twist turns
};

/// "automatic", "generic", "surface-dial", "powermate", "spacemouse"; nothing for other words.
[[nodiscard]] std::optional<KnobProfile> knob_profile_of(std::string_view word);
[[nodiscard]] std::string_view word_of(KnobProfile profile);
/// The profile for a device by its USB or Bluetooth ids; `automatic` when it is not one of the known ones.
[[nodiscard]] KnobProfile known_profile(std::uint16_t vendor, std::uint16_t product);

/// Counts a revolution of a known device as it boots; 0: not known.
/// PowerMate: measured, opening comment of Linux' drivers/input/misc/powermate.c. Surface Dial: its resolution
/// multiplier's value at start (notes in udev-hid-bpf's Microsoft__Surface-Dial.bpf.c).
[[nodiscard]] constexpr double known_counts_per_turn(KnobProfile profile) {
  if (profile == KnobProfile::powermate) return 94.0;
  if (profile == KnobProfile::surface_dial) return 3600.0;
  return 0.0;
}

struct KnobTuning {
  double detents_per_turn = 24.0;  ///< [1, 1000]; what one revolution is worth, the usual count of a clicking encoder
  /// Counts the device sends in one revolution, [0, 100000]. 0: from its descriptor or profile; where these do not say,
  /// one count is one detent.
  double counts_per_turn = 0.0;
  /// Exponent of gain over speed, [0, 2]; 0 switches it off. See knob.cpp.
  double acceleration = 0.5;
  bool invert = false;
  /// Of stick-like axes, part of the full deflection, [0, 0.9].
  double dead_zone = 0.1;
  /// Which axis of a multi-axis device turns: "x", "y", "z", "rx", "ry", "rz"; empty: rz, the twist, or the first of
  /// x, y, z, rx, ry the device has.
  std::string axis;
  KnobProfile profile = KnobProfile::automatic;
  bool ignore = false;  ///< never open it
};

/// Which key is out of its range and what the range is, or nothing.
[[nodiscard]] std::optional<std::string> complaint(const KnobTuning& tuning);

/// Tuning for one device: `match` is "045e:091b" or a part of its name, letters' case ignored.
struct KnobMatch {
  std::string match;
  KnobTuning tuning;
};

struct KnobSettings {
  bool hidraw = true;  ///< devices with a hidraw node
  bool usb = true;     ///< USB devices no kernel driver has
  bool evdev = true;   ///< dials a kernel driver turns into input events
  KnobTuning tuning;   ///< for every device no match names
  std::vector<KnobMatch> devices;
};

/// The tuning for a device: of the first match, else the common one; profile filled in from the ids if automatic.
[[nodiscard]] KnobTuning tuning_for(const KnobSettings& settings, std::uint16_t vendor, std::uint16_t product,
                                    std::string_view name);

/// "045e:091b".
[[nodiscard]] std::string device_id(std::uint16_t vendor, std::uint16_t product);

}  // namespace lackwerk::input
