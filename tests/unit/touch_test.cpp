// Touch screens over a feed in memory: every finger goes down once, moves, and ends once, whatever the devices do.
#include "input/touch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace lackwerk::input {
namespace {

using Kind = RawTouch::Kind;

/// The twin of libinput: what a test puts in comes out with the next read.
class MemoryFeed final : public TouchFeed {
 public:
  std::deque<RawTouch> events;
  std::map<int, CalibrationMatrix> calibrations;
  bool takes_calibration = true, resumes = true, suspended = false;

  void add_descriptors(std::vector<int>& out) const override { out.push_back(7); }
  void read(std::vector<RawTouch>& out) override {
    for (std::size_t k = 0; k < max_raw_a_read && !events.empty(); ++k) {
      out.push_back(std::move(events.front()));
      events.pop_front();
    }
  }
  [[nodiscard]] bool has_more() const override { return !events.empty(); }
  bool calibrate(int device, const CalibrationMatrix& matrix) override {
    calibrations[device] = matrix;
    return takes_calibration;
  }
  void suspend() override { suspended = true; }
  bool resume() override { return resumes; }
  void take_notices(std::vector<Notice>& /*out*/) override {}
};

TouchDevice screen(int id) {
  TouchDevice device;
  device.id = id;
  device.name = "Panel " + std::to_string(id);
  device.node = "event" + std::to_string(id);
  device.vendor = 0x222a;
  device.product = 0x0001;
  device.x = device.y = {0.0, 4095.0};
  device.slots = 10;
  return device;
}

class Touch : public testing::Test {
 protected:
  void start(std::vector<TouchSettings> settings = {}, const std::string& output = "") {
    auto feed = std::make_unique<MemoryFeed>();
    feed_ = feed.get();
    touch_ = std::make_unique<TouchScreens>(std::move(feed), std::move(settings), output);
  }
  void add(TouchDevice device) {
    RawTouch event;
    event.kind = Kind::added;
    event.device = device.id;
    event.added = std::move(device);
    feed_->events.push_back(std::move(event));
  }
  void put(Kind kind, int device, int slot = 0, double x = 0.0, double y = 0.0, std::uint64_t time_us = 1) {
    RawTouch event;
    event.kind = kind;
    event.device = device;
    event.slot = slot;
    event.x = x;
    event.y = y;
    event.time_us = time_us;
    feed_->events.push_back(std::move(event));
  }
  std::vector<Control> read() {
    std::vector<Control> out;
    touch_->read(0.0, out);
    return out;
  }
  std::vector<Notice> notices() {
    std::vector<Notice> out;
    touch_->take_notices(out);
    return out;
  }
  std::vector<DeviceStatus> devices() {
    std::vector<DeviceStatus> out;
    touch_->add_devices(out);
    return out;
  }

  std::unique_ptr<TouchScreens> touch_;
  MemoryFeed* feed_ = nullptr;
};

TEST_F(Touch, NoDeviceIsNormal) {
  start();
  EXPECT_TRUE(read().empty());
  EXPECT_TRUE(devices().empty());
  EXPECT_TRUE(notices().empty());
  EXPECT_EQ(touch_->wake_at_ms(), never_ms);
  std::vector<int> descriptors;
  touch_->add_descriptors(descriptors);
  EXPECT_EQ(descriptors, std::vector<int>{7});
}

TEST_F(Touch, AFingerGoesDownMovesAndEnds) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, 0.25, 0.5, 100);
  EXPECT_EQ(touch_->wake_at_ms(), 0.0);
  auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_down);
  EXPECT_EQ(out[0].values, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(out[0].contact, 0);
  EXPECT_EQ(out[0].time_us, 100u);
  put(Kind::move, 1, 0, 0.3, 0.6, 200);
  put(Kind::up, 1, 0, 0.0, 0.0, 300);
  out = read();
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_move);
  EXPECT_EQ(out[0].values, (std::vector<double>{0.3, 0.6}));
  EXPECT_EQ(out[1].kind, ControlKind::touch_up);
  EXPECT_EQ(out[1].time_us, 300u);
  ASSERT_EQ(devices().size(), 1u);
  EXPECT_EQ(devices()[0].kind, "touch");
  EXPECT_EQ(devices()[0].state, "ready");
  EXPECT_EQ(devices()[0].heard, 3u) << "down, move, up";
}

