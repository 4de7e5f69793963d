// The kiosk as a systemd service: ready, alive, stopping.
//
// Why it exists: the watchdog must be fed by progress of the main loop, not by a thread of its own that would go on
// feeding while the screen is dead. Without systemd (no NOTIFY_SOCKET) everything here does nothing. One thread.
#pragma once

#include <string>

namespace lackwerk::kiosk {

class Service {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC once.
  Service();

  /// The first picture is on its way, or the kiosk waits for a display and can do no more: once.
  void ready(const std::string& status);
  /// One line for `systemctl status`; sent when it has changed.
  void say(const std::string& status);
  /// Called by the loop whenever it has gone round; sends at most four pings in a watchdog period.
  void progress(double now_ms);
  /// When progress() must be called next, CLOCK_MONOTONIC ms: a third of the period after the last ping. Infinite
  /// (1e300) without a watchdog.
  [[nodiscard]] double wake_at_ms() const;
  void stopping();

 private:
  double period_ms_ = 0.0;  ///< 0: no watchdog
  double last_ping_ms_ = -1e300;
  bool ready_ = false;
  std::string said_;
};

}  // namespace lackwerk::kiosk
