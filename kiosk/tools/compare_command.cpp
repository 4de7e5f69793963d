#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/tools/difference_picture.hpp"

namespace lackwerk::tools {
namespace {

struct CompareOptions {
  std::string a, b, mask, map;
  std::optional<double> max_mean, max_p95;
  bool json = false;
};

Result<packs::LinearImage> read_quietly(const std::string& path) {
  const QuietStderr quiet;
  return packs::read_image(path);
}

Result<void> write_quietly(const std::string& path, const packs::LinearImage& a, const packs::LinearImage& b,
                           const std::vector<float>& map, const std::string& note) {
  const QuietStderr quiet;
  return packs::write_difference_picture(path, a, b, map, note);
}

Result<packs::PixelMask> read_mask(const CompareOptions& options) {
  if (options.mask.empty()) return packs::PixelMask();
  const auto image = read_quietly(options.mask);
  if (!image) return tl::unexpected(image.error());
  return packs::mask_of(*image);
}

std::string text_of(const packs::ImageDifference& difference) {
  return "CIEDE2000 of " + std::to_string(difference.pixels) + " pixels: mean " + fixed(difference.mean, 4) + ", p95 " +
         fixed(difference.p95, 4) + ", p99 " + fixed(difference.p99, 4) + ", max " + fixed(difference.max, 4);
}

void print_difference(const packs::ImageDifference& difference, const packs::LinearImage& image, bool json) {
  if (!json) {
    print(text_of(difference));
    return;
  }
  const nlohmann::ordered_json out{{"metric", "CIEDE2000"},       {"width", image.width},    {"height", image.height},
                                   {"pixels", difference.pixels}, {"mean", difference.mean}, {"p95", difference.p95},
                                   {"p99", difference.p99},       {"max", difference.max}};
  print(out.dump());
}

/// The first limit that is exceeded is the error.
Result<void> check_limits(const CompareOptions& options, const packs::ImageDifference& difference) {
  const auto exceeded = [&](const char* name, double value, double limit) {
    return fail(options.b, name, fixed(value, 4) + " is more than " + fixed(limit, 4),
                options.map.empty() ? "--map OUT.png shows where" : options.map + " shows where");
  };
  if (options.max_mean && difference.mean > *options.max_mean)
    return exceeded("mean", difference.mean, *options.max_mean);
  if (options.max_p95 && difference.p95 > *options.max_p95) return exceeded("p95", difference.p95, *options.max_p95);
  return {};
}

int run_compare(const CompareOptions& options) {
  const auto a = read_quietly(options.a);
  if (!a) return report(a.error());
  const auto b = read_quietly(options.b);
  if (!b) return report(b.error());
  const auto mask = read_mask(options);
  if (!mask) return report(mask.error());
  std::vector<float> map;
  auto difference = packs::compare_images(*a, *b, &map, *mask);
  if (!difference) {
    difference.error().file = difference.error().field == "mask" ? options.mask : options.b;
    return report(difference.error());
  }
  if (!options.map.empty()) {
    const auto written = write_quietly(options.map, *a, *b, map, text_of(*difference));
    if (!written) return report(written.error());
  }
  print_difference(*difference, *a, options.json);
  const auto within = check_limits(options, *difference);
  return within ? exit_done : report(within.error());
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "CIEDE2000 statistics of two pictures of one size");
  command->add_option("A", options->a, "first picture (PNG is taken as sRGB, OpenEXR as linear)")->required();
  command->add_option("B", options->b, "second picture")->required();
  command->add_option("--mask", options->mask, "a picture of the same size: only pixels that are white in it count");
  command->add_option("--map", options->map, "write a PNG of A, B and the map of their differences side by side");
  command->add_option("--max-mean", options->max_mean, "fail (exit code 1) if the mean is above this")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--max-p95", options->max_p95, "fail (exit code 1) if the 95th percentile is above this")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace lackwerk::tools
