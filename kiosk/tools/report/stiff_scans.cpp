#include "kiosk/tools/report/stiff_scans.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/workbench.hpp"
#include "packs/tools/cloud_file.hpp"
#include "packs/tools/scan_builder.hpp"

namespace lackwerk::report {

namespace {

constexpr const char* kernel = "scans";

struct ScanCase {
  std::string name;
  core::PointCloud from, to;
  bool virtual_root = false;
};

/// A stem of `height` with points every `step`, jittered by a cube of edge 0.8; label 0.
core::PointCloud stem(double height, double step, unsigned seed) {
  std::mt19937 random(seed);
  const auto jitter = [&] { return 0.8 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  core::PointCloud out;
  const auto count = static_cast<int>(height / step);
  for (int i = 0; i < count; ++i) {
    out.points.emplace_back(jitter(), jitter(), step * i);
    out.labels.push_back(0);
  }
  return out;
}

core::PointCloud moved(core::PointCloud cloud, const std::function<glm::dvec3(const glm::dvec3&)>& motion) {
  for (glm::dvec3& p : cloud.points) p = motion(p);
  return cloud;
}

core::PointCloud alike(std::vector<glm::dvec3> points) {
  core::PointCloud out{std::move(points), {}};
  out.labels.assign(out.points.size(), 0);
  return out;
}

std::vector<ScanCase> scan_cases() {
  const core::PointCloud plain = stem(50.0, 0.5, 1);
  std::vector<ScanCase> out;
  out.push_back({"a single point", plain, alike({{1.0, 2.0, 3.0}})});
  out.push_back({"200 points in one place", plain, alike(std::vector<glm::dvec3>(200, glm::dvec3(1.0, 2.0, 3.0)))});
  std::vector<glm::dvec3> twice = plain.points;
  twice.insert(twice.end(), plain.points.begin(), plain.points.end());
  out.push_back({"every point twice", plain, alike(twice)});
  std::vector<glm::dvec3> line, lattice;
  line.reserve(100);
  lattice.reserve(400);
  for (int i = 0; i < 100; ++i) line.emplace_back(0.0, 0.0, 0.5 * i);
  out.push_back({"a stem without width", plain, alike(line)});
  for (int i = 0; i < 400; ++i) lattice.emplace_back(i % 20, std::floor(0.05 * i), 0.0);
  out.push_back({"a lattice of equal ways", alike(lattice), alike(lattice)});
  out.push_back({"100 times denser", plain, stem(50.0, 0.005, 2)});
  core::PointCloud uneven = stem(50.0, 0.5, 3);
  for (int i = 0; i < 2000; ++i) uneven.points.emplace_back(0.0, 0.001 * i, 49.0);
  uneven.labels.resize(uneven.points.size(), 0);
  out.push_back({"dense at one end", plain, uneven});
  out.push_back({"no overlap", plain, moved(stem(50.0, 0.5, 4), [](auto p) { return p + glm::dvec3(1e4, 0.0, 0.0); })});
  out.push_back({"1e6 from the origin", moved(plain, [](auto p) { return p + glm::dvec3(1e6); }),
                 moved(stem(60.0, 0.5, 5), [](auto p) { return p + glm::dvec3(1e6); })});
  out.push_back({"in units of 1e-9", moved(plain, [](auto p) { return 1e-9 * p; }),
                 moved(stem(60.0, 0.5, 6), [](auto p) { return 1e-9 * p; })});
  // The root that labelled leaves hang from has no points; what bears its number -1 must not be taken for it.
  core::PointCloud leaf = plain;
  std::fill(leaf.labels.begin(), leaf.labels.end(), -1);
  out.push_back({"an empty segment", plain, leaf, true});
  core::PointCloud other = plain;
  std::fill(other.labels.begin(), other.labels.end(), 7);
  out.push_back({"no label in common", plain, other});
  return out;
}

/// Points of both scans that no path leaves or reaches.
double lost(const packs::ScanSeries& series) {
  std::vector<bool> left(series.scans[0].cloud.points.size(), false),
      reached(series.scans[1].cloud.points.size(), false);
  for (const core::CloudPath& path : series.steps[0].paths) {
    left[path.from_point] = true;
    if (path.to_point != core::CloudPath::none) reached[path.to_point] = true;
  }
  return static_cast<double>(std::count(left.begin(), left.end(), false) +
                             std::count(reached.begin(), reached.end(), false));
}

double not_numbers(const packs::ScanSeries& series) {
  double count = 0.0;
  for (const glm::dvec3& p : core::places_at(series.steps[0].paths, 0.5))
    if (!std::isfinite(p.x + p.y + p.z)) ++count;
  return count;
}

/// What one case came to, over both directions and all ways to prepare it.
struct Worst {
  double lost = 0.0, not_numbers = 0.0, violation = 0.0;
  std::string where;
};

void try_one(const ScanCase& instance, bool forward, bool bare, bool labels, Worst& worst) {
  packs::ScanSettings settings;
  settings.threads = 1;
  settings.by_label = labels;
  settings.segments.virtual_root = instance.virtual_root;
  // The choice of pairs needs no exact marginals; here they are asked for.
  settings.transport.most_iterations = 10000;
  if (bare) {
    settings.clean = settings.align = false;
    settings.spacing = -1.0;
  }
  const std::vector<packs::ScanSource> scans{{"one", 0.0, forward ? instance.from : instance.to},
                                             {"two", 1.0, forward ? instance.to : instance.from}};
  const auto series = packs::morph_series(scans, settings);
  const std::string where = std::string(forward ? "forward" : "backward") + (bare ? ", as they are" : ", prepared") +
                            (labels ? ", labelled" : ", segments found");
  if (!series) {
    worst.lost = worst.not_numbers = worst.violation = none;
    worst.where = where + ": " + series.error().line();
    return;
  }
  worst.lost += lost(*series);
  worst.not_numbers += not_numbers(*series);
  if (series->steps[0].worst_violation > worst.violation) {
    worst.violation = series->steps[0].worst_violation;
    worst.where = where;
  }
}

/// 0: refused with exactly one line that says what is wrong.
double unclear(const std::string& line) { return line.empty() || line.find('\n') != std::string::npos ? 1.0 : 0.0; }

void add_refused(Findings& findings) {
  const core::PointCloud plain = stem(50.0, 0.5, 1);
  const std::string text = "1 2 3\n4 nan 6\n";
  const auto read =
      packs::parse_cloud(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), "rows.xyz");
  add_case(findings, kernel, "a row that is no number, from a file", "not refused with one line",
           read ? 1.0 : unclear(read.error().line()), 0.0, read ? "read" : read.error().line());
  for (const bool forward : {true, false}) {
    core::PointCloud wrong = plain;
    wrong.points[7].y = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [name, cloud] :
         {std::pair("a point that is no number", wrong), std::pair("no points", core::PointCloud{})}) {
      const std::vector<packs::ScanSource> scans{{"one", 0.0, forward ? plain : cloud},
                                                 {"two", 1.0, forward ? cloud : plain}};
      const auto series = packs::morph_series(scans, {});
      add_case(findings, kernel, std::string(name) + (forward ? ", forward" : ", backward"),
               "not refused with one line", series ? 1.0 : unclear(series.error().line()), 0.0,
               series ? "morphed" : series.error().line());
    }
  }
}

}  // namespace

void add_stiff_scans(Findings& findings) {
  // A tenth more than the tolerance: the violation is summed again in double after a stop judged in float.
  const double bound = 1.1 * core::CloudTransportOptions{}.tolerance;
  for (const ScanCase& instance : scan_cases()) {
    Worst worst;
    for (const bool forward : {true, false})
      for (const bool bare : {true, false})
        for (const bool labels : {true, false}) try_one(instance, forward, bare, labels, worst);
    add_case(findings, kernel, instance.name, "points that do not leave or arrive", worst.lost, 0.0, worst.where);
    add_case(findings, kernel, instance.name, "places that are no numbers", worst.not_numbers, 0.0, worst.where);
    add_case(findings, kernel, instance.name, "marginal violation, of all mass", worst.violation, bound, worst.where);
  }
  add_refused(findings);
}

}  // namespace lackwerk::report
