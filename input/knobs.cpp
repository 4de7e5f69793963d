#include "input/knobs.hpp"

#include <utility>

#include "input/evdev_dials.hpp"
#include "input/hid_knobs.hpp"
#include "input/hidraw_bus.hpp"
#include "input/usb_bus.hpp"

namespace lackwerk::input {

std::vector<std::unique_ptr<Source>> open_knobs(const KnobSettings& settings, std::vector<Notice>& problems) {
  std::vector<std::unique_ptr<Source>> out;
  const auto problem = [&](const char* way, const Error& error) {
    problems.push_back({true, std::string("no knobs by ") + way + ": " + error.line()});
  };
  if (settings.hidraw) {
    if (auto bus = open_hidraw_bus(); bus)
      out.push_back(std::make_unique<HidKnobs>(std::move(*bus), settings));
    else
      problem("hidraw", bus.error());
  }
  if (settings.usb) {
    HidKnobsOptions options;
    options.settle_ms = usb_settle_ms;
    if (auto bus = open_usb_bus(); bus)
      out.push_back(std::make_unique<HidKnobs>(std::move(*bus), settings, std::move(options)));
    else
      problem("USB", bus.error());
  }
  if (settings.evdev) {
    if (auto bus = open_evdev_bus(); bus)
      out.push_back(std::make_unique<EvdevDials>(std::move(*bus), settings));
    else
      problem("input events", bus.error());
  }
  return out;
}

}  // namespace lackwerk::input
