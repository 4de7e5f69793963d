// Scripted input: a tour that plays by itself, the in-memory twin of a customer's hand.
//
// Why it exists: tests, demos and tours need the same input every time. Text, one step a line:
//     TIME_MS weights W1 W2 ... [over MS]        also: base, lightness, colour
//     TIME_MS white X [over MS]                  how far the flakes' colour is taken out, 0 to 1
//     TIME_MS orbit AZIMUTH_DEG ELEVATION_DEG [over MS]
//     TIME_MS zoom FACTOR [over MS]
//     TIME_MS camera NAME
//     TIME_MS light N                            the mood, 0 to 2
//     TIME_MS dimmer X [over MS]                 0 to 1
// what a knob does:
//     TIME_MS turn DETENTS [over MS]
//     TIME_MS press | release | click
// what fingers do, N = 0 if it is left out:
//     TIME_MS down PLACE [finger N]
//     TIME_MS move PLACE [finger N] [over MS]
//     TIME_MS up [finger N]
//     TIME_MS tap PLACE [finger N]
//     TIME_MS hold PLACE MS [finger N]           down, and up MS later
//     TIME_MS drag PLACE PLACE over MS [finger N]
// A PLACE is X Y, in [0, 1] of the picture from its upper left corner, or @NAME[:A[,B]]: something on the screen,
// wherever it is at that time ("@swatch:1"; kiosk/display/targets.hpp has the names).
// Lines are in order of time; # starts a comment. `over` eases in and out. Owns its steps; one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "input/control.hpp"

namespace lackwerk::input {

/// A scripted touch does not know where things are: its Control has a target's text as its name, and values {way}: how
/// far the finger has come, [0, 1], from the place where it went down or last stopped to this one. X Y is
/// "@picture:X,Y".
struct TouchTarget {
  std::string name;            ///< without the @
  std::vector<double> values;  ///< up to two
};
/// "@swatch:1", "@pad:0.3,0.6". Nothing: not of this form. Names are letters and underscores, numbers finite.
[[nodiscard]] std::optional<TouchTarget> parse_target(std::string_view text);

struct ScriptStep {
  double at_ms = 0.0;
  double over_ms = 0.0;  ///< 0: at once
  Control control;       ///< the final value, or for orbit, zoom and turn the whole change
};

/// Bounds on what a script file may hold.
inline constexpr std::size_t max_script_bytes = 1 << 20;
inline constexpr double max_script_ms = 24.0 * 3600.0 * 1000.0;

/// A scripted finger's touch of something, and a knob's click, take this long.
inline constexpr double script_tap_ms = 80.0;

/// Parses a script's text. `file` is used in errors, whose field is the line number. Sorted by time; a line may give
/// several steps.
[[nodiscard]] Result<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file);

/// Reads and parses a script file.
[[nodiscard]] Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& path);

/// Plays steps against a clock that only goes forward.
class ScriptPlayer {
 public:
  /// `start`: the weights from which the first `over` leaves; white and dimmer leave from 0.
  ScriptPlayer(std::vector<ScriptStep> steps, std::vector<double> start);

  /// The events between the last call and `now_ms`, with their times (ms of this clock) in time_us. Steps under way
  /// give one event a call: blended values, or the part of the orbit, zoom or turn that fell into this interval.
  [[nodiscard]] std::vector<Control> advance(double now_ms);

  /// True when the last step has ended.
  [[nodiscard]] bool finished() const { return next_ == steps_.size() && running_.empty(); }

 private:
  struct Running {
    ScriptStep step;
    std::vector<double> from;  ///< values at its start
    double done = 0.0;         ///< eased progress already sent, [0, 1]
  };
  /// Of kinds whose values are blended; null for others.
  std::vector<double>* last_of(ControlKind kind);

  std::vector<ScriptStep> steps_;
  std::size_t next_ = 0;
  std::vector<Running> running_;
  std::vector<double> base_, lightness_, colour_, white_{0.0}, dimmer_{0.0}, time_{1.0};
};

}  // namespace lackwerk::input
