// What the renderer costs, as ratios within one run and as medians. Run by scripts/bench; asserts nothing: times are
// for reading, limits stand beside them.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "render_gles/governor.hpp"
#include "tests/bench/render/btf_peer.hpp"
#include "tests/bench/render/map_peer.hpp"
#include "tests/bench/render/rounds.hpp"
#include "tests/bench/render/stage.hpp"

namespace lackwerk::bench {
namespace {

using gles::FlakeMode;
using gles::Quality;

struct Options {
  std::string pack, scene, capture, json, only;
  gles::Backend backend = gles::Backend::egl_surfaceless;
  int width = 1280, height = 720, rounds = 15;
  [[nodiscard]] bool wants(const char* section) const {
    return only.empty() || only.find(section) != std::string::npos;
  }
};

constexpr const char* usage =
    "render_bench --pack P.lwp --scene S.lws [--capture DIR] [--rounds 15] [--size 1280x720] [--osmesa]\n"
    "             [--only morph,flakes,rungs,switches,lights,still,governor,start,peer,map] [--json FILE]\n"
    "DIR: capture of the pack's first paint, for the look-up of the flake pictures themselves (peer)\n";

Quality with(FlakeMode flakes, bool cross_fade, int sparkle) {
  Quality quality;
  quality.flakes = flakes;
  quality.flake_cross_fade = cross_fade;
  quality.flake_lights = 1;
  quality.sparkle_lights = sparkle;
  return quality;
}

Candidate frame_of(Stage& stage, std::string name, std::string camera, const Quality& quality) {
  return {std::move(name),
          [&stage, camera = std::move(camera), quality](int k) { stage.draw(stage.view(camera, k), quality); },
          {},
          {}};
}

void update(Stage& stage, int k) {
  if (!stage.renderer().update(stage.weights(k))) std::abort();  // the weights are ours
}

/// The kiosk's own frame: what the governor draws the whole car with.
void morph(Stage& stage, int rounds, Report& report) {
  report.title("Morphing (moving camera)");
  const Quality quality = gles::find_rung("good")->quality;
  int frame = 0;  // of both together: the still one must not find new weights
  std::vector<Candidate> all = {frame_of(stage, "still weights", "hero", quality),
                                {"new weights every frame",
                                 [&](int k) {
                                   update(stage, ++frame);
                                   stage.draw(stage.view("hero", k), quality);
                                 },
                                 {},
                                 {}},
                                {"new weights alone, nothing drawn",
                                 [&](int) {
                                   update(stage, ++frame);
                                   stage.context().gl().Finish();
                                 },
                                 {},
                                 {}}};
  run_rounds(all, rounds);
  report.table(all);
  report.compare("frame rate morphing / still weights", all[0], all[1], ">= 0.95");
}

void flakes(Stage& stage, int rounds, Report& report) {
  update(stage, 0);
  report.title("Flakes, whole car: single flakes of the strongest light over their mean");
  constexpr std::array<const char*, 6> cameras = {"hero", "side", "rear", "front", "rim", "macro"};
  double wall = 0.0, cpu = 0.0;
  for (const char* camera : cameras) {
    std::vector<Candidate> all = {frame_of(stage, "mean", camera, with(FlakeMode::mean, true, 1)),
                                  frame_of(stage, "single", camera, with(FlakeMode::bilinear, true, 1)),
                                  frame_of(stage, "four lights", camera, with(FlakeMode::bilinear, true, 4))};
    run_rounds(all, rounds);
    const bool show =
        stage.renderer().flakes_show(stage.view(camera, 0), stage.target().height(), gles::moving_contrast);
    report.compare(std::string(camera) + (show ? "" : " (too far to show)"), all[1], all[0]);
    report.compare(std::string(camera) + ", four lights", all[2], all[0]);
    wall += ratio(all[1], all[0]) / cameras.size();
    cpu += cpu_ratio(all[1], all[0]) / cameras.size();
  }
  report.value("mean over the cameras", wall, "", cameras.size(), "<= 1.25");
  report.value("mean over the cameras, processor time", cpu, "", cameras.size(), "<= 1.25");
}

void plate_flakes(Stage& stage, int rounds, Report& report) {
  report.title("Flakes on a plate that fills the picture");
  std::vector<Candidate> all = {
      frame_of(stage, "mean", "macro", with(FlakeMode::mean, false, 1)),
      frame_of(stage, "nearest slice, nearest cell", "macro", with(FlakeMode::nearest, false, 1)),
      frame_of(stage, "nearest slice, cross-faded cells", "macro", with(FlakeMode::nearest, true, 1)),
      frame_of(stage, "four slices, nearest cell", "macro", with(FlakeMode::bilinear, false, 1)),
      frame_of(stage, "four slices, cross-faded cells", "macro", with(FlakeMode::bilinear, true, 1)),
      frame_of(stage, "the same for four lights", "macro", with(FlakeMode::bilinear, true, 4)),
      frame_of(stage, "no flakes, not even their mean", "macro", with(FlakeMode::off, false, 1))};
  run_rounds(all, rounds);
  report.table(all);
  report.compare("nearest over mean", all[1], all[0], "<= 1.8");
  gles::Governor governor(1000.0 / 16.0);
  for (int k = 0; k < 60; ++k)
    governor.measured(time_ms([&] { stage.draw(stage.view("macro", k), governor.rung().quality); }));
  const gles::Rung chosen = governor.rung();
  Quality mean = chosen.quality;
  mean.flakes = FlakeMode::mean;
  std::vector<Candidate> two = {frame_of(stage, "mean", "macro", mean),
                                frame_of(stage, std::string(chosen.name), "macro", chosen.quality)};
  run_rounds(two, rounds);
  report.compare("the governor's choice, \"" + std::string(chosen.name) + "\", over mean", two[1], two[0], "<= 3");
  const Candidate full = all[4];
  report.compare("four slices, cross-faded cells, over mean", full, all[0], "<= 3");
}

void rungs(Stage& stage, int rounds, Report& report) {
  for (const char* camera : {"hero", "macro"}) {
    report.title("Rungs of the quality ladder, " + std::string(camera));
    std::vector<Candidate> all;
    for (const gles::Rung& rung : gles::quality_ladder())
      all.push_back(frame_of(stage, std::string(rung.name), camera, rung.quality));
    run_rounds(all, rounds);
    report.table(all);
  }
}

void switches(Stage& stage, int rounds, Report& report) {
  report.title("One switch at a time, hero");
  const Quality whole = with(FlakeMode::bilinear, true, 1);
  std::vector<Candidate> all = {frame_of(stage, "filtered, four taps, four cells, one sparkle light", "hero", whole)};
  const auto changed = [&](const char* name, auto change) {
    Quality quality = whole;
    change(quality);
    all.push_back(frame_of(stage, name, "hero", quality));
  };
  changed("coarse detail", [](Quality& q) { q.coarse = true; });
  changed("no mirror image in the floor", [](Quality& q) { q.floor_mirror = false; });
  changed("no sparkle light", [](Quality& q) { q.sparkle_lights = 0; });
  changed("2 sparkle lights", [](Quality& q) { q.sparkle_lights = 2; });
  changed("3 sparkle lights", [](Quality& q) { q.sparkle_lights = 3; });
  changed("4 sparkle lights", [](Quality& q) { q.sparkle_lights = 4; });
  changed("one tap", [](Quality& q) { q.flakes = FlakeMode::nearest; });
  changed("one cell", [](Quality& q) { q.flake_cross_fade = false; });
  changed("mean flakes", [](Quality& q) { q.flakes = FlakeMode::mean; });
  changed("no flakes", [](Quality& q) { q.flakes = FlakeMode::off; });
  changed("3/4 resolution", [](Quality& q) { q.scale = 0.75f; });
  changed("1/2 resolution", [](Quality& q) { q.scale = 0.5f; });
  changed("no environment", [](Quality& q) { q.path = gles::LightPath::none; });
  run_rounds(all, rounds);
  report.table(all);
}

void lights(Stage& stage, int rounds, Report& report) {
  report.title("Ways of light, hero");
  std::vector<Candidate> all = {frame_of(stage, "filtered", "hero", with(FlakeMode::bilinear, true, 1))};
  for (const int count : {1, 4, 16, 64}) {
    Quality quality = with(FlakeMode::bilinear, true, 1);
    quality.path = gles::LightPath::lights;
    quality.cut_lights = count;
    all.push_back(frame_of(stage, std::to_string(count) + " directional lights", "hero", quality));
  }
  run_rounds(all, rounds);
  report.table(all);
}

void still(Stage& stage, Report& report) {
  report.title("Still picture");
  for (const char* camera : {"hero", "macro"}) {
    gles::Lighting lighting;
    const gles::View view = stage.view(camera, 0);
    stage.renderer().draw(view, lighting, stage.target());
    std::vector<double> ms;
    bool more = true;
    while (more)
      ms.push_back(time_ms([&] {
        const auto refined = stage.renderer().refine(view, lighting, stage.target());
        more = refined && refined->more;
        stage.context().gl().Finish();
      }));
    double sum = 0.0;
    for (const double one : ms) sum += one;
    report.value(std::string(camera) + ", one frame", median(ms), "ms", ms.size());
    report.value(std::string(camera) + ", until it has converged", sum / 1000.0, "s", 1);
  }
}

void governor(Stage& stage, Report& report) {
  for (const char* camera : {"hero", "rim", "macro"}) {
    report.title("What the governor chooses for 16 frames a second, " + std::string(camera));
    gles::Governor governor(1000.0 / 16.0);
    std::vector<double> last;
    constexpr int frames = 90, counted = 30;
    for (int k = 0; k < frames; ++k) {
      const double ms = time_ms([&] {
        update(stage, k);
        stage.draw(stage.view(camera, k), governor.rung().quality);
      });
      if (governor.measured(ms))
        std::printf("  frame %d: %.0f ms, now \"%s\"\n", k, ms, std::string(governor.rung().name).c_str());
      if (k >= frames - counted) last.push_back(ms);
    }
    report.value("rung " + std::to_string(governor.index()) + ", \"" + std::string(governor.rung().name) +
                     "\": frames a second while morphing",
                 1000.0 / median(last), "/s", last.size(), ">= 15");
  }
}

void start(Stage& stage, int rounds, Report& report) {
  report.title("From nothing to the first frame (a new renderer on a warm context; shaders are compiled each time)");
  std::vector<double> scene, paint, weights, draw, second;
  for (int k = 0; k < std::max(3, rounds / 5); ++k) {
    gles::Renderer renderer(stage.context());
    gles::Lighting lighting;
    lighting.quality = gles::find_rung("good")->quality;
    const gles::View view = stage.view("hero", k);
    const auto drawn = [&] {
      renderer.draw(view, lighting, stage.target());
      stage.context().gl().Finish();
    };
    scene.push_back(time_ms([&] { renderer.set_scene(stage.scene()); }));
    paint.push_back(time_ms([&] {
      if (!renderer.set_paint(stage.paint())) std::abort();
    }));
    weights.push_back(time_ms([&] {
      if (!renderer.update(stage.weights(0))) std::abort();
    }));
    draw.push_back(time_ms(drawn));
    second.push_back(time_ms(drawn));
  }
  report.value("scene uploaded", median(scene), "ms", scene.size());
  report.value("paint uploaded", median(paint), "ms", paint.size());
  report.value("first weights", median(weights), "ms", weights.size());
  report.value("first frame, compiling", median(draw), "ms", draw.size());
  report.value("second frame", median(second), "ms", second.size());
  report.title("Bytes on the GPU");
  const gles::GpuBytes bytes = stage.renderer().gpu_bytes();
  constexpr double mega = 1e-6;
  report.value("geometry", mega * static_cast<double>(bytes.geometry), "MB", 1);
  report.value("environment", mega * static_cast<double>(bytes.environment), "MB", 1);
  report.value("paint", mega * static_cast<double>(bytes.paint), "MB", 1);
  report.value("materials", mega * static_cast<double>(bytes.materials), "MB", 1);
  report.value("pictures", mega * static_cast<double>(bytes.pictures), "MB", 1);
  report.value("all but pictures", mega * static_cast<double>(bytes.without_pictures()), "MB", 1, "<= 32");
}

int run(const Options& options) {
  auto opened = Stage::open(options.pack, options.scene, options.backend, options.width, options.height);
  if (!opened) {
    std::fprintf(stderr, "render_bench: %s\n", opened.error().line().c_str());
    return 1;
  }
  Stage& stage = **opened;
  Report report;
  std::printf("%s, %s, %dx%d; load %s\n", options.scene.c_str(), stage.context().info().renderer.c_str(), options.width,
              options.height, machine_load().c_str());
  if (options.wants("morph")) morph(stage, options.rounds, report);
  if (options.wants("rungs")) rungs(stage, options.rounds, report);
  if (options.wants("flakes")) flakes(stage, options.rounds, report);
  if (options.wants("switches")) switches(stage, options.rounds, report);
  if (options.wants("lights")) lights(stage, std::max(3, options.rounds / 3), report);
  if (options.wants("governor")) governor(stage, report);
  if (options.wants("still")) still(stage, report);
  if (options.wants("start")) start(stage, options.rounds, report);
  if (options.wants("map")) compare_map_with_table(stage, "hero", options.rounds, report);
  if (options.wants("peer") && !options.capture.empty())
    if (auto ok = compare_with_btf(stage, options.capture, options.rounds, report); !ok) {
      std::fprintf(stderr, "render_bench: %s\n", ok.error().line().c_str());
      return 1;
    }
  if (options.wants("flakes")) {
    stage.show(plate(stage.scene()));
    plate_flakes(stage, options.rounds, report);
  }
  std::printf("\nload %s\n", machine_load().c_str());
  if (!options.json.empty()) std::ofstream(options.json) << report.json();
  return 0;
}

}  // namespace
}  // namespace lackwerk::bench

int main(int argc, char** argv) {
  lackwerk::bench::Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string name = argv[k];
    if (name == "--osmesa") {
      options.backend = lackwerk::gles::Backend::osmesa;
      continue;
    }
    const char* value = k + 1 < argc ? argv[++k] : nullptr;
    const bool known =
        value != nullptr && (name == "--pack"      ? (options.pack = value, true)
                             : name == "--scene"   ? (options.scene = value, true)
                             : name == "--capture" ? (options.capture = value, true)
                             : name == "--json"    ? (options.json = value, true)
                             : name == "--only"    ? (options.only = value, true)
                             : name == "--rounds"  ? (options.rounds = std::atoi(value)) > 0
                             : name == "--size"    ? std::sscanf(value, "%dx%d", &options.width, &options.height) == 2
                                                   : false);
    if (!known) {
      std::fprintf(stderr, "render_bench: %s is not understood\n%s", name.c_str(), lackwerk::bench::usage);
      return 2;
    }
  }
  if (options.pack.empty() || options.scene.empty()) {
    std::fprintf(stderr, "%s", lackwerk::bench::usage);
    return 2;
  }
  return lackwerk::bench::run(options);
}
