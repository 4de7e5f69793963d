// HID knobs on a bus in memory: threads, retries, unplugging, floods, and nothing left behind.
#include "input/hid_knobs.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "hid_samples.hpp"
#include "input/memory_hid_bus.hpp"

namespace lackwerk::input {
namespace {

using samples::Bytes;

/// Generous: the machine may be busy. Nothing is asserted about how long anything takes.
constexpr auto patience = std::chrono::seconds(20);

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t open_files() {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

std::size_t threads_of_process() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("Threads:", 0) == 0) return std::stoul(line.substr(8));
  return 0;
}

KnobSettings flat() {
  KnobSettings settings;
  settings.tuning.acceleration = 0.0;
  return settings;
}

class HidKnobsTest : public testing::Test {
 protected:
  void begin(const KnobSettings& settings = flat()) {
    auto bus = std::make_unique<MemoryHidBus>();
    bus_ = bus.get();
    HidKnobsOptions options;
    options.read_timeout_ms = 5;
    options.first_retry_ms = 1;
    options.longest_retry_ms = 4;
    knobs_ = std::make_unique<HidKnobs>(std::move(bus), settings, options);
  }

  /// Reads as the kiosk would until `done` holds; the controls are kept.
  template <class Done>
  [[nodiscard]] bool read_until(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      const std::size_t before = controls_.size();
      knobs_->read(now_ms(), controls_);
      EXPECT_LE(controls_.size() - before, max_controls_a_read);
      if (done()) return true;
      std::vector<int> descriptors;
      knobs_->add_descriptors(descriptors);
      std::vector<pollfd> polled;
      for (const int fd : descriptors) polled.push_back({fd, POLLIN, 0});
      if (knobs_->wake_at_ms() > now_ms()) poll(polled.data(), polled.size(), 2);
    }
    return false;
  }

  [[nodiscard]] std::string state(const std::string& name) const {
    std::vector<DeviceStatus> devices;
    knobs_->add_devices(devices);
    std::string out;
    for (const auto& device : devices)
      if (device.name == name) out += (out.empty() ? "" : "+") + device.state;
    return out;
  }

  [[nodiscard]] bool wait_for(const std::string& name, const std::string& wanted) {
    return read_until([&] { return state(name) == wanted; });
  }

  [[nodiscard]] double detents() const {
    double sum = 0.0;
    for (const auto& control : controls_)
      if (control.kind == ControlKind::turn) sum += control.values.at(0);
    return sum;
  }

  [[nodiscard]] int count(ControlKind kind) const {
    int out = 0;
    for (const auto& control : controls_) out += control.kind == kind ? 1 : 0;
    return out;
  }

  [[nodiscard]] std::string notices() {
    std::vector<Notice> lines;
    knobs_->take_notices(lines);
    std::string out;
    for (const auto& line : lines) out += line.text + "\n";
    return out;
  }

  MemoryHidBus* bus_ = nullptr;  ///< belongs to knobs_
  std::unique_ptr<HidKnobs> knobs_;
  std::vector<Control> controls_;
};

TEST_F(HidKnobsTest, NoDeviceIsANormalState) {
  begin();
  knobs_->read(now_ms(), controls_);
  EXPECT_TRUE(controls_.empty());
  EXPECT_EQ(knobs_->wake_at_ms(), never_ms);
  EXPECT_EQ(knobs_->threads(), 0u);
}

TEST_F(HidKnobsTest, APluggedKnobTurns) {
  begin();
  const auto key = bus_->plug("wheel\n", 0x1234, 1, samples::plain_wheel());
  ASSERT_TRUE(wait_for("wheel", "ready"));
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(bus_->send(key, {0x00, 0x03}));
  ASSERT_TRUE(read_until([&] { return detents() > 29.5; }));
  EXPECT_NEAR(detents(), 30.0, 1e-9);
  std::vector<DeviceStatus> devices;
  knobs_->add_devices(devices);
  ASSERT_EQ(devices.size(), 1u);
  EXPECT_EQ(devices[0].heard, controls_.size()) << "whoever installs it sees that it is heard";
  EXPECT_EQ(controls_[0].name, "wheel");
  EXPECT_GT(controls_[0].time_us, 0u);
  EXPECT_NE(notices().find("knob 'wheel'"), std::string::npos);
}

TEST_F(HidKnobsTest, APermissionThatComesLateIsWaitedFor) {
  begin();
  bus_->plug("late", 0x1234, 1, samples::plain_wheel(), 6);
  ASSERT_TRUE(wait_for("late", "waiting"));
  ASSERT_TRUE(wait_for("late", "ready"));
  const auto said = notices();
  EXPECT_NE(said.find("permission denied (check the udev rules)"), std::string::npos) << said;
}

