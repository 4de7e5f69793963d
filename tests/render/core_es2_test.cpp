// A driver that offers what core ES 2.0 promises and nothing else must still show the car: fewer terms, coarser
// numbers, the same picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render_gles/accumulator.hpp"
#include "render_gles/governor.hpp"
#include "render_gles/renderer.hpp"
#include "render_gles/shader_texts.hpp"
#include "tests/render/glsl_resources.hpp"
#include "tests/render/golden_check.hpp"
#include "tests/render/golden_scenes.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;
using gles::CoreEs2;

constexpr int core_fragment_vectors = 16, core_vertex_vectors = 128, core_varyings = 8, core_attributes = 8,
              core_units = 8;

gles::Image picture(gles::Context& context, const GoldenShot& shot, const packs::Scene& scene) {
  EXPECT_TRUE(context.make_current());
  const SyntheticPaint paint;
  const auto target = gles::Framebuffer::create(context, golden_width_px, golden_height_px);
  gles::Renderer renderer(context);
  renderer.set_scene(scene);
  EXPECT_TRUE(renderer.set_paint(paint.get()));
  EXPECT_TRUE(renderer.update(mix(shot.mix)));
  return renderer.still(shot.view, shot.lighting, *target, shot.samples);
}

gles::Image picture(gles::Context& context, const GoldenShot& shot) {
  return picture(context, shot, golden_scene(shot.subject));
}

class CoreEs2Test : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    std::string reason;
    normal_ = open_context(GetParam(), reason);
    if (!normal_ && HasFailure()) FAIL() << reason;  // fatal: the body must not run
    if (!normal_) GTEST_SKIP() << reason;
    core_ = open(CoreEs2::highp);
  }
  [[nodiscard]] std::unique_ptr<gles::Context> open(CoreEs2 core_es2) const {
    auto made = gles::create_context(GetParam(), {.core_es2 = core_es2});
    EXPECT_TRUE(made) << made.error().line();
    return made ? std::move(*made) : nullptr;
  }
  std::unique_ptr<gles::Context> normal_, core_;
};

TEST_P(CoreEs2Test, OffersThePromiseAndNoMore) {
  const gles::ContextInfo& info = core_->info();
  EXPECT_TRUE(info.extensions.empty());
  EXPECT_FALSE(info.desktop);
  EXPECT_EQ(info.max_fragment_uniforms, core_fragment_vectors);
  EXPECT_EQ(info.max_vertex_uniforms, core_vertex_vectors);
  EXPECT_EQ(info.max_varying_vectors, core_varyings);
  EXPECT_EQ(info.max_vertex_attributes, core_attributes);
  EXPECT_EQ(info.max_texture_units, core_units);
  EXPECT_NE(info.platform.find("core ES 2.0"), std::string::npos);
  EXPECT_EQ(info.fragment_highp, normal_->info().fragment_highp);
  EXPECT_FALSE(open(CoreEs2::mediump)->info().fragment_highp);

  EXPECT_TRUE(core_->make_current());
  const auto target = gles::Framebuffer::create(*core_, 32, 32);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->depth_bits(), 16);
  EXPECT_FALSE(gles::Framebuffer::create(*core_, 32, 32, gles::PixelFormat::rgba16f));
  const auto sum = gles::Accumulator::create(*core_, 32, 32);
  ASSERT_TRUE(sum);
  EXPECT_FALSE(sum->linear());
}

TEST_P(CoreEs2Test, SaysWhatItLeavesOut) {
  const auto lines_of = [](gles::Context& context) {
    EXPECT_TRUE(context.make_current());
    const SyntheticPaint paint;
    const auto target = gles::Framebuffer::create(context, 64, 64);
    gles::Renderer renderer(context);
    const GoldenShot shot = golden_shot("macro_moving");
    renderer.set_scene(golden_scene(shot.subject));
    EXPECT_TRUE(renderer.set_paint(paint.get()));
    EXPECT_TRUE(renderer.update(mix(shot.mix)));
    renderer.draw(shot.view, shot.lighting, *target);
    std::string all;
    for (const std::string& line : renderer.explain()) all += line + "\n";
    return all;
  };
  const auto weak = open(CoreEs2::mediump);
  EXPECT_NE(lines_of(*weak).find("left out: single flakes: the driver's fragment shaders have 16-bit floats"),
            std::string::npos);
  EXPECT_NE(lines_of(*core_).find("single flakes of 3 of 4 lights of the environment"), std::string::npos);
  EXPECT_EQ(lines_of(*normal_).find("lights of the environment"), std::string::npos);
}