TEST_F(Touch, ContactsAreUniqueOverDevices) {
  start();
  add(screen(1));
  add(screen(2));
  put(Kind::down, 1, 0, 0.1, 0.1);
  put(Kind::down, 2, 0, 0.2, 0.2);
  put(Kind::down, 1, 1, 0.3, 0.3);
  const auto out = read();
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ((std::set<int>{out[0].contact, out[1].contact, out[2].contact}), (std::set<int>{0, 1, 2}));
  put(Kind::up, 2, 0);
  put(Kind::down, 2, 5, 0.4, 0.4);
  const auto more = read();
  ASSERT_EQ(more.size(), 2u);
  EXPECT_EQ(more[1].contact, out[1].contact) << "numbers are used again";
}

TEST_F(Touch, MovesMergeButNeverAcrossOtherEvents) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, 0.1, 0.1);
  put(Kind::down, 1, 1, 0.9, 0.9);
  EXPECT_EQ(read().size(), 2u);
  for (int k = 1; k <= 50; ++k) {
    put(Kind::move, 1, 0, 0.1 + 0.001 * k, 0.1, static_cast<std::uint64_t>(k));
    put(Kind::move, 1, 1, 0.9 - 0.001 * k, 0.9, static_cast<std::uint64_t>(k));
  }
  put(Kind::up, 1, 1);
  put(Kind::move, 1, 0, 0.5, 0.5, 99);
  put(Kind::move, 1, 0, 0.6, 0.6, 100);
  const auto out = read();
  ASSERT_EQ(out.size(), 4u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_move);
  EXPECT_EQ(out[0].contact, 0);
  EXPECT_DOUBLE_EQ(out[0].values[0], 0.15);
  EXPECT_EQ(out[0].time_us, 50u);
  EXPECT_EQ(out[1].contact, 1);
  EXPECT_DOUBLE_EQ(out[1].values[0], 0.85);
  EXPECT_EQ(out[2].kind, ControlKind::touch_up);
  EXPECT_EQ(out[3].kind, ControlKind::touch_move);
  EXPECT_EQ(out[3].values, (std::vector<double>{0.6, 0.6}));
}

TEST_F(Touch, TenThousandEventsASecondBecomeOneMoveAFrame) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, 0.0, 0.0);
  EXPECT_EQ(read().size(), 1u);
  int sent = 0;
  for (int frame = 0; frame < 60; ++frame) {
    for (; sent < 10'000 * (frame + 1) / 60; ++sent) put(Kind::move, 1, 0, sent / 10'000.0, 0.5);
    const auto out = read();
    ASSERT_EQ(out.size(), 1u);
    EXPECT_DOUBLE_EQ(out[0].values[0], (sent - 1) / 10'000.0);
    EXPECT_EQ(touch_->wake_at_ms(), never_ms);
  }
  EXPECT_EQ(sent, 10'000);
  EXPECT_EQ(devices()[0].heard, 10'001u) << "merged, but heard";
}

TEST_F(Touch, RemovalCancelsWhatIsHeldAndOnlyThat) {
  start();
  add(screen(1));
  add(screen(2));
  put(Kind::down, 1, 0, 0.1, 0.1);
  put(Kind::down, 2, 0, 0.2, 0.2);
  put(Kind::down, 2, 1, 0.3, 0.3);
  EXPECT_EQ(read().size(), 3u);
  // libinput lifts a pointer's button itself before it says that the device is gone: nobody let go.
  put(Kind::up, 2, 0);
  put(Kind::removed, 2);
  const auto out = read();
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_cancel);
  EXPECT_EQ(out[1].kind, ControlKind::touch_cancel);
  EXPECT_EQ((std::set<int>{out[0].contact, out[1].contact}), (std::set<int>{1, 2}));
  EXPECT_EQ(devices().size(), 1u);
  put(Kind::move, 2, 0, 0.5, 0.5);  // a late word of the dead
  put(Kind::move, 1, 0, 0.5, 0.5);
  EXPECT_EQ(read().size(), 1u);
}

TEST_F(Touch, AThousandReplugsLeaveNothingBehind) {
  start();
  int cancelled = 0;
  for (int id = 1; id <= 1000; ++id) {
    add(screen(id));
    put(Kind::down, id, 0, 0.5, 0.5);
    put(Kind::removed, id);
    for (const Control& control : read()) {
      EXPECT_EQ(control.contact, 0);
      cancelled += control.kind == ControlKind::touch_cancel ? 1 : 0;
    }
  }
  EXPECT_EQ(cancelled, 1000);
  EXPECT_TRUE(devices().empty());
  EXPECT_LE(notices().size(), 64u);
}

TEST_F(Touch, ALostSeatCancels) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, 0.1, 0.1);
  EXPECT_EQ(read().size(), 1u);
  touch_->suspend();
  EXPECT_TRUE(feed_->suspended);
  EXPECT_EQ(touch_->wake_at_ms(), 0.0) << "the cancel is to be fetched";
  const auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_cancel);
  feed_->resumes = false;
  notices();
  touch_->resume();
  const auto said = notices();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].problem);
}

