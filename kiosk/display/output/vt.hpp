// The virtual terminal under the kiosk: no text, no cursor and no keyboard shortcuts while it runs, as before once it
// ends.
//
// Why it exists: without it the kernel's text console draws into the same pixels, a keyboard's Ctrl+Alt+F2 shows a
// login to the customer, and a kiosk that dies leaves a dead screen to the technician. No terminal (a container, a seat
// manager, a system without any) is a normal state.
// One process has at most one Console that holds a terminal. The thread that makes it destroys it; a crash on any
// thread restores the terminal. SIGKILL cannot be caught: systemd's TTYReset= restores it then, and the next start does
// not take the leftovers for the state to go back to.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "kiosk/display/log.hpp"

namespace lackwerk::kiosk {

/// The system calls it needs, so that tests can be the kernel. They are also called in a signal handler. Each returns
/// -1 and sets errno as the real ones do.
struct VtCalls {
  int (*open)(const char* path);                                      ///< for reading and writing, close-on-exec
  int (*close)(int fd);                                               ///<
  int (*control)(int fd, unsigned long request, unsigned long data);  ///< ioctl(2); data: a number or an address
  int (*number)(int fd);                                              ///< of the terminal behind fd; 0: is none
  int (*wait_ms)(int ms);                                             ///<
};
[[nodiscard]] const VtCalls& vt_calls();

class Console {
 public:
  /// Takes the terminal on standard input (the unit's TTYPath=), else the one that is shown, if it may: shows it,
  /// switches the keyboard and the text off, and locks switching. Signals of a crash (SIGSEGV, SIGABRT, SIGBUS, SIGFPE,
  /// SIGILL) restore it and go on to whoever handled them before. What was taken, or why nothing was, is logged.
  /// `seat_manager`: Seat::holds_console(): leave it alone.
  [[nodiscard]] static std::unique_ptr<Console> acquire(bool seat_manager, Log& log, const VtCalls& calls = vt_calls());
  /// Restores it.
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// The terminal's number, 1 for /dev/tty1; 0: none.
  [[nodiscard]] int number() const { return number_; }
  /// "tty1", or why there is none: for status.json.
  [[nodiscard]] const std::string& description() const { return description_; }

 private:
  Console(const VtCalls& calls, std::string description) : calls_(&calls), description_(std::move(description)) {}
  void hold(int fd, Log& log);

  const VtCalls* calls_;
  std::string description_;
  int number_ = 0;
  int own_fd_ = -1;  ///< to close; -1: standard input is used
  bool holds_ = false;
  std::vector<std::byte> signal_stack_;  ///< a crash may be a full stack
};

}  // namespace lackwerk::kiosk
