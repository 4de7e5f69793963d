#include "input/evdev_dials.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace lackwerk::input {
namespace {

constexpr std::size_t max_dials = 16;
constexpr double first_retry_ms = 50.0, longest_retry_ms = 5000.0;
/// The races of the first moments heal in 50 + 100 ms; what fails a third time is told.
constexpr int faults_before_notice = 3;
/// Events a read takes from one device; more stay in the kernel for the next one.
constexpr int reads_at_once = 64;
constexpr std::size_t events_at_once = 64;

/// One line of a small file in /sys; empty when there is none.
std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// A bit map as /sys writes it: words of the kernel's long, hexadecimal, the highest first.
template <std::size_t bits>
std::bitset<bits> bit_map(const std::string& text) {
  std::bitset<bits> out;
  std::istringstream words(text);
  constexpr std::size_t word_bits = 8 * sizeof(long);
  for (std::string word; words >> word;) {
    out <<= word_bits;
    for (std::size_t k = 0; k < word.size() && k < word_bits / 4; ++k) {
      const char digit = word[word.size() - 1 - k];
      const unsigned value = digit >= '0' && digit <= '9'   ? static_cast<unsigned>(digit - '0')
                             : digit >= 'a' && digit <= 'f' ? static_cast<unsigned>(digit - 'a' + 10)
                                                            : 0u;
      for (std::size_t bit = 0; bit < 4; ++bit)
        if ((value >> bit & 1u) != 0 && 4 * k + bit < bits) out.set(4 * k + bit);
    }
  }
  return out;
}

std::uint16_t hexadecimal(const std::string& text) {
  std::uint16_t out = 0;
  std::istringstream in(text);
  in >> std::hex >> out;
  return out;
}

class UdevEvdevBus : public EvdevBus {
 public:
  explicit UdevEvdevBus(std::unique_ptr<DeviceMonitor> monitor) : monitor_(std::move(monitor)) {}

  [[nodiscard]] DeviceMonitor& monitor() override { return *monitor_; }
  [[nodiscard]] const DeviceMonitor& monitor() const override { return *monitor_; }

  [[nodiscard]] EvdevInfo describe(const DeviceEvent& device) override {
    EvdevInfo out;
    const std::string folder = device.system + "/device/";
    out.name = first_line(folder + "name");
    out.vendor = hexadecimal(first_line(folder + "id/vendor"));
    out.product = hexadecimal(first_line(folder + "id/product"));
    out.relative = bit_map<REL_CNT>(first_line(folder + "capabilities/rel"));
    out.keys = bit_map<KEY_CNT>(first_line(folder + "capabilities/key"));
    std::error_code ignored;
    out.has_hidraw = !device.hid_system.empty() && std::filesystem::exists(device.hid_system + "/hidraw", ignored);
    return out;
  }

  [[nodiscard]] tl::expected<int, HidFault> open(const DeviceEvent& device) override {
    const int file = ::open(device.node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
      const int code = errno;
      const bool gone = code == ENOENT || code == ENODEV || code == ENXIO;
      return tl::unexpected<HidFault>(
          {gone, device.node + ": " + std::strerror(code),
           code == EACCES || code == EPERM ? "put the kiosk's user into the group input; it is tried again" : ""});
    }
    int clock = CLOCK_MONOTONIC;
    ioctl(file, EVIOCSCLOCKID, &clock);  // refused: the times are of another clock and are set right when read
    return file;
  }

  [[nodiscard]] std::optional<EvdevKeys> held(int descriptor) override {
    std::array<unsigned char, (KEY_CNT + 7) / 8> bytes{};
    if (ioctl(descriptor, EVIOCGKEY(sizeof bytes), bytes.data()) < 0) return std::nullopt;
    EvdevKeys out;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = (bytes.at(k / 8) >> (k % 8) & 1) != 0;
    return out;
  }

