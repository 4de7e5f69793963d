#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/tools/angle_table.hpp"
#include "packs/tools/brdf_import.hpp"
#include "packs/tools/btf_folder.hpp"
#include "packs/tools/panel_photos.hpp"

namespace lackwerk::tools {
namespace {

struct ImportOptions {
  std::string rgl, merl, btf, angles, photos, out;
  packs::BrdfImportSettings settings;
  bool has_provenance = false;
  bool json = false;
};

/// What any of the importers found.
struct Imported {
  packs::Capture capture;
  packs::ImportNotes notes;
  std::optional<packs::BrdfImportReport> brdf;
};

Result<Imported> import_brdf(const ImportOptions& options) {
  packs::BrdfImportReport report;
  auto capture = options.rgl.empty() ? packs::import_merl(options.merl, options.settings, report)
                                     : packs::import_rgl(options.rgl, options.settings, report);
  if (!capture) return tl::unexpected(capture.error());
  return Imported{std::move(*capture), {}, std::move(report)};
}

/// The other sources say their name and provenance themselves; what the command line says goes before.
Result<Imported> import_other(const ImportOptions& options) {
  Imported out;
  auto capture = !options.btf.empty()      ? packs::import_btf_folder(options.btf, &out.notes)
                 : !options.photos.empty() ? packs::import_panel_photos(options.photos, &out.notes)
                                           : packs::read_angle_table(options.angles);
  if (!capture) return tl::unexpected(capture.error());
  core::PaintIdentity& identity = capture->identity;
  const packs::BrdfImportSettings& settings = options.settings;
  if (!settings.name.empty()) identity.name = settings.name;
  if (!settings.note.empty()) identity.source += "; " + settings.note;
  if (options.has_provenance) identity.lobes = identity.flakes = identity.coat = settings.provenance;
  out.capture = std::move(*capture);
  return out;
}

nlohmann::ordered_json difference_json(const packs::BrdfDifference& difference) {
  return {{"mean", difference.mean},
          {"p95", difference.p95},
          {"max", difference.max},
          {"directions", difference.directions}};
}

nlohmann::ordered_json brdf_json(const packs::BrdfImportReport& report) {
  nlohmann::ordered_json albedo = nlohmann::json::array();
  for (std::size_t k = 0; k < report.health.albedo.size(); ++k) {
    const glm::dvec3& value = report.health.albedo[k];
    albedo.push_back({{"theta_in_deg", report.health.theta_in_deg[k]}, {"rgb", {value.x, value.y, value.z}}});
  }
  nlohmann::ordered_json out{{"cells", report.cells},
                             {"holes", report.holes},
                             {"negative_share", report.negative_share},
                             {"albedo", albedo},
                             {"highest_albedo", report.highest_albedo},
                             {"reciprocity",
                              {{"mean", report.health.mean_reciprocity},
                               {"p95", report.health.p95_reciprocity},
                               {"worst", report.health.worst_reciprocity},
                               {"weighted", report.health.weighted_reciprocity},
                               {"pairs", report.health.pairs}}}};
  if (report.resampling) out["resampling_ciede2000"] = difference_json(*report.resampling);
  if (report.from_file) out["from_file_ciede2000"] = difference_json(*report.from_file);
  return out;
}

void print_json(const Imported& found, const ImportOptions& options, double seconds) {
  const core::PaintIdentity& identity = found.capture.identity;
  nlohmann::ordered_json out{{"name", identity.name},
                             {"source", identity.source},
                             {"provenance", core::provenance_name(identity.lobes)},
                             {"folder", options.out},
                             {"fitted", found.capture.is_fitted},
                             {"slices", found.capture.slices.size()},
                             {"angles", found.capture.angles.size()},
                             {"notes", found.notes},
                             {"seconds", seconds}};
  if (found.brdf) out["brdf"] = brdf_json(*found.brdf);
  print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_brdf(const packs::BrdfImportReport& report) {
  print("  " + std::to_string(report.cells) + " cells above the horizon, " + std::to_string(report.holes) + " holes");
  std::string energy = "  albedo at most " + fixed(report.highest_albedo, 3);
  if (report.highest_albedo > 1.0) energy += " (more light out than in: the file's error)";
  if (report.negative_share > 0.0)
    energy += "; " + fixed(100.0 * report.negative_share, 2) + " % of colours lay outside sRGB and were cut";
  print(energy);
  const core::BrdfHealth& health = report.health;
  print("  reciprocity: " + fixed(100.0 * health.mean_reciprocity, 1) + " % mean, " +
        fixed(100.0 * health.p95_reciprocity, 1) + " % p95, " + fixed(100.0 * health.worst_reciprocity, 1) +
        " % worst of " + std::to_string(health.pairs) + " pairs; weighted with the light " +
        fixed(100.0 * health.weighted_reciprocity, 2) + " %");
  const auto line = [](const char* what, const packs::BrdfDifference& difference) {
    print(std::string("  ") + what + ": CIEDE2000 mean " + fixed(difference.mean, 2) + ", p95 " +
          fixed(difference.p95, 2) + ", max " + fixed(difference.max, 2) + " at " +
          std::to_string(difference.directions) + " directions");
  };
  if (report.resampling) line("resampling", *report.resampling);
  if (report.from_file) line("table against file, reciprocity included", *report.from_file);
}

int run_import(const ImportOptions& options) {
  Progress progress("import", options.json);
  progress.update(0.0, "reading");
  const auto found = options.rgl.empty() && options.merl.empty() ? import_other(options) : import_brdf(options);
  if (!found) return report(found.error());
  progress.update(0.8, "writing");
  if (const auto written = packs::write_capture(found->capture, options.out); !written) return report(written.error());
  if (options.json) {
    print_json(*found, options, progress.elapsed_s());
    return exit_done;
  }
  const packs::Capture& capture = found->capture;
  std::string line = options.out + ": " + one_line(capture.identity.name) + ", " +
                     core::provenance_name(capture.identity.lobes) + ", ";
  if (!capture.slices.empty()) line += std::to_string(capture.slices.size()) + " slices, ";
  if (!capture.angles.empty()) line += std::to_string(capture.angles.size()) + " angles, ";
  print(line + fixed(progress.elapsed_s(), 1) + " s");
  print("  " + one_line(capture.identity.source));
  for (const std::string& note : found->notes) print("  " + one_line(note));
  if (found->brdf) print_brdf(*found->brdf);
  if (!capture.is_fitted) print("  not fitted yet: lackwerk fit " + options.out);
  return exit_done;
}

}  // namespace

void add_import_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = app.add_subcommand("import", "Measured data -> capture folder");
  CLI::Option_group* source = command->add_option_group("source", "one of");
  source->add_option("--rgl", options->rgl, "RGL material, *_rgb.bsdf");
  source->add_option("--merl", options->merl, "MERL BRDF binary");
  source->add_option("--btf", options->btf, "folder of flake pictures named by their angles, with paint.toml");
  source->add_option("--angles", options->angles, "table of a spectrophotometer, CSV");
  source->add_option("--photos", options->photos, "folder of photographs of a panel, with photos.toml");
  source->require_option(1);
  command->add_option("-o,--output", options->out, "capture folder to write")->required();
  command->add_option("--name", options->settings.name, "what it is called; else from the file");
  command->add_option("--note", options->settings.note, "added to the source, for captions");
  const std::map<std::string, core::Provenance> words{{"measured", core::Provenance::measured},
                                                      {"published-fit", core::Provenance::published_fit},
                                                      {"simulated", core::Provenance::simulated}};
  CLI::Option* provenance = command->add_option("--provenance", options->settings.provenance, "where it came from")
                                ->transform(CLI::CheckedTransformer(words))
                                ->default_str("measured");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, provenance, &exit_code] {
    options->has_provenance = provenance->count() > 0;
    exit_code = run_import(*options);
  });
}

}  // namespace lackwerk::tools
