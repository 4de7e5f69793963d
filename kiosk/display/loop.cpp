#include "kiosk/display/loop.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "kiosk/display/choices.hpp"
#include "kiosk/display/devices.hpp"
#include "kiosk/display/live.hpp"
#include "kiosk/display/output/seat.hpp"
#include "kiosk/display/output/vt.hpp"
#include "kiosk/display/recording.hpp"
#include "kiosk/display/waiting.hpp"
#include "packs/scene_pack.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::kiosk {
namespace {

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_requested = 0;

struct Content {
  ShownPack shown;
  packs::Scene scene;
};

Result<Content> open_content(const Options& options, PackSource& source) {
  auto pack = source.first();
  if (!pack) return tl::unexpected(pack.error());
  auto scene = packs::read_scene_pack(options.config.scene);
  if (!scene) return tl::unexpected(scene.error());
  return Content{std::move(*pack), std::move(*scene)};
}

bool by_hand(input::ControlKind kind) {
  using input::ControlKind;
  return kind == ControlKind::touch_down || kind == ControlKind::touch_move || kind == ControlKind::touch_up ||
         kind == ControlKind::turn || kind == ControlKind::press || kind == ControlKind::release;
}

Result<RunSummary> run_recording(const Options& options) {
  PackSource source(options.config.packs);
  auto content = open_content(options, source);
  if (!content) return tl::unexpected(content.error());
  const auto backend =
      options.config.output.platform == Platform::osmesa ? gles::Backend::osmesa : gles::Backend::egl_surfaceless;
  auto stage = Stage::create(backend, options.config.output.size_px[0], options.config.output.size_px[1],
                             std::move(content->shown.pack), std::move(content->scene), options.config.output.context);
  if (!stage) return tl::unexpected(stage.error());
  return record(options, **stage, content->shown.is_vouched);
}

Result<RunSummary> run_live(const Options& options) {
  Log log(stderr, stderr_is_journal());
  Service service;
  PackSource source(options.config.packs);
  auto content = open_content(options, source);
  if (!content) return tl::unexpected(content.error());
  auto seat = Seat::open(options.headless() ? "direct" : options.config.seat, log);
  if (!seat) return tl::unexpected(seat.error());
  // Before the output: it restores its picture first and the terminal last.
  const auto console = options.headless() ? nullptr : Console::acquire((*seat)->holds_console(), log);
  auto opened = open_output(options.config.output, **seat, log);
  if (!opened) return tl::unexpected(opened.error());
  Output& output = *opened->output;
  const auto size = output.state() == OutputState::running
                        ? picture_size(output.mode().rotation, output.mode().panel_px)
                        : options.config.output.size_px;
  auto stage =
      Stage::create(output.context(), size[0], size[1], std::move(content->shown.pack), std::move(content->scene));
  if (!stage) return tl::unexpected(stage.error());
  auto interface = open_interface(options, **stage, content->shown.is_vouched, log);
  if (!interface) return tl::unexpected(interface.error());
  auto script = open_script(options, (*interface)->shown());
  if (!script) return tl::unexpected(script.error());
  Picture picture(**stage, options.config.picture);
  if (auto prepared = picture.prepare((*interface)->shown()); !prepared) return tl::unexpected(prepared.error());

  LiveSettings settings;
  if (const char* folder = std::getenv("RUNTIME_DIRECTORY")) settings.status_folder = folder;
  settings.profile = options.config.output.profile;
  settings.pack_file = content->shown.file;
  settings.pack_signed = content->shown.is_signed;
  settings.packs = &source;
  if (!content->shown.is_signed) log.write(Priority::warning, content->shown.file + " is not signed");
  for (const RefusedPlatform& refused : opened->refused)
    settings.refused.push_back({platform_name(refused.platform), refused.why.line()});
  settings.choices_folder = choices_folder();
  settings.visit = script->visit;
  Live live(output, **stage, picture, **interface,
            options.headless() ? Devices{} : open_devices(options.config, **seat, log), std::move(script->player), log,
            service, std::move(settings));

  const HeldSignals signals;
  RunSummary summary;
  std::vector<int> descriptors;
  while (!stop_asked()) {
    (*seat)->dispatch();
    if (auto stepped = live.step(monotonic_ms()); !stepped) {
      live.stop();
      return tl::unexpected(stepped.error());
    }
    ++summary.frames;
    if (live.finished() || (options.frames && live.handed_over() >= static_cast<std::uint64_t>(*options.frames))) break;
    descriptors.clear();
    live.add_descriptors(descriptors);
    if ((*seat)->fd() >= 0) descriptors.push_back((*seat)->fd());
    wait(descriptors, live.wake_at_ms(monotonic_ms()), signals.before());
  }
  live.stop();
  summary.presented = output.presented();
  return summarise(options, **stage, picture, **interface, summary);
}

}  // namespace

void request_stop() noexcept { stop_requested = 1; }
bool stop_asked() noexcept { return stop_requested != 0; }

Result<OpenedScript> open_script(const Options& options, const State& state) {
  if (options.input_script.empty()) return OpenedScript{};
  auto steps = input::read_script(options.input_script);
  if (!steps) return tl::unexpected(steps.error());
  OpenedScript opened;
  opened.visit = !steps->empty() && !by_hand(steps->front().control.kind);
  opened.player.emplace(std::move(*steps), state.weights().base);
  return opened;
}

Result<std::unique_ptr<Interface>> open_interface(const Options& options, Stage& stage, bool vouched, Log& log) {
  InterfaceSettings settings = options.config.interface;
  settings.vouched = vouched;
  if (const auto folder = choices_folder(); !folder.empty()) {
    const auto choices = read_choices(folder, choices_of(settings.experience));
    if (!choices)
      log.error(choices.error());
    else if (*choices)
      settings.experience = with_choices(settings.experience, **choices);
  }
  return Interface::create(stage, settings, log);
}

Result<RunSummary> summarise(const Options& options, Stage& stage, Picture& picture, Interface& interface,
                             RunSummary summary) {
  summary.drawn = picture.drawn();
  summary.refined = picture.refined();
  summary.quality = picture.quality();
  summary.drawn_ms_median = picture.drawn_ms_median();
  summary.realise_ms_median = picture.realise_ms_median();
  if (!options.screenshot.empty()) {
    // What the kiosk would converge to; it is left in the framebuffer.
    (void)picture.still(interface.shown(), std::max(options.config.picture.still_frames, 1));
    const auto composed = interface.compose(stage.framebuffer());
    if (!composed) return tl::unexpected(composed.error());
    if (auto written = gles::write_png((*composed)->read(), options.screenshot); !written)
      return tl::unexpected(written.error());
  }
  summary.uploaded_bytes =
      stage.shows_scans() ? stage.scan_renderer().uploaded_bytes() : stage.renderer().uploads().bytes;
  return summary;
}

Result<RunSummary> run(const Options& options) {
  return options.frames && options.headless() ? run_recording(options) : run_live(options);
}

}  // namespace lackwerk::kiosk
