#include "kiosk/display/recording.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>

#include "input/script.hpp"
#include "kiosk/display/picture.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::kiosk {
namespace {

constexpr double frame_ms = 1000.0 / 30.0;
/// A recording is made in no night.
constexpr int noon_minute = 12 * 60;

Result<void> make_folder(const std::string& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return fail(folder, "--record", code.message(), "choose a folder that can be written");
  return {};
}

std::string frame_path(const std::string& folder, std::uint64_t frame) {
  char name[16];
  std::snprintf(name, sizeof name, "%06u.png", static_cast<unsigned>(frame % 1'000'000));
  return (std::filesystem::path(folder) / name).string();
}

/// What is seen, at the options' samples a pixel.
Result<void> write_frame(const Options& options, Stage& stage, Picture& picture, Interface& interface,
                         std::uint64_t frame) {
  // As shown, or smoother: with several samples the frame is drawn again, moved by parts of a pixel.
  if (options.record_samples > 1) (void)picture.still(interface.shown(), options.record_samples);
  const auto composed = interface.compose(stage.framebuffer());
  if (!composed) return tl::unexpected(composed.error());
  return gles::write_png((*composed)->read(), frame_path(options.record, frame));
}

}  // namespace

Result<RunSummary> record(const Options& options, Stage& stage, bool vouched) {
  Log log(stderr);
  auto opened = open_interface(options, stage, vouched, log);
  if (!opened) return tl::unexpected(opened.error());
  Interface& interface = **opened;
  interface.set_surface(Rotation::none, {stage.framebuffer().width(), stage.framebuffer().height()});
  auto script = open_script(options, interface.shown());
  if (!script) return tl::unexpected(script.error());
  if (!options.record.empty())
    if (auto made = make_folder(options.record); !made) return tl::unexpected(made.error());
  // Before the first frame, so that every one of them is the same wherever it is made.
  while (interface.wants_swatch()) interface.make_swatch();

  Picture picture(stage, options.config.picture);
  if (auto prepared = picture.prepare(interface.shown()); !prepared) return tl::unexpected(prepared.error());
  if (script->visit) interface.begin_visit(0.0);
  RunSummary summary;
  const auto count = static_cast<std::uint64_t>(*options.frames);
  for (; summary.frames < count && !stop_asked(); ++summary.frames) {
    const double now_ms = static_cast<double>(summary.frames) * frame_ms;
    Interface::Changes changes;
    if (script->player)
      for (const input::Control& event : script->player->advance(now_ms)) changes |= interface.take(event, now_ms);
    if (auto complaint = interface.take_complaint())
      return fail(options.input_script, "at " + std::to_string(static_cast<long>(now_ms)) + " ms", complaint->what,
                  complaint->remedy);
    changes |= interface.advance(now_ms, noon_minute);
    const bool other = interface.compare(!changes.weights && !picture.differs(interface.shown()));
    if (auto stepped = picture.step(interface.shown(), changes.weights || other); !stepped)
      return tl::unexpected(stepped.error());
    if (options.record.empty()) continue;
    if (auto written = write_frame(options, stage, picture, interface, summary.frames); !written)
      return tl::unexpected(written.error());
  }
  return summarise(options, stage, picture, interface, summary);
}

}  // namespace lackwerk::kiosk