TEST_F(HidKnobsTest, ARaceThatHealsAtOnceIsNotTold) {
  begin();
  bus_->plug("race", 0x1234, 1, samples::plain_wheel(), 2);
  ASSERT_TRUE(wait_for("race", "ready"));
  EXPECT_EQ(notices().find("permission"), std::string::npos);
}

TEST_F(HidKnobsTest, UnpluggedInTheMiddleOfATurnReleasesWhatIsHeld) {
  begin();
  const auto key = bus_->plug("wheel", 0x1234, 1, samples::plain_wheel());
  ASSERT_TRUE(wait_for("wheel", "ready"));
  ASSERT_TRUE(bus_->send(key, {0x01, 0x02}));
  ASSERT_TRUE(read_until([&] { return count(ControlKind::press) == 1; }));
  bus_->unplug(key);
  ASSERT_TRUE(wait_for("wheel", "gone"));
  EXPECT_EQ(count(ControlKind::release), 1);
  EXPECT_NEAR(detents(), 2.0, 1e-9);
  ASSERT_TRUE(read_until([&] { return knobs_->threads() == 0; }));
  // And back: it takes its own place again.
  bus_->plug("wheel", 0x1234, 1, samples::plain_wheel());
  ASSERT_TRUE(wait_for("wheel", "ready"));
}

TEST_F(HidKnobsTest, OnlyKnobsAreOpened) {
  auto settings = flat();
  settings.devices.push_back({"unwanted", {}});
  settings.devices[0].tuning.ignore = true;
  begin(settings);
  bus_->plug("mouse", 0x1234, 1, samples::mouse());
  bus_->plug("keyboard", 0x1234, 2, samples::keyboard_with_wheel());
  bus_->plug("unwanted", 0x1234, 3, samples::plain_wheel());
  bus_->plug("broken", 0x1234, 4, {0x05, 0x01, 0xa1, 0x01, 0xb4});
  bus_->plug("knob", 0x1234, 5, samples::volume_knob());
  ASSERT_TRUE(wait_for("knob", "ready"));
  ASSERT_TRUE(wait_for("broken", "refused"));
  ASSERT_TRUE(read_until([&] { return knobs_->threads() == 1; }));
  EXPECT_EQ(bus_->opened(), 1);
  EXPECT_EQ(state("mouse") + state("keyboard") + state("unwanted"), "");
}

TEST_F(HidKnobsTest, ASurfaceDialIsSetUpEveryTimeItComesBack) {
  begin();
  const Bytes asleep{0x01, 72, 0, 9, 3, 5, 80, 0};
  for (int time = 1; time <= 3; ++time) {
    const auto key = bus_->plug("Surface Dial", 0x045e, 0x091b, samples::surface_dial(), 1);
    bus_->set_feature_report(key, asleep);
    ASSERT_TRUE(wait_for("Surface Dial", "ready"));
    EXPECT_EQ(bus_->features_sent(), time);
    EXPECT_EQ(bus_->feature_report(key, 1), (Bytes{0x01, 0x10, 0x0e, 9, 3, 5, 80, 0}));
    controls_.clear();
    ASSERT_TRUE(bus_->send(key, {0x01, 0x00, 0x68, 0x01, 0, 0, 0, 0, 0x3a}));
    ASSERT_TRUE(read_until([&] { return count(ControlKind::turn) > 0; }));
    EXPECT_NEAR(detents(), 2.4, 1e-9);
    bus_->unplug(key);
    ASSERT_TRUE(wait_for("Surface Dial", "gone"));
  }
}

TEST_F(HidKnobsTest, ANodeThatStaysWhileItsDeviceSleepsIsSetUpAgain) {
  auto bus = std::make_unique<MemoryHidBus>();
  bus_ = bus.get();
  std::atomic<std::uint64_t> clock_us = 1'000'000;
  HidKnobsOptions options;
  options.read_timeout_ms = 2;
  options.clock_us = [&] { return clock_us.load(); };
  knobs_ = std::make_unique<HidKnobs>(std::move(bus), flat(), options);
  const auto key = bus_->plug("Surface Dial", 0x045e, 0x091b, samples::surface_dial());
  bus_->set_feature_report(key, {0x01, 72, 0, 0, 0, 0, 0, 0});
  ASSERT_TRUE(wait_for("Surface Dial", "ready"));
  EXPECT_EQ(bus_->features_sent(), 1);
  const Bytes turn{0x01, 0x00, 0x01, 0x00, 0, 0, 0, 0, 0x3a};
  clock_us += 1'000'000;
  ASSERT_TRUE(bus_->send(key, turn));
  ASSERT_TRUE(read_until([&] { return count(ControlKind::turn) > 0; }));
  EXPECT_EQ(bus_->features_sent(), 1) << "a short pause is no sleep";
  clock_us += 61'000'000;
  ASSERT_TRUE(bus_->send(key, turn));
  ASSERT_TRUE(read_until([&] { return bus_->features_sent() == 2; }));
  knobs_.reset();  // before the clock it reads
}