 private:
  std::unique_ptr<DeviceMonitor> monitor_;
};

/// Number of a key as a button of a knob, or nothing.
std::optional<std::size_t> button_of(unsigned code) {
  if (code >= BTN_0 && code <= BTN_9) return code - BTN_0;
  if (code == KEY_ENTER || code == KEY_MUTE || code == KEY_PLAYPAUSE) return 0;
  return std::nullopt;
}

/// A relative axis of a dial: the event that counts, and how many of its counts are one of the kernel's "clicks".
struct EvdevAxis {
  unsigned code = 0;
  double counts = 1.0;
};

/// Wheels count in 120ths where the kernel offers it (since 5.0); the coarse event then says the same again.
constexpr double high_resolution = 120.0;

std::vector<EvdevAxis> axes_of(const EvdevInfo& info) {
  std::vector<EvdevAxis> out;
  if (info.relative[REL_DIAL]) out.push_back({REL_DIAL, 1.0});
  if (info.relative[REL_WHEEL_HI_RES])
    out.push_back({REL_WHEEL_HI_RES, high_resolution});
  else if (info.relative[REL_WHEEL])
    out.push_back({REL_WHEEL, 1.0});
  if (info.relative[REL_HWHEEL_HI_RES])
    out.push_back({REL_HWHEEL_HI_RES, high_resolution});
  else if (info.relative[REL_HWHEEL])
    out.push_back({REL_HWHEEL, 1.0});
  return out;
}

double counts_per_turn(const KnobTuning& tuning) {
  if (tuning.counts_per_turn > 0.0) return tuning.counts_per_turn;
  return known_counts_per_turn(tuning.profile);
}

}  // namespace

std::string not_a_dial(const EvdevInfo& info, const KnobTuning& tuning) {
  if (axes_of(info).empty()) return "nothing on it turns";
  if (tuning.profile != KnobProfile::automatic) return {};
  if (info.relative[REL_X] || info.relative[REL_Y] || info.keys[BTN_LEFT] || info.keys[BTN_RIGHT])
    return "it is a mouse";
  if (info.keys[BTN_TOUCH] || info.keys[BTN_TOOL_PEN]) return "it is a pen or touch device";
  if (info.keys[KEY_A] && info.keys[KEY_Z]) return "it is a keyboard";
  return {};
}

Result<std::unique_ptr<EvdevBus>> open_evdev_bus() {
  auto monitor = watch_devices({"input"});
  if (!monitor) return tl::unexpected<Error>(monitor.error());
  return std::make_unique<UdevEvdevBus>(std::move(*monitor));
}

/// One dial. A frame is what lies between two SYN_REPORTs; it counts when it is whole.
struct EvdevDials::Dial {
  Dial(DeviceEvent d, std::string n, const KnobTuning& t, std::vector<EvdevAxis> a)
      : device(std::move(d)), name(std::move(n)), tuning(t), axes(std::move(a)), knob(name, tuning) {}

  DeviceEvent device;
  std::string name;
  KnobTuning tuning;
  std::vector<EvdevAxis> axes;
  Knob knob;
  int descriptor = -1;
  bool gone = false;  ///< let go of; stays until its last controls are taken
  bool dead = false;  ///< not tried again until it is plugged anew
  double retry_ms = 0.0;
  double pause_ms = first_retry_ms;
  int faults = 0;
  std::string fault;
  std::uint64_t heard = 0;

  std::array<double, 3> counts{};
  std::vector<std::pair<std::size_t, bool>> keys;
  bool dropped = false;  ///< the kernel lost events: the rest of this frame is worthless

  void handle(const input_event& event, std::uint64_t now_us, EvdevBus& bus);
  void finish_frame(std::uint64_t time_us);
};

void EvdevDials::Dial::finish_frame(std::uint64_t time_us) {
  const double per_turn = counts_per_turn(tuning);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double clicks = counts.at(k) / axes[k].counts;
    if (clicks == 0.0) continue;
    if (per_turn > 0.0)
      knob.turn(k, clicks / per_turn, time_us);
    else
      knob.step(k, clicks, time_us);
  }
  for (const auto& [number, down] : keys) knob.button(number, down, time_us);
  counts.fill(0.0);
  keys.clear();
}

