// Who may open the graphics devices: a seat manager (seatd, logind) through libseat, or the process itself.
//
// Why it exists: with a seat manager the kiosk needs no device groups and gives the screen back when another session
// takes it; without one it opens the nodes itself, as root or a member of the groups. The rest of the kiosk must not
// care which. Whoever opens the seat owns it and destroys it after every device it gave out. One thread.
#pragma once

#include <memory>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/log.hpp"

namespace lackwerk::kiosk {

class Seat {
 public:
  virtual ~Seat() = default;
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;

  /// `how`: "libseat", "direct", or "auto": libseat if a seat manager answers within `seat_wait_ms`, else direct. Which
  /// one it became is logged, and why. `log` must outlive the seat. Error: an unknown word (usage), or libseat was
  /// asked for and does not answer.
  [[nodiscard]] static Result<std::unique_ptr<Seat>> open(const std::string& how, Log& log);

  /// Opens a device node for reading and writing, close-on-exec and non-blocking. Error: names the node, and the group
  /// or rule that would help. While the seat is not active a seat manager refuses.
  [[nodiscard]] virtual Result<int> open_device(const std::string& path) = 0;
  /// Gives back what open_device() gave; the descriptor is closed.
  virtual void close_device(int fd) = 0;
  /// To poll for reading; -1: nothing to poll.
  [[nodiscard]] virtual int fd() const = 0;
  /// Handles what has arrived; never blocks. active() may have changed afterwards. Devices stay open over a pause, but
  /// a GPU has lost its master then and an input device is dead: open input devices again, set the mode again.
  virtual void dispatch() = 0;
  /// False while another session has the screen.
  [[nodiscard]] virtual bool active() const = 0;
  /// "libseat (seatd), seat0" or "direct": for the log and status.json.
  [[nodiscard]] virtual const std::string& description() const = 0;
  /// Whether a seat manager looks after the console, so that nobody else may (vt.hpp).
  [[nodiscard]] virtual bool holds_console() const { return false; }

 protected:
  Seat() = default;
};

/// libseat's answer is waited for this long: a daemon of the same machine needs milliseconds.
inline constexpr int seat_wait_ms = 2000;

}  // namespace lackwerk::kiosk
