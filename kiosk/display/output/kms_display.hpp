// One monitor under the kernel's mode setting: what is connected, what is set, which picture is on its way.
//
// Why it exists: the hard part of a screen is not drawing but everything that happens between two pictures: no monitor,
// unplug, another monitor, a driver that refuses, a flip that never comes, another session. This is that state machine,
// without GL and without a clock of its own, used by the GPU's and the dumb buffers' output alike.
// Rules it keeps: only a flip event ends a flip; a picture that was refused stays the caller's; every connect sets the
// full state again; off stays off over a hot-plug; nothing but a vanished card is an error. Owns no device (it must
// outlive this) and no buffers; puts the console's picture back when destroyed. One thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input/source.hpp"
#include "kiosk/display/log.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/output/kms_settings.hpp"

namespace lackwerk::kiosk {

class KmsDisplay {
 public:
  /// `until_then`: mode() before the first monitor.
  KmsDisplay(KmsDevice& device, WantedPipe wanted, OutputMode until_then, Log& log);
  ~KmsDisplay();
  KmsDisplay(const KmsDisplay&) = delete;
  KmsDisplay& operator=(const KmsDisplay&) = delete;

  /// Takes the card and looks for a monitor. Error: another program shows pictures on the card.
  [[nodiscard]] Result<void> start(double now_ms);

  [[nodiscard]] OutputState state() const { return state_; }
  [[nodiscard]] const OutputMode& mode() const { return mode_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] bool ready(double now_ms) const;
  /// Puts a framebuffer of mode().panel_px on its way: the full state if that is due, else a flip. Error: card gone.
  [[nodiscard]] Result<Presented> show(DrmId framebuffer, double now_ms);
  /// Reads flips, gives lost ones up, and does what is due. Error: card gone.
  [[nodiscard]] Result<void> dispatch(double now_ms);
  [[nodiscard]] double wake_at_ms() const;

  /// A hot-plug event has come: all connectors are read again, soon.
  void rescan(double now_ms);
  void set_power(bool on, double now_ms);
  [[nodiscard]] bool power() const { return power_; }
  /// The seat was taken, and given back.
  void suspend();
  void resume(double now_ms);

  /// The framebuffers the display engine may read now; 0: none. All others may be drawn into.
  [[nodiscard]] DrmId shown() const { return shown_; }
  [[nodiscard]] DrmId queued() const { return queued_; }
  [[nodiscard]] std::uint64_t flipped_at_us() const { return flipped_at_us_; }
  [[nodiscard]] std::uint64_t presented() const { return presented_; }

 private:
  struct Saved {
    DrmId connector = 0, crtc = 0;
    DrmPipeState state;
  };

  // What is connected.
  [[nodiscard]] Result<void> scan(double now_ms);
  [[nodiscard]] DrmResult<void> take_pipe(Pipe pipe, const DrmSnapshot& snapshot);
  void drop_pipe();
  void disable_pipe();
  [[nodiscard]] bool restore_console();
  void say(const std::string& why);
  void change_state(OutputState state);
  // What is set.
  [[nodiscard]] Result<Presented> set_everything(DrmId framebuffer, double now_ms);
  [[nodiscard]] DrmResult<void> set_atomic(DrmId framebuffer);
  [[nodiscard]] DrmResult<void> set_legacy(DrmId framebuffer);
  [[nodiscard]] DrmResult<void> tested_commit(const std::vector<DrmSetting>& settings, const DrmCommit& how);
  [[nodiscard]] Result<void> put_to_sleep(double now_ms);
  // What is on its way, and what went wrong.
  void queue(DrmId framebuffer, double give_up_at_ms);
  [[nodiscard]] Result<void> read_flips(int timeout_ms);
  void wait_for_flip();
  [[nodiscard]] Result<Presented> refused(int code, const std::string& doing, double now_ms);
  [[nodiscard]] Result<void> try_another_mode(int code, double now_ms);
  void lose_master(int code, double now_ms);

  KmsDevice& device_;
  WantedPipe wanted_;
  Log& log_;
  OutputMode mode_;
  OutputState state_ = OutputState::waiting_for_display;
  std::uint64_t revision_ = 0;
  std::optional<Pipe> pipe_;
  std::vector<DrmMode> refused_modes_;
  PipeProperties properties_;
  std::optional<Saved> saved_;
  std::string said_;  ///< what was chosen and why, as last logged

  bool full_ = true;     ///< the next picture comes with the full state
  bool lit_ = false;     ///< the pipe has been set by this object
  bool atomic_ = false;  ///< the full state was set by an atomic commit
  bool power_ = true;
  bool sleep_due_ = false;  ///< the panel is still to be put to sleep
  bool session_ = true;     ///< the seat is ours, as far as it says
  DrmId shown_ = 0, queued_ = 0;
  std::uint32_t cookie_ = 0;    ///< of the newest flip: late events of older ones are nobody's
  double give_up_at_ms_ = 0.0;  ///< when the queued flip counts as lost
  double retry_at_ms_ = 0.0;    ///< not ready before
  double busy_since_ms_ = -1.0;
  double scan_at_ms_ = input::never_ms, master_at_ms_ = input::never_ms;
  double scanned_at_ms_ = -1e9;
  std::uint64_t flipped_at_us_ = 0, presented_ = 0;
};

/// Error::field of start() when another program shows pictures on the card: no other way to this panel would be seen.
inline constexpr const char* master_field = "master";

/// True for errors that say "not now" instead of "not so".
[[nodiscard]] bool passes(int code);
/// True for errors that say that the card has gone for good.
[[nodiscard]] bool card_gone(int code);

}  // namespace lackwerk::kiosk