// The same light in fewer terms and without half-float targets. Measured on llvmpipe: see docs/figures.md.
TEST_P(CoreEs2Test, GoldenMoving) {
  GoldenShot shot = golden_shot("table_best");
  const gles::Image normal = picture(*normal_, shot), core = picture(*core_, shot);
  const Difference difference = compare_images(normal, core);
  std::printf("  core ES 2.0 with highp, moving: %s\n", text(difference).c_str());
  EXPECT_LT(difference.mean, 0.1);
  EXPECT_LT(difference.p99, 1.0);
  expect_golden(core, "core_moving", GetParam() == Backend::egl_surfaceless);
}

// Frames are summed in bytes here: glass is blended as displayed, and bytes round 16 times.
TEST_P(CoreEs2Test, GoldenSmoothed) {
  const GoldenShot shot = golden_shot("table_smoothed");
  const gles::Image normal = picture(*normal_, shot), core = picture(*core_, shot);
  const Difference difference = compare_images(normal, core);
  std::printf("  core ES 2.0 with highp, smoothed: %s\n", text(difference).c_str());
  EXPECT_LT(difference.mean, 0.5);
  EXPECT_LT(difference.p99, 3.0);
  expect_golden(core, "core_smoothed", GetParam() == Backend::egl_surfaceless);
}

/// Pixels that are far darker than in `good`, though all its neighbours are bright: what a NaN or an overflow leaves.
std::size_t dark_holes(const gles::Image& good, const gles::Image& image) {
  std::size_t holes = 0;
  for (int y = 1; y + 1 < good.height; ++y)
    for (int x = 1; x + 1 < good.width; ++x) {
      int least = 255;
      for (int k = 0; k < 9; ++k) least = std::min<int>(least, good.pixel(x - 1 + k % 3, y - 1 + k / 3)[1]);
      holes += image.pixel(x, y)[1] < least * 3 / 4 - 4 ? 1 : 0;
    }
  return holes;
}

// No golden for 16-bit floats: a CPU without F16C computes with 32 bits.
TEST_P(CoreEs2Test, MediumpShowsTheSamePicture) {
  const auto weak = open(CoreEs2::mediump);
  for (const char* name : {"sphere_moving", "sphere_no_environment", "table_best", "table_sun", "table_smoothed",
                           "table_lights_16", "table_stripes", "table_least"}) {
    GoldenShot shot = golden_shot(name);
    shot.lighting.lights.resize(std::min<std::size_t>(shot.lighting.lights.size(), 1));  // as many as fit
    shot.lighting.quality.flakes = std::min(shot.lighting.quality.flakes, gles::FlakeMode::mean);
    const gles::Image normal = picture(*normal_, shot), image = picture(*weak, shot);
    const Difference difference = compare_images(normal, image);
    const std::size_t holes = dark_holes(normal, image);
    std::printf("  core ES 2.0 with mediump, %s: %s, %zu dark holes\n", name, text(difference).c_str(), holes);
    EXPECT_LT(difference.mean, 0.8) << name;
    EXPECT_LT(difference.p95, 2.5) << name;
    // Where stripes are narrower than pixels a hair's breadth decides which one a pixel shows.
    if (!shot.lighting.stripes) {
      EXPECT_EQ(holes, 0u) << name << ": " << write_failure(normal, image, std::string("mediump_") + name);
    }
  }
}

