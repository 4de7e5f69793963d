// Scripted input: a tour that plays by itself, the in-memory twin of a customer's hand.
//
// Why it exists: tests, demos and the attract loop need the same input every time. Text, one step a line:
//     TIME_MS weights W1 W2 ... [over MS]        also: base, lightness, colour
//     TIME_MS orbit AZIMUTH_DEG ELEVATION_DEG [over MS]
//     TIME_MS zoom FACTOR [over MS]
//     TIME_MS camera NAME
// Lines are in order of time; # starts a comment. Owns its steps; one thread.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "input/control.hpp"

namespace lackwerk::input {

struct ScriptStep {
  double at_ms = 0.0;
  double over_ms = 0.0;  ///< 0: at once
  Control control;       ///< the final value, or for orbit and zoom the whole change
};

/// Bounds on what a script file may hold.
inline constexpr std::size_t max_script_bytes = 1 << 20;
inline constexpr double max_script_ms = 24.0 * 3600.0 * 1000.0;

/// Parses a script's text. `file` is used in errors, whose field is the line number.
[[nodiscard]] Result<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file);

/// Reads and parses a script file.
[[nodiscard]] Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& path);

/// Plays steps against a clock that only goes forward.
class ScriptPlayer {
 public:
  /// `start`: the weights from which the first `over` leaves.
  ScriptPlayer(std::vector<ScriptStep> steps, std::vector<double> start);

  /// The events between the last call and `now_ms`. Steps under way give one event a call: blended weights, or the
  /// part of the orbit or zoom that fell into this interval; ramps ease in and out.
  [[nodiscard]] std::vector<Control> advance(double now_ms);

  /// True when the last step has ended.
  [[nodiscard]] bool finished() const { return next_ == steps_.size() && running_.empty(); }

 private:
  struct Running {
    ScriptStep step;
    std::vector<double> from;  ///< weights at its start
    double done = 0.0;         ///< eased progress already sent, [0, 1]
  };
  std::vector<double>& last_of(ControlKind kind);

  std::vector<ScriptStep> steps_;
  std::size_t next_ = 0;
  std::vector<Running> running_;
  std::vector<double> base_, lightness_, colour_;
};

}  // namespace lackwerk::input
