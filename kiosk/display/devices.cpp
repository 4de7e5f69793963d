#include "kiosk/display/devices.hpp"

#include <cerrno>

#include "input/knobs.hpp"
#include "input/touch_libinput.hpp"

namespace lackwerk::kiosk {

Devices open_devices(const Config& config, Seat& seat, Log& log) {
  Devices devices;
  const input::DeviceAccess access{[&seat, &log](const std::string& path, int /*flags*/) {
                                     auto fd = seat.open_device(path);
                                     if (fd) return *fd;
                                     log.error(fd.error());
                                     return -EACCES;
                                   },
                                   [&seat](int fd) { seat.close_device(fd); }};
  auto feed = input::open_libinput(config.input_seat, access);
  if (feed) {
    auto touch = std::make_unique<input::TouchScreens>(std::move(*feed), config.touch);
    devices.touch = touch.get();
    devices.sources.push_back(std::move(touch));
  } else {
    log.error(feed.error());
  }
  std::vector<input::Notice> notices;
  for (auto& knobs : input::open_knobs(config.knobs, notices)) devices.sources.push_back(std::move(knobs));
  for (const input::Notice& notice : notices)
    log.write(notice.problem ? Priority::warning : Priority::info, notice.text);
  return devices;
}

}  // namespace lackwerk::kiosk
