// Dials as input events: recorded streams through pipes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <map>

#include "input/evdev_dials.hpp"

namespace lackwerk::input {
namespace {

/// The twin: each device is the reading end of a pipe.
class PipeBus : public EvdevBus {
 public:
  ~PipeBus() override {
    for (const auto& [system, pipe] : pipes_) ::close(pipe.write);
  }

  void plug(const std::string& system, const EvdevInfo& info, int fails = 0) {
    infos_[system] = info;
    fails_[system] = fails;
    DeviceEvent event;
    event.system = system;
    event.node = "/dev/input/event" + std::to_string(infos_.size());
    monitor_.add(event);
  }

  void unplug(const std::string& system) {
    cut(system);
    monitor_.remove(system);
  }

  /// The device stops answering; udev has not said so yet.
  void cut(const std::string& system) {
    if (pipes_.count(system) == 0) return;
    ::close(pipes_[system].write);
    pipes_.erase(system);
  }

  void send(const std::string& system, const std::vector<input_event>& events) {
    ASSERT_EQ(pipes_.count(system), 1u) << "nobody has it open";
    const auto bytes = static_cast<ssize_t>(events.size() * sizeof(input_event));
    ASSERT_EQ(::write(pipes_[system].write, events.data(), static_cast<std::size_t>(bytes)), bytes);
  }

  [[nodiscard]] DeviceMonitor& monitor() override { return monitor_; }
  [[nodiscard]] const DeviceMonitor& monitor() const override { return monitor_; }
  [[nodiscard]] EvdevInfo describe(const DeviceEvent& device) override { return infos_[device.system]; }

  [[nodiscard]] tl::expected<int, HidFault> open(const DeviceEvent& device) override {
    if (fails_[device.system]-- > 0)
      return tl::unexpected<HidFault>({false, "permission denied", "join the group input"});
    int ends[2] = {};
    if (pipe2(ends, O_NONBLOCK | O_CLOEXEC) != 0) return tl::unexpected<HidFault>({true, "no pipe", ""});
    cut(device.system);
    pipes_[device.system] = {ends[1]};
    return ends[0];
  }

  [[nodiscard]] std::optional<EvdevKeys> held(int) override { return held_; }

  std::optional<EvdevKeys> held_;

 private:
  struct Pipe {
    int write = -1;
  };
  MemoryDeviceMonitor monitor_;
  std::map<std::string, EvdevInfo> infos_;
  std::map<std::string, int> fails_;
  std::map<std::string, Pipe> pipes_;
};

input_event event(unsigned type, unsigned code, int value, std::uint64_t time_us = 5'000'000) {
  input_event out{};
  out.input_event_sec = static_cast<decltype(out.input_event_sec)>(time_us / 1'000'000);
  out.input_event_usec = static_cast<decltype(out.input_event_usec)>(time_us % 1'000'000);
  out.type = static_cast<std::uint16_t>(type);
  out.code = static_cast<std::uint16_t>(code);
  out.value = value;
  return out;
}

input_event syn(std::uint64_t time_us = 5'000'000) { return event(EV_SYN, SYN_REPORT, 0, time_us); }

/// As the kernel's driver describes it (drivers/input/misc/powermate.c).
EvdevInfo powermate() {
  EvdevInfo info;
  info.name = "Griffin PowerMate";
  info.vendor = 0x077d;
  info.product = 0x0410;
  info.relative.set(REL_DIAL);
  info.keys.set(BTN_0);
  return info;
}

EvdevInfo encoder() {
  EvdevInfo info;
  info.name = "rotary@0";
  info.relative.set(REL_WHEEL);
  info.keys.set(KEY_ENTER);
  return info;
}

class DialTest : public testing::Test {
 protected:
  DialTest() {
    auto bus = std::make_unique<PipeBus>();
    bus_ = bus.get();
    KnobSettings settings;
    settings.tuning.acceleration = 0.0;
    dials_ = std::make_unique<EvdevDials>(std::move(bus), settings);
  }

  std::vector<Control> read(double now_ms = 6000.0) {
    std::vector<Control> out;
    dials_->read(now_ms, out);
    return out;
  }

  [[nodiscard]] std::string states() const {
    std::vector<DeviceStatus> devices;
    dials_->add_devices(devices);
    std::string out;
    for (const auto& device : devices) out += device.name + " " + device.state + ";";
    return out;
  }

