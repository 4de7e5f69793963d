// The console: taken, given back, given back in a crash; the kernel is played by a table of functions.
#include "kiosk/display/output/vt.hpp"

#include <gtest/gtest.h>
#include <linux/kd.h>
#include <linux/vt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <limits>
#include <string>

namespace lackwerk::test {
namespace {

using kiosk::Console;
using kiosk::Log;

/// The kernel. A signal handler calls it, without any argument of ours, so it cannot but be one per process.
struct Kernel {
  int stdin_number = 0;       ///< terminal on standard input
  bool tty0 = true;           ///< may be opened
  int shown = 1;              ///< the terminal one sees
  bool follows = true;        ///< VT_ACTIVATE works
  unsigned long refused = 0;  ///< a request that fails
  unsigned long keyboard = K_UNICODE, display = KD_TEXT;
  char switching = VT_AUTO;
  short release_signal = 0;
  int open_descriptors = 0, waits = 0;
  bool loud = false;  ///< says on standard error when all is as it was: for crashes
};
Kernel kernel;  // NOLINT: see above

int refuse(int error) {
  errno = error;
  return -1;
}

template <class T>
T& at(unsigned long data) {
  return *reinterpret_cast<T*>(data);  // NOLINT(performance-no-int-to-ptr): ioctl(2) does it so
}

int control(int /*fd*/, unsigned long request, unsigned long data) {
  if (request == kernel.refused) return refuse(EPERM);
  switch (request) {
    case KDGKBMODE:
      at<int>(data) = static_cast<int>(kernel.keyboard);
      break;
    case KDGETMODE:
      at<int>(data) = static_cast<int>(kernel.display);
      break;
    case VT_GETMODE:
      at<vt_mode>(data) = {};
      at<vt_mode>(data).mode = kernel.switching;
      break;
    case VT_GETSTATE:
      at<vt_stat>(data).v_active = static_cast<unsigned short>(kernel.shown);
      break;
    case VT_ACTIVATE:
      if (kernel.follows) kernel.shown = static_cast<int>(data);
      break;
    case VT_SETMODE:
      kernel.switching = at<vt_mode>(data).mode;
      kernel.release_signal = at<vt_mode>(data).relsig;
      break;
    case KDSETMODE:
      kernel.display = data;
      break;
    case KDSKBMODE:
      kernel.keyboard = data;
      if (kernel.loud && data == K_UNICODE && kernel.display == KD_TEXT && kernel.switching == VT_AUTO) {
        static constexpr char text[] = "all restored\n";
        if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(99);
      }
      break;
    default:
      return refuse(EINVAL);
  }
  return 0;
}

const kiosk::VtCalls calls = {
    .open =
        [](const char* path) {
          if (!kernel.tty0 || (std::strcmp(path, "/dev/tty0") != 0 && std::strcmp(path, "/dev/tty1") != 0))
            return refuse(EACCES);
          ++kernel.open_descriptors;
          return 1000;
        },
    .close =
        [](int) {
          --kernel.open_descriptors;
          return 0;
        },
    .control = control,
    .number = [](int fd) { return fd == STDIN_FILENO ? kernel.stdin_number : 0; },
    .wait_ms =
        [](int) {
          ++kernel.waits;
          return 0;
        },
};

bool said(const Log& log, const std::string& what) {
  const auto lines = log.lines();
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

void expect_taken() {
  EXPECT_EQ(kernel.keyboard, static_cast<unsigned long>(K_OFF));
  EXPECT_EQ(kernel.display, static_cast<unsigned long>(KD_GRAPHICS));
  EXPECT_EQ(kernel.switching, VT_PROCESS);
}
void expect_restored() {
  EXPECT_EQ(kernel.keyboard, static_cast<unsigned long>(K_UNICODE));
  EXPECT_EQ(kernel.display, static_cast<unsigned long>(KD_TEXT));
  EXPECT_EQ(kernel.switching, VT_AUTO);
  EXPECT_EQ(kernel.open_descriptors, 0);
}

class ConsoleTwin : public testing::Test {
 protected:
  void SetUp() override { kernel = Kernel(); }
  Log log_{nullptr};
};

TEST_F(ConsoleTwin, StandardInputComesFirst) {
  kernel.stdin_number = 3;
  kernel.shown = 1;
  {
    const auto console = Console::acquire(false, log_, calls);
    EXPECT_EQ(console->number(), 3);
    EXPECT_EQ(console->description(), "tty3");
    EXPECT_EQ(kernel.shown, 3);
    EXPECT_EQ(kernel.open_descriptors, 0);
    expect_taken();
  }
  expect_restored();
  EXPECT_TRUE(said(log_, "tty3 taken"));
}

TEST_F(ConsoleTwin, ElseTheOneThatIsShown) {
  {
    const auto console = Console::acquire(false, log_, calls);
    EXPECT_EQ(console->number(), 1);
    EXPECT_EQ(kernel.open_descriptors, 1);
    expect_taken();
  }
  expect_restored();
}

TEST_F(ConsoleTwin, NoneIsNormal) {
  kernel.tty0 = false;
  {
    const auto console = Console::acquire(false, log_, calls);
    EXPECT_EQ(console->number(), 0);
    EXPECT_NE(console->description().find("none: "), std::string::npos);
  }
  expect_restored();
  EXPECT_TRUE(log_.problems().empty());
  EXPECT_TRUE(said(log_, "Permission denied"));
}

TEST_F(ConsoleTwin, SeatManagersTerminalIsLeftAlone) {
  kernel.stdin_number = 1;
  const auto console = Console::acquire(true, log_, calls);
  EXPECT_EQ(console->number(), 0);
  expect_restored();
  EXPECT_TRUE(said(log_, "seat manager"));
}

TEST_F(ConsoleTwin, SecondOneDoesNotTouchTheFirst) {
  const auto first = Console::acquire(false, log_, calls);
  {
    const auto second = Console::acquire(false, log_, calls);
    EXPECT_EQ(second->number(), 0);
  }
  expect_taken();
}

TEST_F(ConsoleTwin, LeftoversOfAKilledKioskAreNotTheStateToGoBackTo) {
  kernel.keyboard = K_OFF;
  kernel.display = KD_GRAPHICS;
  kernel.switching = VT_PROCESS;
  { const auto console = Console::acquire(false, log_, calls); }
  expect_restored();
}

TEST_F(ConsoleTwin, OtherKeyboardModesComeBack) {
  kernel.keyboard = K_XLATE;
  { const auto console = Console::acquire(false, log_, calls); }
  EXPECT_EQ(kernel.keyboard, static_cast<unsigned long>(K_XLATE));
}

TEST_F(ConsoleTwin, WhatIsRefusedIsSaidAndTheRestDone) {
  for (const auto& [request, text] : {std::pair<unsigned long, const char*>(KDSKBMODE, "the keyboard stays on"),
                                      {KDSETMODE, "text stays on"},
                                      {VT_SETMODE, "switching is not locked"}}) {
    kernel = Kernel();
    kernel.refused = request;
    const auto console = Console::acquire(false, log_, calls);
    EXPECT_EQ(console->number(), 1);
    EXPECT_TRUE(said(log_, text)) << text;
  }
}

TEST_F(ConsoleTwin, TerminalWithoutAnswersIsLeftAlone) {
  kernel.refused = KDGKBMODE;
  {
    const auto console = Console::acquire(false, log_, calls);
    EXPECT_NE(console->description().find("left alone"), std::string::npos);
    EXPECT_EQ(kernel.display, static_cast<unsigned long>(KD_TEXT));
  }
  expect_restored();
}

TEST_F(ConsoleTwin, ASwitchThatDoesNotComeIsWaitedForOnlySoLong) {
  kernel.stdin_number = 2;
  kernel.follows = false;
  const auto console = Console::acquire(false, log_, calls);
  EXPECT_GT(kernel.waits, 0);
  EXPECT_LE(kernel.waits, 100);
  EXPECT_TRUE(said(log_, "is not shown"));
  expect_taken();
}

TEST_F(ConsoleTwin, SwitchRequestsAreSignalsThatDoNothing) {
  const auto console = Console::acquire(false, log_, calls);
  struct sigaction now {};
  sigaction(kernel.release_signal, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL);
  raise(kernel.release_signal);  // still here
  expect_taken();
}

TEST_F(ConsoleTwin, HandlersGoWithIt) {
  struct sigaction before {};
  sigaction(SIGBUS, nullptr, &before);
  { const auto console = Console::acquire(false, log_, calls); }
  struct sigaction after {};
  sigaction(SIGBUS, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

// In a process of its own, which dies.

using ConsoleDeathTest = ConsoleTwin;

/// By that signal; sanitizers turn some of them into a failing exit.
struct Died {
  int signal;
  bool operator()(int status) const {
    return WIFSIGNALED(status) ? WTERMSIG(status) == signal : WIFEXITED(status) && WEXITSTATUS(status) != 0;
  }
};

TEST_F(ConsoleDeathTest, EveryCrashRestoresAndStillDiesOfItsSignal) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    EXPECT_EXIT(
        {
          const auto console = Console::acquire(false, log_, calls);
          kernel.loud = true;
          raise(signal);
        },
        Died{signal}, "all restored");
}

TEST_F(ConsoleDeathTest, RealFaultRestores) {
  EXPECT_EXIT(
      {
        const auto console = Console::acquire(false, log_, calls);
        kernel.loud = true;
        volatile int* nowhere = nullptr;
        *nowhere = 1;  // NOLINT(clang-analyzer-core.NullDereference): that is the test
      },
      Died{SIGSEGV}, "all restored");
}

/// Until the stack is full.
// NOLINTNEXTLINE(misc-no-recursion)
int deeper(volatile char* above, int level) {
  std::array<volatile char, 4096> here{};
  here[static_cast<std::size_t>(level) % here.size()] = *above;
  return level == std::numeric_limits<int>::max() ? here[0] : deeper(here.data(), level + 1) + here[1];
}

TEST_F(ConsoleDeathTest, FullStackRestores) {
  EXPECT_EXIT(
      {
        const auto console = Console::acquire(false, log_, calls);
        kernel.loud = true;
        volatile char start = 1;
        kernel.waits = deeper(&start, 0);
      },
      Died{SIGSEGV}, "all restored");
}

TEST_F(ConsoleDeathTest, HandlerThatWasThereBeforeStillRuns) {
  EXPECT_EXIT(
      {
        struct sigaction mine {};
        mine.sa_handler = [](int) { _exit(42); };
        sigaction(SIGABRT, &mine, nullptr);
        const auto console = Console::acquire(false, log_, calls);
        kernel.loud = true;
        raise(SIGABRT);
      },
      testing::ExitedWithCode(42), "all restored");
}

}  // namespace
}  // namespace lackwerk::test
