// The growing tree of 77,448 to 326,032 points, morphed: seconds of each stage, peak memory, and how both grow.
//
// Usage: scan_bench [RUNS] or scan_bench --once PART LABELLED, or scan_bench --pack FILE: the whole tree as a scan
// pack, for `lackwerk scan render --frames`. Each size runs in a process of its own, for the peak of memory is one of a
// process. PART: of the points, as 0.25. LABELLED: 1, or 0 where segments are to be found.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/analysis/cloud_morph.hpp"
#include "packs/tools/growing_tree.hpp"
#include "packs/tools/scan_builder.hpp"
#include "packs/tools/scan_contents.hpp"

namespace lackwerk {
namespace {

/// What a run tells its parent.
struct Figures {
  double points = 0.0, seconds = 0.0, prepare_s = 0.0, segment_s = 0.0, match_s = 0.0, transport_s = 0.0;
  double segments = 0.0, matched = 0.0, grown = 0.0, decayed = 0.0, unsettled = 0.0, violation = 0.0;
  double mean_off = 0.0;  ///< of the tree rebuilt at 0.5, in the unit cube
  double peak_mb = 0.0;
};

/// "Synthetic tree 2" of Golla 2021, 4.4.
constexpr double early_points = 77448.0, late_points = 326032.0;

std::vector<packs::ScanSource> scans(const packs::GrowingTree& tree, double part) {
  const auto scan = [&](const char* name, double time, double points) {
    return packs::ScanSource{
        name, time,
        packs::tree_at(tree, time, static_cast<std::size_t>(std::llround(part * points)), static_cast<unsigned>(time))};
  };
  std::vector<packs::ScanSource> out;
  out.push_back(scan("early", 0.0, early_points));
  out.push_back(scan("late", 1.0, late_points));
  return out;
}

packs::ScanSettings settings_for(bool labelled) {
  packs::ScanSettings settings;
  settings.clean = settings.align = false;  // the tree has no strays and has not moved
  settings.spacing = -1.0;                  // all points count
  settings.by_label = labelled;
  return settings;
}

bool write_pack(const std::string& file) {
  const packs::ScanSettings settings = settings_for(true);
  const auto series = packs::morph_series(scans(packs::growing_tree({}), 1.0), settings);
  if (!series) {
    std::printf("%s\n", series.error().line().c_str());
    return false;
  }
  const packs::BuiltScan built = packs::scan_contents(*series, {"tree", 1, "Tree", ""}, 2, false, 0);
  const auto written = packs::write_scan_pack(file, built.contents());
  if (!written) std::printf("%s\n", written.error().line().c_str());
  return written.has_value();
}

bool run_once(double part, bool labelled, Figures& out) {
  const packs::GrowingTree tree = packs::growing_tree({});
  const packs::ScanSettings settings = settings_for(labelled);
  const auto sources = scans(tree, part);
  const auto start = std::chrono::steady_clock::now();
  const auto series = packs::morph_series(sources, settings);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!series) {
    std::printf("%s\n", series.error().line().c_str());
    return false;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  out.peak_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  out.prepare_s = series->prepare_s;
  out.segment_s = series->segment_s;
  out.match_s = series->match_s;
  out.transport_s = series->transport_s;
  out.points = static_cast<double>(series->scans[0].cloud.points.size() + series->scans[1].cloud.points.size());
  out.segments = static_cast<double>(series->scans[0].tree.segments.size() + series->scans[1].tree.segments.size());
  for (const core::SegmentMatch& match : series->steps[0].matches) {
    double& kind = match.kind == core::MatchKind::matched ? out.matched
                   : match.kind == core::MatchKind::grown ? out.grown
                                                          : out.decayed;
    ++kind;
  }
  out.unsettled = series->steps[0].unsettled;
  out.violation = series->steps[0].worst_violation;
  const core::PointCloud truth = packs::tree_at(tree, 0.5, series->scans[1].cloud.points.size() / 2, 2);
  const double extent = core::extent_of(core::box_of(series->scans[1].cloud.points));
  out.mean_off = core::distance_to(core::places_at(series->steps[0].paths, 0.5), truth.points, extent).mean;
  return true;
}

/// Runs in a child, so that each has a peak of its own.
bool run_apart(double part, bool labelled, Figures& out) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return false;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    Figures mine;
    const bool done = run_once(part, labelled, mine);
    std::fflush(stdout);
    const bool told = done && write(ends[1], &mine, sizeof mine) == static_cast<ssize_t>(sizeof mine);
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  const bool told = child > 0 && read(ends[0], &out, sizeof out) == static_cast<ssize_t>(sizeof out);
  close(ends[0]);
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  return told;
}

void print(const Figures& f) {
  std::printf(
      "  %7.0f points, %4.0f segments (%.0f matched, %.0f grown, %.0f gone): %6.2f s (prepare %.2f, segments %.2f, "
      "matching %.2f, transport %.2f), peak %.0f MB; unsettled %.0f, violation %.4f; at 0.5 off by %.5f\n",
      f.points, f.segments, f.matched, f.grown, f.decayed, f.seconds, f.prepare_s, f.segment_s, f.match_s,
      f.transport_s, f.peak_mb, f.unsettled, f.violation, f.mean_off);
  std::fflush(stdout);
}

}  // namespace
}  // namespace lackwerk

int main(int argc, char** argv) {
  using namespace lackwerk;
  if (argc == 4 && std::string(argv[1]) == "--once") {
    Figures figures;
    if (!run_once(std::stod(argv[2]), std::string(argv[3]) == "1", figures)) return 1;
    print(figures);
    return 0;
  }
  if (argc == 3 && std::string(argv[1]) == "--pack") return write_pack(argv[2]) ? 0 : 1;
  const int runs = argc == 2 ? std::max(1, std::atoi(argv[1])) : 3;
  bool ok = true;
  for (const bool labelled : {true, false}) {
    std::printf("scan morph, growing tree, segments %s, median of %d:\n", labelled ? "from labels" : "found", runs);
    std::vector<Figures> series;
    for (const double part : {1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0}) {
      std::vector<Figures> all(static_cast<std::size_t>(runs));
      for (Figures& one : all) ok = run_apart(part, labelled, one) && ok;
      std::sort(all.begin(), all.end(), [](const Figures& a, const Figures& b) { return a.seconds < b.seconds; });
      series.push_back(all[all.size() / 2]);
      print(series.back());
    }
    // Growing as n log n, each size would take the time of the one before times this.
    for (std::size_t k = 1; k < series.size(); ++k) {
      const double n_log_n =
          series[k].points * std::log(series[k].points) / (series[k - 1].points * std::log(series[k - 1].points));
      std::printf("  %7.0f points: %.2f times the seconds, n log n is %.2f times\n", series[k].points,
                  series[k].seconds / series[k - 1].seconds, n_log_n);
    }
    const Figures& whole = series.back();
    std::printf("scan_morph_%s median %.2f s of %d, limit 30 s: %s; peak %.0f MB, limit 2048: %s\n",
                labelled ? "labels" : "found", whole.seconds, runs, whole.seconds <= 30.0 ? "reached" : "MISSED",
                whole.peak_mb, whole.peak_mb <= 2048.0 ? "reached" : "MISSED");
  }
  return ok ? 0 : 1;
}
