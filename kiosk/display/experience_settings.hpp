// How the kiosk behaves towards visitors and dealers: what kiosk.toml sets, and what a dealer has changed on the
// screen.
//
// Why it exists: configuration and behaviour share these without knowing each other. Values; any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "input/touch_settings.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

/// Of the panel, as a share: darker, a dealer would not find the way back.
inline constexpr double least_brightness = 0.2;

/// Minutes after midnight, local time; from == to: never. from > to goes over midnight.
struct NightHours {
  int from = 0, to = 0;
  [[nodiscard]] bool covers(int minute) const;
  bool operator==(const NightHours&) const = default;
};

/// How far somebody has got with guessing the PIN, as it is kept over a restart.
struct PinRecord {
  int wrong = 0;                ///< attempts since the last lock or right one, [0, 4]
  double lock_s = 0.0;          ///< of the last lock, [0, 3600]; 0: there was none since the right one
  double locked_until_s = 0.0;  ///< seconds since 1970 by the wall clock
  bool operator==(const PinRecord&) const = default;
};

struct ExperienceSettings {
  double idle_s = 60.0;       ///< without a touch or turn until the countdown shows, [5, 3600]
  double countdown_s = 15.0;  ///< of the countdown, then everything is reset, [3, 60]
  NightHours night;           ///< the panel is off, but for visitors: a touch wakes it for one visit
  ui::Language language = ui::Language::english;
  bool beyond_allowed = false;
  bool reduced_motion = false;  ///< no inertia, no tour: the attract screen stands still but for its paints
  bool tour = true;             ///< false: the attract screen stands still on the first paint
  double brightness = 1.0;      ///< [least_brightness, 1]
  bool has_pin = false;         ///< without one there is no dealer's screen
  std::uint64_t seed = 1;       ///< of the attract tour
  /// What the touch screens' reports go through today: a new calibration comes after it.
  std::optional<input::CalibrationMatrix> calibration{};
  PinRecord pin{};  ///< as it was when the kiosk last ran
};

/// What the dealer has changed and the kiosk should keep.
struct DealerChoices {
  ui::Language language = ui::Language::english;
  bool beyond_allowed = false;
  bool reduced_motion = false;
  double brightness = 1.0;
  std::optional<input::CalibrationMatrix> calibration{};  ///< for all touch screens, after a calibration
  PinRecord pin{};                                        ///< not chosen, but kept in the same place
};

/// The [interface] table of kiosk.toml.
struct InterfaceSettings {
  bool vouched = true;  ///< of the pack to begin with: ui::Content::is_vouched
  bool shown = true;    ///< false: the picture alone, as for recordings of paints
  double dpi = 0.0;     ///< of the panel, [30, 600]; 0: as the panel says, else 96
  ExperienceSettings experience{};
  std::string pin;                  ///< what `lackwerk-kiosk --hash-pin` printed; empty: no dealer's screen
  int drift_px = 0;                 ///< the picture wanders by up to this much, against burn-in, [0, 24]
  std::function<double()> wall_s;   ///< seconds since 1970; empty: the machine's
  double attract_brightness = 1.0;  ///< of the attract screen, [0.2, 1]: a dimmed panel lives longer
};

}  // namespace lackwerk::kiosk
