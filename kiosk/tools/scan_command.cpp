#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <glm/common.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/analysis/cloud_neighbours.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/tools/cloud_file.hpp"
#include "packs/tools/scan_builder.hpp"
#include "packs/tools/scan_contents.hpp"

namespace lackwerk::tools {
namespace {

using Json = nlohmann::ordered_json;

struct ScanOptions {
  std::vector<std::string> files;
  std::vector<double> times;
  std::string out, up = "z";
  packs::ScanNaming naming;
  packs::ScanSettings settings;
  bool keep_strays = false, no_alignment = false, ignore_labels = false, labels_differ = false, one_segment = false,
       thin = false, json = false;
};

/// What the flags say, in the settings' words.
packs::ScanSettings settings_of(const ScanOptions& options) {
  packs::ScanSettings settings = options.settings;
  settings.clean = !options.keep_strays;
  settings.align = !options.no_alignment;
  settings.by_label = !options.ignore_labels;
  settings.labels_agree = !options.labels_differ;
  settings.segment = !options.one_segment;
  settings.segments.by_levels = !options.thin;
  const int up = options.up == "x" ? 0 : options.up == "y" ? 1 : 2;
  settings.alignment.up = settings.segments.up = settings.matching.up = up;
  return settings;
}

Result<std::vector<packs::ScanSource>> read_scans(const ScanOptions& options) {
  if (!options.times.empty() && options.times.size() != options.files.size())
    return fail({}, "--times",
                std::to_string(options.times.size()) + " times for " + std::to_string(options.files.size()) + " scans",
                "give one for each, separated by commas", ErrorKind::usage);
  std::vector<packs::ScanSource> out;
  for (std::size_t k = 0; k < options.files.size(); ++k) {
    auto cloud = packs::read_cloud(options.files[k]);
    if (!cloud) return tl::unexpected(cloud.error());
    const double time = options.times.empty() ? static_cast<double>(k) : options.times[k];
    out.push_back({std::filesystem::path(options.files[k]).filename().string(), time, std::move(*cloud)});
  }
  return out;
}

Json json_of(const packs::ScanSeries& series, const packs::BuiltScan& built, double seconds) {
  Json out{{"id", built.info.id},
           {"serial", built.info.serial},
           {"seconds", seconds},
           {"prepare_s", series.prepare_s},
           {"segment_s", series.segment_s},
           {"match_s", series.match_s},
           {"transport_s", series.transport_s},
           {"spacing", built.info.spacing},
           {"labelled", series.labelled},
           {"scans", Json::array()},
           {"steps", Json::array()}};
  for (const packs::PreparedScan& scan : series.scans)
    out["scans"].push_back({{"name", scan.name},
                            {"time", scan.time},
                            {"read", scan.read},
                            {"strays", scan.strays},
                            {"points", scan.cloud.points.size()},
                            {"segments", scan.tree.segments.size()},
                            {"aligned_rms", scan.alignment.rms}});
  for (std::size_t k = 0; k < series.steps.size(); ++k)
    out["steps"].push_back({{"paths", series.steps[k].paths.size()},
                            {"matched", built.kinds[k][0]},
                            {"grown", built.kinds[k][1]},
                            {"decayed", built.kinds[k][2]},
                            {"unsettled", series.steps[k].unsettled},
                            {"worst_violation", series.steps[k].worst_violation}});
  return out;
}

void print_text(const packs::ScanSeries& series, const packs::BuiltScan& built) {
  for (const packs::PreparedScan& scan : series.scans)
    print(one_line(scan.name) + ": " + std::to_string(scan.read) + " points read, " + std::to_string(scan.strays) +
          " strays, " + std::to_string(scan.cloud.points.size()) + " kept in " +
          std::to_string(scan.tree.segments.size()) + (series.labelled ? " labelled" : "") + " segments" +
          (scan.alignment.iterations > 0 ? "; carried to the one before within " + fixed(scan.alignment.rms, 3) : ""));
  for (std::size_t k = 0; k < series.steps.size(); ++k)
    print("  to " + one_line(series.scans[k + 1].name) + ": " + std::to_string(series.steps[k].paths.size()) +
          " paths; segments: " + std::to_string(built.kinds[k][0]) + " matched, " + std::to_string(built.kinds[k][1]) +
          " grown, " + std::to_string(built.kinds[k][2]) + " gone" +
          (series.steps[k].unsettled > 0
               ? "; " + std::to_string(series.steps[k].unsettled) + " transports not settled within their iterations"
               : ""));
  print("time: preparing " + fixed(series.prepare_s, 1) + " s, segments " + fixed(series.segment_s, 1) +
        " s, matching " + fixed(series.match_s, 1) + " s, transport " + fixed(series.transport_s, 1) + " s");
}

int run_morph(const ScanOptions& options) {
  Progress progress("scan morph", options.json);
  progress.update(0.0, "reading");
  const auto sources = read_scans(options);
  if (!sources) return report(sources.error());
  const packs::ScanSettings settings = settings_of(options);
  const auto series = packs::morph_series(
      *sources, settings, [&](double fraction, std::string_view stage) { progress.update(0.9 * fraction, stage); });
  if (!series) return report(series.error());
  progress.update(0.9, "normals");
  const packs::BuiltScan built =
      packs::scan_contents(*series, options.naming, settings.segments.up, settings.matching.fades, settings.threads);
  if (const auto written = packs::write_scan_pack(options.out, built.contents()); !written)
    return report(written.error());
  const double seconds = progress.elapsed_s();
  if (options.json) {
    print(json_of(*series, built, seconds).dump(-1, ' ', false, Json::error_handler_t::replace));
    return exit_done;
  }
  print_text(*series, built);
  std::error_code code;
  const auto bytes = std::filesystem::file_size(options.out, code);
  print(options.out + ": " + fixed(code ? 0.0 : static_cast<double>(bytes) / 1e6, 2) + " MB in " + fixed(seconds, 1) +
        " s");
  return exit_done;
}

/// Distances of a rebuilt scan from the one that was left out, both ways, in the unit cube.
struct Rebuilt {
  const char* way;
  core::CloudDistance to_truth, from_truth;
};

Json json_of(const core::CloudDistance& distance) {
  return {{"mean", distance.mean}, {"deviation", distance.deviation}, {"max", distance.most}};
}

std::string text_of(const core::CloudDistance& distance) {
  return "mean " + fixed(distance.mean, 6) + ", deviation " + fixed(distance.deviation, 6) + ", max " +
         fixed(distance.most, 6);
}

/// Each point goes to its nearest in the other scan, and each of those is reached from its nearest.
std::vector<core::CloudPath> nearest_paths(const packs::PreparedScan& from, const packs::PreparedScan& to) {
  std::vector<core::CloudPath> out;
  std::vector<core::CloudNeighbour> near;
  const core::CloudTree targets(to.cloud.points), sources(from.cloud.points);
  for (const glm::dvec3& p : from.cloud.points) {
    targets.nearest(p, 1, near);
    out.push_back({p, to.cloud.points[near[0].index]});
  }
  for (const glm::dvec3& q : to.cloud.points) {
    sources.nearest(q, 1, near);
    out.push_back({from.cloud.points[near[0].index], q});
  }
  return out;
}

Rebuilt judged(const char* way, const std::vector<core::CloudPath>& paths, double t,
               const std::vector<glm::dvec3>& truth, double extent) {
  const std::vector<glm::dvec3> rebuilt = core::places_at(paths, t);
  return {way, core::distance_to(rebuilt, truth, extent), core::distance_to(truth, rebuilt, extent)};
}

int run_check(const ScanOptions& options) {
  Progress progress("scan check", options.json);
  const auto sources = read_scans(options);
  if (!sources) return report(sources.error());
  if (sources->size() < 3)
    return report({"", "scans", std::to_string(sources->size()) + " given", "one between two others is left out",
                   ErrorKind::usage});
  const packs::ScanSettings settings = settings_of(options);
  auto all = packs::prepare_scans(*sources, settings,
                                  [&](double fraction, std::string_view stage) { progress.update(fraction, stage); });
  if (!all) return report(all.error());
  core::CloudBox box;
  for (const packs::PreparedScan& scan : all->scans) {
    const core::CloudBox own = core::box_of(scan.cloud.points);
    box.low = glm::min(box.low, own.low);
    box.high = glm::max(box.high, own.high);
  }
  const double extent = core::extent_of(box);
  Json out{{"spacing", all->spacing}, {"extent", extent}, {"left_out", Json::array()}};
  for (std::size_t middle = 1; middle + 1 < all->scans.size(); ++middle) {
    packs::ScanSeries two;
    two.spacing = all->spacing;
    two.scans = {all->scans[middle - 1], all->scans[middle + 1]};
    const double t = (all->scans[middle].time - two.scans[0].time) / (two.scans[1].time - two.scans[0].time);
    const std::vector<glm::dvec3>& truth = all->scans[middle].cloud.points;
    std::vector<Rebuilt> ways;
    const auto done = packs::morph_prepared(
        two, settings, [&](double fraction, std::string_view stage) { progress.update(0.5 * fraction, stage); });
    if (!done) return report(done.error());
    ways.push_back(judged("segments", two.steps[0].paths, t, truth, extent));
    packs::ScanSettings whole = settings;
    whole.segment = false;
    if (const auto again = packs::morph_prepared(
            two, whole, [&](double fraction, std::string_view stage) { progress.update(0.5 + 0.5 * fraction, stage); });
        !again)
      return report(again.error());
    ways.push_back(judged("one segment", two.steps[0].paths, t, truth, extent));
    ways.push_back(judged("nearest", nearest_paths(two.scans[0], two.scans[1]), t, truth, extent));
    ways.push_back({"scan before, unmoved", core::distance_to(two.scans[0].cloud.points, truth, extent),
                    core::distance_to(truth, two.scans[0].cloud.points, extent)});
    Json entry{{"name", all->scans[middle].name}, {"t", t}, {"ways", Json::array()}};
    if (!options.json)
      print(one_line(all->scans[middle].name) + " left out and rebuilt at t = " + fixed(t, 4) +
            ", distances in the unit cube:");
    for (const Rebuilt& way : ways) {
      entry["ways"].push_back(
          {{"way", way.way}, {"to_truth", json_of(way.to_truth)}, {"from_truth", json_of(way.from_truth)}});
      if (options.json) continue;
      print("  " + std::string(way.way) + ": " + text_of(way.to_truth) +
            "; from the scan back: " + text_of(way.from_truth));
    }
    out["left_out"].push_back(std::move(entry));
  }
  if (options.json) print(out.dump(-1, ' ', false, Json::error_handler_t::replace));
  return exit_done;
}

/// What both commands take.
void add_options(CLI::App& command, ScanOptions& options) {
  packs::ScanSettings& settings = options.settings;
  command.add_option("CLOUD", options.files, "scans in the order of time: .xyz, .txt, .asc or .ply")->required();
  command.add_option("--times", options.times, "when each was taken, ascending; without it 0, 1, 2, ...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      .add_option("--spacing", settings.spacing,
                  "edge of the cubes that keep one point each; 0: the widest spacing among the scans; below 0: all "
                  "points stay")
      ->capture_default_str();
  command.add_option("--up", options.up, "the vertical axis")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  command.add_flag("--keep-strays", options.keep_strays, "do not take stray points away");
  command.add_flag("--no-alignment", options.no_alignment, "scans lie where they belong already");
  command.add_flag("--standing", settings.alignment.stands,
                   "plants stand: scans are turned about the foot of the stem, not tilted");
  command.add_flag("--ignore-labels", options.ignore_labels, "find segments even where points are labelled");
  command.add_flag("--labels-differ", options.labels_differ,
                   "labels say which points are one part, but not which part it is in the next scan");
  command.add_flag("--one-segment", options.one_segment, "transport across the whole scan, without segments");
  command.add_flag("--thin", options.thin, "find segments in the spanning tree, for plants without broad leaves");
  command.add_flag("--virtual-root", settings.segments.virtual_root, "labelled parts hang from no stem");
  command
      .add_option("--shortest-branch", settings.segments.shortest_branch,
                  "shorter branches are no segments; 0: an eighth of the longest way from the ground")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--neighbours", settings.transport.neighbours, "of each point, to which its mass may go")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command.add_option("--gamma", settings.transport.gamma, "blur of the transport over its median cost")
      ->check(CLI::Range(1e-6, 100.0))
      ->capture_default_str();
  command
      .add_option("--most-distance", settings.matching.most_distance,
                  "parts further apart than this share of the longer one's length are no pair")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command.add_flag("--fade", settings.matching.fades, "parts that are gone fade where they are instead of falling");
  command.add_option("--threads", settings.threads, "0 = as many as the machine has; no effect on the result")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command.add_flag("--json", options.json, "print JSON");
}

}  // namespace

void add_scan_command(CLI::App& app, int& exit_code) {
  auto morph = std::make_shared<ScanOptions>();
  CLI::App& group = command_group(app, "scan", "Scans that grow");
  CLI::App* command = group.add_subcommand("morph", "Build a scan pack: smooth growth between scans of one plant");
  add_options(*command, *morph);
  command->add_option("-o,--output", morph->out, "scan pack to write (.lwp)")->required();
  command->add_option("--id", morph->naming.id,
                      "letters, digits, dots, dashes, underscores; without it the file's name");
  command->add_option("--serial", morph->naming.serial, "grows with every release of an id")->capture_default_str();
  command->add_option("--name", morph->naming.name, "shown on the kiosk; without it the id");
  command->add_option("--time-unit", morph->naming.time_unit, "shown behind a time, as \"days\"");
  command->callback([morph, &exit_code] {
    packs::ScanNaming& naming = morph->naming;
    if (naming.id.empty()) naming.id = std::filesystem::path(morph->out).stem().string();
    if (naming.name.empty()) naming.name = naming.id;
    exit_code = run_morph(*morph);
  });

  auto check = std::make_shared<ScanOptions>();
  command =
      group.add_subcommand("check", "Leave each scan between two others out, rebuild it, and say how far off it is");
  add_options(*command, *check);
  command->callback([check, &exit_code] { exit_code = run_check(*check); });
}

}  // namespace lackwerk::tools
