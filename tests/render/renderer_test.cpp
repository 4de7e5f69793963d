// What the renderer promises around the shading: nothing is drawn or sent without need, and pictures are put together
// the right way round.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/geometric.hpp>

#include "render_gles/display_model.hpp"
#include "render_gles/renderer.hpp"
#include "tests/render/cpu_sphere.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;
using gles::FlakeMode;

/// The paint's rows of the albedo texture: they depend on every weight.
constexpr std::uint64_t albedo_bytes = 4u * (gles::albedo_row_count + 3) * gles::albedo_texels;  // and as one lobe

const gles::View front{{0.0f, -400.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 40.0f, {}};

gles::Lighting lit(FlakeMode flakes = FlakeMode::bilinear) {
  gles::Lighting lighting;
  lighting.lights = {{glm::normalize(glm::vec3(-0.4f, -0.8f, 0.6f)), glm::vec3(0.7f)}};
  lighting.quality.flakes = flakes;
  lighting.dither = false;
  lighting.quality.smooth_edges = false;
  return lighting;
}

packs::MeshPart square(packs::SurfaceKind kind, float y, float half) {
  packs::MeshPart part;
  part.name = "square";
  part.kind = kind;
  part.positions_mm = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
  part.normals.assign(4, {0.0f, -1.0f, 0.0f});
  part.indices = {0, 1, 2, 0, 2, 3};
  return part;
}

packs::Scene scene_of(std::vector<packs::MeshPart> parts) {
  packs::Scene scene;
  scene.name = "test";
  scene.parts = std::move(parts);
  return scene;
}

bool mentions(const std::vector<std::string>& lines, std::string_view words) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.find(words) != std::string::npos; });
}

class RendererTest : public OnBackend {
 protected:
  void SetUp() override {
    OnBackend::SetUp();
    if (!context_) return;
    target_ = std::make_unique<gles::Framebuffer>(gles::Framebuffer::create(*context_, 96, 64).value());
    renderer_ = std::make_unique<gles::Renderer>(*context_);
    renderer_->set_scene(scene_of({sphere(100.0f, 48)}));
  }
  void TearDown() override {
    renderer_.reset();
    target_.reset();
  }
  gles::Image picture(const gles::View& view, const gles::Lighting& lighting) {
    renderer_->draw(view, lighting, *target_);
    return target_->read();
  }

  std::unique_ptr<gles::Framebuffer> target_;
  std::unique_ptr<gles::Renderer> renderer_;
};

TEST_P(RendererTest, NothingChangedMeansNoDraw) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.3)));
  const gles::Lighting lighting = lit();
  EXPECT_TRUE(renderer_->needs_draw(front, lighting, *target_)) << "nothing was drawn yet";
  renderer_->draw(front, lighting, *target_);
  EXPECT_EQ(renderer_->draw_count(), 1u);
  EXPECT_FALSE(renderer_->needs_draw(front, lighting, *target_));

  const gles::UploadCount before = renderer_->uploads();
  ASSERT_TRUE(renderer_->update(mix(0.3)));
  EXPECT_EQ(renderer_->uploads(), before) << "the same weights send nothing";
  EXPECT_FALSE(renderer_->needs_draw(front, lighting, *target_));

  gles::View moved = front;
  moved.eye_mm.x += 1.0f;
  EXPECT_TRUE(renderer_->needs_draw(moved, lighting, *target_));
  gles::Lighting brighter = lighting;
  brighter.exposure = 1.1f;
  EXPECT_TRUE(renderer_->needs_draw(front, brighter, *target_));
  const auto other = gles::Framebuffer::create(*context_, 64, 64).value();
  EXPECT_TRUE(renderer_->needs_draw(front, lighting, other));
  ASSERT_TRUE(renderer_->update(mix(0.31)));
  EXPECT_TRUE(renderer_->needs_draw(front, lighting, *target_));
  EXPECT_EQ(renderer_->draw_count(), 1u);
}

