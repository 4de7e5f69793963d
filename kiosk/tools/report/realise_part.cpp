#include "kiosk/tools/report/realise_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/realise.hpp"
#include "kiosk/tools/report/synthetic_pack.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::report {
namespace {

constexpr int clusters = 50;

core::Weights even_mix(std::size_t paints) {
  return core::Weights::uniform(std::vector<double>(paints, 1.0 / static_cast<double>(paints)));
}

Timing time_realise(const Workbench& bench, const core::InterpolatablePaint& paint) {
  const core::Weights weights = even_mix(paint.paints.size());
  core::RealisedPaint out;
  return bench.time([&] { core::realise(paint, weights, out); });
}

/// What realise() reads and writes of the flakes: clusters, tuples and masses in, corners out.
std::size_t bytes_moved(const core::InterpolatablePaint& paint) {
  core::RealisedPaint out;
  core::realise(paint, even_mix(paint.paints.size()), out);
  std::size_t bytes = out.corners.size() * sizeof(core::QuantisedCuboid) + paint.mass.size_bytes();
  for (const auto& part : paint.paints) bytes += part.clusters.size_bytes() + part.tuple_cluster.size_bytes();
  return bytes;
}

/// The finest mip level of the flakes that the first camera shows, as gles::Renderer::finest_level has it.
int finest_shown_level(const packs::Scene& scene, float texel_mm) {
  const gles::View view = gles::View::from(scene.cameras.front());
  float nearest_mm = std::numeric_limits<float>::max();
  for (const auto& part : scene.parts)
    if (part.kind == packs::SurfaceKind::paint)
      for (const glm::vec3& at : part.positions_mm) nearest_mm = std::min(nearest_mm, glm::distance(at, view.eye_mm));
  const float texels = nearest_mm * gles::pixel_size_per_mm(view, 720) / texel_mm;
  return std::max(0, static_cast<int>(std::floor(std::log2(texels) + 0.585f)));
}

Speed speed_of(const char* id, std::string what, const Timing& timing, double aim, std::string bound_by) {
  Speed speed;
  speed.id = id;
  speed.what = std::move(what);
  speed.value = timing.median_ms;
  speed.unit = "ms";
  speed.aim = aim;
  speed.count = timing.count;
  speed.bound_by = std::move(bound_by);
  return speed;
}

}  // namespace

Result<void> add_realise(Workbench& bench, Findings& findings) {
  auto made = synthetic_pack(5, clusters);
  if (!made) return tl::unexpected(made.error());
  const core::InterpolatablePaint five = made->view();
  const std::size_t bytes = bytes_moved(five);
  const std::vector<std::uint8_t> from(bytes, 1);
  std::vector<std::uint8_t> to(bytes);
  const Timing copy = bench.time([&] { std::memcpy(to.data(), from.data(), bytes); });
  const Timing all = time_realise(bench, five);
  const double gb_per_s = static_cast<double>(bytes) / (copy.median_ms * 1e6);
  findings.speeds.push_back(
      speed_of("realise_5_paints", "realise five paints of 50 clusters, all 67 slices and nine levels", all, 1.0,
               std::to_string(five.mass.size()) + " tuples, each the weighted sum of five boxes: " +
                   digits(1e6 * all.median_ms / static_cast<double>(five.mass.size())) +
                   " ns a tuple in arithmetic; copying the " + digits(static_cast<double>(bytes) / 1e6) +
                   " MB it reads and writes takes " + digits(copy.median_ms) + " ms (" + digits(gb_per_s) + " GB/s)"));

  const auto pack = bench.pack();
  if (!pack) return tl::unexpected(pack.error());
  const auto car = bench.car();
  if (!car) return tl::unexpected(car.error());
  const core::InterpolatablePaint three = (*pack)->contents().paint;
  const Timing whole = time_realise(bench, three);
  const int finest = finest_shown_level(**car, three.texel_mm);
  const core::Weights weights = even_mix(three.paints.size());
  core::RealisedPaint out;
  const Timing view = bench.time([&] {
    core::realise_flake_means(three, weights, out);
    core::realise_flake_levels(three, weights, std::max(finest, 1), three.level_count - 1, out);
  });
  findings.speeds.push_back(
      speed_of("realise_in_view", "realise the three demo paints as the kiosk's first camera needs them at 1280 x 720",
               view, 0.2,
               "means of all " + std::to_string(three.layout.slice_count()) +
                   " slices from level 0, and single flakes from level " + std::to_string(finest) +
                   " on, the finest that the camera shows; all " + std::to_string(three.level_count) +
                   " levels: " + digits(whole.median_ms) + " ms"));
  return {};
}

}  // namespace lackwerk::report
