#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "kiosk/tools/find_recipe.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_memory.hpp"
#include "packs/paint_pack_codec.hpp"
#include "packs/sealed_file.hpp"
#include "packs/tools/pack_builder.hpp"
#include "packs/tools/recipe.hpp"
#include "packs/tools/virtual_goniometer.hpp"

namespace lackwerk::report {

namespace {

constexpr double megabyte = 1e6;

/// One pack that was built, by what it takes and how far its flakes are from the texels.
struct PackPoint {
  int clusters = 0;
  std::size_t paints = 0;
  core::PruneRule rule = core::PruneRule::misfit;
  double pack_bytes = none, gpu_bytes = none;  ///< a paint
  std::vector<double> errors;                  ///< mean over slices, one per paint
  double seconds = none;
  [[nodiscard]] double error() const {
    return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  }
};

int widest_row(const core::InterpolatableData& data) {
  std::uint32_t widest = 0;
  for (std::size_t row = 0; row + 1 < data.tuple_begin.size(); ++row)
    widest = std::max(widest, data.tuple_begin[row + 1] - data.tuple_begin[row]);
  return static_cast<int>(widest);
}

int table_size(const core::InterpolatableData& data) {
  int size = 0;
  for (const auto& part : data.parts)
    if (part.analytic.table) size = std::max<int>(size, part.analytic.table->num_theta);
  return size;
}

Result<PackPoint> build_point(std::span<const packs::Capture> captures, int clusters, core::PruneRule rule) {
  packs::PackBuildSettings settings;
  settings.id = "lackwerk.report";
  settings.clusters.max_clusters = clusters;
  settings.clusters.rule = rule;
  const auto start = std::chrono::steady_clock::now();
  const auto built = packs::build_pack(captures, settings);
  if (!built) return tl::unexpected(built.error());
  PackPoint out;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.clusters = clusters;
  out.paints = captures.size();
  out.rule = rule;
  const double paints = static_cast<double>(captures.size());
  out.pack_bytes =
      static_cast<double>(packs::encode_paint_pack(built->contents()).size() + packs::sealed_header_bytes) / paints;
  const core::InterpolatableData& data = built->data;
  out.gpu_bytes = static_cast<double>(flake_texture_bytes(
                      {data.frame.layout.slice_count(), data.frame.level_count, widest_row(data), table_size(data)})) /
                  paints;
  for (const packs::PaintError& error : built->info.errors)
    out.errors.push_back(static_cast<double>(error.flake_w1_mean));
  return out;
}

Setting setting_of(const PackPoint& point, bool gpu) {
  Setting out;
  const std::string paints = std::to_string(point.paints) + (point.paints == 1 ? " paint" : " paints");
  out.label = std::to_string(point.clusters) + ", " + paints + (gpu ? ", GPU" : ", pack");
  out.value = point.clusters;
  out.line = paints + (gpu ? ", on the GPU" : ", in the pack");
  out.bytes = gpu ? point.gpu_bytes : point.pack_bytes;
  out.error = point.error();
  out.worst = *std::max_element(point.errors.begin(), point.errors.end());
  out.time = timing_of({1e3 * point.seconds});
  return out;
}

/// The fewest clusters of a pack of three paints that are no farther from the texels than the papers' settings.
const PackPoint* fewest(const std::vector<PackPoint>& points, double error, std::size_t paints) {
  const PackPoint* best = nullptr;
  for (const PackPoint& point : points)
    if (point.paints == paints && point.error() <= error && (best == nullptr || point.clusters < best->clusters))
      best = &point;
  return best;
}

Speed memory_speed(const std::string& id, const PackPoint& at, const PackPoint& standard, const PackPoint& papers,
                   bool gpu) {
  Speed out;
  out.id = id;
  out.what = std::string(gpu ? "textures of the flakes on the GPU" : "the pack's file") + ", a paint of " +
             std::to_string(at.paints) + ", at " + std::to_string(at.clusters) +
             " clusters: the fewest measured whose error (" + digits(at.error()) +
             " Lab) is no worse than the papers' settings' (" + digits(papers.error()) + ")";
  out.value = (gpu ? at.gpu_bytes : at.pack_bytes) / megabyte;
  out.unit = "MB";
  out.aim = 0.5;
  out.count = 1;
  out.bound_by = "the default of " + std::to_string(standard.clusters) + " clusters takes " +
                 digits((gpu ? standard.gpu_bytes : standard.pack_bytes) / megabyte) + " MB at " +
                 digits(standard.error()) + " Lab";
  if (gpu) out.bound_by += "; the random texture and the rank tables are shared by all paints of a pack";
  return out;
}

/// Two more paints for packs of five, of the same size as the workbench's.
Result<std::vector<packs::Capture>> five_captures(Workbench& bench) {
  const auto three = bench.captures();
  if (!three) return tl::unexpected(three.error());
  std::vector<packs::Capture> out = **three;
  for (const char* name : {"gu_bmw_339_coated", "gu_opel_titan_coated"}) {
    const auto recipe = packs::read_recipe(tools::find_recipe(name));
    if (!recipe) return tl::unexpected(recipe.error());
    packs::GoniometerSettings settings;
    settings.edge_texels = bench.edge_texels();
    auto capture = packs::measure(*recipe, settings);
    if (!capture) return tl::unexpected(capture.error());
    out.push_back(std::move(*capture));
  }
  return out;
}

struct Wanted {
  std::size_t paints;
  int clusters;
};
/// Rows hold 256 tuples: about 85 clusters of each of three paints, 50 of five.
std::vector<Wanted> wanted_points(bool quick) {
  if (quick) return {{3, 10}, {3, 25}, {3, 50}};
  return {{1, 10}, {1, 25}, {1, 50}, {1, 250}, {3, 10}, {3, 15}, {3, 20},
          {3, 25}, {3, 50}, {3, 80}, {5, 10},  {5, 25}, {5, 50}};
}

Speed build_speed(const Workbench& bench, std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  Speed out;
  out.id = "pack_build";
  out.what = "building the pack of three captures of " + std::to_string(bench.edge_texels()) + " x " +
             std::to_string(bench.edge_texels()) + " texels, default settings, all cores";
  if (bench.quick()) out.what += " (scaled captures: no aim)";
  out.value = seconds[seconds.size() / 2];
  out.unit = "s";
  out.aim = bench.quick() ? none : 5.0;
  out.count = static_cast<int>(seconds.size());
  out.bound_by = "clustering all slices at all levels, and the 1-Wasserstein bound that is stored with them";
  return out;
}

}  // namespace

Result<void> add_flake_memory(Workbench& bench, Findings& findings) {
  const auto three = bench.captures();
  if (!three) return tl::unexpected(three.error());
  const std::span<const packs::Capture> demo(**three);
  constexpr int standard_clusters = core::ClusterSettings{}.max_clusters;
  constexpr std::size_t demo_paints = 3;

  Knob knob;
  knob.id = "memory";
  knob.title = "Bytes of a paint against its error";
  knob.what =
      "Packs of 1, 3 and 5 paints, built whole at several numbers of clusters: bytes a paint in the file and on "
      "the GPU, apart. A row holds 256 tuples at the most, which ends the lines of three and five paints.";
  if (bench.quick())
    knob.what =
        "Packs of 3 paints at several numbers of clusters: bytes a paint in the file and on "
        "the GPU, apart.";
  knob.error_unit = "1-Wasserstein distance at level 0, Lab";
  knob.time_of = "building the pack, all cores";
  knob.bytes_of = "one paint of the pack";
  knob.chosen = std::to_string(standard_clusters) + ", 3 paints, GPU";

  std::vector<PackPoint> points;
  std::vector<double> default_seconds;
  const std::vector<Wanted> wanted = wanted_points(bench.quick());
  std::vector<packs::Capture> five;  // as large as twice the demo's three: made when it is their turn, and let go
  for (const Wanted& one : wanted) {
    if (one.paints > demo.size() && five.empty()) {
      auto made = five_captures(bench);
      if (!made) return tl::unexpected(made.error());
      five = std::move(*made);
    }
    const std::span<const packs::Capture> from =
        one.paints > demo.size() ? std::span<const packs::Capture>(five) : demo;
    auto point = build_point(from.first(one.paints), one.clusters, core::PruneRule::misfit);
    if (!point) return tl::unexpected(point.error());
    if (one.paints == demo_paints && one.clusters == standard_clusters) default_seconds.push_back(point->seconds);
    points.push_back(std::move(*point));
    bench.progress(0.6 + 0.35 * static_cast<double>(points.size()) / static_cast<double>(wanted.size() + 1));
  }
  five = {};
  const auto papers = build_point(demo.first(demo_paints), 50, core::PruneRule::density);
  if (!papers) return tl::unexpected(papers.error());
  for (int again = 0; again < bench.choose(2, 0); ++again) {
    const auto point = build_point(demo.first(demo_paints), standard_clusters, core::PruneRule::misfit);
    if (!point) return tl::unexpected(point.error());
    default_seconds.push_back(point->seconds);
  }

  for (const bool gpu : {false, true})
    for (const PackPoint& point : points) knob.settings.push_back(setting_of(point, gpu));
  Setting theirs = setting_of(*papers, true);
  theirs.label = "papers";
  theirs.line = "papers: density rule, 500 steps, 9 levels";
  const packs::Capture& first = demo.front();
  theirs.bytes = static_cast<double>(papers_texture_bytes(first.layout.slice_count(), 9, 50, 500));
  theirs.eligible = false;
  theirs.note = "one paint alone with all " + std::to_string(first.layout.slice_count()) +
                " slices, as Golla & Klein (2018) lay it out, 16-bit corners; Golla (2021), 2.5.2 measured 4.6 MB of "
                "graphics memory";
  knob.settings.push_back(std::move(theirs));

  const PackPoint* standard = nullptr;
  for (const PackPoint& point : points)
    if (point.paints == demo_paints && point.clusters == standard_clusters) standard = &point;
  const PackPoint* least = fewest(points, papers->error(), demo_paints);
  if (least == nullptr) least = standard;
  knob.why = "Clustered by the papers' density rule, 50 boxes are " + digits(papers->error()) +
             " Lab from the texels. " + std::to_string(least->clusters) + " by the misfit rule are " +
             digits(least->error()) + " in " + digits(least->pack_bytes / megabyte) + " MB a paint in the pack and " +
             digits(least->gpu_bytes / megabyte) + " MB on the GPU. The default of " +
             std::to_string(standard_clusters) + " is " + digits(standard->error()) + " in " +
             digits(standard->pack_bytes / megabyte) + " and " + digits(standard->gpu_bytes / megabyte) + " MB.";
  findings.knobs.push_back(std::move(knob));
  findings.speeds.push_back(memory_speed("pack_bytes_per_paint", *least, *standard, *papers, false));
  findings.speeds.push_back(memory_speed("gpu_bytes_per_paint", *least, *standard, *papers, true));
  findings.speeds.push_back(build_speed(bench, std::move(default_seconds)));
  return {};
}

}  // namespace lackwerk::report
