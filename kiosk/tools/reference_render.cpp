#include "kiosk/tools/reference_render.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/analysis/reference.hpp"
#include "core/realise.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "packs/materials.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::tools {
namespace {

/// Grey levels of the error picture per 8-bit step of standard error: white is 4 steps.
constexpr float error_scale = 64.0f;

core::ReferenceMaterial reference_material(packs::SurfaceKind kind) {
  core::ReferenceMaterial out;
  out.is_paint = kind == packs::SurfaceKind::paint;
  out.is_floor = kind == packs::SurfaceKind::floor;
  if (out.is_paint) return out;
  const packs::Material& material = packs::material_of(kind);
  out.surface = material.surface;
  out.emission = glm::dvec3(material.emission);
  out.coverage = material.coverage;
  return out;
}

/// Spans into `scene`: full-detail parts, one material per surface kind.
core::ReferenceScene reference_scene(const packs::Scene& scene) {
  core::ReferenceScene out;
  for (int kind = 0; kind < packs::surface_kind_count; ++kind)
    out.materials.push_back(reference_material(static_cast<packs::SurfaceKind>(kind)));
  for (const packs::MeshPart& part : scene.parts) {
    if ((part.detail & packs::detail_full) == 0) continue;
    const std::uint8_t* bytes = part.visibility.empty() ? nullptr : part.visibility.front().data();
    out.meshes.push_back({part.positions_mm,
                          part.normals,
                          {bytes, part.visibility.size() * packs::open_visibility.size()},
                          part.indices,
                          static_cast<std::size_t>(part.kind)});
  }
  out.environment = &scene.environment;
  return out;
}

core::ReferenceLighting reference_lighting(const gles::Lighting& lighting) {
  core::ReferenceLighting out;
  for (const gles::DirectionalLight& light : lighting.lights)
    out.lights.push_back({glm::dvec3(light.direction), glm::dvec3(light.radiance)});
  out.gain = static_cast<double>(lighting.environment_gain);
  out.exposure = static_cast<double>(lighting.exposure);
  out.lamp_glow = static_cast<double>(lighting.lamp_glow);
  out.backdrop = glm::dvec3(lighting.backdrop);
  return out;
}

float percentile(std::vector<float> values, double share) {
  if (values.empty()) return 0.0f;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

Result<void> write_pictures(const core::ReferenceImage& image, const std::vector<float>& steps, double exposure,
                            const ReferenceJob& job, const ReferenceSettings& settings) {
  gles::Image shown(image.width, image.height);
  shown.rgb = core::reference_bytes(image, exposure);
  if (auto written = gles::write_png(shown, job.out); !written) return written;
  if (settings.error_image.empty()) return {};
  for (std::size_t k = 0; k < steps.size(); ++k)
    std::fill_n(shown.rgb.begin() + static_cast<std::ptrdiff_t>(3 * k), 3,
                static_cast<std::uint8_t>(std::min(steps[k] * error_scale, 255.0f)));
  return gles::write_png(shown, settings.error_image);
}

}  // namespace

void add_reference_options(CLI::App& command, ReferenceSettings& settings) {
  const std::string group = "Reference";
  command
      .add_option("--reference-samples", settings.samples,
                  "samples a pixel (rounded up to a multiple of 64, at least 128)")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--reference-seconds", settings.seconds, "stop before this time (0: never; 128 samples in any case)")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->group(group);
  command.add_option("--reference-seed", settings.seed, "another seed, other noise")
      ->capture_default_str()
      ->group(group);
  command.add_option("--reference-threads", settings.threads, "0: one per core; no effect on the picture")
      ->check(CLI::Range(0u, 256u))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--visibility", settings.visibility,
                  "baked: what the renderer knows of shadows; traced: true shadows and interreflection")
      ->check(CLI::IsMember({"baked", "traced"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--error-image", settings.error_image,
                  "PNG of the standard error: 64 grey levels for each 8-bit step")
      ->group(group);
}

Result<core::ReferenceImage> reference_image(const ReferenceJob& job, const ReferenceSettings& settings,
                                             const core::ReferenceProgress& progress) {
  if (job.lighting.stripes)
    return fail("", "--camera", "the reference has no stripe reflections", "choose another camera", ErrorKind::usage);
  const gles::FlakeMode flakes = job.lighting.quality.flakes;
  if (flakes != gles::FlakeMode::mean && flakes != gles::FlakeMode::bilinear)
    return fail("", "--flakes", "the reference draws the whole paint", "use mean or bilinear", ErrorKind::usage);
  core::PaintTextures textures = core::make_static_textures(*job.paint);
  core::RealisedPaint realised;
  core::realise(*job.paint, *job.weights, realised);
  core::update_textures(*job.paint, realised, textures);

  core::ReferenceScene scene = reference_scene(*job.scene);
  scene.paint = {job.paint, &realised.analytic, &textures, flakes == gles::FlakeMode::bilinear};
  core::ReferenceOptions options;
  options.width = job.width;
  options.height = job.height;
  options.samples = settings.samples;
  options.seconds = settings.seconds;
  options.seed = settings.seed;
  options.threads = settings.threads;
  if (settings.visibility == "traced") {
    options.visibility = core::ReferenceVisibility::traced;
    options.bounces = 3;  // what a fourth bounce adds is below 1 % between surfaces of 10 to 40 %
  }
  const core::ReferenceView view{glm::dvec3(job.view.eye_mm), glm::dvec3(job.view.target_mm),
                                 static_cast<double>(job.view.vertical_fov_deg)};
  return core::render_reference(scene, view, reference_lighting(job.lighting), options, progress);
}

int run_reference(const ReferenceJob& job, const ReferenceSettings& settings) {
  Progress progress("reference", job.json);
  const auto image = reference_image(job, settings, [&](double fraction, int samples) {
    progress.update(fraction, std::to_string(samples) + " samples a pixel");
  });
  if (!image) return report(image.error());
  const auto exposure = static_cast<double>(job.lighting.exposure);
  const std::vector<float> steps = core::reference_error_steps(*image, exposure);
  if (auto written = write_pictures(*image, steps, exposure, job, settings); !written) return report(written.error());
  const double median = static_cast<double>(percentile(steps, 0.5)), p95 = static_cast<double>(percentile(steps, 0.95));
  const unsigned threads = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const double rate = static_cast<double>(image->paths) / std::max(image->seconds, 1e-9);
  if (job.json) {
    nlohmann::ordered_json out{{"out", job.out},
                               {"backend", "reference"},
                               {"width", image->width},
                               {"height", image->height},
                               {"visibility", settings.visibility},
                               {"samples", image->samples},
                               {"seconds", image->seconds},
                               {"threads", threads},
                               {"paths", image->paths},
                               {"rays", image->rays},
                               {"paths_per_second", rate},
                               {"standard_error_steps", {{"median", median}, {"p95", p95}}}};
    if (!settings.error_image.empty()) out["error_image"] = settings.error_image;
    print(out.dump());
    return exit_done;
  }
  print(job.out + ": " + std::to_string(image->width) + "x" + std::to_string(image->height) + ", " +
        std::to_string(image->samples) + " samples a pixel, " + fixed(image->seconds, 1) + " s on " +
        std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + fixed(rate * 1e-6, 2) +
        " million paths a second; standard error in 8-bit steps: median " + fixed(median, 3) + ", p95 " +
        fixed(p95, 3));
  return exit_done;
}

}  // namespace lackwerk::tools
