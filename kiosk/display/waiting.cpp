#include "kiosk/display/waiting.hpp"

#include <poll.h>

#include <algorithm>

#include "kiosk/display/log.hpp"

namespace lackwerk::kiosk {

HeldSignals::HeldSignals() {
  sigset_t held;
  sigemptyset(&held);
  sigaddset(&held, SIGTERM);
  sigaddset(&held, SIGINT);
  pthread_sigmask(SIG_BLOCK, &held, &before_);
}

HeldSignals::~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

void wait(const std::vector<int>& descriptors, double until_ms, const sigset_t* mask) {
  std::vector<pollfd> polled;
  polled.reserve(descriptors.size());
  for (const int fd : descriptors) polled.push_back({fd, POLLIN, 0});
  // A day is long enough to look again, and fits every clock.
  constexpr double day_ms = 86'400'000.0;
  const double left_ms = std::clamp(until_ms - monotonic_ms(), 0.0, day_ms);
  timespec timeout{};
  timeout.tv_sec = static_cast<time_t>(left_ms / 1000.0);
  timeout.tv_nsec = static_cast<long>((left_ms - static_cast<double>(timeout.tv_sec) * 1000.0) * 1e6);
  ppoll(polled.data(), polled.size(), &timeout, mask);
}

}  // namespace lackwerk::kiosk
