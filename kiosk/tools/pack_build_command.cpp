#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/tools/pack_builder.hpp"

namespace lackwerk::tools {
namespace {

struct BuildOptions {
  std::vector<std::string> folders;
  std::string out;
  packs::PackBuildSettings settings;
  bool json = false;
};

void print_json(const packs::BuiltPack& built, const packs::PackContents& contents, double seconds) {
  nlohmann::ordered_json out{{"id", built.info.id},
                             {"serial", built.info.serial},
                             {"seconds", seconds},
                             {"transport_cost_lab", built.info.transport_cost},
                             {"beyond_limit", built.info.beyond_limit},
                             {"beyond_stop", built.beyond_stop},
                             {"captured_slices", built.captured_slices},
                             {"slices", built.data.frame.layout.slice_count()},
                             {"paints", nlohmann::json::array()}};
  for (std::size_t k = 0; k < built.data.parts.size(); ++k)
    out["paints"].push_back({{"name", built.data.parts[k].identity.name},
                             {"bytes", packs::paint_bytes(contents.paint, k)},
                             {"flake_w1_mean_lab", built.info.errors[k].flake_w1_mean},
                             {"flake_w1_max_lab", built.info.errors[k].flake_w1_max}});
  print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

int run_build(const BuildOptions& options) {
  Progress progress("pack build", options.json);
  const std::vector<std::filesystem::path> folders(options.folders.begin(), options.folders.end());
  const auto built = packs::build_pack_from_folders(
      folders, options.settings, [&](double fraction, std::string_view stage) { progress.update(fraction, stage); });
  if (!built) return report(built.error());
  const packs::PackContents contents = built->contents();
  if (const auto written = packs::write_paint_pack(options.out, contents); !written) return report(written.error());
  const double seconds = progress.elapsed_s();
  if (options.json) {
    print_json(*built, contents, seconds);
    return exit_done;
  }
  for (std::size_t k = 0; k < contents.paint.paints.size(); ++k)
    print(one_line(contents.paint.paints[k].identity.name) + ": " +
          fixed(static_cast<double>(packs::paint_bytes(contents.paint, k)) / 1e6, 2) + " MB, mean flake W1 " +
          fixed(static_cast<double>(built->info.errors[k].flake_w1_mean), 3) + " Lab");
  const int kept = built->data.frame.layout.slice_count();
  if (kept < built->captured_slices)
    print("left out: " + std::to_string(built->captured_slices - kept) + " of " +
          std::to_string(built->captured_slices) + " slices: no light reaches their angles below the coat");
  print("beyond: mixes may go " + fixed(built->info.beyond_limit, 2) + " beyond a paint" +
        (built->beyond_stop.empty() ? "" : "; with more, " + one_line(built->beyond_stop)));
  std::error_code code;
  const auto bytes = std::filesystem::file_size(options.out, code);
  print(options.out + ": " + fixed(code ? 0.0 : static_cast<double>(bytes) / 1e6, 2) + " MB in " + fixed(seconds, 1) +
        " s");
  return exit_done;
}

}  // namespace

void add_pack_build_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BuildOptions>();
  packs::PackBuildSettings& settings = options->settings;
  settings.id.clear();
  CLI::App* command =
      command_group(app, "pack", "Paint packs").add_subcommand("build", "Build a paint pack from 1 to 5 captures");
  command->add_option("DIR", options->folders, "capture folders, in the order of the paints")->required();
  command->add_option("-o,--output", options->out, "paint pack to write (.lwp)")->required();
  command->add_option("--id", settings.id, "letters, digits, dots, dashes, underscores; without it the file's name");
  command->add_option("--serial", settings.serial, "grows with every release of an id")->capture_default_str();
  command->add_option("--seed", settings.random_seed, "of the random textures")->capture_default_str();
  command->add_option("--clusters", settings.clusters.max_clusters, "most clusters per slice and mip level")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  command->add_option("--threads", settings.threads, "0 = as many as the machine has; no effect on the result")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_flag("--all-slices", settings.keep_all_slices,
                    "keep slices whose angles no light reaches below the paints' coats");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] {
    if (options->settings.id.empty()) options->settings.id = std::filesystem::path(options->out).stem().string();
    exit_code = run_build(*options);
  });
}

}  // namespace lackwerk::tools
