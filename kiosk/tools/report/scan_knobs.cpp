#include "kiosk/tools/report/scan_knobs.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/cloud_neighbours.hpp"
#include "packs/scan_pack.hpp"
#include "packs/tools/growing_tree.hpp"
#include "packs/tools/scan_builder.hpp"

namespace lackwerk::report {

namespace {

/// The tree at 0 and 1, and at the time between that the morph is to find.
struct Growth {
  std::vector<packs::ScanSource> scans;
  core::PointCloud truth;
  double extent = 0.0;
  double spacing = 0.0;  ///< what the default spacing comes to

  [[nodiscard]] std::string what() const {
    return "A tree of known growth, its branches labelled, scanned with " +
           std::to_string(scans[0].cloud.points.size()) + " points and later with " +
           std::to_string(scans[1].cloud.points.size()) +
           ", is rebuilt half way between and compared with the tree that stood there. ";
  }
};

packs::ScanSettings usual() {
  packs::ScanSettings settings;
  settings.align = false;          // the tree has not moved
  settings.matching.fades = true;  // the tree at half time holds nothing that falls
  settings.threads = 1;
  return settings;
}

Result<Growth> growth(const Workbench& bench) {
  packs::GrowingTreeOptions options;
  options.levels = 3;
  options.boughs = 6;
  options.crops = false;
  const packs::GrowingTree tree = packs::growing_tree(options);
  Growth out;
  const std::size_t early = bench.choose<std::size_t>(6000, 1000);
  const std::size_t late = bench.choose<std::size_t>(24000, 4000);
  out.scans.push_back({"early", 0.0, packs::tree_at(tree, 0.0, early, 0)});
  out.scans.push_back({"late", 1.0, packs::tree_at(tree, 1.0, late, 1)});
  out.truth = packs::tree_at(tree, 0.5, 2 * late, 2);
  out.extent = core::extent_of(core::box_of(out.scans[1].cloud.points));
  const auto prepared = packs::prepare_scans(out.scans, usual());
  if (!prepared) return tl::unexpected(prepared.error());
  out.spacing = prepared->spacing;
  return out;
}

/// As people write it: "0.05", "15".
std::string plain_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

/// How far each point lies from the nearest of the others, in the unit cube.
void add_distances(std::span<const glm::dvec3> points, std::span<const glm::dvec3> others, double extent,
                   std::vector<double>& out) {
  const core::CloudTree tree(others);
  std::vector<core::CloudNeighbour> near;
  for (const glm::dvec3& p : points) {
    tree.nearest(p, 1, near);
    out.push_back(near[0].distance / extent);
  }
}

Result<Setting> measured(const Workbench& bench, const Growth& growth, const packs::ScanSettings& settings,
                         double value, const char* line) {
  Setting out;
  out.value = value;
  out.label = plain_text(value);
  out.line = line;
  std::optional<Result<packs::ScanSeries>> series;
  out.time = bench.time([&] { series.emplace(packs::morph_series(growth.scans, settings)); }, 400.0, 1, 5);
  if (!series->has_value()) return tl::unexpected(series->error());
  const core::CloudMorph& morph = (*series)->steps[0];
  const std::vector<glm::dvec3> rebuilt = core::places_at(morph.paths, 0.5);
  std::vector<double> errors;
  errors.reserve(rebuilt.size() + growth.truth.points.size());
  add_distances(rebuilt, growth.truth.points, growth.extent, errors);
  add_distances(growth.truth.points, rebuilt, growth.extent, errors);
  set_errors(out, std::move(errors));
  out.bytes = static_cast<double>(morph.paths.size() * sizeof(packs::ScanPath));
  out.note = std::to_string(morph.paths.size()) + " paths, marginals off by at most " + digits(morph.worst_violation);
  if (morph.unsettled > 0) out.note += "; " + std::to_string(morph.unsettled) + " not ended at the iteration limit";
  return out;
}

/// One knob with a setting for each value; `set` turns it.
template <class Set>
Result<Knob> knob_of(const Workbench& bench, const Growth& growth, std::span<const double> values, const char* line,
                     const Set& set) {
  Knob knob;
  knob.error_unit = "distance between rebuilt and true tree, both ways, unit cube, mean";
  knob.time_of = "morphing the two scans on one core";
  knob.bytes_of = "paths of the step in the pack";
  knob.what = growth.what();
  for (const double value : values) {
    packs::ScanSettings settings = usual();
    set(settings, value);
    auto setting = measured(bench, growth, settings, value, line);
    if (!setting) return tl::unexpected(setting.error());
    knob.settings.push_back(std::move(*setting));
  }
  return knob;
}

const Setting& labelled(const Knob& knob, const std::string& label) {
  return *std::find_if(knob.settings.begin(), knob.settings.end(), [&](const Setting& s) { return s.label == label; });
}

std::string off_in(const Setting& setting) {
  return digits(setting.error) + " off in " + digits(setting.time.median_ms) + " ms";
}

std::string kilobytes(const Setting& setting) { return digits(1e-3 * setting.bytes) + " kB"; }

Result<Knob> neighbours_knob(const Workbench& bench, const Growth& growth) {
  const std::vector<double> values = bench.choose<std::vector<double>>({2, 4, 6, 10, 15, 20, 30, 60}, {2, 6, 15, 60});
  auto knob = knob_of(bench, growth, values, "neighbours", [](packs::ScanSettings& settings, double value) {
    settings.transport.neighbours = static_cast<std::size_t>(value);
  });
  if (!knob) return knob;
  knob->id = "scan_neighbours";
  knob->title = "Neighbours a point of a scan may go to";
  knob->what += "Each point may send its mass to this many points of the next scan.";
  knob->chosen = std::to_string(core::CloudTransportOptions{}.neighbours);
  const Setting& chosen = labelled(*knob, knob->chosen);
  const Setting& few = knob->settings.front();
  const Setting& many = knob->settings.back();
  knob->why = "The number of Golla 2021. With " + knob->chosen + " the tree is " + off_in(chosen) + ", with " +
              few.label + " " + off_in(few) + ", with " + many.label + " " + off_in(many) +
              "; one point in twenty is more than " + digits(chosen.p95) + ", " + digits(few.p95) + " and " +
              digits(many.p95) + " off.";
  return knob;
}

Result<Knob> gamma_knob(const Workbench& bench, const Growth& growth) {
  const std::vector<double> values = bench.choose<std::vector<double>>(
      {0.001, 0.003, 0.01, 0.03, 0.05, 0.1, 0.3, 1, 3, 10}, {0.001, 0.01, 0.05, 1, 10});
  auto knob = knob_of(bench, growth, values, "gamma",
                      [](packs::ScanSettings& settings, double value) { settings.transport.gamma = value; });
  if (!knob) return knob;
  knob->id = "scan_gamma";
  knob->title = "Gamma of the transport between scans";
  knob->what += "How much the transport is blurred, over the median cost of the pairs that may exchange mass.";
  knob->chosen = plain_text(core::CloudTransportOptions{}.gamma);
  const Setting& chosen = labelled(*knob, knob->chosen);
  const Setting& sharp = knob->settings.front();
  const Setting& blurred = knob->settings.back();
  knob->why = "At " + knob->chosen + " the tree is " + off_in(chosen) + " (" + kilobytes(chosen) + "); at " +
              sharp.label + " it is " + off_in(sharp) + " (" + kilobytes(sharp) + "), at " + blurred.label + " " +
              off_in(blurred) + " (" + kilobytes(blurred) +
              "): the more blur, the fewer pairs are the largest entry of their row and of their column, and each "
              "other pair is a "
              "path more.";
  return knob;
}

Result<Knob> spacing_knob(const Workbench& bench, const Growth& growth) {
  const std::vector<double> values = bench.choose<std::vector<double>>({0.5, 0.75, 1, 1.5, 2, 3, 5}, {0.5, 1, 2, 5});
  auto knob = knob_of(bench, growth, values, "spacing",
                      [&](packs::ScanSettings& settings, double value) { settings.spacing = value * growth.spacing; });
  if (!knob) return knob;
  knob->id = "scan_spacing";
  knob->title = "Spacing of the points of scans";
  knob->what += "Both scans keep one point for each cube of this edge, in units of the wider scan's own spacing.";
  knob->chosen = "1";
  const Setting& chosen = labelled(*knob, knob->chosen);
  const Setting& fine = knob->settings.front();
  const Setting& coarse = knob->settings.back();
  knob->why = "The coarser scan bounds what can be known: at its own spacing the tree is " + off_in(chosen) + ", at " +
              fine.label + " of it " + off_in(fine) + ", at " + coarse.label + " times " + off_in(coarse) + ".";
  return knob;
}

}  // namespace

Result<void> add_scans(Workbench& bench, Findings& findings) {
  const auto tree = growth(bench);
  if (!tree) return tl::unexpected(tree.error());
  double done = 0.0;
  for (const auto make : {neighbours_knob, gamma_knob, spacing_knob}) {
    auto knob = make(bench, *tree);
    if (!knob) return tl::unexpected(knob.error());
    findings.knobs.push_back(std::move(*knob));
    bench.progress(done += 1.0 / 3.0);
  }
  return {};
}

}  // namespace lackwerk::report
