#include "input/hid_knobs.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "input/hid_knob.hpp"

namespace lackwerk::input {
namespace {

/// Nodes known at a time; a bus with more is not one that people turn.
constexpr std::size_t max_ports = 64;
/// Vanished knobs kept for the status page.
constexpr std::size_t max_gone = 8;
/// The races of the first moments heal in 50 + 100 ms; what fails a third time is told.
constexpr int faults_before_notice = 3;
/// Room for a report: what the descriptor promises, and some more for transports that pad.
constexpr std::size_t min_buffer_bytes = 64, max_buffer_bytes = 4096 + 1;
/// Between two attempts to make a thread.
constexpr double thread_retry_ms = 1000.0;

std::uint64_t monotonic_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000u + static_cast<std::uint64_t>(now.tv_nsec) / 1000u;
}

}  // namespace

/// Wakes the kiosk's poll; any thread.
struct HidKnobs::Shared {
  Shared() : wake(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~Shared() {
    if (wake >= 0) close(wake);
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  void signal() {
    if (!signalled.exchange(true)) eventfd_write(wake, 1);
  }
  /// Before the ports are looked at: what comes later signals again.
  void clear() {
    eventfd_t told = 0;
    eventfd_read(wake, &told);
    signalled = false;
  }

  int wake = -1;
  std::atomic<bool> signalled = false;
};

/// One device and its thread. `mutex` guards what both sides touch; no I/O happens under it.
struct HidKnobs::Port {
  enum class State { queued, opening, ready, waiting, refused, left_alone, gone };

  HidNode node;
  std::string name;
  KnobTuning tuning;

  std::mutex mutex;
  std::condition_variable ended;
  bool stop = false;
  bool finished = false;
  State state = State::queued;
  std::string detail;
  std::optional<HidKnob> knob;
  std::uint64_t heard = 0;
  Notices notices;

  std::thread thread;

  // ---- the reader's side
  void run(HidBus& bus, const HidKnobsOptions& options, Shared& shared);
  bool prepare(HidBus& bus, HidFault& fault);
  void listen(HidDevice& device, const HidKnobsOptions& options, Shared& shared, int& pause_ms);
  void send_settings(HidDevice& device);
  bool pause(int ms);
  void say(State now, const std::string& why, bool problem, bool tell);
  bool stopping();

  // ---- the kiosk's side, `mutex` held
  [[nodiscard]] std::string_view listed_as() const;
};

/// DeviceStatus::state; empty: it is not listed.
std::string_view HidKnobs::Port::listed_as() const {
  switch (state) {
    case State::left_alone:
      break;
    case State::ready:
      return "ready";
    case State::refused:
      return "refused";
    case State::gone:
      return "gone";
    case State::opening:
      // Most of these turn out to be mice and keyboards; they are told when they turn out to be knobs.
      return knob ? "waiting" : "";
    case State::queued:
    case State::waiting:
      return "waiting";
  }
  return "";
}

bool HidKnobs::Port::stopping() {
  const std::lock_guard lock(mutex);
  return stop;
}

/// Waits; false when the port shall end.
bool HidKnobs::Port::pause(int ms) {
  std::unique_lock lock(mutex);
  ended.wait_for(lock, std::chrono::milliseconds(ms), [&] { return stop; });
  return !stop;
}

void HidKnobs::Port::say(State now, const std::string& why, bool problem, bool tell) {
  const std::lock_guard lock(mutex);
  state = now;
  detail = why;
  const std::string what = now == State::left_alone ? "HID device '" : "knob '";
  if (tell) notices.add(problem, what + name + "' (" + node.path + "): " + (why.empty() ? "ready" : why));
}

/// Makes the knob from the device's descriptor. False with a fault, or with the state saying why it is none.
bool HidKnobs::Port::prepare(HidBus& bus, HidFault& fault) {
  auto descriptor = bus.report_descriptor(node);
  if (!descriptor) {
    fault = descriptor.error();
    return false;
  }
  auto made = HidKnob::make(*descriptor, name, tuning);
  if (!made) {
    // Without a remedy nothing is wrong: it is a mouse, or a keyboard.
    const bool wrong = !made.error().remedy.empty();
    say(wrong ? State::refused : State::left_alone, wrong ? made.error().line() : "left alone, " + made.error().what,
        wrong, true);
    return false;
  }
  const std::lock_guard lock(mutex);
  knob.emplace(std::move(*made));
  return true;
}

/// Asks the device for its finest resolution, and believes what it says of the result.
void HidKnobs::Port::send_settings(HidDevice& device) {
  const auto wanted = knob->resolution();
  if (!wanted || wanted->payload_bytes == 0) return;
  std::vector<std::uint8_t> bytes(1 + wanted->payload_bytes);
  bytes[0] = wanted->report_id;
  if (!device.get_feature(bytes)) return;  // then the profile's own number holds
  const auto payload = std::span(bytes).subspan(1);
  const std::vector<std::uint8_t> before(bytes);
  knob->set_resolution(payload);
  const bool taken = device.set_feature(bytes);
  const std::lock_guard lock(mutex);
  knob->use_resolution(taken ? payload : std::span(before).subspan(1));
}

void HidKnobs::Port::listen(HidDevice& device, const HidKnobsOptions& options, Shared& shared, int& pause_ms) {
  std::vector<std::uint8_t> buffer(std::clamp(knob->max_report_bytes(), min_buffer_bytes, max_buffer_bytes));
  std::uint64_t last_us = options.clock_us();
  while (!stopping()) {
    const int size = device.read(buffer, options.read_timeout_ms);
    if (size < 0) return;
    if (size == 0) continue;
    const std::uint64_t now_us = options.clock_us();
    {
      const std::lock_guard lock(mutex);
      if (stop) return;
      knob->report(std::span(buffer).first(std::min(static_cast<std::size_t>(size), buffer.size())), now_us);
    }
    shared.signal();
    pause_ms = options.first_retry_ms;
    if (now_us > last_us + options.asleep_after_us) send_settings(device);
    last_us = now_us;
  }
}

void HidKnobs::Port::run(HidBus& bus, const HidKnobsOptions& options, Shared& shared) {
  int pause_ms = options.first_retry_ms;
  int faults = 0;
  bool prepared = false;
  bool going = options.settle_ms == 0 || pause(options.settle_ms);
  while (going && !stopping()) {
    HidFault fault;
    if (!prepared) prepared = prepare(bus, fault);
    if (!prepared && fault.what.empty()) break;
    if (prepared) {
      auto device = bus.open(node);
      if (device) {
        send_settings(**device);
        say(State::ready, "", false, true);
        shared.signal();
        listen(**device, options, shared, pause_ms);
        fault.what = "it stopped answering";
        faults = 0;
        const std::lock_guard lock(mutex);
        knob->reset(options.clock_us());
      } else {
        fault = device.error();
      }
    }
    if (stopping()) break;
    if (fault.for_good) {
      say(State::gone, fault.what, false, false);
      break;
    }
    ++faults;
    const std::string why = fault.what + (fault.remedy.empty() ? "" : " (" + fault.remedy + ")");
    say(State::waiting, why, true, faults == faults_before_notice);
    shared.signal();
    going = pause(pause_ms);
    pause_ms = std::min(2 * pause_ms, options.longest_retry_ms);
  }
  {
    const std::lock_guard lock(mutex);
    if (knob) knob->reset(options.clock_us());
    finished = true;
  }
  shared.signal();
}

HidKnobs::HidKnobs(std::unique_ptr<HidBus> bus, const KnobSettings& settings, HidKnobsOptions options)
    : bus_(std::move(bus)), settings_(settings), options_(std::move(options)), shared_(std::make_unique<Shared>()) {
  if (!options_.clock_us) options_.clock_us = monotonic_us;
  compare();
}

HidKnobs::~HidKnobs() {
  for (auto& port : ports_) {
    const std::lock_guard lock(port->mutex);
    port->stop = true;
    port->ended.notify_all();
  }
  for (auto& port : ports_)
    if (port->thread.joinable()) port->thread.join();
}

void HidKnobs::add_descriptors(std::vector<int>& out) const {
  bus_->add_descriptors(out);
  out.push_back(shared_->wake);
}

/// Brings the ports in line with what the bus lists.
void HidKnobs::compare() {
  std::set<std::string> now;
  for (auto& node : bus_->list()) {
    now.insert(node.key);
    if (present_.count(node.key) != 0) continue;
    if (ports_.size() >= max_ports) {
      now.erase(node.key);  // looked at again when the next one comes or goes
      notices_.add(true, "more than " + std::to_string(max_ports) + " HID devices: '" + printable(node.name) +
                             "' is not looked at");
      continue;
    }
    auto port = std::make_unique<Port>();
    port->name = printable(node.name);
    port->tuning = tuning_for(settings_, node.vendor, node.product, node.name);
    port->node = std::move(node);
    if (port->tuning.ignore) port->state = Port::State::left_alone;
    ports_.push_back(std::move(port));
  }
  const std::uint64_t now_us = options_.clock_us();
  for (auto& port : ports_) {
    if (now.count(port->node.key) != 0) continue;
    const std::lock_guard lock(port->mutex);
    port->stop = true;
    if (port->knob) port->knob->reset(now_us);  // held buttons are released now, whatever its thread waits for
    port->ended.notify_all();
  }
  present_ = std::move(now);
}

void HidKnobs::start(Port& port) {
  try {
    port.thread = std::thread([&port, this] { port.run(*bus_, options_, *shared_); });
  } catch (const std::system_error& error) {
    const std::lock_guard lock(port.mutex);
    port.state = Port::State::queued;
    port.detail = std::string("no thread: ") + error.what();
    notices_.add(true, "knob '" + port.name + "': " + port.detail);
  }
}

/// Joins what has ended and forgets what is unplugged; starts those who waited for a place.
void HidKnobs::reap() {
  for (auto& port : ports_) {
    const std::lock_guard lock(port->mutex);
    std::vector<Notice> said;
    port->notices.take(said);
    for (const auto& line : said) notices_.add(line.problem, line.text);
  }
  for (auto port = ports_.begin(); port != ports_.end();) {
    bool finished = false, pending = false, stop = false, was_knob = false;
    {
      const std::lock_guard lock((*port)->mutex);
      finished = (*port)->finished;
      stop = (*port)->stop;
      was_knob = (*port)->knob.has_value();
      pending = was_knob && (*port)->knob->knob().has_pending();
    }
    if (finished && (*port)->thread.joinable()) (*port)->thread.join();
    if (!stop || pending || (*port)->thread.joinable()) {
      ++port;
      continue;
    }
    if (was_knob) {
      notices_.add(false, "knob '" + (*port)->name + "' (" + (*port)->node.path + ") is gone");
      if (gone_.size() == max_gone) gone_.erase(gone_.begin());
      gone_.push_back({(*port)->name, "knob", "gone", "unplugged, out of reach or asleep; it may come back any time",
                       (*port)->heard});
    }
    port = ports_.erase(port);
  }
}

std::size_t HidKnobs::threads() const {
  return static_cast<std::size_t>(
      std::count_if(ports_.begin(), ports_.end(), [](const auto& port) { return port->thread.joinable(); }));
}

void HidKnobs::collect(double now_ms, std::vector<Control>& out) {
  // Whoever was first is last next time: a device that floods must not starve the others.
  const std::size_t most = out.size() + max_controls_a_read;
  const std::size_t count = ports_.size();
  for (std::size_t k = 0; k < count && out.size() < most; ++k) {
    Port& port = *ports_[(turn_ + k) % count];
    const std::lock_guard lock(port.mutex);
    const std::size_t before = out.size();
    if (port.knob) port.knob->knob().take(now_ms, most - out.size(), out);
    port.heard += out.size() - before;
  }
  if (count > 0) turn_ = (turn_ + 1) % count;
}

void HidKnobs::read(double now_ms, std::vector<Control>& out) {
  shared_->clear();
  if (bus_->changed()) compare();
  collect(now_ms, out);
  reap();
  start_again_ms_ = never_ms;
  std::size_t running = threads();
  for (auto& port : ports_) {
    bool start_it = false;
    {
      const std::lock_guard lock(port->mutex);
      if (port->state == Port::State::ready)
        std::erase_if(gone_, [&](const DeviceStatus& gone) { return gone.name == port->name; });
      start_it = port->state == Port::State::queued && !port->stop && running < max_knob_devices;
      if (start_it) port->state = Port::State::opening;
    }
    if (!start_it) continue;
    start(*port);
    if (port->thread.joinable())
      ++running;
    else
      start_again_ms_ = now_ms + thread_retry_ms;
  }
}

double HidKnobs::wake_at_ms() const {
  double at = start_again_ms_;
  for (const auto& port : ports_) {
    const std::lock_guard lock(port->mutex);
    if (port->knob) at = std::min(at, port->knob->knob().wake_at_ms());
    if (port->state == Port::State::queued && start_again_ms_ == never_ms && threads() < max_knob_devices) at = 0.0;
  }
  return at;
}

void HidKnobs::add_devices(std::vector<DeviceStatus>& out) const {
  for (const auto& port : ports_) {
    const std::lock_guard lock(port->mutex);
    if (port->stop) continue;  // unplugged; it is listed as gone in a moment
    const std::string_view state = port->listed_as();
    if (state.empty()) continue;
    const std::string where = port->detail.find(port->node.path) == std::string::npos
                                  ? port->node.path + (port->detail.empty() ? "" : ": " + port->detail)
                                  : port->detail;
    out.push_back({port->name, "knob", std::string(state), where, port->heard});
  }
  out.insert(out.end(), gone_.begin(), gone_.end());
}

void HidKnobs::take_notices(std::vector<Notice>& out) { notices_.take(out); }

}  // namespace lackwerk::input
