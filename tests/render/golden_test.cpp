// Golden pictures: what the renderer drew when somebody last looked at it and found it right.
#include <gtest/gtest.h>

#include <algorithm>

#include "packs/scene_pack.hpp"
#include "render_gles/renderer.hpp"
#include "tests/render/golden_check.hpp"
#include "tests/render/golden_scenes.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;

gles::Image picture(gles::Context& context, const packs::Scene& scene, const GoldenShot& shot, int width, int height) {
  const SyntheticPaint paint;
  const auto target = gles::Framebuffer::create(context, width, height);
  EXPECT_TRUE(target);
  gles::Renderer renderer(context);
  renderer.set_scene(scene);
  EXPECT_TRUE(renderer.set_paint(paint.get()));
  EXPECT_TRUE(renderer.update(mix(shot.mix)));
  return renderer.still(shot.view, shot.lighting, *target, shot.samples);
}

class GoldenTest : public testing::TestWithParam<std::tuple<Backend, std::string>> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = open_context(std::get<0>(GetParam()), reason);
    if (!context_ && HasFailure()) FAIL() << reason;  // fatal: the body must not run
    if (!context_) GTEST_SKIP() << reason;
  }
  std::unique_ptr<gles::Context> context_;
};

TEST_P(GoldenTest, LooksAsBefore) {
  const auto& [backend, name] = GetParam();
  const GoldenShot shot = golden_shot(name);
  const gles::Image image = picture(*context_, golden_scene(shot.subject), shot, golden_width_px, golden_height_px);
  expect_golden(image, name, backend == Backend::egl_surfaceless);
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const GoldenShot& shot : golden_shots()) out.push_back(shot.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Shots, GoldenTest,
                         testing::Combine(testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                                          testing::ValuesIn(names())),
                         [](const auto& info) {
                           return std::string(gles::backend_name(std::get<0>(info.param))) + "_" +
                                  std::get<1>(info.param);
                         });

class GoldenCar : public testing::TestWithParam<Backend> {};

// The one picture that depends on the scene builder: the whole car with everything baked into it.
TEST_P(GoldenCar, LooksAsBefore) {
  const auto path = source_folder() / "build" / "demo" / "builtin.lws";
  const auto scene = packs::read_scene_pack(path);
  if (!scene) GTEST_SKIP() << scene.error().line() << "; scripts/demo builds it";
  std::string reason;
  const auto context = open_context(GetParam(), reason);
  if (!context && HasFailure()) FAIL() << reason;
  if (!context) GTEST_SKIP() << reason;
  ASSERT_FALSE(scene->cameras.empty());
  GoldenShot shot;
  shot.view = gles::View::from(scene->cameras.front());
  shot.lighting.exposure = 0.85f;
  shot.lighting.dither = false;
  shot.samples = 8;  // one a pixel would show the mesh's edges, which another compiler may cover differently
  shot.mix = 0.2;
  expect_golden(picture(*context, *scene, shot, 320, 180), "car", GetParam() == Backend::egl_surfaceless);
}

INSTANTIATE_TEST_SUITE_P(Backends, GoldenCar, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

TEST(GoldenTests, NothingElseLiesInTheFolder) {
  std::uintmax_t bytes = 0;
  std::vector<std::string> known = names();
  for (const char* name : {"car", "core_moving", "core_smoothed"}) known.emplace_back(name);
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "tests" / "golden")) {
    bytes += entry.file_size();
    EXPECT_NE(std::find(known.begin(), known.end(), entry.path().stem().string()), known.end())
        << entry.path() << " belongs to no test: remove it";
  }
  EXPECT_LT(bytes, 1'200'000u) << "the repository carries every version of them for ever";
}

}  // namespace
}  // namespace lackwerk::test
