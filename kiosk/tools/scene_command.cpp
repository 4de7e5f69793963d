#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/scene_pack.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/scene_occlusion.hpp"

namespace lackwerk::tools {
namespace {

constexpr int default_rays = 128;

struct SceneOptions {
  std::string model, out;
  int rays = default_rays;
  bool rays_given = false;
  float radius_mm = 100.0f;
  float length_mm = 300.0f;
  bool json = false;
};

/// The car comes with its occlusion; it is only traced again when asked for.
bool wants_occlusion(const packs::Scene& scene, const SceneOptions& options) {
  const bool baked = std::all_of(scene.parts.begin(), scene.parts.end(),
                                 [](const packs::MeshPart& part) { return !part.ambient_occlusion.empty(); });
  return options.rays > 0 && (options.rays_given || !baked);
}

packs::Scene build(const SceneOptions& options) {
  if (options.model == "sphere") return packs::build_sphere(options.radius_mm);
  if (options.model == "capsule") return packs::build_capsule(options.radius_mm, options.length_mm);
  return packs::build_builtin_car();
}

int run_scene(const SceneOptions& options) {
  Progress progress("scene build", options.json);
  progress.update(0.0, options.model);
  packs::Scene scene = build(options);
  progress.update(0.5, "ambient occlusion");
  if (wants_occlusion(scene, options)) packs::bake_ambient_occlusion(scene, options.rays);
  progress.update(0.95, "writing");
  if (const auto written = packs::write_scene_pack(options.out, scene); !written) return report(written.error());
  // Read back: what was promised is what a kiosk will get.
  const auto back = packs::read_scene_pack(options.out, packs::Backing::copy);
  if (!back) return report(back.error());
  std::size_t vertices = 0, triangles = 0;
  for (const auto& part : back->parts) {
    vertices += part.positions_mm.size();
    triangles += part.indices.size() / 3;
  }
  if (options.json) {
    nlohmann::ordered_json out{
        {"scene", back->name},  {"parts", back->parts.size()}, {"cameras", nlohmann::json::array()},
        {"vertices", vertices}, {"triangles", triangles},      {"seconds", progress.elapsed_s()}};
    for (const auto& camera : back->cameras) out["cameras"].push_back(camera.name);
    print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return exit_done;
  }
  print(options.out + ": " + std::to_string(back->parts.size()) + " parts, " + std::to_string(vertices) +
        " vertices, " + std::to_string(triangles) + " triangles, " + fixed(progress.elapsed_s(), 1) + " s");
  return exit_done;
}

}  // namespace

void add_scene_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = command_group(app, "scene", "Scene packs").add_subcommand("build", "Build a scene pack");
  command->add_option("MODEL", options->model, "builtin (the demo car), sphere or capsule")
      ->required()
      ->check(CLI::IsMember({"builtin", "sphere", "capsule"}));
  command->add_option("-o,--output", options->out, "scene pack to write (.lws)")->required();
  CLI::Option* rays =
      command->add_option("--occlusion-rays", options->rays, "rays per vertex for ambient occlusion; 0 = trace none");
  rays->check(CLI::Range(0, 4096))->capture_default_str();
  command->add_option("--radius-mm", options->radius_mm, "of sphere and capsule")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command->add_option("--length-mm", options->length_mm, "of the capsule")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, rays, &exit_code] {
    options->rays_given = rays->count() > 0;
    exit_code = run_scene(*options);
  });
}

}  // namespace lackwerk::tools
