#include "kiosk/display/service.hpp"

#include <systemd/sd-daemon.h>

#include <cstdint>

#include "input/source.hpp"

namespace lackwerk::kiosk {

Service::Service() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) > 0) period_ms_ = static_cast<double>(period_us) * 1e-3;
}

void Service::ready(const std::string& status) {
  if (ready_) return say(status);
  ready_ = true;
  said_ = status;
  sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
}

void Service::say(const std::string& status) {
  if (status == said_) return;
  said_ = status;
  sd_notify(0, ("STATUS=" + status).c_str());
}

void Service::progress(double now_ms) {
  if (period_ms_ <= 0.0 || now_ms - last_ping_ms_ < 0.25 * period_ms_) return;
  last_ping_ms_ = now_ms;
  sd_notify(0, "WATCHDOG=1");
}

double Service::wake_at_ms() const {
  // A third of the period leaves room for one frame that takes long (systemd's advice is half of it).
  return period_ms_ > 0.0 ? last_ping_ms_ + period_ms_ / 3.0 : input::never_ms;
}

void Service::stopping() { sd_notify(0, "STOPPING=1\nSTATUS=stopping"); }

}  // namespace lackwerk::kiosk
