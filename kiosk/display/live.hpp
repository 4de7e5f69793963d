// The live kiosk: one thread between devices, interface, picture and panel.
//
// Why it exists: everything that can happen in a showroom meets here, so it is a step function over edges that have
// twins, and never waits itself: whoever runs it polls the descriptors until wake_at_ms(). Refers to what it is given;
// all of it must outlive it. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/script.hpp"
#include "input/source.hpp"
#include "kiosk/display/devices.hpp"
#include "kiosk/display/import_notice.hpp"
#include "kiosk/display/interface.hpp"
#include "kiosk/display/latency.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/pack_source.hpp"
#include "kiosk/display/picture.hpp"
#include "kiosk/display/service.hpp"
#include "kiosk/display/status.hpp"

namespace lackwerk::kiosk {

struct LiveSettings {
  std::string status_folder;    ///< of status.json, and of the importer's reports; empty: neither
  std::string pack_file;        ///< for the status
  bool pack_signed = false;     ///< by a key of the keyring
  PackSource* packs = nullptr;  ///< tells of another pack; null: there is never another one. Outlives the kiosk
  std::vector<RefusedStatus> refused;
  DisplayProfile profile{};              ///< of the panel: what it cannot show is said
  std::filesystem::path choices_folder;  ///< keeps what the dealer changes; empty: it is forgotten
  std::function<int()> minute_of_day;    ///< local time; empty: the machine's
  std::function<double()> wall_s;        ///< seconds since 1970; empty: the machine's
  bool visit = false;                    ///< begins with one, as for a script that does not touch
};

/// Minutes since midnight by the machine's clock and time zone.
[[nodiscard]] int local_minute();

class Live {
 public:
  Live(Output& output, Stage& stage, Picture& picture, Interface& interface, Devices devices,
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
  void apply(const Interface::Changes& changes, std::uint64_t time_us);
  void take_script(double now_ms);
  void keep_choices();
  void take_pack(double now_ms);
  void take_import(double now_ms);
  [[nodiscard]] Result<void> fit_output();
  [[nodiscard]] Result<void> show();
  void report(double now_ms);
  void check_gamut();
  void sleep_or_wake();
  void make_swatch(double now_ms);
  [[nodiscard]] bool wants_swatch(double now_ms) const;
  [[nodiscard]] bool wants_frame() const;
  [[nodiscard]] double frame_period_ms() const;
  [[nodiscard]] double moves_at_ms(double now_ms) const;

  Output& output_;
  Stage& stage_;
  Picture& picture_;
  Interface& interface_;
  Devices devices_;
  std::optional<input::ScriptPlayer> script_;
  Log& log_;
  Service& service_;
  LiveSettings settings_;
  Latency latency_;

  std::vector<input::Control> controls_;  ///< scratch, kept for its memory
  std::vector<input::Notice> notices_;
  GamutLoss gamut_loss_;  ///< of the last picture that came to rest
  std::uint64_t output_revision_ = 0, flipped_at_us_ = 0, handed_over_ = 0;
  bool suspended_ = false;       ///< the touch screens are closed, another session has the seat
  bool fitted_ = false;          ///< the framebuffer has the output's size
  bool asleep_ = false;          ///< the panel is off
  double touched_ms_ = -1e300;   ///< when a device was last heard
  bool weights_changed_ = true;  ///< since the last realisation
  bool damaged_ = true;          ///< the framebuffer holds what the panel does not
  double started_ms_ = 0.0, stepped_ms_ = 0.0, reported_ms_ = -1e300;
  bool report_due_ = true;
  ImportNotice imports_;
};

}  // namespace lackwerk::kiosk
