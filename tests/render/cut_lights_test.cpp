// Lights cut from an environment and what is looked up beside them show one light, whole.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "render_gles/light_shares.hpp"
#include "render_gles/renderer.hpp"
#include "tests/render/golden_scenes.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;

std::vector<core::EnvironmentLight> spread(int count, float lowest_z) {
  std::vector<core::EnvironmentLight> lights;
  for (int k = 0; k < count; ++k) {
    const float z = 1.0f - (1.0f - lowest_z) * (static_cast<float>(k) + 0.5f) / static_cast<float>(count);
    const float turn = 2.399963f * static_cast<float>(k), radius = std::sqrt(1.0f - z * z);
    lights.push_back({{radius * std::cos(turn), radius * std::sin(turn), z}, glm::vec3(1.0f)});
  }
  return lights;
}

TEST(LightShares, CountsEvenPartsOfTheSphere) {
  EXPECT_NEAR(gles::effective_parts(spread(1, -1.0f)), 1.0, 1e-9);
  for (const int count : {4, 16, 64}) EXPECT_NEAR(gles::effective_parts(spread(count, -1.0f)) / count, 1.0, 0.12);
  // All in a cap of 8 degrees, as under a sun: those at its rim stand for the whole sphere.
  EXPECT_LT(gles::effective_parts(spread(64, 0.99f)), 32.0);
  EXPECT_EQ(gles::effective_parts({}), 1.0);
}

TEST(LightShares, RoughLobesAreTheLightsSharpOnesAreLookedUp) {
  const double border = std::sqrt(gles::share_border / 16.0);
  EXPECT_EQ(gles::light_share(0.7 * border, 16.0), 0.0f);
  EXPECT_NEAR(gles::light_share(border, 16.0), 0.5, 1e-6);
  EXPECT_EQ(gles::light_share(1.42 * border, 16.0), 1.0f);
  float before = 0.0f;
  for (double m = core::min_roughness; m < 1.0; m *= 1.02) {
    const float now = gles::light_share(m, 16.0);
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.1f) << "a morph must show no step";
    before = now;
  }
  core::AnalyticPaint paint;
  paint.lobes[0].m = 0.9 * border;
  const float thin = gles::light_shares(paint, 1.0, 16.0)[1];
  paint.refraction_ior = 1.5;
  EXPECT_GT(gles::light_shares(paint, 1.0, 16.0)[1], thin) << "a coat spreads what comes out of it";
}

class CutLightsTest : public OnBackend {
 protected:
  gles::Image picture(packs::SurfaceKind kind, const core::Environment& environment, int lights, int samples = 1) {
    const SyntheticPaint paint({.flakes = false});
    const auto target = gles::Framebuffer::create(*context_, 64, 64);
    gles::Renderer renderer(*context_);
    packs::Scene scene;
    scene.parts = {sphere(100.0f, 48, kind)};
    scene.environment = environment;
    renderer.set_scene(scene);
    EXPECT_TRUE(renderer.set_paint(paint.get()));
    EXPECT_TRUE(renderer.update(mix(0.4)));
    gles::Lighting lighting;
    lighting.dither = false;
    lighting.backdrop = glm::vec3(0.0f);
    lighting.quality.smooth_edges = false;
    if (lights > 0) {
      lighting.quality.path = gles::LightPath::lights;
      lighting.quality.cut_lights = lights;
    }
    return renderer.still({{0.0f, -500.0f, 120.0f}, glm::vec3(0.0f), 24.0f, {}}, lighting, *target, samples);
  }
};

const std::vector<std::uint8_t> everywhere(64 * 64, 1);

// Every material, sharp or rough, shows about the light that sampling the whole environment shows. Where everything is
// looked up, as from up to four lights, the filtered path's own error is left (a diffuse part without baked irradiance
// takes the roughest level for it).
TEST_P(CutLightsTest, NoMaterialGoesDarkOrCountsLightTwice) {
  using packs::SurfaceKind;
  const core::Environment room = golden_environment();
  for (const SurfaceKind kind : {SurfaceKind::paint, SurfaceKind::chrome, SurfaceKind::rim, SurfaceKind::trim,
                                 SurfaceKind::rubber, SurfaceKind::lamp_red}) {
    const double sampled = mean_luminance(picture(kind, room, 0, gles::sampled_still_frames), everywhere);
    for (const int lights : {1, 4, 16, 64}) {
      const double ratio = mean_luminance(picture(kind, room, lights, 8), everywhere) / sampled;
      std::printf("  %s, %d lights: %.3f of the sampled light\n", gles::surface_name(kind), lights, ratio);
      EXPECT_NEAR(ratio, 1.0, lights < 16 ? 0.15 : 0.06) << gles::surface_name(kind) << ", " << lights;
    }
  }
}

// A still picture adds all of the cut's passes to each of its frames, not the first four lights alone.
TEST_P(CutLightsTest, StillPicturesHaveAllLights) {
  const core::Environment room = golden_environment();
  const double moving = mean_luminance(picture(packs::SurfaceKind::rubber, room, 64), everywhere);
  const double still = mean_luminance(picture(packs::SurfaceKind::rubber, room, 64, 8), everywhere);
  EXPECT_NEAR(still / moving, 1.0, 0.05) << "but for the outline, which is smooth";
}

INSTANTIATE_TEST_SUITE_P(Backends, CutLightsTest, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

}  // namespace
}  // namespace lackwerk::test