TEST_P(RendererTest, OnlyWhatDependsOnTheWeightsTravels) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  // The last level is one texel, which the flakes' mean knows: none of its rows travels.
  const auto rows = static_cast<std::uint64_t>(paint.get().row_count() - paint.get().layout.slice_count());
  const gles::UploadCount fixed = renderer_->uploads();
  EXPECT_EQ(fixed.bytes, 4u * (16 * 16 + 256 * rows) + 2u * 512 * 512) << "slice map, rank table, random numbers";

  core::Weights weights = mix(0.2);
  ASSERT_TRUE(renderer_->update(weights));
  const auto width = static_cast<std::uint64_t>(renderer_->paint()->textures().width);
  const std::uint64_t chi = 4u * 19 * 19 + albedo_bytes, means = 4u * 16 * 16;
  EXPECT_EQ(renderer_->uploads().bytes - fixed.bytes, chi + means) << "single flakes wait for who shows them";
  (void)picture(front, lit());
  EXPECT_EQ(renderer_->uploads().bytes - fixed.bytes, chi + means + 12u * width * rows) << "the texture is made whole";

  // From then on the levels that the view shows.
  const auto shown = static_cast<std::uint64_t>(std::floor(renderer_->finest_level(front, target_->height())));
  ASSERT_GT(shown, 0u) << "a view that leaves a level out";
  const auto slices = static_cast<std::uint64_t>(paint.get().layout.slice_count());
  ASSERT_LT(shown * slices, rows);
  const std::uint64_t flakes = means + 12u * width * (rows - shown * slices) + albedo_bytes;
  const auto sent = [&] {
    const gles::UploadCount before = renderer_->uploads();
    EXPECT_TRUE(renderer_->update(weights));
    (void)picture(front, lit());
    return renderer_->uploads().bytes - before.bytes;
  };
  weights.base = {0.5, 0.5};
  EXPECT_EQ(sent(), chi);
  weights.flake_lightness = {0.6, 0.4};
  EXPECT_EQ(sent(), flakes);
  weights.flake_colour = {0.1, 0.9};
  EXPECT_EQ(sent(), flakes);
  EXPECT_EQ(sent(), 0u);

  // A path of partial updates ends where one full update ends.
  const gles::Image stepwise = picture(front, lit());
  gles::Renderer fresh(*context_);
  fresh.set_scene(scene_of({sphere(100.0f, 48)}));
  ASSERT_TRUE(fresh.set_paint(paint.get()));
  ASSERT_TRUE(fresh.update(weights));
  fresh.draw(front, lit(), *target_);
  EXPECT_EQ(target_->read(), stepwise);
}

TEST_P(RendererTest, RefusedWeightsChangeNothing) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  const gles::Image before = picture(front, lit());
  const gles::UploadCount sent = renderer_->uploads();
  EXPECT_FALSE(renderer_->update(core::Weights::uniform({0.5, 0.7})));
  EXPECT_FALSE(renderer_->update(core::Weights::uniform({1.0})));
  EXPECT_EQ(renderer_->uploads(), sent);
  EXPECT_FALSE(renderer_->needs_draw(front, lit(), *target_));
  EXPECT_EQ(picture(front, lit()), before);
}

TEST_P(RendererTest, PlainPackCompilesLessAndSaysSo) {
  const SyntheticPaint plain({.flakes = false, .table = false, .coat = false, .lobes = 1});
  ASSERT_TRUE(renderer_->set_paint(plain.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  EXPECT_EQ(renderer_->uploads().bytes, albedo_bytes) << "nothing else of this pack lives in textures";
  gles::Lighting lighting = lit(FlakeMode::bilinear);
  lighting.quality.path = gles::LightPath::none;
  renderer_->draw(front, lighting, *target_);
  const auto lines = renderer_->explain();
  for (const char* words :
       {"left out: colour table", "left out: clear coat", "left out: refraction", "left out: flakes: no paint",
        "left out: 2 of 3 lobes", "left out: environment", "left out: glass",
        "program: paint, no environment, 1 lobe, 1 directional light", "programs: 1, draws: 1"})
    EXPECT_TRUE(mentions(lines, words)) << words;

  const SyntheticPaint rich;
  ASSERT_TRUE(renderer_->set_paint(rich.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  renderer_->draw(front, lighting, *target_);
  EXPECT_FALSE(mentions(renderer_->explain(), "left out: colour table"));
  EXPECT_EQ(renderer_->program_count(), 2u);
}

TEST_P(RendererTest, BackgroundIsTheBackdrop) {
  const SyntheticPaint paint({.flakes = false});
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.0)));
  gles::Lighting lighting = lit();
  lighting.backdrop = {0.2f, 0.1f, 0.05f};
  const gles::Image image = picture(front, lighting);
  const auto shown = gles::DisplayModel<double>().display_transform(glm::dvec3(lighting.backdrop));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(0, 0)[c], shown[c] * 255.0, 0.51);
}

