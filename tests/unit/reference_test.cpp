// The reference integrator: against brute-force quadrature, and against its own error bars.
#include "core/analysis/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "core/analysis/reference_room.hpp"
#include "core/analysis/reference_sampling.hpp"
#include "core/paint_model.hpp"
#include "core/realise.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scene.hpp"
#include "render_gles/view.hpp"
#include "tests/unit/reference_scenes.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;
using testing::lit_room;
using testing::Mesh;
using testing::options_of;
using testing::overall;
using testing::quad;
using testing::render;
using testing::sphere;
using testing::white;

TEST(ReferenceRoom, DrawsFromAnyPlaceAgreeWithUniformOnes) {
  const Environment environment = lit_room();
  PaintModel<double> model;
  model.environment = &environment;
  model.u_room = {dvec3(environment.centre_mm), 4000.0};
  model.u_environment_scale = 16.0;
  const RoomSampler sampler(environment);
  std::mt19937 engine(5);
  const auto unit = [&] { return (static_cast<double>(engine()) + 0.5) * 0x1p-32; };
  for (const dvec3 p : {dvec3(0, 0, 1000), dvec3(1500, -900, 300), dvec3(-2000, 1200, 1800), dvec3(2500, 0, 400)}) {
    ASSERT_TRUE(sampler.reaches(p));
    constexpr int draws = 300000;
    double by_map[2] = {}, uniform[2] = {}, mass = 0.0;
    for (int k = 0; k < draws; ++k) {
      if (const auto d = sampler.sample(p, {unit(), unit()})) {
        const dvec3 room = model.room_direction(p, *d);
        const double value = model.environment_sharp(room).y / sampler.pdf(p, *d, room);
        by_map[0] += value;
        by_map[1] += value * value;
      }
      const double z = 2.0 * unit() - 1.0, phi = 2.0 * pi * unit(), s = std::sqrt(1.0 - z * z);
      const dvec3 d(s * std::cos(phi), s * std::sin(phi), z);
      const dvec3 room = model.room_direction(p, d);
      const double value = model.environment_sharp(room).y * 4.0 * pi;
      uniform[0] += value;
      uniform[1] += value * value;
      mass += sampler.pdf(p, d, room) * 4.0 * pi;
    }
    const auto error2 = [](const double* sums) {
      const double mean = sums[0] / draws;
      return (sums[1] / draws - mean * mean) / draws;
    };
    EXPECT_NEAR(by_map[0] / draws, uniform[0] / draws, 4.0 * std::sqrt(error2(by_map) + error2(uniform))) << p.x;
    EXPECT_LT(error2(by_map), 0.2 * error2(uniform)) << "drawing by the map must pay";
    EXPECT_NEAR(mass / draws, 1.0, 0.03) << "the density over all directions";
  }
  EXPECT_FALSE(sampler.reaches({4100, 0, 500})) << "outside the room";
}

/// Everything of one picture of a small square, looked at from so near that all pixels see one point.
struct OnePoint {
  dvec3 n = glm::normalize(dvec3(0.2, -0.3, 0.9)), o = glm::normalize(dvec3(-0.4, -0.5, 0.8));
  glm::vec3 p{800.123f, -500.321f, 600.0f};  // not on a texel's edge
  packs::Visibility bytes{150, 135, 120, 170, 128, 128, 128, 140, 120};
  Environment environment = lit_room();
  Mesh mesh = quad(p, glm::vec3(n), 50.0f);
  ReferenceScene scene;
  ReferenceView view{dvec3(p) + o * 300.0, dvec3(p), 1e-4};

  explicit OnePoint(ReferenceMaterial material) {
    mesh.open_by(bytes);
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(mesh.spans(0));
    scene.environment = &environment;
  }