  PipeBus* bus_ = nullptr;  ///< belongs to dials_
  std::unique_ptr<EvdevDials> dials_;
};

TEST_F(DialTest, PowerMateTurnsAndPresses) {
  bus_->plug("a", powermate());
  EXPECT_EQ(dials_->wake_at_ms(), 0.0) << "the first look is due";
  EXPECT_TRUE(read().empty());
  EXPECT_EQ(states(), "Griffin PowerMate ready;");
  bus_->send("a", {event(EV_REL, REL_DIAL, 40), syn(4'000'000), event(EV_REL, REL_DIAL, 7), syn(),
                   event(EV_KEY, BTN_0, 1), event(EV_MSC, MSC_PULSELED, 3), syn(), event(EV_KEY, BTN_0, 2), syn(),
                   event(EV_KEY, BTN_0, 0), event(EV_REL, REL_DIAL, -47), syn()});
  const auto out = read();
  ASSERT_EQ(out.size(), 4u);
  EXPECT_NEAR(out[0].values.at(0), 12.0, 1e-9) << "half of 94 counts";
  EXPECT_EQ(out[0].time_us, 4'000'000u);
  EXPECT_EQ(out[1].kind, ControlKind::press);
  EXPECT_NEAR(out[2].values.at(0), -12.0, 1e-9);
  EXPECT_EQ(out[3].kind, ControlKind::release);
  EXPECT_EQ(out[0].name, "Griffin PowerMate");
}

TEST_F(DialTest, AHalfFrameWaitsForItsEnd) {
  bus_->plug("a", encoder());
  read();
  bus_->send("a", {event(EV_REL, REL_WHEEL, 1)});
  EXPECT_TRUE(read().empty());
  bus_->send("a", {event(EV_REL, REL_WHEEL, 1), syn()});
  const auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].values.at(0), 2.0, 1e-12);
}

TEST_F(DialTest, FineWheelsAreNotCountedTwice) {
  auto info = encoder();
  info.relative.set(REL_WHEEL_HI_RES);
  bus_->plug("a", info);
  read();
  bus_->send("a", {event(EV_REL, REL_WHEEL_HI_RES, 60), syn(), event(EV_REL, REL_WHEEL, 1),
                   event(EV_REL, REL_WHEEL_HI_RES, 60), syn()});
  const auto out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].values.at(0), 1.0, 1e-12);
}

TEST_F(DialTest, AfterLostEventsTheHeldKeysAreAskedFor) {
  bus_->plug("a", powermate());
  read();
  bus_->send("a", {event(EV_KEY, BTN_0, 1), syn()});
  EXPECT_EQ(read().size(), 1u);
  // The kernel's buffer ran over: this frame is worthless, and the button was let go in between.
  bus_->held_ = EvdevKeys{};
  bus_->send("a", {event(EV_REL, REL_DIAL, 10), event(EV_SYN, SYN_DROPPED, 0), event(EV_REL, REL_DIAL, 50),
                   event(EV_KEY, BTN_0, 1), syn(), event(EV_REL, REL_DIAL, 47), syn()});
  auto out = read();
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].kind, ControlKind::release);
  EXPECT_NEAR(out[1].values.at(0), 12.0, 1e-9);
  // Held, and the press itself was lost.
  bus_->held_->set(BTN_0);
  bus_->send("a", {event(EV_SYN, SYN_DROPPED, 0), syn()});
  out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::press);
  // Cannot be asked: nothing is held for ever.
  bus_->held_.reset();
  bus_->send("a", {event(EV_SYN, SYN_DROPPED, 0), syn()});
  out = read();
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].kind, ControlKind::release);
}

TEST_F(DialTest, UnpluggingReleasesAndPluggingComesBack) {
  bus_->plug("a", powermate());
  read();
  for (int time = 0; time < 1000; ++time) {
    bus_->send("a", {event(EV_KEY, BTN_0, 1), event(EV_REL, REL_DIAL, 1), syn()});
    EXPECT_EQ(read().size(), 2u);
    bus_->unplug("a");
    const auto out = read();
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].kind, ControlKind::release);
    EXPECT_EQ(states(), "");
    bus_->plug("a", powermate());
    read();
    ASSERT_EQ(states(), "Griffin PowerMate ready;");
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++files;
  EXPECT_LT(files, 100u) << "a thousand replugs leave no descriptor behind";
}

