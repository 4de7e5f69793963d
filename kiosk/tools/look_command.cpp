#include <OpenImageIO/imagebuf.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <functional>
#include <memory>

#include "kiosk/display/mood.hpp"
#include "kiosk/display/stage.hpp"
#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/contact_sheet.hpp"
#include "kiosk/tools/output.hpp"
#include "kiosk/tools/progress.hpp"
#include "kiosk/tools/render_options.hpp"

namespace lackwerk::tools {
namespace {

constexpr int tile_width_px = 640;
constexpr int tile_height_px = 360;
constexpr int columns = 3;
/// Captions, weights by paint and camera: changed only on purpose, since sheets are compared with older ones.
constexpr int strip_steps = 5;

struct LookOptions {
  std::string pack, scene = "builtin", folder = "docs/look", backend = "egl";
  int samples = 16;
};

/// Everything a sheet draws on: one stage per scene.
struct Studio {
  std::unique_ptr<kiosk::Stage> car, capsule;
  int samples = 16;
};

Result<gles::Image> shoot(kiosk::Stage& stage, const std::vector<double>& weights, const std::string& camera_name,
                          int samples) {
  const auto camera = find_camera(stage.scene(), camera_name);
  if (!camera) return tl::unexpected(camera.error());
  if (auto made = stage.context().make_current(); !made) return tl::unexpected(made.error());
  if (auto updated = stage.renderer().update(core::Weights::uniform(weights)); !updated)
    return tl::unexpected(updated.error());
  return stage.renderer().still(gles::View::from(*camera), kiosk::lighting_of(kiosk::usual_mood(camera->name)),
                                stage.framebuffer(), samples);
}

std::vector<double> between(std::size_t count, std::size_t from, std::size_t to, double t) {
  std::vector<double> weights(count, 0.0);
  weights[from] += 1.0 - t;
  weights[to] += t;
  return weights;
}

/// Capsules from one paint to the next in even steps, side by side.
Result<gles::Image> morph_strip(Studio& studio, std::size_t count, std::size_t from, std::size_t to) {
  gles::Image strip(tile_width_px, tile_height_px);
  const int piece = tile_width_px / strip_steps;
  for (int step = 0; step < strip_steps; ++step) {
    auto image = shoot(*studio.capsule, between(count, from, to, step / double(strip_steps - 1)), "", studio.samples);
    if (!image) return image;
    for (int y = 0; y < tile_height_px; ++y)
      std::copy_n(image->pixel((image->width - piece) / 2, y), piece * 3,
                  strip.rgb.begin() + (std::ptrdiff_t(y) * tile_width_px + std::ptrdiff_t(step) * piece) * 3);
  }
  return strip;
}

Result<std::unique_ptr<kiosk::Stage>> open_stage(const LookOptions& options, const std::string& scene_name) {
  const auto backend = parse_backend(options.backend);
  if (!backend) return tl::unexpected(backend.error());
  auto pack = packs::PaintPack::open(options.pack);
  if (!pack) return tl::unexpected(pack.error());
  auto scene = load_scene(scene_name);
  if (!scene) return tl::unexpected(scene.error());
  return kiosk::Stage::create(*backend, tile_width_px, tile_height_px, std::move(*pack), std::move(*scene));
}

/// JPEG, because the sheet lives in the repository.
Result<void> write_jpeg(const gles::Image& image, const std::filesystem::path& path) {
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", "jpeg:90");
  const OIIO::ImageBuf buffer(spec, const_cast<std::uint8_t*>(image.rgb.data()));
  if (buffer.write(path.string())) return {};
  return fail(path.string(), "", buffer.geterror(), "choose a folder that can be written");
}

/// before.jpg and this sheet beside each other at half size; nothing where there was no sheet before.
Result<void> write_comparison(const gles::Image& sheet, const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "before.jpg")) return {};
  OIIO::ImageBuf file((folder / "before.jpg").string());
  gles::Image before(file.spec().width, file.spec().height);
  if (file.spec().nchannels != 3 || !file.get_pixels(file.roi(), OIIO::TypeDesc::UINT8, before.rgb.data()))
    return fail((folder / "before.jpg").string(), "", "cannot be read: " + file.geterror(), "remove it");
  return write_jpeg(contact_sheet({{"before", halved(before)}, {"now", halved(sheet)}}, 2), folder / "compare.jpg");
}

