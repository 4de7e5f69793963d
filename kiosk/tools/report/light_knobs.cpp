#include "kiosk/tools/report/light_knobs.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/analysis/environment_build.hpp"
#include "core/analysis/environment_lights.hpp"
#include "core/analysis/studio.hpp"
#include "core/paint_model.hpp"
#include "kiosk/tools/report/coat_knob.hpp"
#include "packs/tools/capture_brdf.hpp"

namespace lackwerk::report {
namespace {

using glm::dvec3;

/// Directions spread evenly over the sphere: a spiral of equal areas (Gonzalez 2010).
std::vector<dvec3> spread_directions(int count) {
  std::vector<dvec3> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count, r = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * std::numbers::pi * k / std::numbers::phi;
    out.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return out;
}

/// Relative root mean square, and of single ones over the mean: 95 % and largest.
void judge(const std::vector<double>& shown, const std::vector<double>& exact, Setting& setting) {
  double squares = 0.0, exact_squares = 0.0, sum = 0.0;
  std::vector<double> off;
  off.reserve(exact.size());
  for (std::size_t k = 0; k < exact.size(); ++k) {
    off.push_back(std::abs(shown[k] - exact[k]));
    squares += off.back() * off.back();
    exact_squares += exact[k] * exact[k];
    sum += exact[k];
  }
  const double mean = sum / static_cast<double>(exact.size());
  for (double& one : off) one /= mean;
  set_errors(setting, std::move(off));
  setting.error = std::sqrt(squares / exact_squares);
}

Timing once(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return timing_of({std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()});
}

// ---- cuts into lights

/// Luminance of the irradiance over pi of each normal, by all texels of the map.
std::vector<double> exact_irradiance(const core::OctahedralImage& map, const std::vector<dvec3>& normals) {
  std::vector<double> out(normals.size(), 0.0);
  for (int y = 0; y < map.edge; ++y)
    for (int x = 0; x < map.edge; ++x) {
      const dvec3 d = core::direction_from_octahedral({(x + 0.5) / map.edge, (y + 0.5) / map.edge});
      const double power = core::luminance_of(dvec3(map.at(x, y))) * core::texel_solid_angle(map.edge, x, y);
      for (std::size_t k = 0; k < normals.size(); ++k)
        out[k] += power * std::max(0.0, glm::dot(normals[k], d)) / std::numbers::pi;
    }
  return out;
}

std::vector<double> irradiance_of(const std::vector<core::EnvironmentLight>& lights,
                                  const std::vector<dvec3>& normals) {
  std::vector<double> out(normals.size(), 0.0);
  for (const core::EnvironmentLight& light : lights)
    for (std::size_t k = 0; k < normals.size(); ++k)
      out[k] += core::luminance_of(dvec3(light.radiance)) * std::max(0.0, glm::dot(normals[k], dvec3(light.direction)));
  return out;
}

/// The paint under every light that stands above it, for one eye.
dvec3 shade(const core::Brdf& brdf, const std::vector<core::EnvironmentLight>& lights, const dvec3& out) {
  dvec3 sum(0.0);
  for (const core::EnvironmentLight& light : lights) {
    const dvec3 in(light.direction);
    if (in.z > 0.0) sum += brdf(in, out) * dvec3(light.radiance) * (in.z * std::numbers::pi);
  }
  return sum;
}

// ---- resolution of the map

constexpr int mirror_edge = core::environment_levels[0].edge;

/// The exact mean around r under a level's lobe: rings of equal angle, as the level's definition weighs them.
double exact_lobe(const dvec3& r, double m, int steps) {
  const dvec3 t = glm::normalize(glm::cross(std::abs(r.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0), r));
  const dvec3 b = glm::cross(r, t);
  // Beyond six times m nothing is left: exp(-36).
  const double last = std::min(std::numbers::pi / 2.0, 2.0 * std::atan(6.0 * m));
  double sum = 0.0, weights = 0.0;
  for (int ring = 0; ring < steps; ++ring) {
    const double theta = (ring + 0.5) / steps * last;
    const double weight = core::beckmann_weight(theta, m) * std::sin(theta);
    for (int sector = 0; sector < steps; ++sector) {
      const double phi = (sector + 0.5) / steps * 2.0 * std::numbers::pi;
      const dvec3 l = r * std::cos(theta) + (t * std::cos(phi) + b * std::sin(phi)) * std::sin(theta);
      sum += weight * core::luminance_of(core::studio_radiance(l));
      weights += weight;
    }
  }
  return sum / weights;
}

double bytes_of_edge(int edge) { return 4.0 * (edge + 2.0) * (edge + 2.0); }

std::vector<double> read_back(const core::OctahedralImage& image, const std::vector<dvec3>& directions) {
  std::vector<double> out;
  out.reserve(directions.size());
  for (const dvec3& d : directions) {
    const glm::dvec2 uv = core::octahedral_from_direction(d);
    out.push_back(core::luminance_of(dvec3(image.filtered(uv.x, uv.y))));
  }
  return out;
}

/// What the renderer reads of the bytes that a scene carries.
Setting stored_setting(const core::Environment& environment, int level, std::string label,
                       const std::vector<dvec3>& directions, const std::vector<double>& exact, const Timing& time) {
  core::PaintModel<double> model;
  model.environment = &environment;
  model.u_environment_scale = static_cast<double>(environment.range);
  std::vector<double> shown;
  shown.reserve(directions.size());
  for (const dvec3& d : directions) shown.push_back(core::luminance_of(model.environment_at(d, level)));
  const int edge = core::environment_levels[static_cast<std::size_t>(level)].edge;
  Setting out;
  out.label = std::move(label);
  out.line = "as stored, 8 bits";
  out.value = edge;
  out.bytes = bytes_of_edge(edge);
  out.time = time;
  out.note = "time: all ten levels and the lights";
  judge(shown, exact, out);
  return out;
}

void add_mirrors(Workbench& bench, const std::vector<dvec3>& directions, const std::vector<double>& exact, Knob& knob) {
  const int most = bench.choose(1024, 512);
  for (int edge = 64; edge <= most; edge *= 2) {
    Setting setting;
    setting.label = "mirror, " + std::to_string(edge);
    setting.line = "mirror";
    setting.value = edge;
    setting.bytes = bytes_of_edge(edge);
    core::OctahedralImage image(1);
    setting.time = once([&] { image = core::resampled(core::studio_radiance, edge, 4); });
    judge(read_back(image, directions), exact, setting);
    knob.settings.push_back(std::move(setting));
  }
}

void add_lobes(Workbench& bench, int level, const std::vector<core::OctahedralImage>& source,
               const std::vector<dvec3>& directions, const std::vector<double>& exact, Knob& knob) {
  const core::EnvironmentLevel& usual = core::environment_levels[static_cast<std::size_t>(level)];
  const std::string lobe = "lobe of m " + digits(usual.m);
  const std::array edges = {usual.edge / 4, usual.edge / 2, usual.edge, 2 * usual.edge};
  for (const int edge : edges) {
    if (edge > bench.choose(2 * usual.edge, usual.edge)) continue;
    Setting setting;
    setting.label = lobe + ", " + std::to_string(edge);
    setting.line = lobe;
    setting.value = edge;
    setting.bytes = bytes_of_edge(edge);
    core::OctahedralImage image(1);
    setting.time = once([&] { image = core::beckmann_filtered(source, usual.m, edge); });
    judge(read_back(image, directions), exact, setting);
    knob.settings.push_back(std::move(setting));
  }
}

const Setting& setting_of(const Knob& knob, const std::string& label) {
  return *std::find_if(knob.settings.begin(), knob.settings.end(),
                       [&](const Setting& setting) { return setting.label == label; });
}

}  // namespace

Result<Knob> cut_lights_knob(Workbench& bench) {
  const auto car = bench.car();
  if (!car) return tl::unexpected(car.error());
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  Knob knob;
  knob.id = "cut_lights";
  knob.title = "Lights cut from the environment";
  knob.what = "The studio's map, halved by its light again and again, as 1 to 256 directional lights.";
  knob.error_unit =
      "irradiance against the sum over the map: root mean square over its own, luminance; 95 % and worst "
      "over the mean";
  knob.time_of = "256 points of the first paint under all lights, one core";
  // The cut sees 256 texels an edge: a quarter of the map's own texels move no light by more than 0.2 degrees.
  const auto maps = core::halvings(core::shown_means((*car)->environment, 0));
  const core::OctahedralImage& map = maps[bench.choose<std::size_t>(1, 2)];
  const std::vector<dvec3> normals = spread_directions(bench.choose(512, 256));
  const std::vector<double> exact = exact_irradiance(map, normals);
  const core::Brdf brdf = packs::capture_brdf((*captures)->front());
  constexpr int points = 256;
  constexpr int most_halvings = 8;
  for (int halvings = 0; halvings <= most_halvings; ++halvings) {
    const auto lights = core::median_cut(map, halvings);
    Setting setting;
    setting.label = std::to_string(lights.size());
    setting.value = static_cast<double>(lights.size());
    setting.line = "median cut";
    setting.eligible = lights.size() <= static_cast<std::size_t>(core::environment_light_count);
    if (!setting.eligible) setting.note = "more than a scene file holds";
    judge(irradiance_of(lights, normals), exact, setting);
    dvec3 sink(0.0);
    setting.time = bench.time(
        [&] {
          for (int k = 0; k < points; ++k) {
            const double theta = 1.2 * k / points;
            sink += shade(brdf, lights, {std::sin(theta), 0.0, std::cos(theta)});
          }
        },
        200.0, 3, 50);
    if (!(sink.x >= 0.0)) setting.note = "not a number";
    knob.settings.push_back(std::move(setting));
  }
  knob.chosen = std::to_string(core::environment_light_count);
  const Setting &chosen = setting_of(knob, knob.chosen), &last = knob.settings.back();
  knob.why = "Scene files hold a tree of " + knob.chosen +
             " lights, whose sums are the smaller cuts: their irradiance is off by " + digits(100.0 * chosen.error) +
             " %, where 4 lights are off by " + digits(100.0 * setting_of(knob, "4").error) + " % and " + last.label +
             " by " + digits(100.0 * last.error) + " % for " + digits(last.time.median_ms / chosen.time.median_ms) +
             " times the shading.";
  return knob;
}

Result<Knob> environment_knob(Workbench& bench) {
  const auto car = bench.car();
  if (!car) return tl::unexpected(car.error());
  const core::Environment& environment = (*car)->environment;
  Knob knob;
  knob.id = "environment";
  knob.title = "Resolution of the environment";
  knob.what =
      "Edges of the studio's octahedral levels: the map itself for mirrors, and what two narrow Beckmann lobes "
      "see; linear between texels, before and after they become bytes.";
  knob.error_unit =
      "radiance against the formula's exact integral: root mean square over its own, luminance; 95 % and "
      "worst over the mean";
  knob.time_of = "making the level, all cores";
  knob.bytes_of = "the level's RGBA8 texels with their border";

  const std::vector<dvec3> directions = spread_directions(bench.choose(4000, 1500));
  std::vector<double> mirror;
  mirror.reserve(directions.size());
  for (const dvec3& d : directions) mirror.push_back(core::luminance_of(core::studio_radiance(d)));
  add_mirrors(bench, directions, mirror, knob);
  const Timing build = once([] { (void)core::build_studio(); });
  knob.chosen = "stored mirror, " + std::to_string(mirror_edge);
  knob.settings.push_back(stored_setting(environment, 0, knob.chosen, directions, mirror, build));

  const auto source = core::halvings(core::resampled(core::studio_radiance, mirror_edge, 4));
  const std::vector<dvec3> few = spread_directions(bench.choose(1000, 250));
  constexpr std::array lobe_levels = {1, 2};
  for (const int level : lobe_levels) {
    const double m = core::environment_levels[static_cast<std::size_t>(level)].m;
    std::vector<double> exact;
    exact.reserve(few.size());
    for (const dvec3& d : few) exact.push_back(exact_lobe(d, m, bench.choose(96, 48)));
    add_lobes(bench, level, source, few, exact, knob);
    knob.settings.push_back(
        stored_setting(environment, level,
                       "stored lobe of m " + digits(m) + ", " +
                           std::to_string(core::environment_levels[static_cast<std::size_t>(level)].edge),
                       few, exact, build));
    bench.progress(0.4 + 0.3 * level / static_cast<double>(lobe_levels.size()));
  }
  const Setting &chosen = setting_of(knob, knob.chosen),
                &half = setting_of(knob, "mirror, " + std::to_string(mirror_edge / 2)),
                &same = setting_of(knob, "mirror, " + std::to_string(mirror_edge)), &lobe = knob.settings.back();
  knob.why = "Scenes carry " + std::to_string(mirror_edge) + " texels an edge for mirrors, " +
             digits(chosen.bytes * 1e-6) + " MB: off by " + digits(100.0 * chosen.error) + " % (" +
             digits(100.0 * same.error) + " % by plain means of as many texels), plain means of half the edge by " +
             digits(100.0 * half.error) +
             " %; nearly all of it stands at the edges of lamps (95 % of directions: below " +
             digits(100.0 * chosen.p95) + " % of the mean). Rougher levels are smaller; " + lobe.label +
             " texels an edge, is off by " + digits(100.0 * lobe.error) +
             " %. The whole atlas keeps to one texture of the size that every OpenGL ES 2.0 driver has.";
  return knob;
}

Result<void> add_light(Workbench& bench, Findings& findings) {
  auto cut = cut_lights_knob(bench);
  if (!cut) return tl::unexpected(cut.error());
  bench.progress(0.3);
  auto environment = environment_knob(bench);
  if (!environment) return tl::unexpected(environment.error());
  bench.progress(0.9);
  auto coat = coat_knob(bench);
  if (!coat) return tl::unexpected(coat.error());
  findings.knobs.push_back(std::move(*cut));
  findings.knobs.push_back(std::move(*environment));
  findings.knobs.push_back(std::move(*coat));
  bench.progress(1.0);
  return {};
}

}  // namespace lackwerk::report
