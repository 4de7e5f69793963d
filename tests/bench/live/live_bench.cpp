// What a visitor feels: from an input event to the picture that shows it, and what an idle kiosk costs. In real time,
// on the real pack, without a panel. Run by scripts/bench; asserts nothing.
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <random>
#include <thread>

#include "kiosk/display/live.hpp"
#include "kiosk/display/output/headless_output.hpp"
#include "kiosk/display/waiting.hpp"
#include "packs/scene_pack.hpp"

namespace lackwerk::bench {
namespace {

/// A hand on another thread: events with their times, and a descriptor that wakes the kiosk.
class Hand final : public input::Source {
 public:
  Hand() : fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~Hand() override { close(fd_); }
  void touch(double azimuth_deg) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({input::ControlKind::orbit,
                        {azimuth_deg, 0.0},
                        "",
                        0,
                        static_cast<std::uint64_t>(kiosk::monotonic_ms() * 1e3)});
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t wrote = write(fd_, &one, sizeof one);
  }
  void add_descriptors(std::vector<int>& out) const override { out.push_back(fd_); }
  void read(double /*now_ms*/, std::vector<input::Control>& out) override {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(fd_, &count, sizeof count);
    const std::lock_guard lock(mutex_);
    out.insert(out.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
  }
  [[nodiscard]] double wake_at_ms() const override { return input::never_ms; }
  void add_devices(std::vector<input::DeviceStatus>& /*out*/) const override {}
  void take_notices(std::vector<input::Notice>& /*out*/) override {}

 private:
  int fd_;
  std::mutex mutex_;
  std::vector<input::Control> waiting_;
};

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

int failed(const Error& error) {
  std::fprintf(stderr, "live_bench: %s\n", error.line().c_str());
  return 1;
}

struct Case {
  const char* name;
  double least_ms, most_ms;  ///< between two events
  int events;
};

/// The attract tour would move by itself: what nobody touches must stand still here.
kiosk::InterfaceSettings still_settings() {
  kiosk::InterfaceSettings settings;
  settings.experience.tour = false;
  settings.experience.idle_s = 3600.0;
  return settings;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What the interface adds to a frame while the puck is dragged, and what it does when nothing moves. Picture and
/// interface are timed within the same frames, so that whatever else the machine does falls on both.
int interface_cost(kiosk::Stage& stage, kiosk::Log& log) {
  constexpr int frames = 300;
  auto opened = kiosk::Interface::create(stage, still_settings(), log);
  if (!opened) return failed(opened.error());
  kiosk::Interface& interface = **opened;
  while (interface.wants_swatch()) interface.make_swatch();
  kiosk::Picture picture(stage, {"least", 62, 0});
  if (auto prepared = picture.prepare(interface.shown()); !prepared) return failed(prepared.error());
  const gles::GlApi& gl = stage.context().gl();
  double now_ms = 1000.0;
  (void)interface.begin_visit(now_ms);
  (void)interface.take({input::ControlKind::touch_down, {1.0}, "@puck", 0, 0}, now_ms);
  std::vector<double> drawing, behaving, composing;
  for (int k = 0; k < frames; ++k) {
    now_ms += 1000.0 / 30.0;
    const double began = kiosk::monotonic_ms();
    const double angle = 0.1 * k;
    const std::string place =
        "@pad:" + std::to_string(0.5 + 0.3 * std::cos(angle)) + "," + std::to_string(0.5 + 0.3 * std::sin(angle));
    auto changes = interface.take({input::ControlKind::touch_move, {1.0}, place, 0, 0}, now_ms);
    changes |= interface.advance(now_ms, 720);
    const double behaved = kiosk::monotonic_ms();
    if (auto stepped = picture.step(interface.shown(), changes.weights); !stepped) return failed(stepped.error());
    gl.Finish();
    const double drawn = kiosk::monotonic_ms();
    if (auto composed = interface.compose(stage.framebuffer()); !composed) return failed(composed.error());
    gl.Finish();
    const double done = kiosk::monotonic_ms();
    behaving.push_back(behaved - began);
    drawing.push_back(drawn - behaved);
    composing.push_back(done - drawn);
  }
  const double picture_ms = median(drawing), behaviour_ms = median(behaving), compose_ms = median(composing);
  std::printf(
      "%-30s n %d at %dx%d: %.2f ms on the picture (limit 2), %.2f ms behaviour, %.1f ms the picture; ratio %.3f\n",
      "interface while dragging", frames, stage.framebuffer().width(), stage.framebuffer().height(), compose_ms,
      behaviour_ms, picture_ms, (picture_ms + compose_ms + behaviour_ms) / picture_ms);
  (void)interface.take({input::ControlKind::touch_up, {}, "script", 0, 0}, now_ms);
  for (int k = 0; k < 60; ++k) {
    now_ms += 1000.0 / 30.0;
    const auto changes = interface.advance(now_ms, 720);
    if (auto stepped = picture.step(interface.shown(), changes.weights); !stepped) return failed(stepped.error());
    if (interface.stale())
      if (auto composed = interface.compose(stage.framebuffer()); !composed) return failed(composed.error());
  }
  int composed = 0;
  const std::uint64_t sent = interface.overlay()->sent_bytes(), tiles = interface.painter()->tiles_drawn();
  for (int k = 0; k < frames; ++k) {
    now_ms += 1000.0 / 30.0;
    (void)interface.advance(now_ms, 720);
    composed += interface.stale() ? 1 : 0;
  }
  std::printf("%-30s n %d: %d composed, %llu tiles drawn, %llu bytes sent (limit 0)\n", "interface at rest", frames,
              composed, static_cast<unsigned long long>(interface.painter()->tiles_drawn() - tiles),
              static_cast<unsigned long long>(interface.overlay()->sent_bytes() - sent));
  return 0;
}

/// What the dealer's brightness costs: dimmed by the overlay, by the pass that takes pictures to the panel, and not at
/// all. The three take turns, so that whatever else the machine does falls on all of them.
int dimming_cost(kiosk::Output& output, kiosk::Stage& stage, kiosk::Log& log) {
  constexpr int rounds = 150;
  kiosk::InterfaceSettings settings = still_settings();
  settings.experience.brightness = 0.7;
  auto opened = kiosk::Interface::create(stage, settings, log);
  if (!opened) return failed(opened.error());
  kiosk::Interface& interface = **opened;
  while (interface.wants_swatch()) interface.make_swatch();
  (void)interface.begin_visit(1000.0);
  struct Way {
    const char* name;
    kiosk::Interface::Dimming dimming;
    float brightness;
    std::vector<double> ms;
  };
  using Dimming = kiosk::Interface::Dimming;
  std::array<Way, 3> ways{{{"not dimmed", Dimming::later, 1.0f, {}},
                           {"dimmed by the overlay", Dimming::here, 1.0f, {}},
                           {"dimmed by the panel's pass", Dimming::later, interface.brightness(), {}}}};
  for (int k = 0; k < rounds; ++k)
    for (Way& way : ways) {
      const double began = kiosk::monotonic_ms();
      (void)output.set_brightness(way.brightness);
      const auto composed = interface.compose(stage.framebuffer(), way.dimming);
      if (!composed) return failed(composed.error());
      if (auto presented = output.present(**composed); !presented) return failed(presented.error());
      stage.context().gl().Finish();
      way.ms.push_back(kiosk::monotonic_ms() - began);
    }
  (void)output.set_brightness(1.0f);
  const double plain = median(ways[0].ms);
  for (Way& way : ways) {
    const double ms = median(way.ms);
    std::printf("%-30s n %d: %.2f ms from picture to panel, ratio %.3f\n", way.name, rounds, ms, ms / plain);
  }
  return 0;
}

int answer_times(kiosk::Output& output, kiosk::Stage& stage, kiosk::Log& log, const Case& it) {
  auto interface = kiosk::Interface::create(stage, still_settings(), log);
  if (!interface) return failed(interface.error());
  kiosk::Picture picture(stage, {});
  if (auto prepared = picture.prepare((*interface)->shown()); !prepared) return failed(prepared.error());
  kiosk::Service service;
  kiosk::Devices devices;
  auto owned = std::make_unique<Hand>();
  Hand& hand = *owned;
  devices.sources.push_back(std::move(owned));
  kiosk::Live live(output, stage, picture, **interface, std::move(devices), std::nullopt, log, service, {});
  std::atomic<bool> done = false;
  std::thread visitor([&] {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> pause(it.least_ms, it.most_ms);
    for (int k = 0; k < it.events; ++k) {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(pause(random)));
      hand.touch(k % 200 < 100 ? 0.5 : -0.5);
    }
    done = true;
  });
  std::vector<int> descriptors;
  while (!done) {
    if (auto stepped = live.step(kiosk::monotonic_ms()); !stepped) return failed(stepped.error());
    descriptors.clear();
    live.add_descriptors(descriptors);
    kiosk::wait(descriptors, std::min(live.wake_at_ms(kiosk::monotonic_ms()), kiosk::monotonic_ms() + 100.0), nullptr);
  }
  visitor.join();
  const kiosk::LatencySummary latency = live.status().latency;
  std::printf("%-30s n %zu, median %.1f ms, p95 %.1f ms = %.2f frame periods (limit 2), quality %s, %.1f ms a frame\n",
              it.name, latency.count, latency.median_ms, latency.p95_ms, latency.p95_frames, picture.quality().c_str(),
              picture.frame_period_ms());
  if (it.least_ms < 10.0) return 0;
  while (!picture.resting() || (*interface)->wants_swatch())
    if (auto stepped = live.step(kiosk::monotonic_ms()); !stepped) return failed(stepped.error());
  constexpr double idle_ms = 5000.0;
  const double cpu = cpu_s(), until = kiosk::monotonic_ms() + idle_ms;
  int rounds = 0;
  const std::uint64_t drawn = picture.drawn() + picture.refined();
  while (kiosk::monotonic_ms() < until) {
    if (auto stepped = live.step(kiosk::monotonic_ms()); !stepped) return failed(stepped.error());
    ++rounds;
    descriptors.clear();
    live.add_descriptors(descriptors);
    kiosk::wait(descriptors, std::min(live.wake_at_ms(kiosk::monotonic_ms()), until), nullptr);
  }
  std::printf("%-30s %.3f %% of a core over %.0f s (limit 1), woken %d times, %llu frames\n", "nothing changes",
              (cpu_s() - cpu) * 1e5 / idle_ms, idle_ms * 1e-3, rounds,
              static_cast<unsigned long long>(picture.drawn() + picture.refined() - drawn));
  return 0;
}

int run(const char* pack_path, const char* scene_path) {
  kiosk::Log log(nullptr);
  kiosk::OutputSettings settings;
  settings.platform = kiosk::Platform::surfaceless;
  auto output = kiosk::make_headless_output(settings, log);
  if (!output) return failed(output.error());
  auto pack = packs::PaintPack::open(pack_path);
  if (!pack) return failed(pack.error());
  auto scene = packs::read_scene_pack(scene_path);
  if (!scene) return failed(scene.error());
  auto stage = kiosk::Stage::create((*output)->context(), settings.size_px[0], settings.size_px[1], std::move(*pack),
                                    std::move(*scene));
  if (!stage) return failed(stage.error());
  if (const int code = interface_cost(**stage, log); code != 0) return code;
  if (const int code = dimming_cost(**output, **stage, log); code != 0) return code;
  // A drag, taps into a picture that is being refined, and the first touch after a rest.
  for (const Case& it :
       {Case{"a drag, an event every 8 ms", 8.0, 8.0, 1500}, Case{"while refining", 400.0, 2500.0, 40}})
    if (const int code = answer_times(**output, **stage, log, it); code != 0) return code;
  return 0;
}

}  // namespace
}  // namespace lackwerk::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "live_bench PACK.lwp SCENE.lws\n");
    return 2;
  }
  return lackwerk::bench::run(argv[1], argv[2]);
}
