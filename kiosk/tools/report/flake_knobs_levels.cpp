#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/analysis/distribution_error.hpp"
#include "core/analysis/flake_clusters.hpp"
#include "core/colour.hpp"
#include "kiosk/tools/report/flake_knobs.hpp"
#include "kiosk/tools/report/flake_knobs_slices.hpp"
#include "kiosk/tools/report/flake_memory.hpp"

namespace lackwerk::report {

namespace {

/// One slice at one level, drawn by its clusters or as the slice's mean: how far from its texels, and how long
/// clustering takes.
struct LevelCost {
  double clustered = 0.0;  ///< Lab
  double as_mean = 0.0;    ///< Lab
};

/// The exact 1-Wasserstein distance to one colour: all texels go there.
double distance_to(const std::vector<glm::vec3>& lab, const glm::vec3& mean) {
  double sum = 0.0;
  for (const glm::vec3& texel : lab) {
    const glm::dvec3 way = glm::dvec3(texel) - glm::dvec3(mean);
    sum += std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
  }
  return sum / static_cast<double>(lab.size());
}

glm::vec3 mean_of(const FlakeLevel& level) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& texel : level.linear) sum += glm::dvec3(texel);
  return {core::lab_from_linear(sum / static_cast<double>(level.linear.size()))};
}

}  // namespace

Result<void> add_flake_levels(Workbench& bench, Findings& findings) {
  const auto samples = flake_samples(bench);
  if (!samples) return tl::unexpected(samples.error());
  const auto pack = bench.pack();
  if (!pack) return tl::unexpected(pack.error());
  const core::InterpolatablePaint paint = (*pack)->data.view();
  const std::size_t all = samples->front().levels.size();

  std::vector<std::vector<LevelCost>> costs;
  costs.reserve(samples->size());
  for (const FlakeSample& slice : *samples) {
    const glm::vec3 mean = mean_of(slice.levels.front());
    std::vector<LevelCost>& own = costs.emplace_back();
    own.reserve(all);
    for (const FlakeLevel& level : slice.levels)
      own.push_back({core::wasserstein1_lab(level.lab, core::cluster_texels(level.lab, {}), {}, 1024),
                     distance_to(level.lab, mean)});
  }

  Knob knob;
  knob.id = "levels";
  knob.title = "Mip levels kept";
  knob.what = "A footprint at the last kept level or beyond is drawn as the slice's mean. Levels 0 to " +
              std::to_string(all - 2) + " of " + std::to_string(samples->size()) + " slices count alike.";
  knob.error_unit = "1-Wasserstein distance, Lab";
  knob.time_of = "clustering all kept levels of one slice";
  knob.bytes_of = "the flakes' textures of the three paints' pack on the GPU";
  knob.chosen = std::to_string(all);
  double at_all = none, one_less = none, bytes_all = none, bytes_less = none;
  const int width = [&] {
    std::uint32_t widest = 0;
    for (std::size_t row = 0; row + 1 < paint.tuple_begin.size(); ++row)
      widest = std::max(widest, paint.tuple_begin[row + 1] - paint.tuple_begin[row]);
    return static_cast<int>(widest);
  }();
  const auto& table = paint.paints.front().analytic.table;
  for (std::size_t kept = 2; kept <= all; ++kept) {
    std::vector<double> errors;
    errors.reserve(samples->size() * all);
    for (const std::vector<LevelCost>& own : costs)
      for (std::size_t level = 0; level + 1 < all; ++level)
        errors.push_back(level + 1 < kept ? own[level].clustered : own[level].as_mean);
    Setting one;
    one.label = std::to_string(kept);
    one.value = static_cast<double>(kept);
    one.line = "levels kept";
    set_errors(one, std::move(errors));
    one.bytes = static_cast<double>(
        flake_texture_bytes({paint.layout.slice_count(), static_cast<int>(kept), width, table ? table->num_theta : 0}));
    std::size_t found = 0;
    one.time = bench.time(
        [&] {
          for (std::size_t level = 0; level + 1 < kept; ++level)
            found += core::cluster_texels(samples->front().levels[level].lab, {}).size();
        },
        60.0, 3, 20);
    if (found == 0) one.note = "no clusters";
    if (kept == all) {
      at_all = one.error;
      bytes_all = one.bytes;
    } else {
      one_less = one.error;
      bytes_less = one.bytes;
    }
    knob.settings.push_back(std::move(one));
  }
  knob.why = "All " + knob.chosen + " levels err by " + digits(at_all) + " Lab in " + digits(bytes_all * 1e-6) +
             " MB; one level less by " + digits(one_less) + " in " + digits(bytes_less * 1e-6) +
             " MB. The last level is one texel and its own mean: it has no rows.";
  findings.knobs.push_back(std::move(knob));
  return {};
}

}  // namespace lackwerk::report
