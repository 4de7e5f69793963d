// The service against a socket of our own in systemd's place.
#include "kiosk/display/service.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "input/source.hpp"

namespace lackwerk::kiosk {
namespace {

class Manager {
 public:
  explicit Manager(const char* watchdog_us) {
    path_ = "/tmp/lackwerk_notify_" + std::to_string(getpid());
    unlink(path_.c_str());
    fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    bound_ = bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    if (watchdog_us != nullptr) setenv("WATCHDOG_USEC", watchdog_us, 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(fd_);
    unlink(path_.c_str());
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  [[nodiscard]] bool bound() const { return bound_; }
  [[nodiscard]] std::vector<std::string> heard() const {
    std::vector<std::string> out;
    std::array<char, 512> text{};
    for (ssize_t n = 0; (n = recv(fd_, text.data(), text.size(), 0)) > 0;)
      out.emplace_back(text.data(), static_cast<std::size_t>(n));
    return out;
  }

 private:
  std::string path_;
  int fd_ = -1;
  bool bound_ = false;
};

TEST(Service, IsReadyOnceAndSaysWhatHasChanged) {
  const Manager manager(nullptr);
  ASSERT_TRUE(manager.bound());
  Service service;
  service.ready("waiting for a display");
  service.ready("showing demo.lwp");
  service.say("showing demo.lwp");
  service.stopping();
  const std::vector<std::string> expected = {"READY=1\nSTATUS=waiting for a display", "STATUS=showing demo.lwp",
                                             "STOPPING=1\nSTATUS=stopping"};
  EXPECT_EQ(manager.heard(), expected);
  EXPECT_EQ(service.wake_at_ms(), input::never_ms);
}

TEST(Service, TheWatchdogIsFedByProgressAndAsksToBeWokenInTime) {
  const Manager manager("2000000");
  ASSERT_TRUE(manager.bound());
  Service service;
  for (double now = 1000.0; now < 5000.0; now += 10.0) service.progress(now);
  EXPECT_EQ(manager.heard().size(), 8u) << "four a period";
  EXPECT_GT(service.wake_at_ms(), 4500.0);
  EXPECT_LT(service.wake_at_ms(), 5000.0 + 1000.0) << "sooner than half a period after the last ping";
}

}  // namespace
}  // namespace lackwerk::kiosk