TEST_F(Touch, APointerIsAFingerWhileItsButtonIsHeld) {
  start();
  TouchDevice tablet = screen(1);
  tablet.kind = TouchKind::pointer;
  add(tablet);
  put(Kind::point, 1, 0, 0.2, 0.3);
  EXPECT_TRUE(read().empty());
  put(Kind::press, 1);
  put(Kind::point, 1, 0, 0.4, 0.5);
  put(Kind::release, 1);
  put(Kind::point, 1, 0, 0.6, 0.7);
  const auto out = read();
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_down);
  EXPECT_EQ(out[0].values, (std::vector<double>{0.2, 0.3}));
  EXPECT_EQ(out[1].values, (std::vector<double>{0.4, 0.5}));
  EXPECT_EQ(out[2].kind, ControlKind::touch_up);
}

TEST_F(Touch, AMouseBeginsInTheMiddleEachTime) {
  start();
  TouchDevice mouse = screen(1);
  mouse.kind = TouchKind::mouse;
  mouse.x = mouse.y = {};
  add(mouse);
  for (int press = 0; press < 2; ++press) {
    put(Kind::nudge, 1, 0, 5000.0, 0.0);
    put(Kind::press, 1);
    put(Kind::nudge, 1, 0, 100.0, -50.0);
    put(Kind::release, 1);
    const auto out = read();
    ASSERT_EQ(out.size(), 3u);
    EXPECT_EQ(out[0].values, (std::vector<double>{0.5, 0.5}));
    EXPECT_EQ(out[1].values, (std::vector<double>{0.6, 0.45}));
  }
}

TEST_F(Touch, OnAnotherOutputItIsIgnoredAndThatIsSaid) {
  start({{"Panel 2", "HDMI-A-2", {}}}, "HDMI-A-1");
  TouchDevice by_udev = screen(1);
  by_udev.output = "DP-1";
  add(by_udev);
  add(screen(2));
  add(screen(3));
  for (const int id : {1, 2, 3}) put(Kind::down, id, 0, 0.5, 0.5);
  EXPECT_EQ(read().size(), 1u);
  auto said = notices();
  ASSERT_EQ(said.size(), 3u);
  EXPECT_NE(said[0].text.find("bound to DP-1"), std::string::npos) << said[0].text;
  EXPECT_NE(said[1].text.find("bound to HDMI-A-2"), std::string::npos) << said[1].text;
  EXPECT_FALSE(said[0].problem);
  EXPECT_EQ(devices()[0].state, "refused");
  EXPECT_EQ(devices()[0].heard, 0u) << "of another screen nothing counts";
  EXPECT_EQ(devices()[2].state, "ready");
  EXPECT_EQ(devices()[2].heard, 1u);
  // The kiosk moves to the other output: that screen counts from now on, nothing is held by a stranger.
  touch_->set_output("HDMI-A-2");
  EXPECT_TRUE(read().empty());
  put(Kind::down, 2, 1, 0.5, 0.5);
  EXPECT_EQ(read().size(), 1u);
  touch_->set_output("HDMI-A-1");
  const auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::touch_cancel);
}

