#include "kiosk/tools/render_options.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>

#include "core/analysis/studio.hpp"
#include "packs/scene_pack.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/scene_bake.hpp"

namespace lackwerk::tools {
namespace {

/// Rays per vertex when a scene is built on the fly: a quick look, a scene pack has more.
constexpr int quick_rays = 48;
constexpr float sphere_radius_mm = 300.0f;
constexpr float capsule_radius_mm = 75.0f;
constexpr float capsule_length_mm = 400.0f;

}  // namespace

Result<std::vector<double>> parse_weights(const std::string& text, std::size_t count, const std::string& option) {
  std::vector<double> weights;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at != end) {
    double value = 0.0;
    const auto [next, code] = std::from_chars(at, end, value);
    if (code != std::errc{} || (next != end && *next != ',')) break;
    weights.push_back(value);
    at = next == end ? end : next + 1;
    if (next != end && at == end) weights.clear();  // a comma at the end
  }
  if (at != end || weights.empty())
    return fail("", option, "'" + text + "' is not a list of numbers", "write one number per paint: 0.2,0.3,0.5",
                ErrorKind::usage);
  if (weights.size() != count)
    return fail("", option, std::to_string(weights.size()) + " weights for " + std::to_string(count) + " paints",
                "give one per paint of the pack; 'lackwerk pack info' lists them", ErrorKind::usage);
  return weights;
}

Result<packs::Scene> load_scene(const std::string& name) {
  packs::Scene scene;
  if (name == "builtin")
    scene = packs::build_builtin_car();
  else if (name == "sphere")
    scene = packs::build_sphere(sphere_radius_mm);
  else if (name == "capsule")
    scene = packs::build_capsule(capsule_radius_mm, capsule_length_mm);
  else
    return packs::read_scene_pack(name);
  scene.environment = core::build_studio();
  packs::bake_scene(scene, {.rays_per_vertex = quick_rays});
  return scene;
}

Result<gles::Backend> parse_backend(const std::string& name) {
  if (name == "egl") return gles::Backend::egl_surfaceless;
  if (name == "osmesa") return gles::Backend::osmesa;
  return fail("", "--backend", "unknown backend '" + name + "'", "use egl or osmesa", ErrorKind::usage);
}

void add_orange_peel_option(CLI::App& command, float& milliradians) {
  constexpr float roughest_mrad = 20.0f;  // over a degree: no paint shop lets that pass
  command
      .add_option("--orange-peel", milliradians,
                  "waves in the clear coat: rms tilt of its mirror image's normal in milliradians (a car has 1 to 5)")
      ->check(CLI::Range(0.0f, roughest_mrad))
      ->capture_default_str();
}

Result<packs::Camera> find_camera(const packs::Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [&](const packs::Camera& c) { return name.empty() || c.name == name; });
  if (found != scene.cameras.end()) return *found;
  std::string known;
  for (const packs::Camera& camera : scene.cameras) known += (known.empty() ? "" : ", ") + camera.name;
  return fail("", "--camera", "no camera '" + name + "'", "this scene has " + known, ErrorKind::usage);
}

}  // namespace lackwerk::tools