TEST_P(RendererTest, NearHidesFarAndGlassBlends) {
  const SyntheticPaint paint({.flakes = false});
  const gles::Lighting lighting = lit();
  const auto middle = [&](std::vector<packs::MeshPart> parts) {
    renderer_->set_scene(scene_of(std::move(parts)));
    EXPECT_TRUE(renderer_->set_paint(paint.get()));
    EXPECT_TRUE(renderer_->update(mix(0.0)));
    const gles::Image image = picture(front, lighting);
    const std::uint8_t* p = image.pixel(48, 32);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  using packs::SurfaceKind;
  const auto rubber = [] { return square(SurfaceKind::rubber, 0.0f, 80.0f); };
  const auto chrome = [] { return square(SurfaceKind::chrome, 50.0f, 80.0f); };
  const auto glass = [] { return square(SurfaceKind::glass, -50.0f, 80.0f); };
  const auto dark = middle({rubber()}), bright = middle({chrome()});
  EXPECT_GT(bright[1], dark[1] + 20);
  EXPECT_EQ(middle({rubber(), chrome()}), dark);
  EXPECT_EQ(middle({chrome(), rubber()}), dark) << "whatever the order";
  const auto through = middle({glass(), chrome()});
  EXPECT_LT(through[1], bright[1]) << "tinted";
  EXPECT_EQ(middle({chrome(), glass()}), through);
  EXPECT_NE(through, middle({glass()})) << "but not opaque";
  // Seen from behind, there is nothing.
  packs::MeshPart away = chrome();
  std::swap(away.indices[1], away.indices[2]);
  std::swap(away.indices[4], away.indices[5]);
  EXPECT_EQ(middle({rubber(), away}), dark);
}

TEST_P(RendererTest, JitterShiftsThePictureByPartsOfAPixel) {
  const SyntheticPaint paint({.flakes = false});
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.0)));
  gles::Lighting lighting = lit();
  lighting.backdrop = glm::vec3(0.0f);
  const auto centroid = [&](glm::vec2 jitter) {
    gles::View view = front;
    view.jitter_px = jitter;
    const gles::Image image = picture(view, lighting);
    glm::dvec2 sum(0.0);
    double count = 0.0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.pixel(x, y);
        if (p[0] + p[1] + p[2] == 0) continue;
        sum += glm::dvec2(x, y);
        count += 1.0;
      }
    return sum / count;
  };
  const glm::dvec2 still = centroid({0.0f, 0.0f}), moved = centroid({0.5f, -0.25f});
  EXPECT_NEAR(moved.x - still.x, 0.5, 0.1);
  EXPECT_NEAR(moved.y - still.y, 0.25, 0.1) << "rows count downwards, the jitter upwards";
}