  /// The integral over directions by brute force, and the coat's mirror image.
  [[nodiscard]] dvec3 quadrature(PaintModel<double>& model, const dvec2& texel, double lod, double flakes) {
    model.environment = &environment;
    model.u_room = {dvec3(environment.centre_mm), 4000.0};
    model.u_environment_scale = 16.0;
    dvec3 v[3];
    for (int k = 0; k < 9; ++k) v[k / 3][k % 3] = (bytes[static_cast<std::size_t>(k)] - 128.0) / 64.0;
    const dvec3 at(p);
    const auto arriving = [&](const dvec3& d) {
      return model.environment_sharp(model.room_direction(at, d)) * model.visible_part(v[0], v[1], v[2], d);
    };
    const dvec3 mirror = n * (2.0 * glm::dot(n, o)) - o;
    const ReferenceFrame frame(mirror);
    constexpr int rings = 1200, spokes = 800;
    dvec3 sum(0.0);
    for (int a = 0; a < rings; ++a) {
      const auto angle = [](double t) { return pi * t * t; };  // denser where lobes peak
      const double from = angle(static_cast<double>(a) / rings), to = angle((a + 1.0) / rings), t = 0.5 * (from + to);
      const double area = (std::cos(from) - std::cos(to)) * 2.0 * pi / spokes;
      for (int b = 0; b < spokes; ++b) {
        const double phi = 2.0 * pi * (b + 0.5) / spokes;
        const dvec3 d = frame.to_world({std::sin(t) * std::cos(phi), std::sin(t) * std::sin(phi), std::cos(t)});
        const double c = glm::dot(n, d);
        if (c > 0.0) sum += model.paint_factor(n, d, o, texel, lod, flakes) * arriving(d) * (c * area / pi);
      }
    }
    return sum + arriving(mirror) * model.fresnel_dielectric(glm::dot(n, o), model.u_coat_ior);
  }
};

void expect_agreement(const ReferenceImage& image, const dvec3& exact) {
  const auto [mean, error] = overall(image);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c], exact[c], 4.0 * error[c] + 1.5e-3 * exact[c]) << "channel " << c;
    EXPECT_LT(error[c], 6e-3 * exact[c]) << "the error bar must be able to refuse";
  }
}

TEST(ReferencePoint, AgreesWithQuadratureOverAllDirections) {
  // Polaris Silber's first two lobes and a mirror-like one under a coat that refracts (Guenther et al. 2005, Table 1).
  AnalyticPaint paint;
  paint.diffuse = {0.055, 0.063, 0.071};
  paint.lobes = {Lobe{{0.065, 0.082, 0.088}, 0.38, 1.0}, Lobe{{0.11, 0.13, 0.13}, 0.17, 0.92},
                 Lobe{{0.02, 0.02, 0.02}, 0.04, 0.5}};
  paint.coat_ior = paint.refraction_ior = 1.5;
  OnePoint point({paint});
  const ReferenceImage image = render(point.scene, point.view, {}, options_of(8, 1024));
  PaintModel<double> model;
  static const InterpolatablePaint nothing;
  bind_model(nothing, paint, no_textures(), model);
  expect_agreement(image, point.quadrature(model, {0, 0}, 0, 0));
}

TEST(ReferencePoint, AgreesWithQuadratureForAPaintOfTheDemoPack) {
  const std::filesystem::path path = std::filesystem::path(LACKWERK_SOURCE_DIR) / "build/demo/demo.lwp";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "build/demo/demo.lwp is not there (scripts/demo makes it)";
  const auto pack = packs::PaintPack::open(path);
  if (!pack) GTEST_SKIP() << "build/demo/demo.lwp: " << pack.error().line();
  const InterpolatablePaint& paint = pack->paint();
  std::vector<double> weights(paint.paints.size(), 0.0);
  weights[0] = 1.0;
  PaintTextures textures = make_static_textures(paint);
  RealisedPaint realised;
  realise(paint, Weights::uniform(weights), realised);
  update_textures(paint, realised, textures);
  ReferenceMaterial material;
  material.is_paint = true;
  OnePoint point(material);
  point.scene.paint = {&paint, &realised.analytic, &textures, true};
  const ReferenceImage image = render(point.scene, point.view, {}, options_of(8, 1024));
  PaintModel<double> model;
  bind_model(paint, realised.analytic, textures, model);
  // So near that one texel fills the picture: its single flake, at level 0.
  const dvec2 texel = model.surface_texel(dvec3(point.p), point.n, 1.0 / static_cast<double>(paint.texel_mm));
  expect_agreement(image, point.quadrature(model, texel, -20.0, 1.0));
}