TEST_F(Touch, AbsurdDevicesAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const AxisRange range :
       {AxisRange{0, 0}, AxisRange{10, -10}, AxisRange{nan, 1}, AxisRange{0, nan}, AxisRange{-infinity, infinity}}) {
    TouchDevice device = screen(1);
    device.y = range;
    EXPECT_TRUE(refusal_of(device));
    start();
    add(device);
    put(Kind::down, 1, 0, 0.5, 0.5);
    EXPECT_TRUE(read().empty());
    ASSERT_EQ(devices().size(), 1u);
    EXPECT_EQ(devices()[0].state, "refused");
    EXPECT_NE(devices()[0].detail.find("range"), std::string::npos);
    const auto said = notices();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(said[0].problem);
    // The next device on that node is judged anew.
    TouchDevice better = screen(2);
    better.node = device.node;
    add(better);
    EXPECT_TRUE(read().empty());
    ASSERT_EQ(devices().size(), 1u);
    EXPECT_EQ(devices()[0].state, "ready");
    EXPECT_EQ(devices()[0].heard, 0u) << "nor does it inherit";
  }
  for (const int slots : {-1, 0, max_slots + 1}) {
    TouchDevice device = screen(1);
    device.slots = slots;
    EXPECT_TRUE(refusal_of(device)) << slots;
  }
  TouchDevice large = screen(1);
  large.slots = 40;
  EXPECT_FALSE(refusal_of(large)) << "large frames announce that many";
}

TEST_F(Touch, OfManyFingersTenCount) {
  start();
  add(screen(1));
  for (int slot = 0; slot < 40; ++slot) put(Kind::down, 1, slot, 0.5, 0.5);
  EXPECT_EQ(read().size(), static_cast<std::size_t>(max_fingers));
  EXPECT_EQ(notices().size(), 2u) << "ready, and once that others are ignored";
  put(Kind::move, 1, 30, 0.6, 0.6);
  put(Kind::up, 1, 30);
  EXPECT_TRUE(read().empty());
}

TEST_F(Touch, PositionsAreCleaned) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, std::numeric_limits<double>::quiet_NaN(), 0.5);
  EXPECT_TRUE(read().empty());
  put(Kind::down, 1, 0, -3.0, 17.0);
  put(Kind::move, 1, 0, 0.5, std::numeric_limits<double>::infinity());
  const auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].values, (std::vector<double>{0.0, 1.0}));
}

TEST_F(Touch, DownTwiceCancelsTheFirst) {
  start();
  add(screen(1));
  put(Kind::down, 1, 0, 0.1, 0.1);
  put(Kind::down, 1, 0, 0.9, 0.9);
  const auto out = read();
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ(out[1].kind, ControlKind::touch_cancel);
  EXPECT_EQ(out[1].contact, out[0].contact);
  EXPECT_EQ(out[2].kind, ControlKind::touch_down);
}

TEST_F(Touch, CalibrationGoesToTheDeviceThatIsMeant) {
  const CalibrationMatrix turned{0, -1, 1, 1, 0, 0};
  start({{"222A:0001", "", turned}, {"", "", {}}});
  add(screen(1));
  TouchDevice other = screen(2);
  other.product = 2;
  add(other);
  read();
  ASSERT_EQ(feed_->calibrations.size(), 1u);
  EXPECT_EQ(feed_->calibrations[1], turned);
  notices();
  feed_->takes_calibration = false;
  add(screen(3));
  read();
  const auto said = notices();
  ASSERT_EQ(said.size(), 2u);
  EXPECT_TRUE(said[0].problem);
  EXPECT_FALSE(is_usable({1, 0, 0, 1, 0, 0})) << "everything on one line";
  EXPECT_FALSE(is_usable({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 1, 0}));
  EXPECT_TRUE(is_usable(turned));
}