void EvdevDials::Dial::handle(const input_event& event, std::uint64_t now_us, EvdevBus& bus) {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) {
    dropped = true;
    counts.fill(0.0);
    keys.clear();
    return;
  }
  if (event.type == EV_SYN && event.code == SYN_REPORT) {
    // A clock that runs ahead of ours, or none, is not believed.
    const auto said_us = static_cast<std::uint64_t>(event.input_event_sec) * 1'000'000u +
                         static_cast<std::uint64_t>(event.input_event_usec);
    const std::uint64_t time_us = said_us == 0 ? now_us : std::min(said_us, now_us);
    if (dropped) {
      dropped = false;
      const auto held = bus.held(descriptor);
      std::array<bool, max_knob_buttons> down{};
      for (unsigned code = 0; held && code < KEY_CNT; ++code)
        if (const auto number = button_of(code); number && held->test(code)) down.at(*number) = true;
      for (std::size_t number = 0; number < down.size(); ++number) knob.button(number, down.at(number), time_us);
      return;
    }
    finish_frame(time_us);
    return;
  }
  if (dropped) return;
  if (event.type == EV_REL) {
    for (std::size_t k = 0; k < axes.size(); ++k)
      if (axes[k].code == event.code) counts.at(k) += event.value;
  } else if (event.type == EV_KEY && event.value != 2 && keys.size() < 2 * max_knob_buttons) {  // 2: repeated
    if (const auto number = button_of(event.code)) keys.emplace_back(*number, event.value != 0);
  }
}

EvdevDials::EvdevDials(std::unique_ptr<EvdevBus> bus, const KnobSettings& settings)
    : bus_(std::move(bus)), settings_(settings) {}

EvdevDials::~EvdevDials() {
  for (const auto& dial : dials_)
    if (dial->descriptor >= 0) ::close(dial->descriptor);
}

void EvdevDials::add_descriptors(std::vector<int>& out) const {
  out.push_back(bus_->monitor().descriptor());
  for (const auto& dial : dials_)
    if (dial->descriptor >= 0) out.push_back(dial->descriptor);
}

void EvdevDials::list_anew(double now_ms) {
  const auto devices = bus_->monitor().list();
  for (auto& dial : dials_) {
    const bool there = std::any_of(devices.begin(), devices.end(),
                                   [&](const DeviceEvent& d) { return d.system == dial->device.system; });
    if (!there) close(*dial, static_cast<std::uint64_t>(now_ms * 1000.0));
  }
  for (const auto& device : devices) consider(device, now_ms);
}

/// Makes a dial of a device if it is one and not known yet.
void EvdevDials::consider(const DeviceEvent& device, double now_ms) {
  if (device.node.find("/event") == std::string::npos) return;
  const bool known = std::any_of(dials_.begin(), dials_.end(),
                                 [&](const auto& dial) { return !dial->gone && dial->device.system == device.system; });
  if (known) return;
  const EvdevInfo info = bus_->describe(device);
  const KnobTuning tuning = tuning_for(settings_, info.vendor, info.product, info.name);
  if (tuning.ignore || !not_a_dial(info, tuning).empty()) return;
  if (info.has_hidraw && settings_.hidraw) return;
  if (dials_.size() >= max_dials) {
    notices_.add(true,
                 "more than " + std::to_string(max_dials) + " dials: '" + printable(info.name) + "' is not looked at");
    return;
  }
  dials_.push_back(std::make_unique<Dial>(device, printable(info.name), tuning, axes_of(info)));
  dials_.back()->retry_ms = now_ms;
}

/// What udev has said since the last call. A full list costs some 0.2 ms a device, too much for every event.
void EvdevDials::follow(double now_ms) {
  std::vector<DeviceEvent> events;
  bus_->monitor().read(events);
  bool list = !listed_;
  for (const auto& event : events) list |= event.action == DeviceEvent::Action::lost;
  if (list) {
    list_anew(now_ms);
    listed_ = true;
    return;
  }
  for (const auto& event : events) {
    if (event.action == DeviceEvent::Action::added) consider(event, now_ms);
    if (event.action != DeviceEvent::Action::removed) continue;
    for (auto& dial : dials_)
      if (dial->device.system == event.system) close(*dial, static_cast<std::uint64_t>(now_ms * 1000.0));
  }
}