// Outdoor maps hold a sun of 100,000 and more beside shadows of 0.1; 16 bits end at 65504 and lose digits below 6e-5.
TEST_P(CoreEs2Test, MediumpStandsASun) {
  const auto weak = open(CoreEs2::mediump);
  GoldenShot shot = golden_shot("table_least");
  shot.lighting.quality.scale = 1.0f;
  for (const double sun : {1e4, 3e5}) {
    packs::Scene scene = golden_scene(shot.subject);
    scene.environment = golden_environment(sun);
    const gles::Image normal = picture(*normal_, shot, scene), image = picture(*weak, shot, scene);
    const Difference difference = compare_images(normal, image);
    const std::size_t holes = dark_holes(normal, image);
    std::printf("  mediump under a sun of %.0e: %s, %zu dark holes\n", sun, text(difference).c_str(), holes);
    EXPECT_LT(difference.mean, 0.8) << write_failure(normal, image, "mediump_sun");
    EXPECT_LT(difference.p95, 2.5);
    EXPECT_EQ(holes, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, CoreEs2Test, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

TEST(CoreResources, CountsLikeTheSpecification) {
  const std::string text = preprocessed(
      "#define N 2\n#define HAS 1\nuniform vec4 a; // a\nuniform vec3 b[N];\nuniform vec2 c;\nuniform float d;\n"
      "uniform float never;\nuniform sampler2D s;\n#if HAS && !(N == 3) && defined(HAS)\nuniform mat4 m;\n#else\n"
      "uniform vec4 out_of_it;\n#endif\nvoid f() { a; b; c; d; m; s; out_of_it; }");
  const auto variables = used_variables(text, "uniform");
  ASSERT_EQ(variables.size(), 5u);
  EXPECT_EQ(used_samplers(text), 1);
  EXPECT_EQ(packed_rows(variables), 4 + 1 + 2 + 1) << "d stands beside b[0]";
  EXPECT_EQ(packed_rows({{"x", 2, 1}, {"y", 2, 1}, {"z", 1, 1}}), 2);
  EXPECT_EQ(packed_rows({{"x", 3, 2}, {"y", 1, 3}}), 3) << "an array stays in one column";
}

/// The richest programs that the renderer asks for where fragments have 16 uniform vectors.
std::vector<gles::Features> richest_programs(bool highp) {
  gles::ContextInfo info;
  info.max_fragment_uniforms = core_fragment_vectors;
  std::vector<gles::Features> out;
  for (int kind = 0; kind < packs::surface_kind_count; ++kind)
    for (const gles::ShaderPath path : {gles::ShaderPath::none, gles::ShaderPath::filtered, gles::ShaderPath::mirror})
      for (int lights = 0; lights <= gles::usable_lights(info); ++lights) {
        gles::Features f;
        f.surface = static_cast<packs::SurfaceKind>(kind);
        f.lobes = f.surface == packs::SurfaceKind::paint ? 3 : 1;
        f.table = f.flakes = f.coat = f.refraction = f.visibility = f.irradiance = f.floor_mirror = true;
        f.flake_taps = f.flake_cells = 4;
        f.path = path;
        f.narrow = 7;
        f.lights = lights;
        f.flake_lights = highp ? lights : 0;
        f.sparkle_lights = highp ? gles::usable_sparkle_lights(info, lights) : 0;
        f.room_lights = f.less_mean_flakes = path != gles::ShaderPath::filtered;
        f.orange_peel = highp;  // 16 bits cannot hold its phases: see view.hpp
        out.push_back(f.canonical());
        f.irradiance = f.floor_mirror = false;
        out.push_back(f.canonical());
      }
  return out;
}

TEST(CoreResources, ProgramsFitTheSmallestDriver) {
  int uniforms = 0, varyings = 0, attributes = 0, units = 0;
  for (const bool highp : {true, false})
    for (const gles::Features& features : richest_programs(highp)) {
      const std::string fragment = preprocessed(gles::fragment_source(features, highp));
      const std::string vertex = preprocessed(gles::vertex_source(features));
      const auto fragment_uniforms = used_variables(fragment, "uniform");
      const int rows = packed_rows(fragment_uniforms);
      std::string names;
      for (const ShaderVariable& v : fragment_uniforms)
        names += " " + v.name + ":" + std::to_string(v.columns) + "x" + std::to_string(v.rows);
      EXPECT_LE(rows, core_fragment_vectors) << features.text() << ":" << names;
      EXPECT_LE(packed_rows(used_variables(vertex, "uniform")), core_vertex_vectors) << features.text();
      EXPECT_LE(packed_rows(used_variables(vertex, "varying")), core_varyings) << features.text();
      EXPECT_LE(used_variables(vertex, "attribute").size(), static_cast<std::size_t>(core_attributes));
      EXPECT_LE(used_samplers(fragment), core_units) << features.text();
      uniforms = std::max(uniforms, rows);
      varyings = std::max(varyings, packed_rows(used_variables(vertex, "varying")));
      attributes = std::max(attributes, static_cast<int>(used_variables(vertex, "attribute").size()));
      units = std::max(units, used_samplers(fragment));
    }
  std::printf("  at most %d fragment uniform vectors, %d varying vectors, %d attributes, %d texture units\n", uniforms,
              varyings, attributes, units);
  EXPECT_GE(uniforms, 10) << "the count must see what is there";
  EXPECT_GE(varyings, 7);
  EXPECT_GE(units, 6);
}

TEST(CoreResources, NoWordBeyondTheLanguage) {
  for (const char* file :
       {"surface_vertex.glsl", "surface_fragment.glsl", "surface_inputs.glsl", "surface_visible.glsl",
        "paint_fetch.glsl", "paint_model.glsl", "environment.glsl", "display.glsl", "filtered_light.glsl",
        "sampled_light.glsl", "screen_vertex.glsl", "screen_copy.glsl", "screen_resolve.glsl", "screen_smooth.glsl",
        "orange_peel.glsl", "isochromatic.glsl", "mapped_paint.glsl"})
    for (const char* word : {"dFdx", "dFdy", "fwidth", "texture2DLod", "texture2DGrad", "#extension", "textureCube",
                             "gl_FragDepth", "gl_FragData", "while"})
      EXPECT_EQ(gles::shader_text(file).find(word), std::string_view::npos) << file << " uses " << word;
}

}  // namespace
}  // namespace lackwerk::test