/// All shots of the sheet, in order.
std::vector<std::pair<std::string, std::function<Result<gles::Image>()>>> shots(Studio& studio) {
  const auto& paints = studio.car->pack().paints()->paint().paints;
  const std::size_t count = paints.size();
  const std::vector<double> even(count, 1.0 / static_cast<double>(count));
  std::vector<std::pair<std::string, std::function<Result<gles::Image>()>>> list;
  const auto add = [&](std::string caption, std::vector<double> weights, std::string camera) {
    list.emplace_back(std::move(caption), [&studio, weights = std::move(weights), camera = std::move(camera)] {
      return shoot(*studio.car, weights, camera, studio.samples);
    });
  };
  for (std::size_t k = 0; k < count; ++k) add(paints[k].identity.name, between(count, k, k, 0.0), "hero");
  add("side, even mix", even, "side");
  add("rear, " + paints[0].identity.name, between(count, 0, 0, 0.0), "rear");
  add("front, " + paints[count - 1].identity.name, between(count, count - 1, count - 1, 0.0), "front");
  for (std::size_t k = 0; k < count; ++k) add("macro, " + paints[k].identity.name, between(count, k, k, 0.0), "macro");
  add("macro, even mix", even, "macro");
  add("rim, " + paints[count > 1 ? 1 : 0].identity.name, between(count, count > 1 ? 1 : 0, count > 1 ? 1 : 0, 0.0),
      "rim");
  add("stripe reflections", even, "stripe");
  for (std::size_t k = 0; k < count && count > 1; ++k) {
    const std::size_t to = (k + 1) % count;
    list.emplace_back(paints[k].identity.name + " to " + paints[to].identity.name,
                      [&studio, count, k, to] { return morph_strip(studio, count, k, to); });
  }
  return list;
}

Result<void> make_sheet(const LookOptions& options) {
  Studio studio;
  studio.samples = options.samples;
  auto car = open_stage(options, options.scene);
  if (!car) return tl::unexpected(car.error());
  studio.car = std::move(*car);
  auto capsule = open_stage(options, "capsule");
  if (!capsule) return tl::unexpected(capsule.error());
  studio.capsule = std::move(*capsule);

  Progress progress("look", false);
  std::vector<Tile> tiles;
  const auto list = shots(studio);
  for (const auto& [caption, shot] : list) {
    progress.update(static_cast<double>(tiles.size()) / static_cast<double>(list.size()), caption);
    auto image = shot();
    if (!image) return tl::unexpected(image.error());
    tiles.push_back({caption, std::move(*image)});
  }
  const std::filesystem::path folder(options.folder);
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return fail(options.folder, "-o", code.message(), "choose a folder that can be written");
  if (std::filesystem::exists(folder / "sheet.jpg"))
    std::filesystem::rename(folder / "sheet.jpg", folder / "before.jpg", code);
  const gles::Image sheet = contact_sheet(tiles, columns);
  if (auto written = write_jpeg(sheet, folder / "sheet.jpg"); !written) return written;
  return write_comparison(sheet, folder);
}

}  // namespace

void add_look_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LookOptions>();
  CLI::App* command = app.add_subcommand("look",
                                         "the fixed set of pictures every change is judged on: sheet.jpg, the last one "
                                         "as before.jpg, both as compare.jpg");
  command->add_option("--pack", options->pack, "paint pack (.lwp)")->required();
  command->add_option("--scene", options->scene, "scene pack (.lws), or builtin")->capture_default_str();
  command->add_option("--backend", options->backend, "egl or osmesa")->capture_default_str();
  command->add_option("--samples", options->samples, "samples a pixel")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_option("-o,--out", options->folder, "folder of the sheet")->capture_default_str();
  command->callback([options, &exit_code] {
    const auto made = make_sheet(*options);
    exit_code = made ? exit_done : report(made.error());
    if (made) print(options->folder + "/sheet.jpg");
  });
}

}  // namespace lackwerk::tools
