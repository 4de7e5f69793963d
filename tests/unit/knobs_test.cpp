// All ways at once, against whatever this machine has: each opens or says why not, and none waits or throws.
#include "input/knobs.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <set>

namespace lackwerk::input {
namespace {

TEST(Knobs, EveryWayOpensOrSaysWhyNot) {
  std::vector<Notice> problems;
  const auto sources = open_knobs({}, problems);
  EXPECT_EQ(sources.size() + problems.size(), 3u);
  for (const auto& problem : problems) {
    EXPECT_TRUE(problem.problem);
    EXPECT_NE(problem.text.find("no knobs by "), std::string::npos) << problem.text;
  }
  std::set<int> seen;
  for (const auto& source : sources) {
    std::vector<Control> controls;
    source->read(0.0, controls);
    source->read(1.0, controls);
    std::vector<int> descriptors;
    source->add_descriptors(descriptors);
    EXPECT_FALSE(descriptors.empty());
    for (const int descriptor : descriptors) {
      EXPECT_TRUE(seen.insert(descriptor).second) << "each source has its own";
      pollfd polled{descriptor, POLLIN, 0};
      EXPECT_GE(poll(&polled, 1, 0), 0);
      EXPECT_EQ(polled.revents & POLLNVAL, 0);
    }
    std::vector<DeviceStatus> devices;
    source->add_devices(devices);
    for (const auto& device : devices) EXPECT_FALSE(device.name.empty());
  }
}

TEST(Knobs, NoWayIsFineToo) {
  KnobSettings settings;
  settings.hidraw = settings.usb = settings.evdev = false;
  std::vector<Notice> problems;
  EXPECT_TRUE(open_knobs(settings, problems).empty());
  EXPECT_TRUE(problems.empty());
}

}  // namespace
}  // namespace lackwerk::input