TEST_F(HidKnobsTest, AFloodIsMergedAndNothingIsLost) {
  begin();
  const auto key = bus_->plug("flood", 0x1234, 1, samples::plain_wheel());
  const auto calm = bus_->plug("calm", 0x1234, 2, samples::plain_wheel());
  ASSERT_TRUE(wait_for("flood", "ready"));
  ASSERT_TRUE(wait_for("calm", "ready"));
  constexpr int events = 10'000;
  std::thread sender([&] {
    for (int event = 0; event < events; ++event) {
      while (bus_->unread(key) > 32) std::this_thread::yield();  // the kernel's buffer must not be what loses
      bus_->send(key, {static_cast<std::uint8_t>(event % 2), 0x01});
      if (event % 1000 == 0) bus_->send(calm, {0x00, 0x01});
    }
  });
  const auto flooded = [&] {
    double sum = 0.0;
    for (const auto& control : controls_)
      if (control.kind == ControlKind::turn && control.name == "flood") sum += control.values[0];
    return sum;
  };
  EXPECT_TRUE(read_until([&] { return flooded() > events - 0.5; }));
  sender.join();
  EXPECT_TRUE(read_until([&] { return detents() > events + 9.5; }));
  EXPECT_NEAR(flooded(), events, 1e-6);
  EXPECT_NEAR(detents(), events + 10.0, 1e-6) << "the other knob is heard too";
}

TEST_F(HidKnobsTest, SixteenDevicesAtATime) {
  begin();
  std::vector<std::string> keys;
  for (int k = 0; k < 20; ++k) keys.push_back(bus_->plug("knob " + std::to_string(k), 1, 1, samples::plain_wheel()));
  const auto in_state = [&](const std::string& wanted) {
    std::vector<DeviceStatus> devices;
    knobs_->add_devices(devices);
    return std::count_if(devices.begin(), devices.end(), [&](const DeviceStatus& d) { return d.state == wanted; });
  };
  ASSERT_TRUE(read_until([&] { return in_state("ready") == 16; }));
  EXPECT_EQ(in_state("waiting"), 4);
  EXPECT_EQ(knobs_->threads(), 16u);
  EXPECT_EQ(bus_->open_now(), 16);
  // Those who wait take the places of those who go.
  for (const auto& key : keys) {
    if (in_state("waiting") == 0) break;
    bus_->unplug(key);
    ASSERT_TRUE(read_until([&] { return knobs_->threads() <= 16; }));
  }
  ASSERT_TRUE(read_until([&] { return in_state("waiting") == 0; }));
}

TEST_F(HidKnobsTest, AThousandReplugsLeaveNothingBehind) {
  begin();
  bus_->plug("first", 1, 1, samples::plain_wheel());
  ASSERT_TRUE(wait_for("first", "ready"));
  const std::size_t files = open_files(), threads = threads_of_process();
  int presses = 0;
  for (int time = 0; time < 1000; ++time) {
    const auto key = bus_->plug("again", 0x045e, 0x091b, samples::surface_dial(), time % 3);
    // Every tenth goes before anybody could open it.
    if (time % 10 != 9) {
      ASSERT_TRUE(read_until([&] { return bus_->send(key, {0x01, 0x01, 0x24, 0x00, 0, 0, 0, 0, 0x3a}); }));
      ++presses;
      ASSERT_TRUE(read_until([&] { return count(ControlKind::press) == presses; }));
    }
    bus_->unplug(key);
  }
  ASSERT_TRUE(read_until([&] { return knobs_->threads() == 1; }));
  EXPECT_EQ(count(ControlKind::release), presses);
  EXPECT_NEAR(detents(), presses * 0.24, 1e-6);
  EXPECT_EQ(open_files(), files);
  EXPECT_EQ(threads_of_process(), threads);
  EXPECT_EQ(bus_->open_now(), 1);
  std::vector<Notice> lines;
  knobs_->take_notices(lines);
  EXPECT_LE(lines.size(), 40u) << "a loose contact must not fill the journal";
  std::vector<DeviceStatus> devices;
  knobs_->add_devices(devices);
  EXPECT_LE(devices.size(), 10u);
}

TEST_F(HidKnobsTest, TheEndJoinsEveryThread) {
  const std::size_t files = open_files(), threads = threads_of_process();
  for (int round = 0; round < 20; ++round) {
    begin();
    bus_->plug("ready", 1, 1, samples::plain_wheel());
    bus_->plug("never", 1, 2, samples::plain_wheel(), 1'000'000);
    if (round % 2 == 0) {
      ASSERT_TRUE(wait_for("ready", "ready"));
    }
    knobs_->read(now_ms(), controls_);
    knobs_.reset();
  }
  EXPECT_EQ(open_files(), files);
  EXPECT_EQ(threads_of_process(), threads);
}

}  // namespace
}  // namespace lackwerk::input