TEST_F(DialTest, ADeviceThatStopsAnsweringIsTriedAgain) {
  bus_->plug("a", powermate());
  read(1000.0);
  bus_->send("a", {event(EV_KEY, BTN_0, 1, 900'000), syn(900'000)});
  EXPECT_EQ(read(1000.0).size(), 1u);
  bus_->cut("a");
  EXPECT_EQ(read(1001.0).size(), 1u) << "released";
  EXPECT_EQ(states(), "Griffin PowerMate waiting;");
  EXPECT_EQ(dials_->wake_at_ms(), 1051.0);
  read(1060.0);
  EXPECT_EQ(states(), "Griffin PowerMate ready;");
}

TEST_F(DialTest, PermissionsAreWaitedForWithGrowingPauses) {
  bus_->plug("a", encoder(), 4);
  double now_ms = 0.0;
  std::vector<double> pauses;
  for (int k = 0; k < 10 && states() != "rotary@0 ready;"; ++k) {
    read(now_ms);
    if (dials_->wake_at_ms() == never_ms) break;
    pauses.push_back(dials_->wake_at_ms() - now_ms);
    now_ms = dials_->wake_at_ms();
  }
  EXPECT_EQ(pauses, (std::vector<double>{50.0, 100.0, 200.0, 400.0}));
  EXPECT_EQ(states(), "rotary@0 ready;");
  std::vector<Notice> lines;
  dials_->take_notices(lines);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].problem);
  EXPECT_NE(lines[0].text.find("join the group input"), std::string::npos);
}

TEST_F(DialTest, LostEventsMakeANewList) {
  bus_->plug("a", powermate());
  read();
  // The plugging of b and the pulling of a were lost; only that something was is known.
  auto& monitor = dynamic_cast<MemoryDeviceMonitor&>(bus_->monitor());
  bus_->plug("b", encoder());
  bus_->unplug("a");
  std::vector<DeviceEvent> unseen;
  monitor.read(unseen);
  read();
  EXPECT_EQ(states().find("rotary"), std::string::npos);
  DeviceEvent lost;
  lost.action = DeviceEvent::Action::lost;
  monitor.tell(lost);
  read();
  EXPECT_EQ(states(), "rotary@0 ready;");
}

TEST_F(DialTest, TenThousandEventsAreFewControls) {
  bus_->plug("a", encoder());
  read();
  double sum = 0.0;
  for (int burst = 0; burst < 100; ++burst) {
    std::vector<input_event> events;
    for (int k = 0; k < 50; ++k) {
      events.push_back(event(EV_REL, REL_WHEEL, 1));
      events.push_back(syn());
    }
    bus_->send("a", events);
    const auto out = read();
    EXPECT_EQ(out.size(), 1u);
    for (const auto& control : out) sum += control.values.at(0);
  }
  EXPECT_NEAR(sum, 5000.0, 1e-6);
}

TEST_F(DialTest, OnlyDialsAreOpened) {
  auto mouse = encoder();
  mouse.name = "mouse";
  mouse.relative.set(REL_X);
  mouse.relative.set(REL_Y);
  mouse.keys.set(BTN_LEFT);
  auto keyboard = encoder();
  keyboard.name = "keyboard";
  keyboard.keys.set(KEY_A);
  keyboard.keys.set(KEY_Z);
  auto raw = encoder();
  raw.name = "has hidraw";
  raw.has_hidraw = true;
  EvdevInfo touch;
  touch.keys.set(BTN_TOUCH);
  bus_->plug("m", mouse);
  bus_->plug("k", keyboard);
  bus_->plug("h", raw);
  bus_->plug("t", touch);
  bus_->plug("e", encoder());
  read();
  EXPECT_EQ(states(), "rotary@0 ready;");
  KnobTuning forced;
  forced.profile = KnobProfile::generic;
  EXPECT_EQ(not_a_dial(mouse, forced), "");
  EXPECT_EQ(not_a_dial(touch, forced), "nothing on it turns");
  EXPECT_EQ(not_a_dial(mouse, {}), "it is a mouse");
}

}  // namespace
}  // namespace lackwerk::input
