#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/find_recipe.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/svg_plot.hpp"
#include "packs/paint_pack.hpp"
#include "packs/tools/flake_life.hpp"

namespace lackwerk::tools {
namespace {

struct LifeOptions {
  std::string source, pack, paint, out;
  bool json = false;
};

/// One angle: what the source does, and what the pack makes of it.
struct Angle {
  packs::LifeScan scan;
  const char* name;
  const char* label;
  std::optional<core::LifeCurve> source;  ///< nothing where a capture's layout has too few slices
  std::optional<double> source_half_deg;  ///< nothing where the source's slices do not tell
  core::LifeCurve shown;
  double shown_half_deg = 0.0;
};
using Angles = std::array<Angle, 2>;

Result<std::string> curves_of_capture(const std::string& folder, Angles& angles) {
  const auto capture = packs::read_capture(folder);
  if (!capture) return tl::unexpected(capture.error());
  const packs::KnownLife known = packs::known_life(*capture);
  for (Angle& angle : angles) {
    angle.source = packs::slice_curve(*capture, angle.scan);
    if (!angle.scan.along_h && angle.source) angle.source_half_deg = known.life.half_i_deg;
    if (angle.scan.along_h && known.origin != core::LifeOrigin::assumed) angle.source_half_deg = known.life.half_h_deg;
  }
  return capture->identity.name;
}

Result<std::string> curves_of_recipe(const std::string& file, Angles& angles) {
  const auto recipe = packs::read_recipe(find_recipe(file));
  if (!recipe) return tl::unexpected(recipe.error());
  for (Angle& angle : angles) {
    auto curve = packs::source_curve(*recipe, {}, angle.scan);
    if (!curve) return tl::unexpected(curve.error());
    angle.source = std::move(*curve);
    angle.source_half_deg = core::half_width_deg(*angle.source);
  }
  return recipe->identity.name;
}

Result<std::size_t> find_paint(const packs::PaintPack& pack, const LifeOptions& options, const std::string& name) {
  const auto& paints = pack.paint().paints;
  if (pack.paint().layout.slice_count() == 0) return fail(options.pack, "layout", "the pack has no flakes");
  const std::string& wanted = options.paint.empty() ? name : options.paint;
  const auto found =
      std::find_if(paints.begin(), paints.end(), [&](const auto& paint) { return paint.identity.name == wanted; });
  if (found != paints.end()) return static_cast<std::size_t>(found - paints.begin());
  return fail(options.pack, "paints", "has no paint named \"" + wanted + "\"",
              "name one with --paint; `lackwerk pack info` lists them", ErrorKind::usage);
}

std::vector<std::pair<double, double>> points(const core::LifeCurve& curve) {
  std::vector<std::pair<double, double>> out;
  for (std::size_t k = 0; k < curve.correlation.size(); ++k)
    out.emplace_back(static_cast<double>(k) * curve.step_deg, curve.correlation[k]);
  return out;
}

std::string degrees(const std::optional<double>& half) {
  if (!half) return "unknown";
  return *half < double{core::widest_cell_deg} ? fixed(*half, 2) + " degrees" : "beyond the scan";
}

Plot plot_of(const Angle& angle, const std::string& title) {
  Plot plot{
      title, std::string("lag of ") + angle.label + ", degrees inside the coat", "autocorrelation of a texel", 0.0, 1.0,
      {}};
  plot.x_end = static_cast<double>(angle.scan.pictures - angle.scan.starts) * angle.scan.step_deg;
  if (angle.source)
    plot.lines.push_back({"source, half width " + degrees(angle.source_half_deg), points(*angle.source), "#c03020",
                          angle.source->correlation.size() < 12});
  plot.lines.push_back({"shown, half width " + degrees(angle.shown_half_deg), points(angle.shown), "#2050b0", false});
  return plot;
}

nlohmann::ordered_json angle_json(const Angle& angle) {
  const auto number = [](const std::optional<double>& v) { return v ? nlohmann::ordered_json(*v) : nullptr; };
  std::optional<double> ratio;
  if (angle.source_half_deg) ratio = angle.shown_half_deg / *angle.source_half_deg;
  return {{"source_half_width_deg", number(angle.source_half_deg)},
          {"shown_half_width_deg", angle.shown_half_deg},
          {"ratio", number(ratio)},
          {"source", angle.source ? nlohmann::ordered_json(points(*angle.source)) : nullptr},
          {"shown", points(angle.shown)}};
}

int run_life(const LifeOptions& options) {
  Angles angles{{{packs::life_scan_h, "theta_h", "theta_h at theta_i = 0", {}, {}, {}, 0.0},
                 {packs::life_scan_i, "theta_i", "theta_i at theta_h = 0", {}, {}, {}, 0.0}}};
  const auto pack = packs::PaintPack::open(options.pack, packs::Backing::copy);
  if (!pack) return report(pack.error());
  const bool folder = std::filesystem::is_directory(options.source);
  const auto name = folder ? curves_of_capture(options.source, angles) : curves_of_recipe(options.source, angles);
  if (!name) return report(name.error());
  const auto index = find_paint(*pack, options, *name);
  if (!index) return report(index.error());
  std::vector<Plot> plots;
  for (Angle& angle : angles) {
    angle.shown = packs::reconstruction_curve(pack->paint(), *index, angle.scan);
    angle.shown_half_deg = core::half_width_deg(angle.shown);
    plots.push_back(plot_of(angle, *name));
  }
  if (!options.out.empty()) {
    std::ofstream file(options.out, std::ios::binary);
    file << svg_text(plots);
    if (!file.flush()) return report({options.out, "", "cannot be written", "check folder and permissions"});
  }
  if (options.json) {
    nlohmann::ordered_json out{{"name", *name}};
    for (const Angle& angle : angles) out[angle.name] = angle_json(angle);
    print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_done;
  }
  for (const Angle& angle : angles)
    print(one_line(*name) + ", " + angle.label + ": half width of the source " + degrees(angle.source_half_deg) +
          ", as shown " + degrees(angle.shown_half_deg));
  return exit_done;
}

}  // namespace

void add_flake_life_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LifeOptions>();
  CLI::App* command = app.add_subcommand(
      "flake-life", "Angular life of a paint's flakes: autocorrelation of the source and as shown from a pack");
  command->add_option("SOURCE", options->source, "recipe (measured at fine angles) or capture folder (its slices)")
      ->required();
  command->add_option("--pack", options->pack, "paint pack that holds the paint")->required();
  command->add_option("--paint", options->paint, "its name in the pack, where it differs");
  command->add_option("-o,--output", options->out, "write the plot (.svg)");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_life(*options); });
}

}  // namespace lackwerk::tools