TEST_F(Touch, SettingsMatchByIdsOrPartOfTheName) {
  const std::vector<TouchSettings> settings{{"ilitek", "a", {}}, {"222a:0001", "b", {}}};
  TouchDevice device = screen(1);
  ASSERT_NE(find_settings(settings, device), nullptr);
  EXPECT_EQ(find_settings(settings, device)->output, "b");
  device.name = "ILITEK ILITEK-TP";
  EXPECT_EQ(find_settings(settings, device)->output, "a");
  device.name = "x";
  device.vendor = 0;
  EXPECT_EQ(find_settings(settings, device), nullptr);
}

TEST_F(Touch, AFloodOfTouchesIsBoundedAndItsDeviceRefused) {
  start();
  add(screen(1));
  add(screen(2));
  put(Kind::down, 2, 0, 0.5, 0.5);
  std::size_t most = 0, handed = 0;
  for (int frame = 0; frame < 20; ++frame) {
    for (int k = 0; k < 4000; ++k) {
      put(Kind::down, 1, 0, 0.5, 0.5);
      put(Kind::up, 1, 0);
    }
    const auto out = read();
    most = std::max(most, out.size());
    handed += out.size();
  }
  EXPECT_LE(most, max_controls_a_read);
  EXPECT_LE(handed, 6 * max_controls_a_read);
  EXPECT_EQ(devices()[0].state, "refused");
  EXPECT_EQ(devices()[1].state, "ready") << "the other one goes on";
  while (!read().empty() || touch_->wake_at_ms() == 0.0) {
  }
  put(Kind::move, 2, 0, 0.6, 0.6);
  EXPECT_EQ(read().size(), 1u);
}

TEST_F(Touch, NamesAreCleaned) {
  EXPECT_EQ(clean_name("a\nb\x1b[2J"), "a?b?[2J");
  EXPECT_EQ(clean_name(std::string(500, 'x')).size(), 80u);
}

// Any events in any order: what comes out is always well formed.
TEST_F(Touch, ARandomStormKeepsItsPromises) {
  std::mt19937 random(7);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int run = 0; run < 20; ++run) {
    start({{"Panel 3", "HDMI-A-2", {}}}, "HDMI-A-1");
    std::set<int> held;
    for (int round = 0; round < 200; ++round) {
      for (int k = pick(60); k > 0; --k) {
        const int id = 1 + pick(4);
        const int what = pick(100);
        if (what < 3)
          add(screen(id));
        else if (what < 5)
          put(Kind::removed, id);
        else
          put(static_cast<Kind>(2 + pick(8)), id, pick(12), pick(300) / 100.0 - 1.0, pick(300) / 100.0 - 1.0);
      }
      if (pick(50) == 0) touch_->set_output(pick(2) == 0 ? "HDMI-A-1" : "HDMI-A-2");
      if (pick(50) == 0) touch_->suspend();
      const auto out = read();
      ASSERT_LE(out.size(), max_controls_a_read);
      for (const Control& control : out) {
        if (control.kind == ControlKind::touch_down) {
          ASSERT_TRUE(held.insert(control.contact).second) << "down twice";
        } else if (control.kind == ControlKind::touch_move) {
          ASSERT_TRUE(held.contains(control.contact)) << "moved while not down";
        } else {
          ASSERT_EQ(held.erase(control.contact), 1u) << "ended while not down";
        }
        for (const double value : control.values) ASSERT_TRUE(value >= 0.0 && value <= 1.0);
      }
    }
    for (int id = 1; id <= 4; ++id) put(Kind::removed, id);
    while (touch_->wake_at_ms() == 0.0)
      for (const Control& control : read())
        if (control.kind != ControlKind::touch_down && control.kind != ControlKind::touch_move)
          held.erase(control.contact);
        else
          held.insert(control.contact);
    EXPECT_TRUE(held.empty()) << "everything ends";
  }
}

}  // namespace
}  // namespace lackwerk::input
