#include "kiosk/display/output/vt.hpp"

#include <fcntl.h>
#include <linux/kd.h>
#include <linux/major.h>
#include <linux/vt.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

namespace lackwerk::kiosk {
namespace {

constexpr std::array<int, 5> crash_signals = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
/// For the switch to our terminal; the kernel needs a few milliseconds.
constexpr int most_waits = 50;
constexpr int wait_step_ms = 20;
/// Several times what a handler's frame needs with the largest vector registers (11 kB with AMX).
constexpr std::size_t signal_stack_bytes = std::size_t{64} << 10;

/// What a signal handler must know. A handler gets no argument of ours, so this cannot but be one object per process:
/// the one piece of such state in the kiosk.
struct Restore {
  std::atomic<bool> armed{false};  ///< everything below is set, and the terminal is ours
  decltype(VtCalls::control) control = nullptr;
  int fd = -1;
  unsigned long keyboard = 0, display = 0;
  vt_mode switching{};
  std::array<struct sigaction, crash_signals.size()> before{};
};
Restore restore;
static_assert(std::atomic<bool>::is_always_lock_free, "used in a signal handler");

unsigned long address(void* of) { return reinterpret_cast<unsigned long>(of); }

/// Async-signal-safe: ioctl(2) is a bare system call on Linux. Once; later calls do nothing.
void restore_terminal() {
  if (!restore.armed.exchange(false)) return;
  restore.control(restore.fd, VT_SETMODE, address(&restore.switching));
  restore.control(restore.fd, KDSETMODE, restore.display);
  restore.control(restore.fd, KDSKBMODE, restore.keyboard);
}

extern "C" void lackwerk_on_crash(int signal) {
  const int error = errno;
  restore_terminal();
  const auto* at = std::find(crash_signals.begin(), crash_signals.end(), signal);
  sigaction(signal, &restore.before[static_cast<std::size_t>(at - crash_signals.begin())], nullptr);
  errno = error;
  raise(signal);  // waits until this handler returns, then does what would have been done without it
}

void catch_crashes() {
  struct sigaction action {};
  action.sa_handler = lackwerk_on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t k = 0; k < crash_signals.size(); ++k) sigaction(crash_signals[k], &action, &restore.before[k]);
}

/// Unless somebody else has taken the signal since.
void let_go_of_crashes() {
  for (std::size_t k = 0; k < crash_signals.size(); ++k) {
    struct sigaction now {};
    sigaction(crash_signals[k], nullptr, &now);
    if (now.sa_handler == lackwerk_on_crash) sigaction(crash_signals[k], &restore.before[k], nullptr);
  }
}

std::string error_text() { return std::strerror(errno); }

/// The terminal that is shown; 0: cannot be known.
int shown(const VtCalls& calls, int fd) {
  vt_stat state{};
  return calls.control(fd, VT_GETSTATE, address(&state)) == 0 ? state.v_active : 0;
}

struct Found {
  int fd = -1, number = 0;
  bool own = false;
  std::string why_not;
};

Found find_terminal(const VtCalls& calls) {
  if (const int number = calls.number(STDIN_FILENO); number > 0) return {STDIN_FILENO, number, false, {}};
  const int any = calls.open("/dev/tty0");
  if (any < 0) return {-1, 0, false, "standard input is no terminal, and /dev/tty0: " + error_text()};
  const int number = shown(calls, any);
  const std::string state_error = error_text();
  calls.close(any);
  if (number <= 0) return {-1, 0, false, "/dev/tty0 does not say which terminal is shown: " + state_error};
  const std::string path = "/dev/tty" + std::to_string(number);
  const int fd = calls.open(path.c_str());
  if (fd < 0) return {-1, 0, false, path + ": " + error_text()};
  return {fd, number, true, {}};
}

}  // namespace

