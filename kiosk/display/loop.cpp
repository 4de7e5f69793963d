#include "kiosk/display/loop.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "input/script.hpp"
#include "kiosk/display/mood.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/display/state.hpp"
#include "packs/scene_pack.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double frame_ms = 1000.0 / 30.0;
/// Samples a pixel of the screenshot: what the kiosk would have converged to by then.
constexpr int screenshot_samples = 16;

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_requested = 0;

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Result<void> make_folder(const std::string& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return fail(folder, "--record", code.message(), "choose a folder that can be written");
  return {};
}

/// As shown, or smoother: with several samples the frame is drawn again, moved by parts of a pixel.
Result<void> record_frame(Stage& stage, const State& state, const Options& options, std::uint64_t frame) {
  char name[16];
  std::snprintf(name, sizeof name, "%06u.png", static_cast<unsigned>(frame % 1'000'000));
  const gles::Image image =
      options.record_samples == 1
          ? stage.framebuffer().read()
          : stage.renderer().still(gles::View::from(state.camera()), lighting_of(usual_mood(state.camera().name)),
                                   stage.framebuffer(), options.record_samples);
  return gles::write_png(image, (std::filesystem::path(options.record) / name).string());
}

/// What was asked of the loop, minus the stage: so that run() reads as the loop it is.
struct Session {
  Stage& stage;
  State state;
  std::optional<input::ScriptPlayer> player;
  std::vector<double> drawn_ms, realise_ms;

  /// Feeds the input up to now and draws if anything changed.
  Result<void> step(double now_ms) {
    State::Changes changes;
    if (player)
      for (const input::Control& event : player->advance(now_ms)) {
        const auto change = state.apply(event);
        changes.weights |= change.weights;
        changes.view |= change.view;
      }
    const auto start = Clock::now();
    gles::Renderer& renderer = stage.renderer();
    if (changes.weights) {
      if (auto updated = renderer.update(state.weights()); !updated) return updated;
      realise_ms.push_back(ms_since(start));
    }
    const gles::View view = gles::View::from(state.camera());
    const gles::Lighting lighting = lighting_of(usual_mood(state.camera().name));
    if (!renderer.needs_draw(view, lighting, stage.framebuffer())) return {};
    renderer.draw(view, lighting, stage.framebuffer());
    stage.context().gl().Finish();
    drawn_ms.push_back(ms_since(start));
    return {};
  }
};

}  // namespace

void request_stop() noexcept { stop_requested = 1; }

Result<RunSummary> run(const Options& options) {
  auto pack = packs::PaintPack::open(options.pack);
  if (!pack) return tl::unexpected(pack.error());
  auto scene = packs::read_scene_pack(options.scene);
  if (!scene) return tl::unexpected(scene.error());
  const int paint_count = static_cast<int>(pack->paint().paints.size());
  std::optional<input::ScriptPlayer> player;
  if (!options.input_script.empty()) {
    auto steps = input::read_script(options.input_script);
    if (!steps) return tl::unexpected(steps.error());
    player.emplace(std::move(*steps), first_paint(paint_count).base);
  }
  if (!options.record.empty())
    if (auto made = make_folder(options.record); !made) return tl::unexpected(made.error());
  auto stage =
      Stage::create(options.backend, options.size.width, options.size.height, std::move(*pack), std::move(*scene));
  if (!stage) return tl::unexpected(stage.error());

  Session session{**stage, State(paint_count, (*stage)->scene().cameras), std::move(player), {}, {}};
  if (auto updated = (*stage)->renderer().update(session.state.weights()); !updated)
    return tl::unexpected(updated.error());
  (*stage)->renderer().prepare(lighting_of(usual_mood(session.state.camera().name)));

  RunSummary summary;
  const auto start = Clock::now();
  while (stop_requested == 0) {
    const bool virtual_clock = options.frames.has_value();
    const double now_ms = virtual_clock ? static_cast<double>(summary.frames) * frame_ms : ms_since(start);
    if (auto stepped = session.step(now_ms); !stepped) return tl::unexpected(stepped.error());
    if (!options.record.empty())
      if (auto written = record_frame(**stage, session.state, options, summary.frames); !written)
        return tl::unexpected(written.error());
    ++summary.frames;
    if (virtual_clock) {
      if (summary.frames >= static_cast<std::uint64_t>(*options.frames)) break;
      continue;
    }
    if (session.player && session.player->finished()) break;
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double, std::milli>(now_ms + frame_ms)));
  }
  summary.drawn = session.drawn_ms.size();
  if (!options.screenshot.empty()) {
    const auto image = (*stage)->renderer().still(gles::View::from(session.state.camera()),
                                                  lighting_of(usual_mood(session.state.camera().name)),
                                                  (*stage)->framebuffer(), screenshot_samples);
    if (auto written = gles::write_png(image, options.screenshot); !written) return tl::unexpected(written.error());
  }
  summary.uploaded_bytes = (*stage)->renderer().uploads().bytes;
  summary.drawn_ms_median = median(std::move(session.drawn_ms));
  summary.realise_ms_median = median(std::move(session.realise_ms));
  return summary;
}

}  // namespace lackwerk::kiosk
