// Seats: direct access, and a seat manager played by a table of functions.
#include "kiosk/display/output/seat.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <libseat.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <set>
#include <string>
#include <thread>

#include "kiosk/display/output/seat_libseat.hpp"

namespace lackwerk::test {
namespace {

using kiosk::Log;
using kiosk::Seat;

/// The manager. libseat's functions take no user data, so it cannot but be one per process; each test resets it.
struct Manager {
  const libseat_seat_listener* listener = nullptr;
  void* userdata = nullptr;
  int refuse = 0;            ///< errno of open_seat; 0: takes it
  int answers_after_ms = 0;  ///< how long open_seat blocks
  std::atomic<int> opened{0}, closed{0};
  int disabled = 0, next_id = 7;
  std::set<int> devices;
  enum class Event { none, enable, disable, gone } next = Event::none;
  std::string backend;
  void reset() {
    listener = nullptr;
    userdata = nullptr;
    refuse = answers_after_ms = disabled = 0;
    opened = closed = 0;
    next_id = 7;
    devices.clear();
    next = Event::none;
    backend.clear();
  }
};
Manager manager;  // NOLINT: see above

libseat* the_seat() { return reinterpret_cast<libseat*>(&manager); }

const kiosk::LibseatCalls calls = {
    .open_seat = [](const libseat_seat_listener* listener, void* userdata) -> libseat* {
      if (const char* backend = std::getenv("LIBSEAT_BACKEND"); backend != nullptr) manager.backend = backend;
      std::this_thread::sleep_for(std::chrono::milliseconds(manager.answers_after_ms));
      if (manager.refuse != 0) {
        errno = manager.refuse;
        return nullptr;
      }
      manager.listener = listener;
      manager.userdata = userdata;
      ++manager.opened;
      return the_seat();
    },
    .disable_seat =
        [](libseat*) {
          ++manager.disabled;
          return 0;
        },
    .close_seat =
        [](libseat*) {
          ++manager.closed;
          return 0;
        },
    .open_device =
        [](libseat*, const char* path, int* fd) {
          *fd = open(path, O_RDWR);
          if (*fd < 0) return -1;
          manager.devices.insert(manager.next_id);
          return manager.next_id++;
        },
    .close_device =
        [](libseat*, int id) {
          manager.devices.erase(id);
          return 0;
        },
    .seat_name = [](libseat*) { return "seat7"; },
    .get_fd = [](libseat*) { return 0; },
    .dispatch =
        [](libseat*, int) {
          const auto event = std::exchange(manager.next, Manager::Event::none);
          if (event == Manager::Event::enable) manager.listener->enable_seat(the_seat(), manager.userdata);
          if (event == Manager::Event::disable) manager.listener->disable_seat(the_seat(), manager.userdata);
          if (event == Manager::Event::gone) {
            errno = ECONNRESET;
            return -1;
          }
          return event == Manager::Event::none ? 0 : 1;
        },
};

bool said(const Log& log, const std::string& what) {
  const auto lines = log.lines();
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

bool closed(int fd) { return fcntl(fd, F_GETFD) == -1 && errno == EBADF; }

class SeatManager : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("LIBSEAT_BACKEND");
    manager.reset();
    manager.next = Manager::Event::enable;
  }
  Log log_{nullptr};
};

TEST_F(SeatManager, OpensActiveAndClosesOnce) {
  {
    auto seat = kiosk::open_libseat(calls, "seatd", 1000, log_);
    ASSERT_TRUE(seat) << seat.error().line();
    EXPECT_TRUE((*seat)->active());
    EXPECT_TRUE((*seat)->holds_console());
    EXPECT_EQ((*seat)->description(), "libseat (seatd), seat7");
    EXPECT_EQ((*seat)->fd(), 0);
    EXPECT_EQ(manager.backend, "seatd");
    EXPECT_EQ(std::getenv("LIBSEAT_BACKEND"), nullptr);  // as it was
  }
  EXPECT_EQ(manager.opened, 1);
  EXPECT_EQ(manager.closed, 1);
}

TEST_F(SeatManager, GivesDevicesOutAndTakesThemBack) {
  auto seat = kiosk::open_libseat(calls, "", 1000, log_);
  ASSERT_TRUE(seat);
  const auto first = (*seat)->open_device("/dev/null");
  const auto second = (*seat)->open_device("/dev/zero");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(fcntl(*first, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  EXPECT_EQ(fcntl(*first, F_GETFL) & O_NONBLOCK, O_NONBLOCK);
  EXPECT_EQ(manager.devices.size(), 2u);
  (*seat)->close_device(*first);
  EXPECT_TRUE(closed(*first));
  EXPECT_EQ(manager.devices.size(), 1u);
  (*seat)->close_device(*first);  // twice is harmless
  (*seat)->close_device(12345);
  EXPECT_EQ(manager.devices.size(), 1u);
  seat->reset();  // what was not given back
  EXPECT_TRUE(closed(*second));
  EXPECT_TRUE(manager.devices.empty());
}

TEST_F(SeatManager, RefusedDeviceIsNamed) {
  auto seat = kiosk::open_libseat(calls, "", 1000, log_);
  ASSERT_TRUE(seat);
  const auto device = (*seat)->open_device("/nonexistent/card0");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().file, "/nonexistent/card0");
  EXPECT_FALSE(device.error().remedy.empty());
}

TEST_F(SeatManager, PausesAndComesBack) {
  auto seat = kiosk::open_libseat(calls, "", 1000, log_);
  ASSERT_TRUE(seat);
  manager.next = Manager::Event::disable;
  (*seat)->dispatch();
  EXPECT_FALSE((*seat)->active());
  EXPECT_EQ(manager.disabled, 1);  // answered, or the manager would wait
  EXPECT_TRUE(said(log_, "taken by another session"));
  (*seat)->dispatch();
  EXPECT_FALSE((*seat)->active());
  manager.next = Manager::Event::enable;
  (*seat)->dispatch();
  EXPECT_TRUE((*seat)->active());
  EXPECT_TRUE(said(log_, "given back"));
}

TEST_F(SeatManager, ManagerThatDiesIsSaidOnceAndNotPolled) {
  auto seat = kiosk::open_libseat(calls, "", 1000, log_);
  ASSERT_TRUE(seat);
  manager.next = Manager::Event::gone;
  (*seat)->dispatch();
  EXPECT_FALSE((*seat)->active());
  EXPECT_EQ((*seat)->fd(), -1);
  (*seat)->dispatch();
  ASSERT_EQ(log_.problems().size(), 1u);
  EXPECT_EQ(log_.problems()[0].times, 1);
}

TEST_F(SeatManager, SeatThatIsNotActiveYetIsOne) {
  manager.next = Manager::Event::none;
  auto seat = kiosk::open_libseat(calls, "", 20, log_);
  ASSERT_TRUE(seat);
  EXPECT_FALSE((*seat)->active());
  manager.next = Manager::Event::enable;
  (*seat)->dispatch();
  EXPECT_TRUE((*seat)->active());
}

TEST_F(SeatManager, RefusalSaysWhy) {
  manager.refuse = EACCES;
  const auto seat = kiosk::open_libseat(calls, "seatd", 1000, log_);
  ASSERT_FALSE(seat);
  EXPECT_NE(seat.error().what.find("Permission denied"), std::string::npos);
  EXPECT_EQ(seat.error().field, "seatd");
}

TEST_F(SeatManager, SilentManagerIsLeftAndItsLateSeatClosed) {
  manager.answers_after_ms = 200;
  const auto seat = kiosk::open_libseat(calls, "seatd", 10, log_);
  ASSERT_FALSE(seat);
  EXPECT_NE(seat.error().what.find("no answer within 10 ms"), std::string::npos);
  EXPECT_EQ(manager.closed, 0);
  for (int k = 0; k < 500 && manager.closed == 0; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(manager.closed, 1);
}

TEST(SeatDirect, OpensWhatTheProcessMay) {
  Log log(nullptr);
  const auto seat = Seat::open("direct", log);
  ASSERT_TRUE(seat);
  EXPECT_EQ((*seat)->description(), "direct");
  EXPECT_TRUE((*seat)->active());
  EXPECT_FALSE((*seat)->holds_console());
  EXPECT_EQ((*seat)->fd(), -1);
  EXPECT_TRUE(said(log, "seat: direct"));
  const auto device = (*seat)->open_device("/dev/null");
  ASSERT_TRUE(device) << device.error().line();
  EXPECT_EQ(fcntl(*device, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  EXPECT_EQ(fcntl(*device, F_GETFL) & O_ACCMODE, O_RDWR);
  EXPECT_EQ(fcntl(*device, F_GETFL) & O_NONBLOCK, O_NONBLOCK);
  (*seat)->close_device(*device);
  EXPECT_TRUE(closed(*device));

  const auto missing = (*seat)->open_device("/dev/dri/card99");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().file, "/dev/dri/card99");
  EXPECT_NE(missing.error().remedy.find("plugged in"), std::string::npos);
}

TEST(SeatDirect, ForbiddenNodeNamesTheGroup) {
  if (geteuid() == 0) GTEST_SKIP() << "root may open everything";
  Log log(nullptr);
  const auto seat = Seat::open("direct", log);
  ASSERT_TRUE(seat);
  const auto device = (*seat)->open_device("/dev/mem");
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().remedy.find("group"), std::string::npos);
}

TEST(SeatDirect, UnknownWordIsAUsageError) {
  Log log(nullptr);
  const auto seat = Seat::open("weston", log);
  ASSERT_FALSE(seat);
  EXPECT_EQ(seat.error().kind, ErrorKind::usage);
  EXPECT_NE(seat.error().what.find("weston"), std::string::npos);
}

TEST(SeatDirect, AutoComesBackInTimeAndSaysWhatItBecame) {
  // Whatever this machine has. A socket nobody answers on, in the place of seatd's:
  const std::string socket = testing::TempDir() + "lackwerk_no_seatd.sock";
  {
    const int fd = open(socket.c_str(), O_CREAT | O_CLOEXEC | O_WRONLY, 0600);
    close(fd);
  }
  setenv("SEATD_SOCK", socket.c_str(), 1);
  Log log(nullptr);
  const auto seat = Seat::open("auto", log);
  unsetenv("SEATD_SOCK");
  unlink(socket.c_str());
  ASSERT_TRUE(seat) << seat.error().line();
  EXPECT_TRUE(said(log, "seat: " + (*seat)->description()));
}

}  // namespace
}  // namespace lackwerk::test
