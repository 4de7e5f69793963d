#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/analysis/studio.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/scene_pack.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "packs/tools/environment_map.hpp"
#include "packs/tools/import_materials.hpp"
#include "packs/tools/scene_bake.hpp"
#include "packs/tools/scene_detail.hpp"
#include "packs/tools/scene_import.hpp"

namespace lackwerk::tools {
namespace {

const std::set<std::string> subjects = {"builtin", "sphere", "capsule"};
constexpr double capsule_length_mm = 300.0;
/// Shares of the waiting time, measured on the built-in car.
constexpr double after_model = 0.25, after_environment = 0.4, after_baking = 0.97;

struct SceneOptions {
  std::string model, out, environment = "studio", paint, up;
  std::vector<std::string> materials;
  std::optional<float> room_radius_mm;
  double length_mm = 0.0, rotate_deg = 0.0, crease_deg = 40.0;
  bool floor = true;
  int rays = packs::BakeSettings{}.rays_per_vertex;
  float radius_mm = 100.0f;
  bool json = false;
  [[nodiscard]] bool is_subject() const { return subjects.count(model) > 0; }
};

/// What is printed at the end besides the scene.
struct Made {
  packs::ImportedScene imported;  ///< built-in subjects fill the scene alone
  packs::BakeReport bake;
};

tl::unexpected<Error> wrong_use(const std::string& option, const std::string& what, const std::string& remedy) {
  return fail("", option, what, remedy, ErrorKind::usage);
}

Result<packs::ImportSettings> import_settings(const SceneOptions& options) {
  if (options.paint.empty())
    return wrong_use("--paint",
                     "'" + options.model + "' is not builtin, sphere or capsule, so it is taken for a model file",
                     "name the material that is to be painted");
  packs::ImportSettings settings;
  settings.paint = options.paint;
  settings.floor = options.floor;
  settings.crease_deg = options.crease_deg;
  settings.placement.length_mm = options.length_mm;
  settings.placement.rotate_deg = options.rotate_deg;
  if (!options.up.empty()) settings.placement.up = options.up == "y" ? packs::UpAxis::y : packs::UpAxis::z;
  for (const std::string& text : options.materials) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
      return wrong_use("--material", "'" + text + "' is not NAME=KIND", "write --material Windows=glass");
    const auto kind = packs::importable_kind(text.substr(equals + 1));
    if (!kind) return tl::unexpected(kind.error());
    settings.kinds.emplace_back(text.substr(0, equals), *kind);
  }
  return settings;
}

Result<packs::ImportedScene> model_of(const SceneOptions& options, Progress& progress) {
  packs::ImportedScene out;
  if (options.model == "sphere") {
    out.scene = packs::build_sphere(options.radius_mm);
  } else if (options.model == "capsule") {
    const double length_mm = options.length_mm > 0.0 ? options.length_mm : capsule_length_mm;
    out.scene = packs::build_capsule(options.radius_mm, static_cast<float>(length_mm));
  } else if (options.model == "builtin") {
    out.scene = packs::build_builtin_car();
  } else {
    const auto settings = import_settings(options);
    if (!settings) return tl::unexpected(settings.error());
    return packs::import_scene(options.model, *settings, [&progress](double done, const std::string& stage) {
      progress.update(done * after_model, stage);
    });
  }
  return out;
}

Result<packs::LoadedEnvironment> environment_of(const SceneOptions& options) {
  core::EnvironmentRoom room = core::studio_room;
  if (options.room_radius_mm) room.radius_mm = *options.room_radius_mm;
  if (options.environment != "studio") return packs::load_environment(options.environment, room);
  if (!options.room_radius_mm) return packs::LoadedEnvironment{core::build_studio(), {}};
  return packs::LoadedEnvironment{core::build_environment("studio", core::studio_radiance, room), {}};
}

Result<Made> make(const SceneOptions& options, Progress& progress) {
  progress.update(0.0, "model");
  auto imported = model_of(options, progress);
  if (!imported) return tl::unexpected(imported.error());
  Made made{std::move(*imported), {}};
  progress.update(after_model, "environment");
  auto light = environment_of(options);
  if (!light) return tl::unexpected(light.error());
  made.imported.scene.environment = std::move(light->environment);
  auto& repairs = made.imported.repairs;
  repairs.insert(repairs.end(), light->repairs.begin(), light->repairs.end());
  if (options.rays > 0)
    made.bake = packs::bake_scene(made.imported.scene, {options.rays}, [&progress](double done) {
      progress.update(after_environment + (after_baking - after_environment) * done, "baking light");
    });
  return made;
}

nlohmann::ordered_json described(const packs::Scene& scene, const Made& made, const SceneOptions& options) {
  std::size_t vertices = 0;
  for (const auto& part : scene.parts) vertices += part.positions_mm.size();
  nlohmann::ordered_json out{{"scene", scene.name},
                             {"parts", scene.parts.size()},
                             {"cameras", nlohmann::json::array()},
                             {"vertices", vertices},
                             {"triangles", packs::triangles_at(scene, packs::detail_full)},
                             {"triangles_coarse", packs::triangles_at(scene, packs::detail_coarse)},
                             {"environment", scene.environment.name},
                             {"room_radius_mm", scene.environment.room_radius_mm},
                             {"lights", scene.environment.lights.size()},
                             {"materials", nlohmann::json::object()},
                             {"placement", made.imported.placement},
                             {"repairs", made.imported.repairs}};
  for (const auto& camera : scene.cameras) out["cameras"].push_back(camera.name);
  for (const auto& material : made.imported.materials) out["materials"][material.name] = packs::name_of(material.kind);
  if (options.rays > 0)
    out["bake"] = {{"rays", options.rays},
                   {"fit_error_mean", made.bake.fit_error_mean},
                   {"fit_error_p95", made.bake.fit_error_p95}};
  return out;
}

void print_lines(const nlohmann::ordered_json& facts, const SceneOptions& options, double seconds) {
  for (const auto& [name, kind] : facts["materials"].items())
    print("material " + one_line(name) + ": " + kind.get<std::string>());
  if (const auto placement = facts["placement"].get<std::string>(); !placement.empty()) print(placement);
  for (const auto& repair : facts["repairs"]) print("mended: " + one_line(repair.get<std::string>()));
  if (facts.contains("bake"))
    print("baked with " + std::to_string(options.rays) + " rays, visibility off by " +
          fixed(100.0 * facts["bake"]["fit_error_mean"].get<double>(), 1) + " % (p95 " +
          fixed(100.0 * facts["bake"]["fit_error_p95"].get<double>(), 1) + " %)");
  print(options.out + ": " + std::to_string(facts["parts"].get<std::size_t>()) + " parts, " +
        std::to_string(facts["vertices"].get<std::size_t>()) + " vertices, " +
        std::to_string(facts["triangles"].get<std::size_t>()) + " triangles (coarse " +
        std::to_string(facts["triangles_coarse"].get<std::size_t>()) + "), environment " +
        one_line(facts["environment"].get<std::string>()) + ", " + fixed(seconds, 1) + " s");
}

int run_scene(const SceneOptions& options) {
  // Said now, not after the waiting time.
  const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
  if (std::error_code ignored; !folder.empty() && !std::filesystem::is_directory(folder, ignored))
    return report(fail(options.out, "", "its folder does not exist", "create it first").value());
  Progress progress("scene build", options.json);
  const auto made = make(options, progress);
  if (!made) return report(made.error());
  progress.update(after_baking, "writing");
  if (const auto written = packs::write_scene_pack(options.out, made->imported.scene); !written)
    return report(written.error());
  // Read back: what was promised is what a kiosk will get.
  const auto back = packs::read_scene_pack(options.out, packs::Backing::copy);
  if (!back) return report(back.error());
  nlohmann::ordered_json facts = described(*back, *made, options);
  if (!options.json) {
    print_lines(facts, options, progress.elapsed_s());
    return exit_done;
  }
  std::error_code ignored;
  facts["bytes"] = std::filesystem::file_size(options.out, ignored);
  facts["seconds"] = progress.elapsed_s();
  print(facts.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return exit_done;
}

/// Those that say something about a model file; refused for the built-in subjects.
std::vector<CLI::Option*> add_model_options(CLI::App& command, SceneOptions& options) {
  return {
      command.add_option("--paint", options.paint, "material of MODEL that is painted: its name or a part of it"),
      command.add_option("--material", options.materials,
                         "NAME=KIND: what another material is (glass, chrome, rubber, trim, rim, lamp_clear, lamp_red, "
                         "interior, paint); may be repeated"),
      command.add_option("--up", options.up, "axis of MODEL that points up; guessed if not given")
          ->check(CLI::IsMember({"y", "z"})),
      command.add_option("--rotate-deg", options.rotate_deg, "turn MODEL, seen from above, so that its nose is at +x")
          ->check(CLI::Range(-360.0, 360.0)),
      command.add_flag("--floor,!--no-floor", options.floor, "put a showroom floor under MODEL")->capture_default_str(),
      command
          .add_option("--crease-deg", options.crease_deg, "edges sharper than this stay sharp where normals are made")
          ->check(CLI::Range(0.0, 180.0))
          ->capture_default_str(),
  };
}

}  // namespace

void add_scene_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = command_group(app, "scene", "Scene packs").add_subcommand("build", "Build a scene pack");
  command
      ->add_option("MODEL", options->model,
                   "builtin (the demo car), sphere, capsule, or a model file (.gltf, .glb, .obj, ...)")
      ->required();
  command->add_option("-o,--output", options->out, "scene pack to write (.lws)")->required();
  command->add_option("--env", options->environment, "studio, or a lat-long HDR map (.hdr, .exr)")
      ->capture_default_str();
  command
      ->add_option("--room-radius-mm", options->room_radius_mm,
                   "of the sphere on which the map is painted; 0 = far away; the studio's own if not given")
      ->check(CLI::Range(0.0, static_cast<double>(packs::max_room_radius_mm)));
  const std::vector<CLI::Option*> model_only = add_model_options(*command, *options);
  command->add_option("--occlusion-rays", options->rays, "rays per vertex for the baked light; 0 = bake nothing")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->add_option("--radius-mm", options->radius_mm, "of sphere and capsule")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command
      ->add_option("--length-mm", options->length_mm,
                   "of the capsule without its ends (300), or of a model file's longest side")
      ->check(CLI::Range(1.0, 100000.0));
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, model_only, &exit_code] {
    for (const CLI::Option* option : model_only)
      if (options->is_subject() && option->count() > 0) {
        exit_code = report(wrong_use(option->get_name(), "has no meaning for '" + options->model + "'",
                                     "give a model file, or leave it out")
                               .value());
        return;
      }
    if (options->room_radius_mm && *options->room_radius_mm > 0.0f &&
        *options->room_radius_mm < packs::min_room_radius_mm) {
      exit_code = report(wrong_use("--room-radius-mm", "is below 100", "give 0 or at least 100").value());
      return;
    }
    exit_code = run_scene(*options);
  });
}

}  // namespace lackwerk::tools