TEST(ReferencePoint, DirectionalLightsAndLampsAreExact) {
  AnalyticPaint paint;
  paint.diffuse = {0.2, 0.4, 0.6};
  ReferenceMaterial material{paint};
  material.emission = {0.5, 0.25, 0.125};
  OnePoint point(material);
  const dvec3 l1 = glm::normalize(dvec3(0.1, 0.2, 0.9)), l2 = glm::normalize(dvec3(-0.9, 0.1, 0.2));
  ReferenceLighting lighting;
  lighting.gain = 0.0;  // nothing but the lights
  lighting.lamp_glow = 2.0;
  lighting.lights = {{l1, dvec3(1.0, 0.8, 0.6)}, {l2, dvec3(0.2, 0.3, 0.4)}, {-point.n, dvec3(9.0)}};
  PaintModel<double> model;
  dvec3 v[3];
  for (int k = 0; k < 9; ++k) v[k / 3][k % 3] = (point.bytes[static_cast<std::size_t>(k)] - 128.0) / 64.0;
  dvec3 exact(1.0, 0.5, 0.25);
  for (const ReferenceLight& light : lighting.lights)
    exact += light.radiance * paint.diffuse * std::max(glm::dot(point.n, light.direction), 0.0) *
             model.visible_part(v[0], v[1], v[2], light.direction);
  const auto [mean, error] = overall(render(point.scene, point.view, lighting, options_of(8, 1024)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], exact[c], 4.0 * error[c] + 1e-6) << c;
}

/// A ball on a glossy floor in the lit room.
struct BallOnFloor {
  Environment environment = lit_room();
  Mesh ball = sphere({0, 0, 300}, 300.0f, 32), floor = quad(glm::vec3(0), glm::vec3(0, 0, 1), 3000.0f);
  ReferenceScene scene;
  ReferenceView view{{900, -1800, 900}, {0, 0, 250}, 30.0};
  ReferenceLighting lighting;

  BallOnFloor() {
    AnalyticPaint paint;
    paint.diffuse = {0.05, 0.1, 0.3};
    paint.lobes[0] = {dvec3(0.1), 0.2, 0.5};
    paint.coat_ior = paint.refraction_ior = 1.5;
    AnalyticPaint ground;
    ground.diffuse = dvec3(0.12);
    ground.lobes[0] = {dvec3(0.55), 0.08, 0.04};
    ReferenceMaterial stone{ground};
    stone.is_floor = true;
    scene.materials = {{paint}, stone};
    scene.meshes = {ball.spans(0), floor.spans(1)};
    scene.environment = &environment;
    lighting.lights = {{glm::normalize(dvec3(1, -1, 2)), dvec3(0.5)}};
    lighting.backdrop = dvec3(0.02);
  }
};

TEST(ReferencePicture, IsTheSameForAnyNumberOfThreads) {
  const BallOnFloor subject;
  ReferenceOptions options = options_of(34, 128);
  const ReferenceImage one = render(subject.scene, subject.view, subject.lighting, options);
  for (const unsigned threads : {2u, 5u}) {
    options.threads = threads;
    const ReferenceImage many = render(subject.scene, subject.view, subject.lighting, options);
    EXPECT_TRUE(one.mean == many.mean && one.error == many.error) << threads;
    EXPECT_EQ(one.rays, many.rays);
  }
  options.seed = 2;
  EXPECT_FALSE(one.mean == render(subject.scene, subject.view, subject.lighting, options).mean);
}

class ErrorBars : public ::testing::TestWithParam<ReferenceVisibility> {};

