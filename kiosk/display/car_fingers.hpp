// What fingers on the car mean: one orbits, two zoom (and orbit by their mean movement), a flick goes on turning, two
// taps frame the car.
//
// Why it exists: behaviour under real fingers is tested with lists of touches. Whoever decides which finger is on the
// car (Experience) sends only those here, in pixels of the picture. Owns values only; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "input/control.hpp"
#include "kiosk/display/orientation.hpp"

namespace lackwerk::kiosk {

/// A finger across the whole width turns the car this far, and as far per pixel up and down.
inline constexpr double orbit_degrees_a_width = 270.0;
/// A finger that stays within this part of the picture's shorter edge rests: fingertips roll, panels jitter.
inline constexpr double rest_share = 0.01;
/// Two taps nearer to each other than this part of the shorter edge are meant for the same place.
inline constexpr double double_tap_share = 0.06;
inline constexpr std::uint64_t tap_us = 300'000;         ///< a longer touch is no tap
inline constexpr std::uint64_t double_tap_us = 400'000;  ///< from the first tap's end to the second one's beginning

/// Turning goes on after a flick: speed falls by e each of these, and is nothing below the least.
inline constexpr double inertia_ms = 350.0;
inline constexpr double least_turn_deg_s = 3.0;
/// A panel that reports two places in no time makes no car spin.
inline constexpr double most_turn_deg_s = 540.0;

/// The turn that is left over when a finger leaves.
struct Flick {
  double azimuth_deg_s = 0.0, elevation_deg_s = 0.0;
};

/// A flick under way.
class Coasting {
 public:
  Coasting(Flick flick, double now_ms) : flick_(flick), since_ms_(now_ms) {}
  /// Degrees since the last call: azimuth, elevation. Over any times the sum is the same.
  [[nodiscard]] std::array<double, 2> turn(double now_ms);
  [[nodiscard]] bool ended(double now_ms) const;

 private:
  Flick flick_;
  double since_ms_, done_ = 0.0;
};

class CarFingers {
 public:
  using Controls = std::vector<input::Control>;
  /// What a finger's leaving means.
  struct Left {
    bool frame = false;  ///< the second of two taps
    std::optional<Flick> flick;
  };

  /// `picture_px`: each > 0. Fingers that are down are forgotten if it changes.
  void set_picture(std::array<int, 2> picture_px);
  /// A finger goes down; a third one is not taken (false).
  bool down(int contact, Point px, std::uint64_t time_us);
  /// Orbits and zooms.
  [[nodiscard]] Controls move(int contact, Point px, std::uint64_t time_us);
  [[nodiscard]] Left up(int contact, std::uint64_t time_us);
  void cancel(int contact);
  void clear();
  [[nodiscard]] std::size_t count() const { return fingers_.size(); }

 private:
  struct Finger {
    int contact;
    Point start, at;
    std::uint64_t down_us;
    bool resting = true;  ///< has not left the place where it went down
    bool alone = true;    ///< was never one of two: only then it can tap or flick
  };
  struct Tap {
    Point at;
    std::uint64_t up_us;
  };
  /// A turn and when it was reported.
  struct Turn {
    double azimuth_deg, elevation_deg;
    std::uint64_t time_us;
  };
  [[nodiscard]] Finger* find(int contact);
  [[nodiscard]] std::optional<Flick> flick(std::uint64_t up_us) const;
  [[nodiscard]] double shorter_edge() const;

  std::array<int, 2> picture_px_{1920, 1080};
  std::vector<Finger> fingers_;
  std::optional<Tap> tap_;  ///< the first of two
  std::deque<Turn> turns_;  ///< the last ones of a finger alone
};

}  // namespace lackwerk::kiosk