TEST_P(RendererTest, StillSmoothsEdgesAndRepeats) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  const gles::Lighting lighting = lit();
  const gles::Image once = picture(front, lighting);
  EXPECT_EQ(renderer_->still(front, lighting, *target_, 1), once);
  const gles::Image smooth = renderer_->still(front, lighting, *target_, 16);
  EXPECT_EQ(renderer_->still(front, lighting, *target_, 16), smooth);
  EXPECT_TRUE(std::equal(smooth.pixel(0, 0), smooth.pixel(0, 0) + 3, once.pixel(0, 0)))
      << "flat areas keep their bytes";
  // Along a row, the largest step between neighbours is the sphere's edge.
  const auto steepest = [](const gles::Image& image) {
    int step = 0;
    for (int x = 1; x < image.width; ++x)
      step = std::max(step, std::abs(image.pixel(x, 32)[1] - image.pixel(x - 1, 32)[1]));
    return step;
  };
  EXPECT_LT(steepest(smooth), steepest(once));
}

// Refining goes on until the frames are done, ends where still() ends, and starts again only when something changes.
TEST_P(RendererTest, ARestingPictureConvergesAndStops) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  const gles::Lighting lighting = lit();
  constexpr int frames = 32;
  const auto more_of = [&](const gles::View& view) {
    const auto refined = renderer_->refine(view, lighting, *target_, frames);
    EXPECT_TRUE(refined);
    return refined && refined->more;
  };
  EXPECT_FALSE(more_of(front)) << "nothing was drawn yet";
  const gles::Image moving = picture(front, lighting);
  int refined = 0;
  gles::Image before = moving;
  double largest_step = 0.0;
  for (bool more = true; more; ++refined) {
    const auto result = renderer_->refine(front, lighting, *target_, frames);
    ASSERT_TRUE(result) << result.error().line();
    more = result->more;
    EXPECT_TRUE(result->frame);
    const gles::Image now = target_->read();
    EXPECT_TRUE(result->shown || now == before);
    largest_step = std::max(largest_step, compare_images(before, now).mean);
    before = now;
  }
  EXPECT_EQ(refined, frames);
  EXPECT_FALSE(more_of(front));
  EXPECT_FALSE(renderer_->needs_draw(front, lighting, *target_));
  EXPECT_EQ(renderer_->draw_count(), 1u) << "refining is not drawing";
  const double whole = compare_images(moving, before).mean;
  std::printf("  from moving to still: CIEDE2000 mean %.3f, largest step on the way %.3f\n", whole, largest_step);
  EXPECT_GT(whole, 0.0);
  EXPECT_LT(largest_step, 0.25 * whole + 0.1) << "the switch is a fade";
  EXPECT_EQ(renderer_->still(front, lighting, *target_, frames), before);

  gles::View moved = front;
  moved.eye_mm.x += 1.0f;
  EXPECT_FALSE(more_of(moved)) << "a new view is drawn first";
  picture(moved, lighting);
  EXPECT_TRUE(more_of(moved));
}

// A frame in strips is the frame: no row is missed or drawn twice, however many there are.
TEST_P(RendererTest, AFrameInStripsIsTheSamePicture) {
  const SyntheticPaint paint;
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.5)));
  const gles::Lighting lighting = lit();
  constexpr int frames = gles::sampled_still_frames;
  const gles::Image whole = renderer_->still(front, lighting, *target_, frames);
  for (const int strips : {3, 16}) {
    picture(front, lighting);
    int calls = 0, added = 0;
    for (bool more = true; more; ++calls) {
      const auto result = renderer_->refine(front, lighting, *target_, frames, strips);
      ASSERT_TRUE(result) << result.error().line();
      EXPECT_TRUE(result->frame || !result->shown);
      added += result->frame ? 1 : 0;
      more = result->more;
    }
    EXPECT_EQ(added, frames);
    // A driver with too few uniforms for sampling smooths the moving picture, which takes one call a frame.
    EXPECT_TRUE(calls == frames * strips || calls == frames) << calls;
    EXPECT_EQ(target_->read(), whole) << strips << " strips";
  }
}

