#include "packs/tools/scan_builder.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "packs/tools/parallel.hpp"

namespace lackwerk::packs {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// How much of the whole preparing, segments, matching and transport take, about; measured on 250,000 points.
constexpr double prepared_part = 0.2, segmented_part = 0.45, matched_part = 0.6;

void tell(const ScanProgress& progress, double fraction, std::string_view stage) {
  if (progress) progress(fraction, stage);
}

Error about(const std::string& name, std::string field, std::string what, std::string remedy) {
  return {name, std::move(field), std::move(what), std::move(remedy), ErrorKind::run};
}

Result<void> check_sources(std::span<const ScanSource> sources) {
  if (sources.size() < 2)
    return fail({}, "scans", std::to_string(sources.size()) + " given", "a morph needs two scans or more",
                ErrorKind::usage);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    if (sources[k].cloud.points.empty()) return fail(sources[k].name, "points", "there are none", "scan it again");
    if (std::any_of(sources[k].cloud.points.begin(), sources[k].cloud.points.end(),
                    [](const glm::dvec3& p) { return !std::isfinite(p.x + p.y + p.z); }))
      return fail(sources[k].name, "points", "one is not finite", "take it away");
    if (!std::isfinite(sources[k].time) || (k > 0 && sources[k].time <= sources[k - 1].time))
      return fail(sources[k].name, "time", "does not come after the one before", "give ascending --times",
                  ErrorKind::usage);
  }
  return {};
}

/// The cloud without strays. One that is small or all in one place stays.
core::PointCloud cleaned(const core::PointCloud& cloud, const ScanSettings& settings) {
  if (!settings.clean) return cloud;
  return core::picked(cloud, core::inliers_of(cloud.points, settings.cleaning));
}

bool all_labelled(std::span<const PreparedScan> scans) {
  return std::all_of(scans.begin(), scans.end(),
                     [](const PreparedScan& scan) { return scan.cloud.labels.size() == scan.cloud.points.size(); });
}

core::CloudSegments one_segment(std::size_t points) {
  core::CloudSegments out;
  out.segments.emplace_back();
  for (std::uint32_t i = 0; i < points; ++i) out.segments[0].points.push_back(i);
  return out;
}

Result<core::CloudSegments> tree_of(const PreparedScan& scan, const ScanSeries& series, const ScanSettings& settings) {
  if (!settings.segment) return one_segment(scan.cloud.points.size());
  core::SegmentOptions options = settings.segments;
  if (series.labelled) return core::labelled_segments(scan.cloud, options);
  // A stem a few points thick must be a line, not a bundle of them.
  constexpr double skeleton_spacings = 6.0;
  const double own = series.spacing > 0.0 ? series.spacing : core::spacing_of(scan.cloud.points);
  if (options.skeleton_spacing <= 0.0) options.skeleton_spacing = skeleton_spacings * own;
  return core::segments_of(scan.cloud.points, options);
}

/// One transport problem of one step.
struct Task {
  std::size_t step = 0;
  std::uint32_t match = 0;
  std::size_t points = 0;
};

void solve(const ScanSeries& series, const Task& task, const ScanSettings& settings, core::MatchPaths& out,
           std::optional<Error>& wrong) {
  auto paths = core::match_paths(series.scans[task.step].cloud.points, series.scans[task.step + 1].cloud.points,
                                 series.steps[task.step].matches[task.match], task.match, settings.transport);
  if (paths)
    out = std::move(*paths);
  else
    wrong = paths.error();
}

}  // namespace

Result<ScanSeries> prepare_scans(std::span<const ScanSource> sources, const ScanSettings& settings,
                                 const ScanProgress& progress) {
  if (const auto ok = check_sources(sources); !ok) return tl::unexpected(ok.error());
  const auto start = Clock::now();
  const int threads = thread_count(settings.threads);
  ScanSeries out;
  out.scans.resize(sources.size());
  std::vector<double> own_spacing(sources.size(), 0.0);
  tell(progress, 0.0, "strays");
  for_each_index(sources.size(), threads, [&](std::size_t k) {
    PreparedScan& scan = out.scans[k];
    scan.name = sources[k].name;
    scan.time = sources[k].time;
    scan.read = sources[k].cloud.points.size();
    scan.cloud = cleaned(sources[k].cloud, settings);
    scan.strays = scan.read - scan.cloud.points.size();
    own_spacing[k] = core::spacing_of(scan.cloud.points);
  });
  out.spacing = settings.spacing < 0.0   ? 0.0
                : settings.spacing > 0.0 ? settings.spacing
                                         : *std::max_element(own_spacing.begin(), own_spacing.end());
  tell(progress, 0.4 * prepared_part, "spacing");
  if (out.spacing > 0.0) {
    std::vector<std::optional<Error>> wrong(sources.size());
    for_each_index(sources.size(), threads, [&](std::size_t k) {
      auto even = core::resampled(out.scans[k].cloud, out.spacing);
      if (even)
        out.scans[k].cloud = std::move(*even);
      else
        wrong[k] = even.error();
    });
    for (std::size_t k = 0; k < wrong.size(); ++k)
      if (wrong[k]) return tl::unexpected(about(out.scans[k].name, wrong[k]->field, wrong[k]->what, wrong[k]->remedy));
  }
  tell(progress, 0.6 * prepared_part, "alignment");
  if (settings.align)
    for (std::size_t k = 1; k < out.scans.size(); ++k) {
      PreparedScan& scan = out.scans[k];
      scan.alignment = core::align(scan.cloud.points, out.scans[k - 1].cloud.points, settings.alignment);
      for (glm::dvec3& p : scan.cloud.points) p = scan.alignment.motion(p);
      tell(progress, prepared_part * (0.6 + 0.4 * static_cast<double>(k) / static_cast<double>(out.scans.size())),
           "alignment");
    }
  out.prepare_s = seconds_since(start);
  return out;
}

