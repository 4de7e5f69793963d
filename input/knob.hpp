// The feel of one knob: motion and switches in, controls out.
//
// Why it exists: a wheel with ten counts a turn and a dial with 3600, a twisted stick and a clicking encoder must feel
// alike, and none of them may flood the kiosk. Pure state; whoever shares one between threads locks it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "input/control.hpp"
#include "input/knob_settings.hpp"
#include "input/source.hpp"

namespace lackwerk::input {

inline constexpr std::size_t max_knob_axes = 8;
inline constexpr std::size_t max_knob_buttons = 32;

class Knob {
 public:
  /// `name`: of its controls; further axes are called "name 2", "name 3". `tuning` must be free of complaints.
  Knob(std::string name, const KnobTuning& tuning);

  // Times are CLOCK_MONOTONIC in microseconds; one that lies before the last counts as the last.

  /// Part of a revolution, positive clockwise. Cut to ten revolutions: no hand does more between two reports.
  void turn(std::size_t axis, double revolutions, std::uint64_t time_us);
  /// A motion that the device itself cuts into detents.
  void step(std::size_t axis, double detents, std::uint64_t time_us);
  /// A stick's deflection, [-1, 1], which turns for as long as it lasts. `repeats`: the device says it again and again
  /// while it lasts, so that silence means zero.
  void deflect(std::size_t axis, double deflection, bool repeats, std::uint64_t time_us);
  void button(std::size_t number, bool down, std::uint64_t time_us);
  /// The device is gone: what is held is released, what is deflected rests.
  void let_go(std::uint64_t time_us);

  /// Appends at most `limit` controls, in the order in which they happened; the rest waits. Turns of one axis between
  /// two switches are one control, whose time is that of the earliest motion in it.
  void take(double now_ms, std::size_t limit, std::vector<Control>& out);
  /// When take() has something again by itself: at once (0), soon (a stick is deflected), or never_ms.
  [[nodiscard]] double wake_at_ms() const;
  [[nodiscard]] bool has_pending() const { return !pending_.empty(); }

 private:
  struct Axis {
    double speed = 0.0;  ///< revolutions/s, smoothed
    bool clockwise = true;
    std::uint64_t last_us = 0;
    double rate = 0.0;  ///< detents/s from deflection
    bool repeats = false;
    std::uint64_t integrated_us = 0;
    std::uint64_t told_us = 0;  ///< last report of the deflection
  };
  struct Pending {
    ControlKind kind = ControlKind::turn;
    std::size_t index = 0;  ///< axis or button
    double detents = 0.0;
    std::uint64_t time_us = 0;
  };

  double gain(Axis& axis, double revolutions, std::uint64_t time_us) const;
  void integrate(std::size_t axis, std::uint64_t time_us);
  void add_turn(std::size_t axis, double detents, std::uint64_t time_us);
  void add_switch(ControlKind kind, std::size_t number, std::uint64_t time_us);
  void compact();

  std::string name_;
  KnobTuning tuning_;
  std::array<Axis, max_knob_axes> axes_{};
  std::array<bool, max_knob_buttons> down_{};
  std::vector<Pending> pending_;
  double taken_ms_ = 0.0;
};

}  // namespace lackwerk::input