void EvdevDials::try_open(Dial& dial, double now_ms) {
  auto opened = bus_->open(dial.device);
  if (opened) {
    dial.descriptor = *opened;
    dial.fault.clear();
    dial.faults = 0;
    dial.pause_ms = first_retry_ms;
    dial.dropped = false;
    notices_.add(false, "dial '" + dial.name + "' (" + dial.device.node + "): ready");
    return;
  }
  const HidFault& fault = opened.error();
  dial.fault = fault.what + (fault.remedy.empty() ? "" : " (" + fault.remedy + ")");
  dial.dead = fault.for_good;
  dial.retry_ms = now_ms + dial.pause_ms;
  dial.pause_ms = std::min(2.0 * dial.pause_ms, longest_retry_ms);
  if (++dial.faults == faults_before_notice) notices_.add(true, "dial '" + dial.name + "': " + dial.fault);
}

void EvdevDials::close(Dial& dial, std::uint64_t now_us) {
  if (dial.gone) return;
  if (dial.descriptor >= 0) {
    ::close(dial.descriptor);
    notices_.add(false, "dial '" + dial.name + "' (" + dial.device.node + ") is gone");
  }
  dial.descriptor = -1;
  dial.knob.let_go(now_us);
  dial.gone = true;
}

/// False when the device is gone.
bool EvdevDials::read_events(Dial& dial, std::uint64_t now_us) {
  std::array<input_event, events_at_once> events{};
  for (int count = 0; count < reads_at_once; ++count) {
    const ssize_t size = ::read(dial.descriptor, events.data(), sizeof events);
    if (size < 0) return errno == EAGAIN || errno == EINTR;
    if (size == 0) return false;
    const std::size_t whole = static_cast<std::size_t>(size) / sizeof(input_event);
    for (std::size_t k = 0; k < whole; ++k) dial.handle(events.at(k), now_us, *bus_);
    if (whole < events.size()) return true;
  }
  return true;
}

void EvdevDials::read(double now_ms, std::vector<Control>& out) {
  const auto now_us = static_cast<std::uint64_t>(std::max(now_ms, 0.0) * 1000.0);
  follow(now_ms);
  const std::size_t most = out.size() + max_controls_a_read;
  for (auto& dial : dials_) {
    if (!dial->gone && !dial->dead && dial->descriptor < 0 && now_ms >= dial->retry_ms) try_open(*dial, now_ms);
    if (dial->descriptor >= 0 && !read_events(*dial, now_us)) {
      // Unplugged, and udev has not said so yet; should it still be there, it is tried again.
      ::close(dial->descriptor);
      dial->descriptor = -1;
      dial->fault = "it stopped answering";
      dial->retry_ms = now_ms + dial->pause_ms;
      dial->knob.let_go(now_us);
    }
    const std::size_t before = out.size();
    dial->knob.take(now_ms, most - out.size(), out);
    dial->heard += out.size() - before;
  }
  std::erase_if(dials_, [](const auto& dial) { return dial->gone && !dial->knob.has_pending(); });
}

double EvdevDials::wake_at_ms() const {
  if (!listed_) return 0.0;
  double at = never_ms;
  for (const auto& dial : dials_) {
    at = std::min(at, dial->knob.wake_at_ms());
    if (dial->descriptor < 0 && !dial->gone && !dial->dead) at = std::min(at, dial->retry_ms);
  }
  return at;
}

void EvdevDials::add_devices(std::vector<DeviceStatus>& out) const {
  for (const auto& dial : dials_) {
    const bool ready = dial->descriptor >= 0;
    const bool gone = dial->gone || dial->dead;
    out.push_back({dial->name, "dial",
                   ready  ? "ready"
                   : gone ? "gone"
                          : "waiting",
                   dial->device.node + (dial->fault.empty() ? "" : ": " + dial->fault), dial->heard});
  }
}

void EvdevDials::take_notices(std::vector<Notice>& out) { notices_.take(out); }

}  // namespace lackwerk::input
