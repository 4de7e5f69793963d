// The live kiosk: one thread between devices, state, picture and panel.
//
// Why it exists: everything that can happen in a showroom meets here, so it is a step function over edges that have
// twins, and never waits itself: whoever runs it polls the descriptors until wake_at_ms(). Refers to what it is given;
// all of it must outlive it. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/script.hpp"
#include "input/source.hpp"
#include "kiosk/display/devices.hpp"
#include "kiosk/display/gestures.hpp"
#include "kiosk/display/latency.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/picture.hpp"
#include "kiosk/display/service.hpp"
#include "kiosk/display/state.hpp"
#include "kiosk/display/status.hpp"

namespace lackwerk::kiosk {

struct LiveSettings {
  std::string status_folder;  ///< empty: no status.json
  std::string pack_file;      ///< for the status
  std::vector<RefusedStatus> refused;
  DisplayProfile profile{};  ///< of the panel: what it cannot show is said
};

class Live {
 public:
  Live(Output& output, Stage& stage, Picture& picture, State& state, Devices devices,
       std::optional<input::ScriptPlayer> script, Log& log, Service& service, LiveSettings settings);

  /// Once round: events in, state on, at most one frame drawn and handed over, status out. Error: the display device is
  /// lost for good, or the paint is refused: the process should end.
  [[nodiscard]] Result<void> step(double now_ms);

  void add_descriptors(std::vector<int>& out) const;
  /// When step() wants to be called even if nothing is readable; not after `now_ms` if there is something to draw.
  [[nodiscard]] double wake_at_ms(double now_ms) const;

  /// The script has been played and its last picture rests on the panel.
  [[nodiscard]] bool finished() const;
  /// Pictures handed to the output and taken.
  [[nodiscard]] std::uint64_t handed_over() const { return handed_over_; }
  [[nodiscard]] Status status() const;
  /// The last word: writes a status that says so.
  void stop();

 private:
  void take_input(double now_ms);
  void apply(const input::Control& control);
  [[nodiscard]] Result<void> fit_output();
  [[nodiscard]] Result<void> show();
  void report(double now_ms);
  void check_gamut();
  [[nodiscard]] bool wants_frame() const;
  [[nodiscard]] double frame_period_ms() const;

  Output& output_;
  Stage& stage_;
  Picture& picture_;
  State& state_;
  Devices devices_;
  std::optional<input::ScriptPlayer> script_;
  Log& log_;
  Service& service_;
  LiveSettings settings_;
  Gestures gestures_;
  Latency latency_;

  std::vector<input::Control> controls_;  ///< scratch, kept for its memory
  std::vector<input::Notice> notices_;
  GamutLoss gamut_loss_;  ///< of the last picture that came to rest
  std::uint64_t output_revision_ = 0, flipped_at_us_ = 0, handed_over_ = 0;
  bool suspended_ = false;       ///< the touch screens are closed, another session has the seat
  bool fitted_ = false;          ///< the framebuffer has the output's size
  bool weights_changed_ = true;  ///< since the last realisation
  bool damaged_ = true;          ///< the framebuffer holds what the panel does not
  double started_ms_ = 0.0, reported_ms_ = -1e300;
  bool report_due_ = true;
};

}  // namespace lackwerk::kiosk
