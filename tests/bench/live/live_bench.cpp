// What a visitor feels: from an input event to the picture that shows it, and what an idle kiosk costs. In real time,
// on the real pack, without a panel. Run by scripts/bench; asserts nothing.
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
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
  // A drag, taps into a picture that is being refined, and the first touch after a rest.
  for (const Case& it :
       {Case{"a drag, an event every 8 ms", 8.0, 8.0, 1500}, Case{"while refining", 400.0, 2500.0, 40}}) {
    kiosk::State state(static_cast<int>((*stage)->pack().paint().paints.size()), (*stage)->scene().cameras);
    kiosk::Picture picture(**stage, {});
    if (auto prepared = picture.prepare(state); !prepared) return failed(prepared.error());
    kiosk::Service service;
    kiosk::Devices devices;
    auto owned = std::make_unique<Hand>();
    Hand& hand = *owned;
    devices.sources.push_back(std::move(owned));
    kiosk::Live live(**output, **stage, picture, state, std::move(devices), std::nullopt, log, service, {});
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
      kiosk::wait(descriptors, std::min(live.wake_at_ms(kiosk::monotonic_ms()), kiosk::monotonic_ms() + 100.0),
                  nullptr);
    }
    visitor.join();
    const kiosk::LatencySummary latency = live.status().latency;
    std::printf(
        "%-30s n %zu, median %.1f ms, p95 %.1f ms = %.2f frame periods (limit 2), quality %s, %.1f ms a frame\n",
        it.name, latency.count, latency.median_ms, latency.p95_ms, latency.p95_frames, picture.quality().c_str(),
        picture.frame_period_ms());
    if (it.least_ms < 10.0) continue;
    while (!picture.resting())
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
  }
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
