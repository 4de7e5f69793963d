#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/analysis/distribution_error.hpp"
#include "core/analysis/flake_clusters.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"

namespace lackwerk::report {

namespace {

using core::ClusterSettings;
using core::PruneRule;

/// Bytes of one cluster of one paint in a pack of it alone: corners, its index in the tuple and the tuple's mass.
constexpr double bytes_a_cluster = sizeof(core::QuantisedCuboid) + sizeof(std::uint8_t) + sizeof(std::uint32_t);

struct Samples {
  std::vector<FlakeSample> slices;
  std::vector<std::size_t> judged;
  double slices_a_paint = 0.0;  ///< that a pack keeps
};

/// Error over all samples, time on the first (brightest) slice, bytes as if all slices had the samples' clusters.
Setting measure(const Workbench& bench, const Samples& samples, const ClusterSettings& settings) {
  Setting out;
  std::vector<double> errors;
  double clusters = 0.0;
  for (const FlakeSample& slice : samples.slices) {
    for (std::size_t level = 0; level < slice.levels.size(); ++level) {
      const std::vector<glm::vec3>& lab = slice.levels[level].lab;
      const std::vector<core::LabCuboid> boxes = core::cluster_texels(lab, settings);
      clusters += static_cast<double>(boxes.size());
      if (std::find(samples.judged.begin(), samples.judged.end(), level) != samples.judged.end())
        errors.push_back(core::wasserstein1_lab(lab, boxes, {}, 1024));
    }
  }
  set_errors(out, std::move(errors));
  out.bytes = clusters / static_cast<double>(samples.slices.size()) * samples.slices_a_paint * bytes_a_cluster;
  const std::vector<glm::vec3>& first = samples.slices.front().levels.front().lab;
  std::size_t found = 0;
  out.time = bench.time([&] { found += core::cluster_texels(first, settings).size(); }, 120.0, 3, 40);
  if (found == 0) out.note = "no clusters";
  return out;
}

std::string size_text(const Workbench& bench) {
  const std::string edge = std::to_string(bench.edge_texels());
  return edge + " x " + edge;
}

Knob cluster_knob(const Workbench& bench, const Samples& samples) {
  Knob knob;
  knob.id = "clusters";
  knob.title = "Clusters a slice";
  knob.what =
      "Boxes that stand for the colours of one slice, by this program's pruning rule and by that of Golla (2021), "
      "on " +
      std::to_string(samples.slices.size()) + " slices of three paints at " + std::to_string(samples.judged.size()) +
      " mip levels.";
  knob.error_unit = "1-Wasserstein distance, Lab";
  knob.time_of = "clustering one slice of " + size_text(bench) + " texels";
  knob.bytes_of = "boxes, indices and masses of one paint in its pack";
  knob.chosen = "50";
  double ours = none, theirs = none, less = none, more = none;
  for (const PruneRule rule : {PruneRule::misfit, PruneRule::density}) {
    for (const int count : {5, 10, 25, 50, 100, 150, 200, 250}) {
      ClusterSettings settings;
      settings.rule = rule;
      settings.max_clusters = count;
      Setting one = measure(bench, samples, settings);
      const bool misfit = rule == PruneRule::misfit;
      one.value = count;
      one.label = std::to_string(count) + (misfit ? "" : " by density");
      one.line = misfit ? "misfit rule" : "density rule";
      if (count == 50) (misfit ? ours : theirs) = one.error;
      if (misfit && count == 25) less = one.error;
      if (misfit && count == 100) more = one.error;
      knob.settings.push_back(std::move(one));
      bench.progress(0.25 * static_cast<double>(knob.settings.size()) / 16.0);
    }
  }
  knob.why = "50 boxes are " + digits(ours) + " Lab from their texels, 25 are " + digits(less) + " and 100 are " +
             digits(more) + "; five paints of 50 fill the 256 tuples a row can have. The density rule leaves " +
             digits(theirs) + " at 50.";
  return knob;
}

Knob depth_knob(const Workbench& bench, const Samples& samples) {
  Knob knob;
  knob.id = "octree_depth";
  knob.title = "Depth of the colour octree";
  knob.what = "Bits an axis: colours in one of the finest cells stay together. 50 clusters by the misfit rule.";
  knob.error_unit = "1-Wasserstein distance, Lab";
  knob.time_of = "clustering one slice of " + size_text(bench) + " texels";
  const int chosen = ClusterSettings{}.depth;
  knob.chosen = std::to_string(chosen);
  double at_chosen = none, time_chosen = none, best = none;
  for (const int depth : {4, 6, 8, 10, 12, 14, 16, 18, 21}) {
    ClusterSettings settings;
    settings.depth = depth;
    Setting one = measure(bench, samples, settings);
    one.value = depth;
    one.label = std::to_string(depth);
    one.line = "bits an axis";
    one.bytes = none;
    if (depth == chosen) {
      at_chosen = one.error;
      time_chosen = one.time.median_ms;
    }
    if (!(best <= one.error)) best = one.error;
    knob.settings.push_back(std::move(one));
    bench.progress(0.25 + 0.1 * static_cast<double>(knob.settings.size()) / 9.0);
  }
  knob.why = "At " + knob.chosen + " bits the error is " + digits(at_chosen) + " Lab in " + digits(time_chosen) +
             " ms; the least over all depths is " + digits(best) +
             ". Spare levels are for slices with an outlier: one texel of 1e4 Lab takes about 7 of them.";
  return knob;
}

Speed octree_speed(const Workbench& bench, const Samples& samples) {
  // Over the first slice of each paint and one grazing one: how many colours differ decides the work.
  std::vector<double> rates;
  std::string each;
  Speed out;
  for (const FlakeSample& slice : samples.slices) {
    const std::vector<glm::vec3>& lab = slice.levels.front().lab;
    std::size_t found = 0;
    const Timing time = bench.time([&] { found += core::cluster_texels(lab, {}).size(); }, 200.0, 5, 60);
    rates.push_back(static_cast<double>(lab.size()) / time.median_ms * 1e-3);
    out.count += found > 0 ? time.count : 0;
  }
  std::sort(rates.begin(), rates.end());
  out.id = "octree";
  out.what = "clustering " + size_text(bench) + " texels into 50 boxes, one core, median over " +
             std::to_string(rates.size()) + " slices";
  out.value = rates[rates.size() / 2];
  out.unit = "million texels/s";
  out.aim = 20.0;
  out.at_least = true;
  out.bound_by = "slowest slice " + digits(rates.front()) + ", fastest " + digits(rates.back()) +
                 " (dark slices have many equal texels): radix passes over 16 bytes a texel and the moments of every "
                 "inner node";
  return out;
}

}  // namespace

Result<void> add_flake_clusters(Workbench& bench, Findings& findings) {
  auto slices = flake_samples(bench);
  if (!slices) return tl::unexpected(slices.error());
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  Samples samples;
  samples.slices = std::move(*slices);
  samples.judged = judged_levels(bench);
  const packs::Capture& first = (*captures)->front();
  samples.slices_a_paint = core::reachable_layout(first.layout, first.analytic.refraction_ior).slice_count();
  findings.knobs.push_back(cluster_knob(bench, samples));
  findings.knobs.push_back(depth_knob(bench, samples));
  findings.speeds.push_back(octree_speed(bench, samples));
  return {};
}

}  // namespace lackwerk::report
