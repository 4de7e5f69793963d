#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/realise.hpp"
#include "kiosk/display/mood.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/display/state.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/reference_render.hpp"
#include "kiosk/tools/render_options.hpp"
#include "packs/mix_code.hpp"
#include "render_gles/accumulator.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::tools {
namespace {

struct RenderOptions {
  std::string pack, scene = "builtin", camera, size = "1280x720", backend = "egl", quality = "still", flakes, out;
  std::optional<std::string> weights, lightness, colour, mix;  ///< given but empty is a mistake, not a default
  double white = 0.0;
  int samples = 16;
  gles::CoreEs2 core_es2 = gles::CoreEs2::off;
  bool explain = false, json = false;
  ReferenceSettings reference;
  std::string rung, path, mask;
  int cut_lights = 16;
  float orange_peel_mrad = 0.0f;
};

/// --mix, or the three groups from the command line; groups not given follow --weights, which defaults to the first
/// paint.
Result<core::Weights> read_weights(const RenderOptions& options, const packs::PaintPack& pack) {
  const core::InterpolatablePaint& paint = pack.paint();
  if (options.mix) return packs::mix_for(pack.info(), paint.paints.size(), *options.mix);
  core::Weights weights = kiosk::first_paint(static_cast<int>(paint.paints.size()));
  if (options.weights) {
    auto all = parse_weights(*options.weights, paint.paints.size(), "--weights");
    if (!all) return tl::unexpected(all.error());
    weights = core::Weights::uniform(*all);
  }
  if (options.lightness) {
    auto group = parse_weights(*options.lightness, paint.paints.size(), "--lightness");
    if (!group) return tl::unexpected(group.error());
    weights.flake_lightness = std::move(*group);
  }
  if (options.colour) {
    auto group = parse_weights(*options.colour, paint.paints.size(), "--colour");
    if (!group) return tl::unexpected(group.error());
    weights.flake_colour = std::move(*group);
  }
  weights.flake_white = options.white;
  if (auto checked = core::check_weights(paint, weights); !checked) {
    checked.error().kind = ErrorKind::usage;
    return tl::unexpected(checked.error());
  }
  return weights;
}

/// Empty for weights that no code can hold.
std::string mix_code(const packs::PackInfo& pack, const core::Weights& weights) {
  for (const auto* group : {&weights.base, &weights.flake_lightness, &weights.flake_colour})
    for (const double weight : *group)
      if (weight < packs::least_mix_weight || weight > packs::most_mix_weight) return {};
  return packs::encode_mix(pack, weights);
}

gles::Lighting read_lighting(const RenderOptions& options, const packs::Camera& camera) {
  gles::Lighting lighting = kiosk::lighting_of(kiosk::usual_mood(camera.name));
  if (const gles::Rung* rung = gles::find_rung(options.rung)) lighting.quality = rung->quality;
  if (options.path == "lights") lighting.quality.path = gles::LightPath::lights;
  if (options.path == "none") lighting.quality.path = gles::LightPath::none;
  lighting.quality.cut_lights = options.cut_lights;
  lighting.orange_peel_mrad = options.orange_peel_mrad;
  if (options.flakes == "off") lighting.quality.flakes = gles::FlakeMode::off;
  if (options.flakes == "mean") lighting.quality.flakes = gles::FlakeMode::mean;
  if (options.flakes == "nearest") lighting.quality.flakes = gles::FlakeMode::nearest;
  if (options.flakes == "bilinear") lighting.quality.flakes = gles::FlakeMode::bilinear;
  return lighting;
}

int run_render(const RenderOptions& options) {
  const bool reference = options.backend == "reference";
  const auto backend = parse_backend(reference ? "egl" : options.backend);
  if (!backend) return report(backend.error());
  const auto size = kiosk::parse_size(options.size);
  if (!size) return report(size.error());
  auto pack = packs::PaintPack::open(options.pack);
  if (!pack) return report(pack.error());
  const auto weights = read_weights(options, *pack);
  if (!weights) return report(weights.error());
  const std::string code = mix_code(pack->info(), *weights);
  auto scene = load_scene(options.scene);
  if (!scene) return report(scene.error());
  const auto camera = find_camera(*scene, options.camera);
  if (!camera) return report(camera.error());
  if (reference)
    return run_reference({&*scene, &pack->paint(), &*weights, gles::View::from(*camera),
                          read_lighting(options, *camera), size->width, size->height, options.out, options.json},
                         options.reference);
  auto stage = kiosk::Stage::create(*backend, size->width, size->height, std::move(*pack), std::move(*scene),
                                    {.core_es2 = options.core_es2});
  if (!stage) return report(stage.error());

  gles::Renderer& renderer = (*stage)->renderer();
  if (const auto updated = renderer.update(*weights); !updated) return report(updated.error());
  const gles::View view = gles::View::from(*camera);
  const gles::Lighting lighting = read_lighting(options, *camera);
  renderer.prepare(view, lighting, (*stage)->framebuffer());
  const auto start = std::chrono::steady_clock::now();
  const int samples = options.quality == "still" ? options.samples : 1;
  const gles::Image image = renderer.still(view, lighting, (*stage)->framebuffer(), samples);
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (const auto written = gles::write_png(image, options.out); !written) return report(written.error());
  if (!options.mask.empty())
    if (const auto written = gles::write_png(renderer.subject(view, (*stage)->framebuffer()), options.mask); !written)
      return report(written.error());

  if (options.json) {
    nlohmann::ordered_json out{{"out", options.out},
                               {"backend", gles::backend_name(*backend)},
                               {"renderer", (*stage)->context().info().renderer},
                               {"width", size->width},
                               {"height", size->height},
                               {"samples", samples},
                               {"mix", code},
                               {"render_ms", ms}};
    if (options.explain) {
      out["explain"] = renderer.explain();
      out["savings"] = nlohmann::json::array();
      for (const gles::Saving& saving : renderer.measure_savings(view, lighting, (*stage)->framebuffer()))
        out["savings"].push_back(
            {{"what", saving.what}, {"with_ms", saving.with_ms}, {"without_ms", saving.without_ms}});
    }
    print(out.dump());
    return exit_done;
  }
  print(options.out + ": " + options.size + ", " + std::to_string(samples) +
        (samples == 1 ? " sample, " : " samples, ") + fixed(ms, 0) + " ms on " + (*stage)->context().info().renderer);
  if (options.explain) {
    for (const std::string& line : renderer.explain()) print("  " + line);
    for (const gles::Saving& saving : renderer.measure_savings(view, lighting, (*stage)->framebuffer()))
      print("  saved: " + saving.what + ": a moving frame takes " + fixed(saving.without_ms, 1) + " ms, with it " +
            fixed(saving.with_ms, 1) + " ms (medians of 5)");
  }
  return exit_done;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "a picture of a scene in a mix of a pack's paints");
  command->add_option("--pack", options->pack, "paint pack (.lwp)")->required();
  command->add_option("--scene", options->scene, "scene pack (.lws), or builtin, sphere, capsule")
      ->capture_default_str();
  command->add_option("--weights", options->weights, "one number per paint, sum 1: 0.2,0.3,0.5 (default: the first)");
  command->add_option("--lightness", options->lightness, "weights of the flakes' lightness alone");
  command->add_option("--colour", options->colour, "weights of the flakes' colour alone");
  command->add_option("--white", options->white, "how far the flakes' colour is taken out, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  CLI::Option* mix = command->add_option("--mix", options->mix, "instead of weights: the code of a mix, \"LW1...\"");
  for (const char* other : {"--weights", "--lightness", "--colour", "--white"}) mix->excludes(other);
  command->add_option("--camera", options->camera, "a camera of the scene (default: its first)");
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command->add_option("--backend", options->backend, "egl, osmesa or reference")->capture_default_str();
  command->add_option("--quality", options->quality, "moving: one sample a pixel; still: --samples of them")
      ->check(CLI::IsMember({"moving", "still"}))
      ->capture_default_str();
  command->add_option("--samples", options->samples, "samples a pixel of still quality")
      ->check(CLI::Range(1, gles::Accumulator::max_frames))
      ->capture_default_str();
  command->add_option("--flakes", options->flakes, "off, mean, nearest or bilinear (default)")
      ->check(CLI::IsMember({"off", "mean", "nearest", "bilinear"}));
  command
      ->add_option_function<std::string>(
          "--core-es2", [options](const std::string& word) { options->core_es2 = *gles::parse_core_es2(word); },
          "draw as the weakest OpenGL ES 2.0 driver would: with highp or only mediump floats in fragment shaders")
      ->check(CLI::IsMember({"highp", "mediump"}));
  std::vector<std::string> rungs;
  for (const gles::Rung& rung : gles::quality_ladder()) rungs.emplace_back(rung.name);
  command->add_option("--rung", options->rung, "quality of a moving picture, as the kiosk's governor chooses it")
      ->check(CLI::IsMember(rungs));
  command->add_option("--path", options->path, "light from the environment: filtered (default), lights or none")
      ->check(CLI::IsMember({"filtered", "lights", "none"}));
  command->add_option("--lights", options->cut_lights, "lights cut from the environment on --path lights")
      ->check(CLI::IsMember({1, 4, 16, 64}))
      ->capture_default_str();
  add_orange_peel_option(*command, options->orange_peel_mrad);
  command->add_option("--mask", options->mask,
                      "PNG to write: white where the subject is, black on floor and background");
  command->add_option("-o,--out", options->out, "PNG to write")->required();
  command->add_flag("--explain", options->explain, "print what was left out, and why");
  command->add_flag("--json", options->json, "print JSON");
  add_reference_options(*command, options->reference);
  command->callback([options, &exit_code] { exit_code = run_render(*options); });
}

}  // namespace lackwerk::tools