const VtCalls& vt_calls() {
  static constexpr VtCalls calls = {
      .open = [](const char* path) { return ::open(path, O_RDWR | O_CLOEXEC | O_NOCTTY | O_NONBLOCK); },
      .close = [](int fd) { return ::close(fd); },
      .control = [](int fd, unsigned long request, unsigned long data) { return ioctl(fd, request, data); },
      .number =
          [](int fd) {
            struct stat node {};
            if (fstat(fd, &node) != 0 || !S_ISCHR(node.st_mode) || major(node.st_rdev) != TTY_MAJOR) return 0;
            const unsigned number = minor(node.st_rdev);
            return number <= MAX_NR_CONSOLES ? static_cast<int>(number) : 0;  // from 64 on they are serial lines
          },
      .wait_ms =
          [](int ms) {
            const timespec time{0, ms * 1'000'000L};
            return nanosleep(&time, nullptr);
          },
  };
  return calls;
}

std::unique_ptr<Console> Console::acquire(bool seat_manager, Log& log, const VtCalls& calls) {
  const auto nothing = [&](const std::string& why) {
    log.info("console: " + why);
    return std::unique_ptr<Console>(new Console(calls, why));
  };
  if (seat_manager) return nothing("left to the seat manager");
  if (restore.armed) return nothing("already held by this process");
  const Found found = find_terminal(calls);
  if (found.fd < 0) return nothing("none: " + found.why_not);
  std::unique_ptr<Console> console(new Console(calls, "tty" + std::to_string(found.number)));
  console->number_ = found.number;
  if (found.own) console->own_fd_ = found.fd;
  console->hold(found.fd, log);
  return console;
}

void Console::hold(int fd, Log& log) {
  const auto complain = [&](const char* what) {
    log.warning("console: " + description_ + ": " + what + ": " + error_text());
  };
  int keyboard = K_UNICODE, display = KD_TEXT;
  vt_mode switching{};
  if (calls_->control(fd, KDGKBMODE, address(&keyboard)) != 0 ||
      calls_->control(fd, KDGETMODE, address(&display)) != 0 ||
      calls_->control(fd, VT_GETMODE, address(&switching)) != 0) {
    complain("does not tell its state, so it is left alone");
    description_ += ", left alone";
    return;
  }
  // A kiosk that was killed leaves these; nobody wants them back.
  if (keyboard == K_OFF) keyboard = K_UNICODE;
  if (switching.mode == VT_PROCESS) switching = {};
  restore.control = calls_->control;
  restore.fd = fd;
  restore.keyboard = static_cast<unsigned long>(keyboard);
  restore.display = KD_TEXT;
  restore.switching = switching;

  signal_stack_.resize(signal_stack_bytes);
  stack_t before{};
  stack_t stack{};
  stack.ss_sp = signal_stack_.data();
  stack.ss_size = signal_stack_.size();
  if (sigaltstack(nullptr, &before) != 0 || (before.ss_flags & SS_DISABLE) == 0 || sigaltstack(&stack, nullptr) != 0)
    signal_stack_.clear();  // somebody else's is there: as good
  catch_crashes();
  holds_ = true;
  restore.armed = true;

  if (shown(*calls_, fd) != number_) {
    calls_->control(fd, VT_ACTIVATE, static_cast<unsigned long>(number_));
    int waits = 0;
    while (shown(*calls_, fd) != number_ && waits < most_waits) {
      calls_->wait_ms(wait_step_ms);
      ++waits;
    }
    if (waits == most_waits)
      log.warning("console: " + description_ + " is not shown: another program holds the screen");
  }
  if (calls_->control(fd, KDSKBMODE, K_OFF) != 0) complain("the keyboard stays on");
  if (calls_->control(fd, KDSETMODE, KD_GRAPHICS) != 0) complain("text stays on");
  // The kernel asks before it switches, by a signal that is ignored unless somebody handles it; no answer is a no.
  vt_mode locked{};
  locked.mode = VT_PROCESS;
  locked.relsig = locked.acqsig = SIGURG;
  if (calls_->control(fd, VT_SETMODE, address(&locked)) != 0) complain("switching is not locked");
  log.notice("console: " + description_ + " taken");
}

Console::~Console() {
  if (holds_) {
    restore_terminal();
    let_go_of_crashes();
    if (!signal_stack_.empty()) {
      stack_t off{};
      off.ss_flags = SS_DISABLE;
      sigaltstack(&off, nullptr);
    }
  }
  if (own_fd_ >= 0) calls_->close(own_fd_);
}

}  // namespace lackwerk::kiosk
