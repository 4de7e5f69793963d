// One model, three evaluations: EGL, OSMesa, and the CPU at double precision.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>
#include <ostream>

#include "render_gles/renderer.hpp"
#include "tests/render/cpu_sphere.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;
using gles::FlakeMode;

constexpr float radius_mm = 100.0f;
constexpr int edge = 320;
// GPU against CPU, CIEDE2000. One step of 8 bits is about 0.2 to 0.5; measured are means of 0.003 to 0.010 and p99 of 0
// to 0.44. Single pixels may show another flake (a texel's edge falls on the other side): the maximum is not bounded.
constexpr double largest_mean = 0.03;
constexpr double largest_p99 = 0.6;

struct Case {
  const char* name;
  FlakeMode flakes;
  double weight;       ///< of the second paint
  double eye_mm;       ///< distance
  bool plain = false;  ///< two lobes and nothing else: the shortest texts
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Agreement : public testing::TestWithParam<Case> {};

gles::View camera(double distance_mm) {
  const auto d = static_cast<float>(distance_mm);
  return {{0.2f * d, -0.9f * d, 0.3f * d}, {0.0f, 0.0f, 0.0f}, 30.0f, {}};
}

gles::Lighting one_light(FlakeMode flakes) {
  gles::Lighting lighting;
  lighting.lights = {{glm::normalize(glm::vec3(-0.4f, -0.8f, 0.7f)), glm::vec3(0.8f, 0.78f, 0.74f)}};
  lighting.quality.path = gles::LightPath::none;
  lighting.dither = false;
  lighting.quality.smooth_edges = false;
  lighting.quality.flakes = flakes;
  return lighting;
}

struct Rendered {
  gles::Image image;
  std::optional<CpuPicture> cpu;
};

std::optional<Rendered> render(Backend backend, const Case& c, const SyntheticPaint& paint, std::string& reason) {
  const auto context = open_context(backend, reason);
  if (!context) return std::nullopt;
  packs::Scene scene;
  scene.parts.push_back(sphere(radius_mm, 256));
  gles::Renderer renderer(*context);
  renderer.set_scene(scene);
  EXPECT_TRUE(renderer.set_paint(paint.get()));
  EXPECT_TRUE(renderer.update(mix(c.weight)));
  const auto target = gles::Framebuffer::create(*context, edge, edge);
  const gles::View view = camera(c.eye_mm);
  const gles::Lighting lighting = one_light(c.flakes);
  renderer.draw(view, lighting, *target);
  return Rendered{target->read(), shade_sphere(radius_mm, view, lighting, paint.get(), *renderer.paint(), edge, edge)};
}

TEST_P(Agreement, BackendsAndCpu) {
  const Case& c = GetParam();
  const SyntheticPaint paint(c.plain ? PaintOptions{false, false, false, 2, 0.6f} : PaintOptions{});
  std::array<std::optional<Rendered>, 2> pictures;
  std::string skipped;
  for (const Backend backend : {Backend::egl_surfaceless, Backend::osmesa}) {
    std::string reason;
    auto& picture = pictures[backend == Backend::osmesa ? 1 : 0];
    picture = render(backend, c, paint, reason);
    if (!picture) {
      skipped += reason + "\n";
      continue;
    }
    const CpuPicture& cpu = *picture->cpu;
    const Difference difference = compare_images(picture->image, cpu.image, cpu.mask);
    std::printf("%-8s %-9s against CPU: %s; %zu of %zu sphere pixels masked\n", gles::backend_name(backend), c.name,
                text(difference).c_str(), cpu.hit - cpu.compared, cpu.hit);
    EXPECT_LE(difference.mean, largest_mean) << gles::backend_name(backend);
    EXPECT_LE(difference.p99, largest_p99) << gles::backend_name(backend);
    EXPECT_GT(cpu.compared, cpu.hit * 9 / 10) << "the mask must not hide the picture";
  }
  if (!skipped.empty()) GTEST_SKIP() << skipped;
  const Difference difference = compare_images(pictures[0]->image, pictures[1]->image);
  std::printf("egl against osmesa, %s: %s\n", c.name, text(difference).c_str());
  EXPECT_LE(difference.mean, 0.1);
}

// The comparison above must be able to fail: a picture of slightly other weights is outside its bounds.
TEST(AgreementBounds, SeeAnotherMixture) {
  std::string reason;
  const auto context = open_context(Backend::egl_surfaceless, reason);
  if (!context) GTEST_SKIP() << reason;
  const SyntheticPaint paint;
  packs::Scene scene;
  scene.parts.push_back(sphere(radius_mm, 128));
  gles::Renderer renderer(*context);
  renderer.set_scene(scene);
  ASSERT_TRUE(renderer.set_paint(paint.get()));
  const auto target = gles::Framebuffer::create(*context, edge, edge);
  ASSERT_TRUE(target);
  std::array<gles::Image, 2> images;
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(renderer.update(mix(0.40 + 0.01 * static_cast<double>(k))));
    renderer.draw(camera(420), one_light(FlakeMode::mean), *target);
    images[k] = target->read();
  }
  const Difference difference = compare_images(images[0], images[1]);
  std::printf("  one hundredth of the way to another paint: %s\n", text(difference).c_str());
  EXPECT_GT(difference.mean, 2.0 * largest_mean);
}

INSTANTIATE_TEST_SUITE_P(
    Sphere, Agreement,
    testing::Values(Case{"off", FlakeMode::off, 0.0, 420}, Case{"off_mix", FlakeMode::off, 0.4, 420},
                    Case{"mean", FlakeMode::mean, 0.4, 420}, Case{"nearest", FlakeMode::nearest, 0.4, 420},
                    Case{"bilinear", FlakeMode::bilinear, 0.4, 420}, Case{"far", FlakeMode::bilinear, 0.7, 3000},
                    Case{"plain", FlakeMode::bilinear, 0.5, 420, true}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lackwerk::test
