// What fingers and knobs mean: touches, turns and presses in, the kiosk's controls out.
//
// Why it exists: behaviour under real fingers is tested with lists of events. The picture has two parts: a strip along
// its lower edge is the slider through the paints, the rest is the car. One finger on the car orbits, two zoom (and
// orbit by their mean movement), two taps go home; a third finger there is ignored, as is a second one in the strip. A
// knob turns the morph, the orbit or the zoom: a short press goes to the next of the three, a long one goes home. The
// view stops when the finger stops: inertia is not part of this. Owns values only; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "input/control.hpp"
#include "kiosk/display/orientation.hpp"

namespace lackwerk::kiosk {

/// The slider is the part of the picture below this, in [0, 1] of its height.
inline constexpr double slider_top = 0.84;
/// Left and right of the slider's path, in [0, 1] of the picture's width: its ends are reached before the frame is.
inline constexpr double slider_margin = 0.05;
/// A finger across the whole width turns the car this far, and as far per pixel up and down.
inline constexpr double orbit_degrees_a_width = 270.0;
/// Detents of a knob from one paint to the next: a dial with 24 a turn shows a new paint each turn.
inline constexpr double detents_a_paint = 24.0;
/// A dial with 24 detents a turn orbits half round with each of them.
inline constexpr double orbit_degrees_a_detent = 7.5;
/// A dial with 24 detents a turn halves the distance twice with each turn.
inline constexpr double zoom_detents_a_halving = 12.0;
/// A finger that stays within this part of the picture's shorter edge rests: fingertips roll, panels jitter.
inline constexpr double rest_share = 0.01;
/// Two taps nearer to each other than this part of the shorter edge are meant for the same place.
inline constexpr double double_tap_share = 0.06;
inline constexpr std::uint64_t tap_us = 300'000;         ///< a longer touch is no tap
inline constexpr std::uint64_t double_tap_us = 400'000;  ///< from the first tap's end to the second one's beginning
inline constexpr std::uint64_t long_press_us = 1'000'000;

/// What the knob turns.
enum class Focus { morph, orbit, zoom };
[[nodiscard]] const char* focus_name(Focus focus);

class Gestures {
 public:
  /// `paints`: of the pack, in [1, max_paints]. `home`: the camera to go back to, the scene's first.
  Gestures(std::size_t paints, std::string home);

  /// Another mode or mounting. `panel_px` as the panel is built, each > 0; until it is known a usual panel's is taken.
  /// If anything changes, fingers that are down are forgotten.
  void set_rotation(Rotation rotation, std::array<int, 2> panel_px = {1920, 1080});
  /// Another pack or scene: the morph position begins anew.
  void set_paints(std::size_t paints, std::string home);
  /// Somebody else has set the weights (a script): a knob goes on from there.
  void follow(const std::vector<double>& weights);

  /// What the event means to the state, in order. Controls that are no touch, turn, press or release come back as they
  /// are; weights among them are followed.
  [[nodiscard]] std::vector<input::Control> take(const input::Control& event);
  /// What has come to mean something by time alone (a long press). `now_ms`: CLOCK_MONOTONIC.
  [[nodiscard]] std::vector<input::Control> advance(double now_ms);
  /// When advance() wants to be called; input::never_ms if never.
  [[nodiscard]] double wake_at_ms() const;

  /// Position on the closed path of the pack's paints (morph_path.hpp), for the slider's picture.
  [[nodiscard]] double morph_position() const { return position_; }
  [[nodiscard]] Focus focus() const { return focus_; }
  /// Fingers that mean something now.
  [[nodiscard]] int fingers() const;

 private:
  enum class Role { slider, car, ignored };
  struct Finger {
    int contact;
    Role role;
    Point start, at;      ///< pixels of the picture
    bool resting = true;  ///< has not left the place where it went down
    bool alone = true;    ///< was never one of two on the car: only then it can tap
    std::uint64_t down_us = 0;
  };
  struct Tap {
    Point at;
    std::uint64_t up_us;
  };

  using Controls = std::vector<input::Control>;

  [[nodiscard]] std::optional<Point> pixel_of(const input::Control& event) const;
  [[nodiscard]] Controls down(const input::Control& event);
  [[nodiscard]] Controls move(const input::Control& event);
  [[nodiscard]] Controls up(const input::Control& event);
  [[nodiscard]] Controls turn(const input::Control& event);
  [[nodiscard]] Controls release(const input::Control& event);
  [[nodiscard]] Controls slide(Point pixel, std::uint64_t time_us);
  [[nodiscard]] Controls move_on_car(Finger& finger, Point to, std::uint64_t time_us);
  [[nodiscard]] input::Control home(std::uint64_t time_us) const;
  [[nodiscard]] std::vector<Finger*> on_car();
  [[nodiscard]] double shorter_edge() const;

  int paints_ = 1;
  std::string home_;
  Rotation rotation_ = Rotation::none;
  std::array<int, 2> picture_px_{1920, 1080};  ///< as it is seen
  double position_ = 0.0;
  Focus focus_ = Focus::morph;
  std::vector<Finger> fingers_;
  std::optional<Tap> tap_;                        ///< the first of two
  std::map<std::string, std::uint64_t> pressed_;  ///< knob: since when, µs
};

}  // namespace lackwerk::kiosk
