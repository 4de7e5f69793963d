#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/tools/image_compare.hpp"

namespace lackwerk::tools {
namespace {

struct CompareOptions {
  std::string a, b, map;
  bool json = false;
};

Result<packs::LinearImage> read_quietly(const std::string& path) {
  const QuietStderr quiet;
  return packs::read_image(path);
}

int run_compare(const CompareOptions& options) {
  const auto a = read_quietly(options.a);
  if (!a) return report(a.error());
  const auto b = read_quietly(options.b);
  if (!b) return report(b.error());
  std::vector<float> map;
  auto difference = packs::compare_images(*a, *b, &map);
  if (!difference) {
    difference.error().file = options.b;
    return report(difference.error());
  }
  if (!options.map.empty())
    if (const auto written = packs::write_difference_map(options.map, a->width, a->height, map); !written)
      return report(written.error());
  if (options.json) {
    nlohmann::ordered_json out{{"metric", "CIEDE2000"},    {"width", a->width},      {"height", a->height},
                               {"mean", difference->mean}, {"p95", difference->p95}, {"p99", difference->p99},
                               {"max", difference->max}};
    print(out.dump());
    return exit_done;
  }
  print("CIEDE2000 of " + std::to_string(difference->pixels) + " pixels: mean " + fixed(difference->mean, 4) +
        ", p95 " + fixed(difference->p95, 4) + ", p99 " + fixed(difference->p99, 4) + ", max " +
        fixed(difference->max, 4));
  return exit_done;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "CIEDE2000 statistics of two pictures of one size");
  command->add_option("A", options->a, "first picture (PNG is taken as sRGB, OpenEXR as linear)")->required();
  command->add_option("B", options->b, "second picture")->required();
  command->add_option("--map", options->map, "write a grey PNG of the differences: white is 10 and above");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace lackwerk::tools
