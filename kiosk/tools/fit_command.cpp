#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/analysis/brdf_fit.hpp"
#include "core/analysis/brdf_fit_model.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/fit_engine.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/capture_error.hpp"
#include "packs/tools/fit_picture.hpp"
#include "packs/tools/map_fit.hpp"

namespace lackwerk::tools {
namespace {

/// Pixels along an edge of the sphere that is looked at.
constexpr int picture_edge = 320;

struct FitCommandOptions {
  std::string source, out, picture, colour = "lobes", engine;
  int lobes = 3, table_nodes = 46;
  double ior = 1.5;
  bool json = false;
};

struct Outcome {
  core::AnalyticPaint paint;
  std::optional<core::BrdfFit> fit;  ///< none for a map: nothing was searched for
  packs::FormError error;
  double fit_s = 0.0, judge_s = 0.0;
};

core::BrdfSample sample_of(const packs::AngleReading& reading) {
  const packs::ReadingSample at = packs::reading_sample(reading);
  core::BrdfSample sample;
  sample.in = at.directions.in;
  sample.out = at.directions.out;
  sample.rgb = at.brdf;
  return sample;
}

std::vector<core::BrdfSample> samples_of(const packs::Capture& capture, const core::Brdf& known) {
  std::vector<core::BrdfSample> samples;
  for (const packs::AngleReading& reading : capture.angles) {
    samples.push_back(sample_of(reading));
    if (known) samples.back().known = known(samples.back().in, samples.back().out);
  }
  return samples;
}

/// The mean flakes as a BRDF: the fit must leave room for them. Empty without flakes.
core::Brdf flakes_brdf(const packs::Capture& capture) {
  core::MeanFlakes mean = packs::mean_flakes(capture);
  if (!mean) return {};
  return [mean](const glm::dvec3& in, const glm::dvec3& out) {
    const core::FitPoint at = core::fit_point(in, out);
    return mean(at.theta_h, at.theta_d) / std::numbers::pi;
  };
}

Result<Outcome> search(const packs::Capture& capture, const FitCommandOptions& options) {
  core::FitOptions fit_options;
  fit_options.lobes = options.lobes;
  fit_options.colour = options.colour == "table" ? core::FitColour::table : core::FitColour::lobes;
  fit_options.table_nodes = static_cast<std::uint16_t>(options.table_nodes);
  fit_options.known = flakes_brdf(capture);
  auto fit = capture.measured ? core::fit_brdf(*capture.measured, fit_options)
                              : core::fit_brdf(samples_of(capture, fit_options.known), fit_options);
  if (!fit) return tl::unexpected(fit.error());
  Outcome out;
  out.paint = fit->paint;
  out.fit = std::move(*fit);
  return out;
}

Result<Outcome> take_map(const packs::Capture& capture, const FitCommandOptions& options) {
  auto paint = packs::map_capture(capture, options.ior, static_cast<std::uint16_t>(options.table_nodes));
  if (!paint) return tl::unexpected(paint.error());
  Outcome out;
  out.paint = std::move(*paint);
  return out;
}

/// Fits, writes the model into `capture` and judges it there.
Result<Outcome> fit_capture(packs::Capture& capture, const FitCommandOptions& options) {
  Progress progress("fit", options.json);
  progress.update(0.0, capture.measured ? "table" : "angles");
  const bool is_map = options.colour == "map";
  auto out = is_map ? take_map(capture, options) : search(capture, options);
  if (!out) {
    out.error().file = options.source;
    return out;
  }
  out->fit_s = progress.elapsed_s();
  capture.analytic = out->paint;
  capture.is_fitted = true;
  capture.form = is_map ? packs::PaintForm::mapped : packs::PaintForm::fitted;
  progress.update(0.9, "comparing");
  const core::Brdf whole = packs::capture_brdf(capture);
  out->error = packs::capture_error(capture, whole);
  if (capture.measured && !options.picture.empty()) {
    const QuietStderr quiet;
    const auto written =
        packs::write_fit_picture(options.picture, packs::compare_fit(*capture.measured, whole, picture_edge));
    if (!written) return tl::unexpected(written.error());
  }
  out->judge_s = progress.elapsed_s() - out->fit_s;
  return out;
}

nlohmann::ordered_json error_json(const core::FitError& error) {
  return {{"values", error.values}, {"rms", error.rms}, {"p95", error.p95}, {"bias", error.bias}};
}

nlohmann::ordered_json fit_json(const core::BrdfFit& fit) {
  nlohmann::ordered_json parameters = nlohmann::json::array(), regions;
  for (const core::FitParameter& p : fit.condition.parameters)
    parameters.push_back({{"name", p.name},
                          {"value", p.value},
                          {"slack", p.slack},  // infinity is null in JSON
                          {"standing", core::standing_name(p.standing)}});
  for (int k = 0; k < core::fit_region_count; ++k)
    regions[core::fit_region_name(static_cast<core::FitRegion>(k))] =
        error_json(fit.errors.regions[static_cast<std::size_t>(k)]);
  return {{"lobes", fit.lobes},
          {"points", fit.points},
          {"masked", fit.masked},
          {"converged", fit.has_converged},
          {"condition", fit.condition.number},
          {"parameters", parameters},
          {"log_error", {{"whole", error_json(fit.errors.whole)}, {"regions", regions}}}};
}

void print_json(const packs::Capture& capture, const Outcome& outcome, const FitCommandOptions& options) {
  nlohmann::ordered_json out{{"name", capture.identity.name},
                             {"folder", options.out.empty() ? options.source : options.out},
                             {"colour", options.colour},
                             {"form", packs::form_name(capture.form)}};
  if (outcome.fit) out.update(fit_json(*outcome.fit));
  const packs::FormError& error = outcome.error;
  out["ciede2000"] = {{"over", packs::judge_name(error.judged_by)},
                      {"count", error.count},
                      {"mean", error.e2000_mean},
                      {"p95", error.e2000_p95},
                      {"max", error.e2000_max}};
  out["seconds"] = {{"fit", outcome.fit_s}, {"compare", outcome.judge_s}};
  print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

/// 0.0123, and 3.1e-08 where fixed digits would hide the number.
std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string error_line(const char* name, const core::FitError& error) {
  if (error.values == 0) return std::string("  ") + name + ": nothing measured";
  return std::string("  ") + name + ": log error rms " + short_number(error.rms) + ", p95 " + short_number(error.p95) +
         ", bias " + short_number(error.bias) + " of " + std::to_string(error.values) + " values";
}

void print_fit(const core::BrdfFit& fit) {
  print(error_line("all", fit.errors.whole));
  for (int k = 0; k < core::fit_region_count; ++k)
    print(error_line(core::fit_region_name(static_cast<core::FitRegion>(k)),
                     fit.errors.regions[static_cast<std::size_t>(k)]));
  print("  condition " + (std::isfinite(fit.condition.number) ? short_number(fit.condition.number) : "infinite") +
        "; parameters, and how far each can move for 1 % of error:");
  for (const core::FitParameter& p : fit.condition.parameters) {
    std::string line = "    " + p.name + " " + short_number(p.value);
    if (std::isfinite(p.slack)) line += " +- " + short_number(p.slack);
    if (p.standing != core::Standing::determined) line += std::string(" (") + core::standing_name(p.standing) + ")";
    print(line);
  }
}

void print_text(const packs::Capture& capture, const Outcome& outcome, const FitCommandOptions& options) {
  std::string line = one_line(capture.identity.name) + ": ";
  if (outcome.fit) {
    line += std::to_string(outcome.fit->lobes) + " lobes, colour by " + options.colour + ", " +
            std::to_string(outcome.fit->points) + " values (" + std::to_string(outcome.fit->masked) + " masked), " +
            fixed(outcome.fit_s, 2) + " s" + (outcome.fit->has_converged ? "" : "; NOT converged");
  } else {
    line += "isochromatic map, coat of index " + fixed(options.ior, 2) + ", " + fixed(outcome.fit_s, 2) + " s";
  }
  print(line);
  const packs::FormError& error = outcome.error;
  print("  CIEDE2000 over " + std::to_string(error.count) + " " + packs::judge_name(error.judged_by) + ": mean " +
        fixed(static_cast<double>(error.e2000_mean), 2) + ", p95 " + fixed(static_cast<double>(error.e2000_p95), 2) +
        ", max " + fixed(static_cast<double>(error.e2000_max), 2));
  if (outcome.fit) print_fit(*outcome.fit);
}

Result<packs::Capture> read_source(const FitCommandOptions& options) {
  const QuietStderr quiet;
  return packs::read_capture(options.source);
}

Result<void> write_fitted(const packs::Capture& capture, const FitCommandOptions& options) {
  const QuietStderr quiet;
  return packs::write_capture(capture, options.out.empty() ? options.source : options.out);
}

int run_fit(const FitCommandOptions& options) {
  auto capture = read_source(options);
  if (!capture) return report(capture.error());
  if (!options.engine.empty()) {
    EngineFitOptions engine;
    engine.source = options.source;
    engine.json = options.json;
    return run_engine_fit(*capture, options.out, engine);
  }
  if (!capture->measured && capture->angles.empty())
    return report({options.source, "measured", "holds nothing that was measured", "make it with `lackwerk import`"});
  const auto outcome = fit_capture(*capture, options);
  if (!outcome) return report(outcome.error());
  const auto written = write_fitted(*capture, options);
  if (!written) return report(written.error());
  options.json ? print_json(*capture, *outcome, options) : print_text(*capture, *outcome, options);
  return exit_done;
}

int run(const FitCommandOptions& options) {
  const auto refuse = [&](const char* field, const char* what, const char* remedy) {
    return report({options.source, field, what, remedy, ErrorKind::usage});
  };
  if (!options.engine.empty() && options.out.empty())
    return refuse("--engine", "needs a folder for its files", "give -o OUT");
  if (!options.engine.empty() && !options.picture.empty())
    return refuse("--picture", "is not for --engine", "its OUT has a compare.png");
  return run_fit(options);
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FitCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "fit", "Fit the paint model to what a capture holds as measured, and write it into the capture");
  command->add_option("DIR", options->source, "capture folder, as `lackwerk import` writes it")->required();
  command->add_option("--lobes", options->lobes, "most Cook-Torrance lobes; fewer where more gain nothing")
      ->check(CLI::Range(0, 3))
      ->capture_default_str();
  command
      ->add_option("--colour", options->colour,
                   "colour per lobe (lobes), grey lobes below a colour table (table), or an isochromatic map (map)")
      ->check(CLI::IsMember({"lobes", "table", "map"}))
      ->capture_default_str();
  command->add_option("--table-nodes", options->table_nodes, "nodes of the colour table along each angle")
      ->check(CLI::Range(2, 256))
      ->capture_default_str();
  command->add_option("--ior", options->ior, "of the clear coat, for --colour map; 1: none")
      ->check(CLI::Range(1.0, 2.5))
      ->capture_default_str();
  command->add_option("--engine", options->engine, "fit what a game engine can draw instead; writes glTF into -o")
      ->check(CLI::IsMember({"ggx"}));
  command->add_option("--picture", options->picture, "write a PNG: measured | fitted | their differences");
  command->add_option("-o,--output", options->out, "write here and leave DIR as it is");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lackwerk::tools
