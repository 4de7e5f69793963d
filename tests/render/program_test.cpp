// Every switch of the shading texts compiles and links on both backends, and equal pictures share a program.
#include <gtest/gtest.h>

#include "render_gles/program.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;
using gles::Features;

/// All combinations of the paint's own switches under two lights; all light, studio and stripe switches with
/// everything else on; and every other surface under 0 to 4 lights.
std::vector<Features> variants() {
  std::vector<Features> out;
  for (int bits = 0; bits < 8; ++bits)
    for (int lobes = 0; lobes <= 3; ++lobes)
      for (int flakes = 0; flakes < 4; ++flakes) {
        Features f;
        f.lobes = lobes;
        f.table = (bits & 1) != 0;
        f.coat = (bits & 2) != 0;
        f.refraction = (bits & 4) != 0;
        f.flakes = flakes > 0;
        f.flake_lights = flakes > 1 ? 1 : 0;
        f.flake_taps = flakes > 2 ? 4 : 1;
        f.lights = 2;
        f.studio = true;
        out.push_back(f);
      }
  for (int lights = 0; lights <= 4; ++lights)
    for (int single = 0; single <= lights; ++single)
      for (int bits = 0; bits < 3; ++bits) {
        Features f{packs::SurfaceKind::paint, 3, true, true, 4, true, true, lights, single, bits == 2, bits == 1};
        out.push_back(f);
      }
  for (int kind = 1; kind < packs::surface_kind_count; ++kind)
    for (int lights = 0; lights <= 4; ++lights) {
      Features f;
      f.surface = static_cast<packs::SurfaceKind>(kind);
      f.lights = lights;
      out.push_back(f);
    }
  return out;
}

class Programs : public testing::TestWithParam<Backend> {};

TEST_P(Programs, EveryVariantCompiles) {
  std::string reason;
  const auto context = open_context(GetParam(), reason);
  if (!context) GTEST_SKIP() << reason;
  gles::ProgramCache cache(*context);
  double total_ms = 0.0, longest_ms = 0.0;
  int most_uniforms = 0;
  const std::vector<Features> all = variants();
  for (const Features& features : all) {
    const gles::Program& program = cache.get(features);  // aborts with the log if not
    EXPECT_GE(program.location("u_clip_from_world"), 0);
    EXPECT_EQ(program.location("u_no_such_uniform"), -1);
    most_uniforms = std::max(most_uniforms, program.uniform_vectors());
  }
  const std::size_t programs = cache.size();
  for (const Features& features : all) {
    const double ms = cache.get(features).compile_ms();
    total_ms += ms;
    longest_ms = std::max(longest_ms, ms);
  }
  EXPECT_EQ(cache.size(), programs) << "asking again compiles nothing";
  EXPECT_EQ(cache.lines().size(), programs);
  EXPECT_LT(programs, all.size()) << "equal pictures share programs";
  std::printf("  %zu programs for %zu variants, mean %.1f ms, longest %.1f ms, at most %d uniform vectors (unpacked)\n",
              programs, all.size(), total_ms / static_cast<double>(all.size()), longest_ms, most_uniforms);
}

TEST_P(Programs, SixteenBitFragmentsCompile) {
  std::string reason;
  const auto context = open_context(GetParam(), reason);
  if (!context) GTEST_SKIP() << reason;
  Features f{packs::SurfaceKind::paint, 3, true, true, 4, true, true, 4, 4, false, true};
  EXPECT_GE(gles::Program(context->gl(), f, false).location("u_clip_from_world"), 0);
  f.surface = packs::SurfaceKind::floor;
  EXPECT_GE(gles::Program(context->gl(), f.canonical(), false).location("u_clip_from_world"), 0);
}

// What does not show costs nothing: the driver finds no texture of single flakes where only their mean is drawn.
TEST_P(Programs, MeanFlakesReadOnlyTheMean) {
  std::string reason;
  const auto context = open_context(GetParam(), reason);
  if (!context) GTEST_SKIP() << reason;
  const Features mean{packs::SurfaceKind::paint, 3, true, true, 1, true, true, 2, 0, false, true};
  const gles::Program program(context->gl(), mean, true);
  EXPECT_GE(program.location("u_mean"), 0);
  for (const char* name : {"u_slice", "u_rank", "u_corner", "u_random", "u_lab_lo"})
    EXPECT_EQ(program.location(name), -1) << name;
  Features without = mean;
  without.flakes = false;
  EXPECT_EQ(gles::Program(context->gl(), without, true).location("u_mean"), -1);
}

INSTANTIATE_TEST_SUITE_P(Backends, Programs, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

TEST(Features, CanonicalDropsWhatDoesNotShow) {
  const Features all{packs::SurfaceKind::paint, 3, true, true, 4, true, true, 2, 4, false, true};
  EXPECT_EQ(all.canonical().flake_lights, 2) << "no more than there are lights";
  Features mean = all;
  mean.flake_lights = 0;
  EXPECT_EQ(mean.canonical().flake_taps, 1);
  EXPECT_TRUE(mean.canonical().flakes) << "their mean still shows";
  Features stripes = all;
  stripes.stripes = true;
  EXPECT_EQ(stripes.canonical(),
            (Features{packs::SurfaceKind::paint, 0, false, false, 1, false, false, 0, 0, true, false}));
  Features chrome = all;
  chrome.surface = packs::SurfaceKind::chrome;
  EXPECT_EQ(chrome.canonical(), (Features{packs::SurfaceKind::chrome, 0, false, false, 1, false, false, 2}));
}

TEST(Features, TextNamesTheSwitches) {
  const Features all{packs::SurfaceKind::paint, 3, true, true, 4, true, true, 2, 1, false, true};
  EXPECT_EQ(all.text(),
            "paint, 3 lobes, colour table, coat, refraction, flakes of 1 light with 4 taps, 2 lights, studio");
}

}  // namespace
}  // namespace lackwerk::test