// The light that the flakes add, single against mean, under the same camera (the raw brightness changes with distance,
// because another part of the sphere comes into view). Measured: bilinear 0.973 to 1.017, nearest 0.958 to 1.013.
// What is left is noise (some 5,000 texels in view at x1, one in twelve a flake), the invented paint's own levels,
// whose cuboids do not keep the mean exactly, and for nearest the slices' convex fall-off, which rounding to a node
// cuts off.
TEST_P(RendererTest, ZoomingOutKeepsTheFlakesBrightness) {
  const SyntheticPaint paint({.lobes = 0});
  ASSERT_TRUE(renderer_->set_paint(paint.get()));
  ASSERT_TRUE(renderer_->update(mix(0.4)));
  renderer_->set_scene(scene_of({sphere(100.0f, 128)}));
  target_ = std::make_unique<gles::Framebuffer>(gles::Framebuffer::create(*context_, 256, 256).value());
  for (const FlakeMode mode : {FlakeMode::nearest, FlakeMode::bilinear})
    for (int step = 0; step < 6; ++step) {
      gles::View view = front;
      view.eye_mm.y = -400.0f * static_cast<float>(1 << step);
      gles::Lighting lighting = lit(mode);
      lighting.quality.path = gles::LightPath::none;
      lighting.exposure = 0.12f;  // so that the tone curve stays linear for nearly all flakes
      const auto mask = shade_sphere(100.0f, view, lighting, paint.get(), *renderer_->paint(), 256, 256).mask;
      const auto luminance = [&](FlakeMode drawn) {
        lighting.quality.flakes = drawn;
        return mean_luminance(picture(view, lighting), mask);
      };
      const double without = luminance(FlakeMode::off), mean = luminance(FlakeMode::mean), single = luminance(mode);
      const double ratio = (single - without) / (mean - without);
      std::printf("  %s, distance x%d: flakes give %.0f %% of the light, and %.4f of their mean\n",
                  mode == FlakeMode::nearest ? "nearest" : "bilinear", 1 << step, 100.0 * (single - without) / single,
                  ratio);
      EXPECT_GT(single - without, 0.3 * single) << "the test must see flakes";
      EXPECT_NEAR(ratio, 1.0, mode == FlakeMode::bilinear ? 0.03 : 0.05);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, RendererTest, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

TEST(Meshes, SplitKeepsEveryTriangle) {
  const packs::MeshPart part = sphere(10.0f, 200);
  ASSERT_GT(part.positions_mm.size(), 65536u);
  for (const std::size_t limit : {std::size_t{65536}, std::size_t{1000}}) {
    const auto chunks = gles::split_part(part, limit);
    EXPECT_GT(chunks.size(), 1u);
    std::size_t at = 0;
    for (const gles::MeshChunk& chunk : chunks) {
      EXPECT_LE(chunk.vertices.size(), limit);
      for (const std::uint16_t index : chunk.indices) {
        ASSERT_LT(index, chunk.vertices.size());
        ASSERT_EQ(chunk.vertices[index].position_mm, part.positions_mm[part.indices[at]]);
        ASSERT_EQ(chunk.vertices[index].visibility, packs::open_visibility);
        ++at;
      }
    }
    EXPECT_EQ(at, part.indices.size());
  }
}

TEST(Meshes, DepthRangeHoldsTheScene) {
  gles::Box box;
  box.include({-100.0f, -100.0f, 0.0f});
  box.include({100.0f, 100.0f, 50.0f});
  for (const glm::vec3 eye :
       {glm::vec3(0.0f, -3000.0f, 400.0f), glm::vec3(0.0f, 0.0f, 2000.0f), glm::vec3(150.0f, 0.0f, 25.0f)}) {
    const glm::mat4 clip = gles::clip_from_world({eye, glm::vec3(0.0f, 0.0f, 20.0f), 40.0f, {}}, 160, 90, {&box, 1});
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec4 p = clip * glm::vec4(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                                           corner & 4 ? box.hi.z : box.lo.z, 1.0f);
      const bool in_view = p.w > 0.0f && std::abs(p.x) <= p.w && std::abs(p.y) <= p.w;
      if (in_view) {
        EXPECT_LE(std::abs(p.z), p.w) << "clipped by the depth range";
      }
    }
  }
}

}  // namespace
}  // namespace lackwerk::test
