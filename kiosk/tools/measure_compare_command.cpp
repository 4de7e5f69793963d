#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/tools/angle_table.hpp"
#include "packs/tools/capture_colours.hpp"

namespace lackwerk::tools {
namespace {

using packs::ColourSource;

struct MeasureCompareOptions {
  std::string a, b;
  ColourSource from_a = ColourSource::automatic, from_b = ColourSource::automatic;
  std::optional<double> max_mean, max_worst;
  bool json = false;
};

/// A capture's folder, or a spectrophotometer's table.
Result<packs::Capture> read_either(const std::string& path) {
  const QuietStderr quiet;
  const std::filesystem::path file(path);
  std::error_code code;
  if (std::filesystem::is_regular_file(file, code) && file.filename() != "paint.toml")
    return packs::read_angle_table(file);
  return packs::read_capture(file);
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string lab_text(const glm::dvec3& lab) {
  return padded(fixed(lab.x, 2), 8) + padded(fixed(lab.y, 2), 8) + padded(fixed(lab.z, 2), 8);
}

std::string names_of(const std::vector<core::MeasuringAngle>& angles) {
  std::string out;
  for (const core::MeasuringAngle& angle : angles) out += (out.empty() ? "" : ", ") + core::angle_name(angle);
  return out;
}

nlohmann::ordered_json side_json(const packs::Capture& capture, ColourSource source) {
  return {{"name", capture.identity.name},
          {"source", capture.identity.source},
          {"provenance", core::provenance_name(capture.identity.lobes)},
          {"of", packs::source_name(source)}};
}

void print_json(const packs::Capture& a, const packs::Capture& b, const packs::CaptureComparison& comparison) {
  const auto lab_json = [](const glm::dvec3& lab) { return nlohmann::ordered_json{lab.x, lab.y, lab.z}; };
  nlohmann::ordered_json out{{"metric", "CIEDE2000"},
                             {"a", side_json(a, comparison.a)},
                             {"b", side_json(b, comparison.b)},
                             {"mean", comparison.at.mean},
                             {"worst", comparison.at.angles[comparison.at.worst].ciede2000},
                             {"worst_angle", core::angle_name(comparison.at.angles[comparison.at.worst].angle)},
                             {"angles", nlohmann::json::array()},
                             {"left_out", nlohmann::json::array()}};
  for (const core::AngleDifference& d : comparison.at.angles)
    out["angles"].push_back({{"angle", core::angle_name(d.angle)},
                             {"light_deg", d.angle.light_deg},
                             {"aspecular_deg", d.angle.aspecular_deg},
                             {"lab_a", lab_json(d.lab_a)},
                             {"lab_b", lab_json(d.lab_b)},
                             {"ciede2000", d.ciede2000}});
  for (const core::MeasuringAngle& angle : comparison.left_out) out["left_out"].push_back(core::angle_name(angle));
  print(out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_text(const packs::Capture& a, const packs::Capture& b, const packs::CaptureComparison& comparison) {
  const auto side = [](const packs::Capture& capture, ColourSource source) {
    return capture.identity.name + " (" + packs::source_name(source) + ", " +
           core::provenance_name(capture.identity.lobes) + "; " + capture.identity.source + ")";
  };
  print(one_line("A: " + side(a, comparison.a)));
  print(one_line("B: " + side(b, comparison.b)));
  print("   angle     L*A     a*A     b*A     L*B     a*B     b*B  CIEDE2000");
  for (const core::AngleDifference& d : comparison.at.angles)
    print(padded(core::angle_name(d.angle), 8) + lab_text(d.lab_a) + lab_text(d.lab_b) +
          padded(fixed(d.ciede2000, 2), 11));
  const core::AngleDifference& worst = comparison.at.angles[comparison.at.worst];
  print("CIEDE2000 over " + std::to_string(comparison.at.angles.size()) + " angles: mean " +
        fixed(comparison.at.mean, 2) + ", worst " + fixed(worst.ciede2000, 2) + " at " + core::angle_name(worst.angle));
  if (!comparison.left_out.empty()) print("not compared, known to one of them alone: " + names_of(comparison.left_out));
}

Result<void> check_limits(const MeasureCompareOptions& options, const core::AngleComparison& comparison) {
  const core::AngleDifference& worst = comparison.angles[comparison.worst];
  if (options.max_mean && comparison.mean > *options.max_mean)
    return fail(options.b, "mean", fixed(comparison.mean, 4) + " is more than " + fixed(*options.max_mean, 4),
                "the table shows where");
  if (options.max_worst && worst.ciede2000 > *options.max_worst)
    return fail(options.b, core::angle_name(worst.angle),
                fixed(worst.ciede2000, 4) + " is more than " + fixed(*options.max_worst, 4),
                "the table shows the others");
  return {};
}

int run_measure_compare(const MeasureCompareOptions& options) {
  const auto a = read_either(options.a);
  if (!a) return report(a.error());
  const auto b = read_either(options.b);
  if (!b) return report(b.error());
  const auto comparison = packs::compare_captures(*a, options.from_a, options.a, *b, options.from_b, options.b);
  if (!comparison) return report(comparison.error());
  options.json ? print_json(*a, *b, *comparison) : print_text(*a, *b, *comparison);
  const auto within = check_limits(options, comparison->at);
  return within ? exit_done : report(within.error());
}

}  // namespace

void add_measure_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MeasureCompareOptions>();
  CLI::App* command = app.add_subcommand("measure-compare", "CIEDE2000 of two captures at the standard angles");
  command->add_option("A", options->a, "a capture folder, or the CSV table of a spectrophotometer")->required();
  command->add_option("B", options->b, "another one")->required();
  const std::map<std::string, ColourSource> words{{"auto", ColourSource::automatic},
                                                  {"angles", ColourSource::angles},
                                                  {"brdf", ColourSource::brdf},
                                                  {"model", ColourSource::model}};
  command->add_option("--of-a", options->from_a, "which part of A: what was measured before the model, or one of them")
      ->transform(CLI::CheckedTransformer(words));
  command->add_option("--of-b", options->from_b, "which part of B")->transform(CLI::CheckedTransformer(words));
  command->add_option("--max-mean", options->max_mean, "fail (exit code 1) if the mean is above this")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--max-worst", options->max_worst, "fail (exit code 1) if an angle is above this")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_measure_compare(*options); });
}

}  // namespace lackwerk::tools
