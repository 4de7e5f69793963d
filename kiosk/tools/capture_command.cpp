#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/find_recipe.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::tools {
namespace {

struct CaptureOptions {
  std::string recipe, out;
  packs::GoniometerSettings settings;
  bool json = false;
};

int run_capture(const CaptureOptions& options) {
  const auto recipe = packs::read_recipe(find_recipe(options.recipe));
  if (!recipe) return report(recipe.error());
  Progress progress("capture", options.json);
  const auto capture = packs::measure(*recipe, options.settings, [&](int done, int total) {
    progress.update(0.9 * done / total, "slice " + std::to_string(done) + " of " + std::to_string(total));
  });
  if (!capture) return report(capture.error());
  progress.update(0.9, "writing");
  if (const auto written = packs::write_capture(*capture, options.out); !written) return report(written.error());
  if (options.json) {
    const nlohmann::ordered_json out{{"name", capture->identity.name},   {"folder", options.out},
                                     {"slices", capture->slices.size()}, {"edge_texels", capture->edge_texels},
                                     {"texel_mm", capture->texel_mm},    {"seconds", progress.elapsed_s()}};
    print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_done;
  }
  print(options.out + ": " + one_line(capture->identity.name) + ", " + std::to_string(capture->slices.size()) +
        " slices of " + std::to_string(capture->edge_texels) + " texels, " + fixed(progress.elapsed_s(), 1) + " s");
  return exit_done;
}

}  // namespace

void add_capture_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CaptureOptions>();
  packs::GoniometerSettings& settings = options->settings;
  settings.threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 64u));
  CLI::App* command = app.add_subcommand("capture", "Virtual goniometer: photographs a recipe into a capture folder");
  command->add_option("RECIPE", options->recipe, "recipe file, or the name of one that comes with the program")
      ->required();
  command->add_option("-o,--output", options->out, "capture folder to write")->required();
  command->add_option("--edge", settings.edge_texels, "texels per slice edge")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--texel-mm", settings.texel_mm, "edge of a texel on the paint, millimetres")
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "of the flakes' places")->capture_default_str();
  command->add_option("--threads", settings.threads, "no effect on the result")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_capture(*options); });
}

}  // namespace lackwerk::tools