TEST_P(ErrorBars, SayHowFarTwoSeedsDiffer) {
  const BallOnFloor subject;
  ReferenceOptions options = options_of(26, 512);
  options.visibility = GetParam();
  const ReferenceImage a = render(subject.scene, subject.view, subject.lighting, options);
  options.seed = 99;
  const ReferenceImage b = render(subject.scene, subject.view, subject.lighting, options);
  // Reduced chi-square as the ratio of sums: single error bars of 8 batches scatter by a quarter themselves.
  dvec3 squared(0.0), variance(0.0);
  double luminance = 0.0, luminance_variance = 0.0;
  for (std::size_t k = 0; k < a.mean.size(); ++k) {
    const dvec3 d = a.mean[k] - b.mean[k];
    const dvec3 v = a.error[k] * a.error[k] + b.error[k] * b.error[k];
    squared += d * d;
    variance += v;
    luminance += luminance_of(d) * luminance_of(d);
    luminance_variance += a.luminance_error[k] * a.luminance_error[k] + b.luminance_error[k] * b.luminance_error[k];
  }
  ASSERT_GT(variance.y, 0.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(squared[c] / variance[c], 1.0, 0.2) << c;
  EXPECT_NEAR(luminance / luminance_variance, 1.0, 0.2);
}
INSTANTIATE_TEST_SUITE_P(All, ErrorBars, ::testing::Values(ReferenceVisibility::baked, ReferenceVisibility::traced),
                         [](const auto& info) {
                           return info.param == ReferenceVisibility::baked ? "Baked" : "Traced";
                         });

TEST(ReferencePicture, GlassCoversWhatLiesBehindIt) {
  const Environment environment = uniform_environment(glm::vec3(0.5f));
  const Mesh wall = quad({0, 100, 0}, {0, -1, 0}, 400.0f);
  const Mesh pane = quad({0, 0, 0}, {0, -1, 0}, 400.0f), second = quad({0, 50, 0}, {0, -1, 0}, 400.0f);
  const Mesh turned = quad({0, -50, 0}, {0, 1, 0}, 400.0f);  // its back: not there
  AnalyticPaint glass;
  glass.diffuse = dvec3(0.02);
  glass.coat_ior = 1.52;
  ReferenceMaterial window{glass}, bright{AnalyticPaint{}};
  window.coverage = 0.8;
  bright.emission = dvec3(1.0);
  const ReferenceScene scene{
      {bright, window}, {wall.spans(0), pane.spans(1), second.spans(1), turned.spans(1)}, &environment, {}};
  ReferenceLighting lighting;
  lighting.lamp_glow = 3.0;
  const auto [mean, error] = overall(render(scene, {{0, -500, 0}, {0, 0, 0}, 0.01}, lighting, options_of(8, 256)));
  // One pane: its tint lit from everywhere through the coat, and the coat's mirror image.
  PaintModel<double> model;
  static const InterpolatablePaint nothing;
  bind_model(nothing, glass, no_textures(), model);
  const double f = model.fresnel_dielectric(1.0, 1.52);
  double tint = 0.0;
  constexpr int steps = 4000;
  for (int k = 0; k < steps; ++k) {
    const double u = (k + 0.5) / steps;  // sine squared: 2 sin cos dt = du
    const double c = std::sqrt(1.0 - u);
    tint += model.paint_factor({0, 0, 1}, {std::sqrt(u), 0, c}, {0, 0, 1}, {0, 0}, 0, 0).x / steps;
  }
  const double colour = 0.5 * (tint + f), through = (1.0 - 0.8) * (1.0 - f);
  const double exact = colour + through * (colour + through * 3.0);
  EXPECT_NEAR(mean.x, exact, 4.0 * error.x + 1e-4);
}

TEST(ReferencePicture, ProjectsAsTheRendererDoes) {
  // A glowing square seen from aside: its middle must lie where clip_from_world puts it.
  const Environment environment = uniform_environment(glm::vec3(0.0f));
  const glm::vec3 spot(300.0f, 120.0f, 500.0f);
  gles::View view;
  view.eye_mm = {2000.0f, -2500.0f, 1400.0f};
  view.target_mm = {100.0f, 50.0f, 300.0f};
  view.vertical_fov_deg = 35.0f;
  const Mesh square = quad(spot, glm::normalize(view.eye_mm - spot), 60.0f);
  ReferenceMaterial glow;
  glow.emission = dvec3(1.0);
  const ReferenceScene scene{{glow}, {square.spans(0)}, &environment, {}};
  ReferenceOptions options = options_of(64, 1024);
  options.width = 96;
  ReferenceLighting lighting;
  lighting.lamp_glow = 1.0;
  const ReferenceImage image = render(scene, {dvec3(view.eye_mm), dvec3(view.target_mm), 35.0}, lighting, options);
  double sum = 0.0;
  dvec2 middle(0.0);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const double v = image.mean[static_cast<std::size_t>(y * 96 + x)].y;
      sum += v;
      middle += v * dvec2(x + 0.5, y + 0.5);
    }
  ASSERT_GT(sum, 1.0);
  middle /= sum;
  gles::Box box;
  box.lo = spot - 20.0f;
  box.hi = spot + 20.0f;
  const glm::vec4 clip = gles::clip_from_world(view, 96, 64, std::span(&box, 1)) * glm::vec4(spot, 1.0f);
  EXPECT_NEAR(middle.x, (static_cast<double>(clip.x / clip.w) * 0.5 + 0.5) * 96.0, 0.03);
  EXPECT_NEAR(middle.y, (0.5 - static_cast<double>(clip.y / clip.w) * 0.5) * 64.0, 0.03);
}

