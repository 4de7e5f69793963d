#include "tests/bench/render/map_peer.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "core/analysis/colour_map.hpp"
#include "core/analysis/map_paint.hpp"

namespace lackwerk::bench {
namespace {

constexpr double coat_index = 1.5;

core::ColourMap invented(core::CriticalAngleCure cure) {
  core::ColourMapSettings settings;
  settings.index = coat_index;
  settings.cure = cure;
  const core::Brdf flop = [](const glm::dvec3& in, const glm::dvec3& out) {
    const core::FlakeAngles flake = core::flake_angles(in, out, coat_index);
    const double bright = 0.05 + std::exp(-16.0 * flake.theta_flake * flake.theta_flake);
    return glm::dvec3(1.0 - flake.theta_inc, 0.5, 0.2 + flake.theta_inc) * (bright / std::numbers::pi);
  };
  auto map = core::colour_map_of(flop, settings);
  if (!map) std::abort();  // the settings are ours
  return std::move(*map);
}

enum class Colour { none, table, map, sliding_map };

/// A renderer of its own for each way, so that nothing is uploaded while time is taken.
struct Drawer {
  core::InterpolatablePaint paint;
  gles::Renderer renderer;

  Drawer(Stage& stage, Colour colour) : renderer(stage.context()) {
    const core::ColourMap map =
        invented(colour == Colour::sliding_map ? core::CriticalAngleCure::slide_along : core::CriticalAngleCure::clip);
    paint.paints.resize(1);
    core::AnalyticPaint& analytic = paint.paints[0].analytic;
    analytic = core::paint_of_map(map, coat_index, 91);
    // Lobes as a fitted paint has them: chi is not all that a pixel costs.
    analytic.lobes = {core::Lobe{glm::dvec3(0.16), 0.42, 0.35}, core::Lobe{glm::dvec3(0.09), 0.21, 0.5},
                      core::Lobe{glm::dvec3(0.012), 0.06, 0.4}};
    if (colour == Colour::none) analytic.table.reset();
    const gles::PaintMap nodes{map.width(), map.settings().index, map.settings().cure, map.nodes()};
    const bool mapped = colour == Colour::map || colour == Colour::sliding_map;
    renderer.set_scene(stage.scene());
    if (!renderer.set_paint(paint, mapped ? &nodes : nullptr)) std::abort();
    if (!renderer.update(core::Weights::uniform({1.0}))) std::abort();
  }
};

gles::Lighting lit(std::size_t lights, gles::LightPath path) {
  gles::Lighting out;
  constexpr std::array<glm::vec3, 4> towards = {
      {{-0.4f, -0.8f, 0.7f}, {0.6f, 0.65f, 0.45f}, {0.8f, -0.5f, 0.3f}, {-0.7f, 0.2f, 0.6f}}};
  for (std::size_t k = 0; k < lights; ++k) out.lights.push_back({glm::normalize(towards.at(k)), glm::vec3(0.5f)});
  out.quality.path = path;
  out.quality.cut_lights = 16;  // of 4 the diffuse part shows nothing
  out.quality.flakes = gles::FlakeMode::off;
  out.quality.smooth_edges = false;
  return out;
}

}  // namespace

void compare_map_with_table(Stage& stage, const char* camera, int rounds, Report& report) {
  Drawer none(stage, Colour::none), table(stage, Colour::table), map(stage, Colour::map),
      sliding(stage, Colour::sliding_map);
  struct Light {
    const char* name;
    gles::Lighting lighting;
  };
  const std::array<Light, 3> lights = {{{"one light", lit(1, gles::LightPath::none)},
                                        {"four lights", lit(4, gles::LightPath::none)},
                                        {"lights of the environment", lit(0, gles::LightPath::lights)}}};
  for (const Light& light : lights) {
    report.title(std::string("Colour map and colour table, ") + light.name);
    const auto with = [&](const char* name, Drawer& drawer) {
      return Candidate{name,
                       [&](int k) {
                         drawer.renderer.draw(stage.view(camera, k), light.lighting, stage.target());
                         stage.context().gl().Finish();
                       },
                       {},
                       {}};
    };
    std::vector<Candidate> all = {with("colour table", table), with("colour map", map),
                                  with("colour map, sliding (cure B)", sliding), with("neither", none)};
    run_rounds(all, rounds);
    report.table(all);
    report.compare("map over table", all[1], all[0]);
    report.compare("sliding map over table", all[2], all[0]);
    report.compare("neither over table", all[3], all[0]);
  }
}

}  // namespace lackwerk::bench
