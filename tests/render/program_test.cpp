// Every switch of the shading texts compiles and links on both backends, and equal pictures share a program.
#include <gtest/gtest.h>

#include "render_gles/program.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

using gles::Backend;
using gles::Features;

using gles::ShaderOutput;
using gles::ShaderPath;

/// A paint with everything on.
Features full(ShaderPath path) {
  Features f;
  f.lobes = 3;
  f.table = f.flakes = f.coat = f.refraction = f.visibility = f.irradiance = true;
  f.flake_taps = f.flake_cells = 4;
  f.path = path;
  f.sparkle_lights = path == ShaderPath::filtered ? 2 : 0;
  f.still_flakes = path == ShaderPath::sampled;
  return f;
}

/// All combinations of the paint's own switches on every path; all numbers of lights; and every other surface on every
/// path with every output.
std::vector<Features> variants() {
  std::vector<Features> out;
  for (const auto path : {ShaderPath::none, ShaderPath::filtered, ShaderPath::sampled, ShaderPath::mirror}) {
    for (int bits = 0; bits < 16; ++bits)
      for (int flakes = 0; flakes < 4; ++flakes) {
        Features f = full(path);
        f.lobes = (bits + flakes) % 4;
        f.narrow = bits % 8;
        f.table = (bits & 1) != 0;
        f.coat = (bits & 2) != 0;
        f.refraction = (bits & 4) != 0;
        f.visibility = f.irradiance = (bits & 8) != 0;
        f.diffuse = flakes != 1;
        f.flakes = flakes > 0;
        f.flake_taps = flakes > 2 ? 4 : 1;
        f.flake_cells = flakes > 2 ? 4 : 1;
        f.lights = flakes % 2;
        out.push_back(f);
      }
    for (int kind = 1; kind < packs::surface_kind_count; ++kind)
      for (const auto output : {ShaderOutput::display, ShaderOutput::linear, ShaderOutput::mirror_image}) {
        Features f;
        f.surface = static_cast<packs::SurfaceKind>(kind);
        f.path = path;
        f.output = output;
        f.lobes = 1;
        f.coat = kind % 2 == 0;
        f.visibility = f.irradiance = true;
        f.floor_mirror = true;
        out.push_back(f);
      }
  }
  for (int lights = 0; lights <= 4; ++lights)
    for (int single = 0; single <= lights; ++single)
      for (int bits = 0; bits < 2; ++bits) {
        Features f = full(bits == 0 ? ShaderPath::filtered : ShaderPath::mirror);
        f.lights = lights;
        f.flake_lights = single;
        f.sparkle_lights = single;
        f.stripes = lights == 4 && single == 0;
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
  Features f = full(ShaderPath::filtered);
  f.lights = f.flake_lights = 1;
  EXPECT_GE(gles::Program(context->gl(), f, false).location("u_clip_from_world"), 0);
  f.surface = packs::SurfaceKind::floor;
  EXPECT_GE(gles::Program(context->gl(), f.canonical(), false).location("u_clip_from_world"), 0);
}

// What does not show costs nothing: the driver finds no texture of single flakes where only their mean is drawn.
TEST_P(Programs, MeanFlakesReadOnlyTheMean) {
  std::string reason;
  const auto context = open_context(GetParam(), reason);
  if (!context) GTEST_SKIP() << reason;
  Features mean = full(ShaderPath::filtered);
  mean.sparkle_lights = 0;
  mean.lights = 2;
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
  Features all = full(ShaderPath::filtered);
  all.lights = 2;
  all.flake_lights = 4;
  EXPECT_EQ(all.canonical().flake_lights, 2) << "no more than there are lights";
  Features mean = all;
  mean.flake_lights = mean.sparkle_lights = 0;
  EXPECT_EQ(mean.canonical().flake_taps, 1);
  EXPECT_EQ(mean.canonical().flake_cells, 1);
  EXPECT_TRUE(mean.canonical().flakes) << "their mean still shows";
  Features stripes = all;
  stripes.stripes = true;
  Features bare;
  bare.path = ShaderPath::none;
  bare.stripes = true;
  EXPECT_EQ(stripes.canonical(), bare);
  Features chrome = all;
  chrome.surface = packs::SurfaceKind::chrome;
  EXPECT_FALSE(chrome.canonical().table || chrome.canonical().flakes || chrome.canonical().sparkle_lights > 0);
  EXPECT_EQ(chrome.canonical().lights, 2) << "lights fall on everything";
  Features sampled = all;
  sampled.path = ShaderPath::sampled;
  EXPECT_EQ(sampled.canonical().sparkle_lights, 0) << "the samples show the flakes themselves";
  EXPECT_FALSE(sampled.canonical().irradiance);
  Features narrow = all;
  narrow.lobes = 1;
  narrow.narrow = 7;
  EXPECT_EQ(narrow.canonical().narrow, 1);
}

TEST(Features, TextNamesTheSwitches) {
  Features all = full(ShaderPath::filtered);
  all.lights = 2;
  all.flake_lights = 1;
  EXPECT_EQ(
      all.text(),
      "paint, filtered environment, 3 lobes, colour table, coat, refraction, single flakes with 4 taps and 4 cells, "
      "2 sparkle lights, 1 flake light, 2 directional lights, visibility, baked irradiance");
}

}  // namespace
}  // namespace lackwerk::test