TEST(ReferencePicture, TheFloorMirrorsTheBallAndTracedLightIsShadowed) {
  BallOnFloor subject;
  subject.lighting.lights.clear();
  // A spot of floor in front of the ball, and one under its rim.
  const auto floor_at = [&](dvec3 place, ReferenceVisibility visibility, bool with_ball) {
    ReferenceScene scene = subject.scene;
    if (!with_ball) scene.meshes.erase(scene.meshes.begin());
    ReferenceOptions options = options_of(4, 4096);
    options.visibility = visibility;
    options.bounces = 1;
    return overall(render(scene, {{0, -2500, 900}, place, 0.05}, subject.lighting, options)).first.y;
  };
  const dvec3 mirrored(0, -450, 0), shaded(-250, 0, 0);
  const double with = floor_at(mirrored, ReferenceVisibility::baked, true);
  const double without = floor_at(mirrored, ReferenceVisibility::baked, false);
  EXPECT_GT(std::abs(with - without), 0.02 * without) << "the floor's gloss sees the ball";
  EXPECT_LT(floor_at(shaded, ReferenceVisibility::traced, true),
            0.7 * floor_at(shaded, ReferenceVisibility::traced, false))
      << "the ball shades the floor under it";
  // Without the ball nothing stands between: both worlds are one.
  EXPECT_NEAR(floor_at(shaded, ReferenceVisibility::traced, false), floor_at(shaded, ReferenceVisibility::baked, false),
              0.01 * without);
}

TEST(ReferencePicture, BytesAndStepsFollowTheDisplayTransform) {
  ReferenceImage image;
  image.width = 2;
  image.height = 1;
  image.mean = {dvec3(0.1, 0.2, 0.3), dvec3(40.0)};
  image.error = {dvec3(1e-4), dvec3(0.0)};
  image.luminance_error = {1e-4, 0.0};
  const auto bytes = reference_bytes(image, 0.85);
  const dvec3 shown = PaintModel<double>().display_transform(dvec3(0.1, 0.2, 0.3) * 0.85);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(bytes[static_cast<std::size_t>(c)], std::lround(shown[c] * 255.0));
  const auto steps = reference_error_steps(image, 0.85);
  // Red is the darkest and moves most: 255 * 0.85e-4 * d(srgb)/dx at 0.085, about 2.0.
  EXPECT_NEAR(steps[0], 255.0 * 0.85e-4 * 1.055 / 2.4 * std::pow(0.085, 1.0 / 2.4 - 1.0), 2e-3);
  EXPECT_EQ(steps[1], 0.0f);
}

TEST(ReferencePicture, RefusesWhatItCannotDraw) {
  const Environment environment = uniform_environment(glm::vec3(1.0f));
  Mesh broken = quad({0, 0, 0}, {0, -1, 0}, 10.0f);
  broken.indices[5] = 4;
  const auto refused = render_reference({{{white()}}, {broken.spans(0)}, &environment, {}}, {}, {}, options_of(8, 16));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("index"), std::string::npos);
  ReferenceMaterial paint;
  paint.is_paint = true;
  EXPECT_FALSE(render_reference({{paint}, {}, &environment, {}}, {}, {}, options_of(8, 16)));
  EXPECT_FALSE(render_reference({{}, {}, &environment, {}}, {}, {}, options_of(0, 16)));
}

}  // namespace
}  // namespace lackwerk::core
