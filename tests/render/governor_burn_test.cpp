// The governor on real frames while another thread burns a core. Times are whatever this machine takes; what is held
// are counts of changes and ratios within one run.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "kiosk/display/state.hpp"
#include "render_gles/governor.hpp"
#include "tests/render/kiosk_stage.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Governor;
using gles::Rung;
using gles::rung_count;

/// Keeps one core busy as long as it lives.
class Burner {
 public:
  Burner()
      : thread_([this] {
          std::uint64_t x = 1;
          while (!stop_.load(std::memory_order_relaxed))
            for (int k = 0; k < 4096; ++k) x = x * 6364136223846793005u + 1442695040888963407u;
          burnt_ = x;
        }) {}
  ~Burner() {
    stop_ = true;
    thread_.join();
  }
  Burner(const Burner&) = delete;
  Burner& operator=(const Burner&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> burnt_{0};
  std::thread thread_;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class GovernorBurn : public OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (!context_) return;
    stage_ = synthetic_stage(*context_, 240, 180);
    ASSERT_NE(stage_, nullptr);
    ASSERT_TRUE(stage_->renderer().update(kiosk::first_paint(2)));
  }
  /// Milliseconds of one frame of a view that has never been drawn before.
  double frame_ms(const Rung& rung) {
    gles::View view = gles::View::from(stage_->scene().cameras.front());
    view.eye_mm.x += 0.01f * static_cast<float>(++frames_);
    gles::Lighting lighting;
    lighting.quality = rung.quality;
    const auto start = std::chrono::steady_clock::now();
    stage_->renderer().draw(view, lighting, stage_->framebuffer());
    context_->gl().Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  /// What `lackwerk report` does: the rungs in turn.
  gles::RungCosts measured_costs(double& best_ms) {
    std::array<std::vector<double>, rung_count> ms;
    for (int round = 0; round <= 9; ++round)
      for (std::size_t k = 0; k < rung_count; ++k) {
        const double one = frame_ms(gles::quality_ladder()[k]);
        if (round > 0) ms[k].push_back(one);  // the first compiles
      }
    gles::RungCosts costs;
    best_ms = median(ms[0]);
    for (std::size_t k = 0; k < rung_count; ++k) costs.cost[k] = median(ms[k]) / best_ms;
    return costs;
  }
  struct Course {
    int changes = 0;
    int taken_back = 0;  ///< steps down that followed a step up
    std::vector<double> last_ms;
  };
  /// So many governed frames; the last 30 are kept.
  Course run(Governor& governor, int frames) {
    Course out;
    bool went_up = false;
    for (int k = 0; k < frames; ++k) {
      const int before = governor.index();
      const double ms = frame_ms(governor.rung());
      if (k + 30 >= frames) out.last_ms.push_back(ms);
      if (!governor.measured(ms)) continue;
      ++out.changes;
      const bool up = governor.index() < before;
      out.taken_back += !up && went_up ? 1 : 0;
      went_up = up;
    }
    return out;
  }

  std::unique_ptr<kiosk::Stage> stage_;
  int frames_ = 0;
};

TEST_P(GovernorBurn, HoldsTheFrameTimeAndDoesNotGoToAndFro) {
  double best_ms = 0.0;
  const gles::RungCosts costs = measured_costs(best_ms);
  // Room for the best rung while nothing else runs, hardly any beside a burning core.
  const double target_ms = 1.15 * best_ms;
  Governor governor(target_ms, 0, costs);
  constexpr int frames = 150;
  const Course calm = run(governor, frames);
  const std::string calm_rung(governor.rung().name);
  Course burnt;
  std::vector<double> least_ms;
  {
    const Burner burner;
    burnt = run(governor, frames);
    int least = 0;
    for (int k = 1; k < static_cast<int>(rung_count); ++k)
      if (!costs.dominated(k)) least = k;
    for (int k = 0; k < 15; ++k) least_ms.push_back(frame_ms(gles::quality_ladder()[static_cast<std::size_t>(least)]));
  }
  const std::string burnt_rung(governor.rung().name);
  const Course after = run(governor, frames);
  std::printf("  target %.1f ms; costs", target_ms);
  for (const double cost : costs.cost) std::printf(" %.2f", cost);
  std::printf(
      "\n  calm: \"%s\" %.1f ms, %d changes; a core burning: \"%s\" %.1f ms, %d changes (least rung %.1f ms); "
      "after: \"%s\" %.1f ms, %d changes\n",
      calm_rung.c_str(), median(calm.last_ms), calm.changes, burnt_rung.c_str(), median(burnt.last_ms), burnt.changes,
      median(least_ms), std::string(governor.rung().name).c_str(), median(after.last_ms), after.changes);
  // A step up needs 45 frames of calm, 90 after one that had to be taken back, then 180: two of those fit into 150
  // frames, whatever else the machine does, and one more that was made just before them.
  for (const Course& course : {calm, burnt, after}) {
    EXPECT_LE(course.taken_back, 3);
    // Steps up: at most one in 45 frames. Steps down: as many, and the ladder once.
    EXPECT_LE(course.changes, 2 * (frames / 45) + static_cast<int>(rung_count) - 1);
  }
  // Where the least rung has room to spare beside the burner, what the governor has come to holds.
  if (median(least_ms) <= 0.7 * target_ms) {
    EXPECT_LE(median(burnt.last_ms), target_ms);
  }
}

INSTANTIATE_TEST_SUITE_P(All, GovernorBurn, testing::Values(gles::Backend::egl_surfaceless),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

}  // namespace
}  // namespace lackwerk::test
