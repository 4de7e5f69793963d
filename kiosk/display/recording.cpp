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

}  // namespace

Result<RunSummary> record(const Options& options, Stage& stage) {
  State state(static_cast<int>(stage.pack().paint().paints.size()), stage.scene().cameras);
  auto player = open_script(options, state);
  if (!player) return tl::unexpected(player.error());
  if (!options.record.empty())
    if (auto made = make_folder(options.record); !made) return tl::unexpected(made.error());

  Picture picture(stage, options.config.picture);
  if (auto prepared = picture.prepare(state); !prepared) return tl::unexpected(prepared.error());
  RunSummary summary;
  const auto count = static_cast<std::uint64_t>(*options.frames);
  for (; summary.frames < count && !stop_asked(); ++summary.frames) {
    bool weights_changed = false;
    if (*player)
      for (const input::Control& event : (*player)->advance(static_cast<double>(summary.frames) * frame_ms))
        weights_changed |= state.apply(event).weights;
    if (auto stepped = picture.step(state, weights_changed); !stepped) return tl::unexpected(stepped.error());
    if (options.record.empty()) continue;
    // As shown, or smoother: with several samples the frame is drawn again, moved by parts of a pixel.
    const gles::Image image =
        options.record_samples == 1 ? stage.framebuffer().read() : picture.still(state, options.record_samples);
    if (auto written = gles::write_png(image, frame_path(options.record, summary.frames)); !written)
      return tl::unexpected(written.error());
  }
  return summarise(options, stage, picture, state, summary);
}

}  // namespace lackwerk::kiosk