Result<void> morph_prepared(ScanSeries& series, const ScanSettings& settings, const ScanProgress& progress,
                            double begin) {
  const int threads = thread_count(settings.threads);
  const auto report = [&](double fraction, std::string_view stage) {
    const double from = begin > 0.0 ? prepared_part : 0.0;
    tell(progress, begin + (fraction - from) / (1.0 - from) * (1.0 - begin), stage);
  };
  series.labelled = settings.segment && settings.by_label && all_labelled(series.scans);
  auto start = Clock::now();
  report(prepared_part, "segments");
  std::vector<std::optional<Error>> wrong(series.scans.size());
  for_each_index(series.scans.size(), threads, [&](std::size_t k) {
    auto tree = tree_of(series.scans[k], series, settings);
    if (tree)
      series.scans[k].tree = std::move(*tree);
    else
      wrong[k] = tree.error();
  });
  for (std::size_t k = 0; k < wrong.size(); ++k)
    if (wrong[k]) return tl::unexpected(about(series.scans[k].name, wrong[k]->field, wrong[k]->what, wrong[k]->remedy));
  series.segment_s = seconds_since(start);

  start = Clock::now();
  report(segmented_part, "matching");
  core::MatchOptions matching = settings.matching;
  matching.by_label = series.labelled && settings.labels_agree;
  matching.merges = matching.merges && !series.labelled;  // given parts are whole
  series.steps.assign(series.scans.size() - 1, {});
  for_each_index(series.steps.size(), threads, [&](std::size_t k) {
    const PreparedScan& from = series.scans[k];
    const PreparedScan& to = series.scans[k + 1];
    series.steps[k].matches = core::match_segments(from.cloud.points, from.tree, to.cloud.points, to.tree, matching);
  });
  series.match_s = seconds_since(start);

  // The largest first, so that no thread is left alone with one at the end.
  start = Clock::now();
  std::vector<Task> tasks;
  double all_points = 0.0;
  for (std::size_t k = 0; k < series.steps.size(); ++k)
    for (std::uint32_t m = 0; m < series.steps[k].matches.size(); ++m) {
      const core::SegmentMatch& match = series.steps[k].matches[m];
      tasks.push_back({k, m, match.from_points.size() + match.to_points.size()});
      all_points += static_cast<double>(tasks.back().points);
    }
  std::vector<std::size_t> order(tasks.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t one, std::size_t two) { return tasks[one].points > tasks[two].points; });
  std::vector<core::MatchPaths> paths(tasks.size());
  wrong.assign(tasks.size(), {});
  const auto caller = std::this_thread::get_id();
  std::atomic<std::size_t> points_done{0};
  for_each_index(order.size(), threads, [&](std::size_t k) {
    const Task& task = tasks[order[k]];
    solve(series, task, settings, paths[order[k]], wrong[order[k]]);
    const std::size_t done = points_done += task.points;
    if (std::this_thread::get_id() == caller)
      report(matched_part + (1.0 - matched_part) * static_cast<double>(done) / std::max(1.0, all_points), "transport");
  });
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    if (wrong[k])
      return tl::unexpected(
          about(series.scans[tasks[k].step + 1].name, wrong[k]->field, wrong[k]->what, wrong[k]->remedy));
    core::add_match_paths(std::exchange(paths[k], {}), series.steps[tasks[k].step]);
  }
  series.transport_s = seconds_since(start);
  report(1.0, "done");
  return {};
}

Result<ScanSeries> morph_series(std::span<const ScanSource> sources, const ScanSettings& settings,
                                const ScanProgress& progress) {
  auto series = prepare_scans(sources, settings, progress);
  if (!series) return tl::unexpected(series.error());
  if (auto done = morph_prepared(*series, settings, progress, prepared_part); !done)
    return tl::unexpected(done.error());
  return series;
}

}  // namespace lackwerk::packs
