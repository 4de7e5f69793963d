// What udev tells, and the twin that stands in for it.
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>

#include "input/device_text.hpp"
#include "input/udev_monitor.hpp"

namespace lackwerk::input {
namespace {

bool readable(int descriptor) {
  pollfd polled{descriptor, POLLIN, 0};
  return poll(&polled, 1, 0) == 1;
}

DeviceEvent device(const std::string& system) {
  DeviceEvent out;
  out.system = system;
  out.subsystem = "hidraw";
  return out;
}

TEST(DeviceMonitor, TheTwinListsAndTells) {
  MemoryDeviceMonitor monitor;
  EXPECT_FALSE(readable(monitor.descriptor()));
  monitor.add(device("a"));
  monitor.add(device("b"));
  monitor.remove("a");
  monitor.remove("no such device");
  ASSERT_TRUE(readable(monitor.descriptor()));
  ASSERT_EQ(monitor.list().size(), 1u);
  EXPECT_EQ(monitor.list()[0].system, "b");
  EXPECT_EQ(monitor.list()[0].action, DeviceEvent::Action::present);
  std::vector<DeviceEvent> events;
  monitor.read(events);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[1].action, DeviceEvent::Action::added);
  EXPECT_EQ(events[2].action, DeviceEvent::Action::removed);
  EXPECT_EQ(events[2].system, "a");
  EXPECT_FALSE(readable(monitor.descriptor()));
}

TEST(DeviceMonitor, ReadsAreBounded) {
  MemoryDeviceMonitor monitor;
  for (int k = 0; k < 100; ++k) monitor.tell(device("x"));
  std::vector<DeviceEvent> events;
  monitor.read(events);
  EXPECT_EQ(events.size(), max_device_events);
  EXPECT_TRUE(readable(monitor.descriptor())) << "more is waiting";
  monitor.read(events);
  EXPECT_EQ(events.size(), 100u);
  EXPECT_FALSE(readable(monitor.descriptor()));
}

TEST(UdevMonitor, ListsWhatSysHas) {
  auto monitor = watch_devices({"mem"}, {"DEVNAME"});
  if (!monitor) GTEST_SKIP() << monitor.error().line();
  EXPECT_GE((*monitor)->descriptor(), 0);
  std::vector<DeviceEvent> events;
  (*monitor)->read(events);  // does not wait
  const auto devices = (*monitor)->list();
  if (devices.empty()) GTEST_SKIP() << "this /sys lists no memory devices";
  const auto null = std::find_if(devices.begin(), devices.end(), [](const auto& d) { return d.node == "/dev/null"; });
  ASSERT_NE(null, devices.end());
  EXPECT_EQ(null->subsystem, "mem");
  EXPECT_EQ(null->action, DeviceEvent::Action::present);
  EXPECT_EQ(null->properties.at("DEVNAME"), "/dev/null");
  EXPECT_NE(null->system.find("/sys/"), std::string::npos);
}

TEST(DeviceText, NamesAreMadeFit) {
  EXPECT_EQ(printable(" Surface Dial \n"), "Surface Dial");
  EXPECT_EQ(printable(""), "unnamed");
  EXPECT_EQ(printable("\t \n"), "unnamed");
  EXPECT_EQ(printable("a\x1b[31mb"), "a?[31mb");
  EXPECT_EQ(printable("Dreh\xc3\xa4\x72gler"), "Dreh\xc3\xa4rgler");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "??31m")
      << "a C1 control character";
  EXPECT_EQ(printable("\xff\xc0\x80\xed\xa0\x80"), "??????");
  EXPECT_EQ(printable("cut \xe2\x82"), "cut ??");
  EXPECT_EQ(printable(std::string(300, 'x')).size(), 80u);
}

TEST(Notices, AreMergedAndBounded) {
  Notices notices;
  for (int k = 0; k < 1000; ++k) notices.add(true, "the same");
  for (int k = 0; k < 1000; ++k) notices.add(false, "line " + std::to_string(k));
  std::vector<Notice> out;
  notices.take(out);
  ASSERT_EQ(out.size(), 33u);
  EXPECT_EQ(out[0].text, "the same");
  EXPECT_EQ(out.back().text, "969 more lines about input devices were left out");
  out.clear();
  notices.take(out);
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace lackwerk::input
