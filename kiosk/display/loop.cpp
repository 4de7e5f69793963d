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
#include "render_gles/governor.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double frame_ms = 1000.0 / 30.0;
/// Samples a pixel of the screenshot: what the kiosk would have converged to by then.
constexpr int screenshot_samples = gles::still_frames;

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

/// What was asked of the loop, minus the stage: so that run() reads as the loop it is.
class Session {
 public:
  Session(Stage& stage, State state, std::optional<input::ScriptPlayer> player, const Options& options)
      : stage_(stage),
        state_(std::move(state)),
        player_(std::move(player)),
        options_(options),
        governor_(options.frame_ms) {
    if (const gles::Rung* rung = gles::find_rung(options.quality)) fixed_ = rung;
  }

  /// Compiles what the first frame needs.
  Result<void> prepare() {
    if (auto updated = stage_.renderer().update(state_.weights()); !updated) return updated;
    stage_.renderer().prepare(view(), lighting(), stage_.framebuffer());
    return {};
  }

  /// Feeds the input up to now; draws if anything changed, else improves what is shown.
  Result<void> step(double now_ms) {
    State::Changes changes;
    if (player_)
      for (const input::Control& event : player_->advance(now_ms)) {
        const auto change = state_.apply(event);
        changes.weights |= change.weights;
        changes.view |= change.view;
      }
    const auto start = Clock::now();
    gles::Renderer& renderer = stage_.renderer();
    if (changes.weights) {
      if (auto updated = renderer.update(state_.weights()); !updated) return updated;
      realise_ms.push_back(ms_since(start));
    }
    // A new quality alone is no reason to draw: it would show as a step in a picture that rests.
    if (!renderer.needs_draw(view(), lighting(), stage_.framebuffer())) return rest();
    quality_ = (fixed_ != nullptr ? *fixed_ : governor_.rung()).quality;
    const std::uint64_t programs = renderer.program_count();
    renderer.draw(view(), lighting(), stage_.framebuffer());
    stage_.context().gl().Finish();
    drawn_ms.push_back(ms_since(start));
    resting_ = false;
    // Frames that compiled something say nothing about the next ones.
    if (programs == renderer.program_count()) governor_.measured(drawn_ms.back());
    return {};
  }

  /// As shown, or smoother: with several samples the frame is drawn again, moved by parts of a pixel.
  Result<void> record(std::uint64_t frame) {
    char name[16];
    std::snprintf(name, sizeof name, "%06u.png", static_cast<unsigned>(frame % 1'000'000));
    const gles::Image image =
        options_.record_samples == 1 ? stage_.framebuffer().read() : still(options_.record_samples);
    return gles::write_png(image, (std::filesystem::path(options_.record) / name).string());
  }

  [[nodiscard]] gles::Image still(int samples) {
    return stage_.renderer().still(view(), lighting(), stage_.framebuffer(), samples);
  }
  [[nodiscard]] bool finished() const { return player_ && player_->finished() && resting_; }
  [[nodiscard]] std::string quality() const {
    return fixed_ != nullptr ? std::string(fixed_->name) : std::string(governor_.rung().name) + " (chosen)";
  }

  std::vector<double> drawn_ms, realise_ms;
  std::uint64_t refined = 0;

 private:
  [[nodiscard]] gles::View view() const { return gles::View::from(state_.camera()); }
  [[nodiscard]] gles::Lighting lighting() const {
    gles::Lighting lighting = lighting_of(usual_mood(state_.camera().name));
    lighting.quality = quality_;
    return lighting;
  }
  Result<void> rest() {
    if (resting_) return {};
    if (options_.still_frames < 2) {
      resting_ = true;
      return {};
    }
    const auto more = stage_.renderer().refine(view(), lighting(), stage_.framebuffer(), options_.still_frames);
    if (!more) return tl::unexpected(more.error());
    stage_.context().gl().Finish();
    ++refined;
    resting_ = !*more;
    return {};
  }

  Stage& stage_;
  State state_;
  std::optional<input::ScriptPlayer> player_;
  const Options& options_;
  gles::Governor governor_;
  const gles::Rung* fixed_ = nullptr;
  gles::Quality quality_;  ///< of the frame on the screen
  bool resting_ = false;   ///< nothing changes and nothing can be improved
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
  auto stage = Stage::create(options.backend, options.size.width, options.size.height, std::move(*pack),
                             std::move(*scene), {.core_es2 = options.core_es2});
  if (!stage) return tl::unexpected(stage.error());

  Session session(**stage, State(paint_count, (*stage)->scene().cameras), std::move(player), options);
  if (auto prepared = session.prepare(); !prepared) return tl::unexpected(prepared.error());

  RunSummary summary;
  const auto start = Clock::now();
  while (stop_requested == 0) {
    const bool virtual_clock = options.frames.has_value();
    const double now_ms = virtual_clock ? static_cast<double>(summary.frames) * frame_ms : ms_since(start);
    if (auto stepped = session.step(now_ms); !stepped) return tl::unexpected(stepped.error());
    if (!options.record.empty())
      if (auto written = session.record(summary.frames); !written) return tl::unexpected(written.error());
    ++summary.frames;
    if (virtual_clock) {
      if (summary.frames >= static_cast<std::uint64_t>(*options.frames)) break;
      continue;
    }
    if (session.finished()) break;
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double, std::milli>(now_ms + frame_ms)));
  }
  summary.drawn = session.drawn_ms.size();
  summary.refined = session.refined;
  summary.quality = session.quality();
  if (!options.screenshot.empty())
    if (auto written = gles::write_png(session.still(screenshot_samples), options.screenshot); !written)
      return tl::unexpected(written.error());
  summary.uploaded_bytes = (*stage)->renderer().uploads().bytes;
  summary.drawn_ms_median = median(std::move(session.drawn_ms));
  summary.realise_ms_median = median(std::move(session.realise_ms));
  return summary;
}

}  // namespace lackwerk::kiosk
