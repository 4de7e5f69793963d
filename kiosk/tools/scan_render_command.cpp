#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/display/stage.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/render_options.hpp"
#include "packs/scan_pack.hpp"
#include "render_gles/scan_renderer.hpp"

namespace lackwerk::tools {
namespace {

struct ScanRenderOptions {
  std::string pack, out, size = "1280x720", backend = "egl";
  double time = 0.0, azimuth_deg = 30.0, height_deg = 12.0;
  std::size_t points = gles::ScanLook{}.most_points;
  float least_spacing_px = gles::ScanLook{}.least_spacing_px, splat_px = 0.0f;
  int frames = 1;
  std::string way = "quickest";
  bool time_given = false, json = false;
};

/// Median ms of a frame while time goes on (so that each differs from the one before).
double frame_ms(gles::ScanRenderer& renderer, const gles::View& view, const gles::ScanLook& look,
                const packs::ScanInfo& info, const gles::Framebuffer& target, const gles::GlApi& gl, int frames) {
  std::vector<double> all;
  const double first = info.states.front().time, span = info.states.back().time - first;
  for (int k = 0; k < frames; ++k) {
    const auto start = std::chrono::steady_clock::now();
    renderer.draw(view, look, first + span * (k + 0.5) / frames, target);
    gl.Finish();
    all.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

int run_render(const ScanRenderOptions& options) {
  const auto backend = parse_backend(options.backend);
  if (!backend) return report(backend.error());
  const auto size = kiosk::parse_size(options.size);
  if (!size) return report(size.error());
  const auto pack = packs::ScanPack::open(options.pack, packs::Backing::copy);
  if (!pack) return report(pack.error());
  const auto context = gles::create_context(*backend);
  if (!context) return report(context.error());
  auto target = gles::Framebuffer::create(**context, size->width, size->height);
  if (!target) return report(target.error());
  gles::ScanRenderer renderer(**context);
  renderer.set_pack(*pack);
  const gles::View view =
      renderer.view_from(options.azimuth_deg, options.height_deg, static_cast<double>(size->width) / size->height);
  gles::ScanLook look;
  look.most_points = options.points;
  look.least_spacing_px = options.least_spacing_px;
  if (options.splat_px > 0.0f) look.least_splat_px = look.most_splat_px = options.splat_px;
  if (options.way != "quickest") look.way = options.way == "cpu" ? gles::ScanWay::cpu : gles::ScanWay::shaders;
  const double time = options.time_given ? options.time : pack->info().states.back().time;
  double ms = 0.0;
  if (options.frames > 1) ms = frame_ms(renderer, view, look, pack->info(), *target, (*context)->gl(), options.frames);
  renderer.draw(view, look, time, *target);
  if (const auto written = gles::write_png(target->read(), options.out); !written) return report(written.error());
  nlohmann::ordered_json out{{"out", options.out},
                             {"renderer", (*context)->info().renderer},
                             {"points", renderer.drawn_points()},
                             {"gpu_bytes", renderer.gpu_bytes()}};
  if (options.frames > 1) out["frame_ms"] = ms;
  if (options.json)
    print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    print(options.out + ": " + std::to_string(renderer.drawn_points()) + " points" +
          (options.frames > 1 ? ", median " + fixed(ms, 1) + " ms a frame" : ""));
  return exit_done;
}

}  // namespace

void add_scan_render_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ScanRenderOptions>();
  CLI::App* command =
      command_group(app, "scan", "Scans that grow").add_subcommand("render", "A picture of a scan pack at any time");
  command->add_option("PACK", options->pack, "scan pack")->required();
  command->add_option("-o,--output", options->out, "picture to write (.png)")->required();
  CLI::Option* time =
      command->add_option("--time", options->time, "in the pack's own unit; without it the last scan's");
  command->add_option("--azimuth", options->azimuth_deg, "degrees, where the camera stands")->capture_default_str();
  command->add_option("--height", options->height_deg, "degrees above the horizon")
      ->check(CLI::Range(-89.0, 89.0))
      ->capture_default_str();
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command->add_option("--backend", options->backend, "egl or osmesa")->capture_default_str();
  command->add_option("--points", options->points, "at most that many are drawn")->capture_default_str();
  command
      ->add_option("--least-spacing", options->least_spacing_px,
                   "pixels between neighbours below which points are thinned; 0: none are")
      ->check(CLI::Range(0.0, 64.0))
      ->capture_default_str();
  command->add_option("--splat", options->splat_px, "every point this many pixels wide; 0: as wide as it takes")
      ->check(CLI::Range(0.0, 64.0))
      ->capture_default_str();
  command
      ->add_option("--frames", options->frames, "draws that many more while time goes on, and says how long one takes")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--way", options->way,
                   "who moves and draws the points: shaders, cpu, or quickest: the CPU if the GPU is one too")
      ->check(CLI::IsMember({"quickest", "shaders", "cpu"}))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, time, &exit_code] {
    options->time_given = time->count() > 0;
    exit_code = run_render(*options);
  });
}

}  // namespace lackwerk::tools
