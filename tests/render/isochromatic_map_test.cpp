// A colour map over the plane of incidence on the GPU: the same colours as on the CPU, for all cures of the critical
// angle, at all geometries; and paints without one do not notice.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>
#include <ostream>

#include "core/analysis/colour_map.hpp"
#include "core/analysis/map_paint.hpp"
#include "core/paint_model.hpp"
#include "render_gles/display_model.hpp"
#include "render_gles/renderer.hpp"
#include "render_gles/shader_texts.hpp"
#include "tests/render/glsl_resources.hpp"
#include "tests/render/golden_scenes.hpp"
#include "tests/render/support.hpp"
#include "tests/render/synthetic_paint.hpp"

namespace lackwerk::test {
namespace {

using core::CriticalAngleCure;
using gles::Backend;
using gles::Features;
using gles::FlakeMode;
using gles::LightPath;
using gles::MapUse;
using gles::PaintMap;
using gles::ShaderPath;
using glm::dvec3;

constexpr float radius_mm = 100.0f;
constexpr int edge_px = 240;
constexpr double coat_index = 1.5;
constexpr std::array cures = {CriticalAngleCure::clip, CriticalAngleCure::slide, CriticalAngleCure::slide_along,
                              CriticalAngleCure::index_one};

const char* name_of(CriticalAngleCure cure) {
  constexpr std::array names = {"clip", "slide", "slide_along", "index_one"};
  return names.at(static_cast<std::size_t>(cure));
}

/// A flop as of pearls: bright where flakes lie flat, from red to blue along the angle of incidence.
core::Brdf flop() {
  return [](const dvec3& in, const dvec3& out) {
    const core::FlakeAngles flake = core::flake_angles(in, out, coat_index);
    const double bright = 0.05 + 1.5 * std::exp(-std::pow(flake.theta_flake / 0.25, 2));
    return dvec3(1.0 - flake.theta_inc, 0.5, 0.2 + flake.theta_inc) * (bright / std::numbers::pi);
  };
}

core::ColourMap flop_map(CriticalAngleCure cure) {
  core::ColourMapSettings settings;
  settings.index = coat_index;
  settings.cure = cure;
  return *core::colour_map_of(flop(), settings);
}

PaintMap for_gpu(const core::ColourMap& map) {
  return {map.width(), map.settings().index, map.settings().cure, map.nodes()};
}

/// The map as a paint: white diffuse below a coat. Its table is the map's mean over phi_d.
core::InterpolatablePaint paint_of(const core::ColourMap& map) {
  core::InterpolatablePaint paint;
  paint.paints.resize(1);
  paint.paints[0].analytic = core::paint_of_map(map, coat_index, 91);
  return paint;
}

packs::Scene sphere_scene() {
  packs::Scene scene;
  scene.parts.push_back(sphere(radius_mm, 256));
  return scene;
}

const gles::View camera = {{84.0f, -378.0f, 126.0f}, {0.0f, 0.0f, 0.0f}, 30.0f, {}};

gles::Lighting one_light(const glm::vec3& towards) {
  gles::Lighting lighting;
  lighting.lights = {{glm::normalize(towards), glm::vec3(0.8f, 0.78f, 0.74f)}};
  lighting.quality.path = LightPath::none;
  lighting.quality.flakes = FlakeMode::mean;
  lighting.quality.smooth_edges = false;
  lighting.dither = false;
  return lighting;
}

/// From beside the eye, and from behind the sphere: half of what is seen is lit at 60 to 90 degrees.
const glm::vec3 front(-0.4f, -0.8f, 0.7f), behind(0.6f, 0.65f, 0.45f);

gles::Image drawn(gles::Context& context, const core::InterpolatablePaint& paint, const core::Weights& weights,
                  const PaintMap* map, const gles::Lighting& lighting, const packs::Scene& scene, int samples = 1) {
  EXPECT_TRUE(context.make_current());
  gles::Renderer renderer(context);
  renderer.set_scene(scene);
  EXPECT_TRUE(renderer.set_paint(paint, map));
  EXPECT_TRUE(renderer.update(weights));
  const auto target = gles::Framebuffer::create(context, edge_px, edge_px);
  return renderer.still(camera, lighting, *target, samples);
}

// ---- the sphere on the CPU

using Model = core::PaintModel<double>;

struct CpuSphere {
  gles::Image image{edge_px, edge_px};
  std::vector<std::uint8_t> mask;  ///< 1 where the surface faces the eye, see shade_sphere
};

/// Unit direction d as seen by a surface with this normal; any turn around it does.
dvec3 local(const dvec3& d, const dvec3& n) {
  const dvec3 t = glm::normalize(glm::cross(std::abs(n.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0), n));
  return {glm::dot(d, t), glm::dot(d, glm::cross(n, t)), glm::dot(d, n)};
}

/// The sphere under one light, its lobes times the map, its mean flakes as they are. `gpu` lends the numbers that are
/// not the map's.
CpuSphere shaded(const core::ColourMap& map, const gles::Lighting& lighting, const core::InterpolatablePaint& paint,
                 const gles::PaintGpu& gpu) {
  core::PaintTextures bare = gpu.textures();
  bare.table_size = 0;
  core::PaintTextures with_flakes = bare;
  bare.mean.clear();
  bare.slice.clear();
  Model lobes, all;
  core::bind_model(paint, gpu.analytic(), bare, lobes);
  core::bind_model(paint, gpu.analytic(), with_flakes, all);
  gles::DisplayModel<double> display;
  const dvec3 eye(camera.eye_mm), i(lighting.lights.front().direction);
  const dvec3 forward = glm::normalize(-eye), right = glm::normalize(glm::cross(forward, dvec3(0, 0, 1)));
  const dvec3 up = glm::cross(right, forward);
  const double half = std::tan(glm::radians(static_cast<double>(camera.vertical_fov_deg)) * 0.5);
  CpuSphere out;
  out.mask.resize(static_cast<std::size_t>(edge_px) * edge_px);
  for (int y = 0; y < edge_px; ++y)
    for (int x = 0; x < edge_px; ++x) {
      const double u = (2.0 * (x + 0.5) / edge_px - 1.0) * half, v = (1.0 - 2.0 * (y + 0.5) / edge_px) * half;
      const dvec3 ray = glm::normalize(forward + right * u + up * v);
      const double b = glm::dot(ray, eye), d = b * b - glm::dot(eye, eye) + double{radius_mm} * radius_mm;
      if (d < 0.0) continue;
      const dvec3 n = (eye + ray * (-b - std::sqrt(d))) / double{radius_mm}, o = -ray;
      dvec3 sum(0.0);
      if (const double ci = glm::dot(n, i); ci > 0.0) {
        const dvec3 smooth = lobes.paint_factor(n, i, o, {}, 0.0, 0.0);
        const dvec3 flakes = all.paint_factor(n, i, o, {}, 0.0, 0.0) - smooth;
        sum = dvec3(lighting.lights.front().radiance) * (ci * (smooth * map.factor(local(i, n), local(o, n)) + flakes));
      }
      const dvec3 shown = display.display_transform(sum * double{lighting.exposure});
      const auto at = static_cast<std::size_t>(y * edge_px + x);
      for (int c = 0; c < 3; ++c)
        out.image.rgb[3 * at + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(std::clamp(shown[c], 0.0, 1.0) * 255.0));
      out.mask[at] = glm::dot(n, o) > 0.15 ? 1 : 0;
    }
  return out;
}

// CIEDE2000. Measured are means of 0.005 to 0.041 and p99 of 0 to 0.83: the map's bytes turn the last bit of a pixel
// somewhat oftener than those of a table (agreement_test.cpp), whose own error is on both sides there.
constexpr double largest_mean = 0.08, largest_p99 = 1.0;

class IsochromaticMap : public OnBackend {};

TEST_P(IsochromaticMap, SphereAgreesWithTheCpu) {
  const packs::Scene scene = sphere_scene();
  const SyntheticPaint synthetic({.table = false});
  for (const CriticalAngleCure cure : cures) {
    const core::ColourMap map = flop_map(cure);
    const PaintMap gpu_map = for_gpu(map);
    const core::InterpolatablePaint white = paint_of(map);
    for (const glm::vec3& towards : {front, behind})
      for (const bool lobes : {false, true}) {
        const core::InterpolatablePaint& paint = lobes ? synthetic.get() : white;
        const core::Weights weights = lobes ? mix(0.4) : core::Weights::uniform({1.0});
        const gles::Lighting lighting = one_light(towards);
        gles::Renderer renderer(*context_);
        renderer.set_scene(scene);
        ASSERT_TRUE(renderer.set_paint(paint, &gpu_map));
        ASSERT_TRUE(renderer.update(weights));
        const auto target = gles::Framebuffer::create(*context_, edge_px, edge_px);
        renderer.draw(camera, lighting, *target);
        const CpuSphere cpu = shaded(map, lighting, paint, *renderer.paint());
        const Difference difference = compare_images(target->read(), cpu.image, cpu.mask);
        std::printf("  %s, %s, %s: %s\n", name_of(cure), towards == front ? "front" : "behind",
                    lobes ? "lobes and flakes" : "map alone", text(difference).c_str());
        EXPECT_LE(difference.mean, largest_mean);
        EXPECT_LE(difference.p99, largest_p99);
        EXPECT_GT(difference.pixels, 20'000u) << "the mask must not hide the picture";
      }
  }
}

// The bounds above must be able to fail: the cures do not look alike.
TEST_P(IsochromaticMap, CuresShow) {
  const packs::Scene scene = sphere_scene();
  const core::ColourMap map = flop_map(CriticalAngleCure::clip);
  const core::InterpolatablePaint paint = paint_of(map);
  std::vector<gles::Image> images;
  for (const CriticalAngleCure cure : cures) {
    PaintMap gpu_map = for_gpu(map);
    gpu_map.cure = cure;
    images.push_back(drawn(*context_, paint, core::Weights::uniform({1.0}), &gpu_map, one_light(behind), scene));
  }
  for (std::size_t a = 0; a < images.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT(compare_images(images[a], images[b]).p99, 2.0 * largest_p99)
          << name_of(cures.at(a)) << " and " << name_of(cures.at(b));
}

/// Neutral: chi = 1 everywhere.
struct NeutralMap {
  std::vector<glm::vec3> nodes = std::vector<glm::vec3>(std::size_t{8} * 15, glm::vec3(1.0f));
  PaintMap map{8, coat_index, CriticalAngleCure::clip, nodes};
};

std::size_t most_apart(const gles::Image& a, const gles::Image& b) {
  std::size_t most = 0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k)
    most = std::max(most, static_cast<std::size_t>(std::abs(int{a.rgb[k]} - int{b.rgb[k]})));
  return most;
}

TEST_P(IsochromaticMap, NeutralMapIsNoMap) {
  const SyntheticPaint paint({.table = false});
  packs::Scene scene = golden_scene(golden_shot("sphere_moving").subject);
  scene.parts = sphere_scene().parts;
  struct Way {
    const char* name;
    LightPath path;
    int samples;
    FlakeMode flakes;
  };
  for (const Way& way : {Way{"light", LightPath::none, 1, FlakeMode::bilinear},
                         Way{"light and filtered environment", LightPath::filtered, 1, FlakeMode::mean},
                         Way{"lights of the environment", LightPath::lights, 1, FlakeMode::mean},
                         Way{"sampled environment", LightPath::filtered, 32, FlakeMode::mean}})
    for (const CriticalAngleCure cure : cures) {
      if (way.path != LightPath::none && cure != CriticalAngleCure::clip) continue;  // the same text, and slow
      NeutralMap neutral;
      neutral.map.cure = cure;
      gles::Lighting lighting = one_light(behind);
      lighting.quality.path = way.path;
      lighting.quality.cut_lights = 16;  // of 4 the diffuse part shows nothing
      lighting.quality.flakes = way.flakes;
      const gles::Image with = drawn(*context_, paint.get(), mix(0.4), &neutral.map, lighting, scene, way.samples);
      const gles::Image without = drawn(*context_, paint.get(), mix(0.4), nullptr, lighting, scene, way.samples);
      // Every pixel, silhouettes at grazing angles too: a NaN would show black or white.
      EXPECT_LE(most_apart(with, without), 1u) << way.name << ", " << name_of(cure);
      EXPECT_LE(different_bytes(with, without), with.rgb.size() / 200) << way.name << ", " << name_of(cure);
    }
}

TEST_P(IsochromaticMap, StandsInForTheTable) {
  const SyntheticPaint with_table, without_table({.table = false});
  const NeutralMap neutral;
  const gles::Lighting lighting = one_light(front);
  const packs::Scene scene = sphere_scene();
  const gles::Image plain = drawn(*context_, without_table.get(), mix(0.4), nullptr, lighting, scene);
  const gles::Image coloured = drawn(*context_, with_table.get(), mix(0.4), nullptr, lighting, scene);
  const gles::Image mapped = drawn(*context_, with_table.get(), mix(0.4), &neutral.map, lighting, scene);
  EXPECT_LE(most_apart(mapped, plain), 1u);
  EXPECT_GT(compare_images(coloured, plain).mean, 1.0);
}

// Inside the coat a line is known by theta_h and theta_i: where the paint bends directions as the map does, its table
// holds the map, and all ways of light must agree.
TEST_P(IsochromaticMap, AgreesWithItsTableInAllLight) {
  packs::Scene scene = golden_scene(golden_shot("sphere_moving").subject);
  scene.parts = sphere_scene().parts;
  const core::ColourMap map = flop_map(CriticalAngleCure::clip);
  const PaintMap gpu_map = for_gpu(map);
  const core::InterpolatablePaint paint = paint_of(map);
  const core::Weights weights = core::Weights::uniform({1.0});
  struct Way {
    const char* name;
    LightPath path;
    int samples;
    bool light;
  };
  for (const Way& way : {Way{"light", LightPath::none, 1, true}, Way{"filtered", LightPath::filtered, 1, false},
                         Way{"lights of the environment", LightPath::lights, 1, false},
                         Way{"sampled", LightPath::filtered, 32, false}}) {
    gles::Lighting lighting = one_light(behind);
    if (!way.light) lighting.lights.clear();
    lighting.quality.path = way.path;
    lighting.quality.cut_lights = 16;  // of 4 the diffuse part shows nothing
    const gles::Image by_map = drawn(*context_, paint, weights, &gpu_map, lighting, scene, way.samples);
    const gles::Image by_table = drawn(*context_, paint, weights, nullptr, lighting, scene, way.samples);
    const Difference difference = compare_images(by_map, by_table);
    std::printf("  map against its table, %s: %s\n", way.name, text(difference).c_str());
    EXPECT_LE(difference.mean, 0.3) << way.name;
    // Nothing asks the map there, and the table is the same.
    if (way.path == LightPath::filtered && way.samples == 1) {
      EXPECT_EQ(different_bytes(by_map, by_table), 0u);
    } else {
      EXPECT_GT(different_bytes(by_map, by_table), 0u) << way.name << ": the map is asked";
    }
  }
}

TEST_P(IsochromaticMap, BadMapsAreRefusedAndTheOldPaintStays) {
  const SyntheticPaint paint;
  gles::Renderer renderer(*context_);
  ASSERT_TRUE(renderer.set_paint(paint.get()));
  const gles::PaintGpu* before = renderer.paint();
  const auto refused = [&](const PaintMap& map, const char* field) {
    const auto set = renderer.set_paint(paint.get(), &map);
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().field, field);
    EXPECT_EQ(renderer.paint(), before);
  };
  std::vector<glm::vec3> nodes(std::size_t{2} * 3, glm::vec3(0.5f));
  refused({0, 1.5, CriticalAngleCure::clip, {}}, "map.edge");
  refused({1, 1.5, CriticalAngleCure::clip, nodes}, "map.edge");
  refused({1025, 1.5, CriticalAngleCure::clip, nodes}, "map.edge");
  refused({4'000'000'000u, 1.5, CriticalAngleCure::clip, nodes}, "map.edge");
  refused({3, 1.5, CriticalAngleCure::clip, nodes}, "map.nodes");
  refused({2, 0.99, CriticalAngleCure::clip, nodes}, "map.index");
  refused({2, std::numeric_limits<double>::quiet_NaN(), CriticalAngleCure::clip, nodes}, "map.index");
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.1f, 7e4f}) {
    std::vector<glm::vec3> spoilt = nodes;
    spoilt[4].y = bad;
    refused({2, 1.5, CriticalAngleCure::clip, spoilt}, "map.nodes");
  }
  const PaintMap good{2, 1.5, CriticalAngleCure::clip, nodes};
  EXPECT_TRUE(renderer.set_paint(paint.get(), &good));
}

TEST_P(IsochromaticMap, SaysSoAndCountsItsBytes) {
  const SyntheticPaint paint;
  const NeutralMap neutral;
  gles::Renderer renderer(*context_);
  ASSERT_TRUE(renderer.set_paint(paint.get(), &neutral.map));
  ASSERT_TRUE(renderer.update(mix(0.4)));
  const std::size_t with = renderer.gpu_bytes().paint;
  std::string said;
  for (const std::string& line : renderer.explain()) said += line + "\n";
  EXPECT_NE(said.find("colour map: 8 x 15 nodes"), std::string::npos) << said;
  ASSERT_TRUE(renderer.set_paint(paint.get()));
  ASSERT_TRUE(renderer.update(mix(0.4)));
  EXPECT_EQ(with + 19u * 19u * 4u, renderer.gpu_bytes().paint + 8u * 15u * 4u) << "the map instead of the table";
}

INSTANTIATE_TEST_SUITE_P(Backends, IsochromaticMap, testing::Values(Backend::egl_surfaceless, Backend::osmesa),
                         [](const auto& info) { return std::string(gles::backend_name(info.param)); });

// ---- the function alone, over all geometries

/// x: theta of the light, y: of the eye, both from 0 to 90 degrees, ends included; the azimuth between them is u_phi.
/// Red and green: square roots of chi's over u_most; blue: 1 where all three numbers are numbers >= 0.
constexpr const char* grid_main = R"(
uniform float u_phi;
uniform float u_most;
void main() {
  vec2 theta = (gl_FragCoord.xy - 0.5) * (1.5707963267948966 / 255.0);
  vec3 i = vec3(sin(theta.x), 0.0, cos(theta.x));
  vec3 o = vec3(sin(theta.y) * cos(u_phi), sin(theta.y) * sin(u_phi), cos(theta.y));
  vec3 chi = map_factor(vec3(0.0, 0.0, 1.0), i, o);
  float good = chi.x >= 0.0 && chi.y >= 0.0 && chi.z >= 0.0 && chi.x + chi.y + chi.z < 1000.0 ? 1.0 : 0.0;
  gl_FragColor = vec4(sqrt(chi.x / u_most), sqrt(chi.y / u_most), good, 1.0);
}
)";

gles::Image over_geometries(const gles::Context& context, const PaintMap& map, float phi, float most) {
  constexpr int geometries = 256;
  const gles::GlApi& gl = context.gl();
  const gles::MapUniforms uniforms = gles::map_uniforms(map);
  std::string fragment = gles::shader_prelude(context.info().fragment_highp);
  fragment += "#define HAS_TABLE 0\n#define HAS_FLAKES 0\n#define COLOUR_MAP ";
  fragment += uniforms.towards_gloss == 0.0f ? "1\n" : "2\n";
  for (const char* file : {"paint_fetch.glsl", "isochromatic.glsl", "mapped_paint.glsl"})
    fragment += std::string(gles::shader_text(file)) + "\n";
  const gles::GlObject program =
      gles::link_program(gl, "#version 100\n" + std::string(gles::shader_text("screen_vertex.glsl")),
                         fragment + grid_main, {"a_corner"}, "a colour map over all geometries");
  const gles::MapTexture encoded = *gles::encode_map(map);
  const gles::GlObject texture = gles::make_texture(gl);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, name, GL_NEAREST);
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, encoded.width, encoded.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                encoded.rgba.data());
  const auto target = gles::Framebuffer::create(context, geometries, geometries, gles::PixelFormat::rgba8, false);
  target->bind();
  gl.UseProgram(program.id());
  gl.BindTexture(GL_TEXTURE_2D, texture.id());  // making the target bound its own
  const auto at = [&](const char* name) { return gl.GetUniformLocation(program.id(), name); };
  gl.Uniform1i(at("u_map_nodes"), 0);
  gl.Uniform4f(at("u_map"), uniforms.index, uniforms.towards_gloss, static_cast<float>(map.edge - 1), encoded.scale);
  gl.Uniform1f(at("u_phi"), phi);
  gl.Uniform1f(at("u_most"), most);
  const gles::GlObject corners = gles::make_buffer(gl);
  constexpr std::array<float, 6> triangle = {-1, -1, 3, -1, -1, 3};
  gl.BindBuffer(GL_ARRAY_BUFFER, corners.id());
  gl.BufferData(GL_ARRAY_BUFFER, sizeof triangle, triangle.data(), GL_STATIC_DRAW);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_BLEND);
  gl.EnableVertexAttribArray(0);
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  return target->read();
}

class MapOverGeometries : public OnDriver {};

TEST_P(MapOverGeometries, IsTheCpusAndAlwaysANumber) {
  for (const CriticalAngleCure cure : cures) {
    const core::ColourMap map = flop_map(cure);
    float most = 0.0f;
    for (const glm::vec3& node : map.nodes()) most = std::max({most, node.x, node.y, node.z});
    double sum = 0.0, largest = 0.0;
    std::size_t count = 0, bad = 0, far = 0;
    for (const double phi_deg : {0.0, 1e-3, 45.0, 90.0, 135.0, 179.9, 180.0}) {
      const double phi = glm::radians(phi_deg);
      const gles::Image image = over_geometries(*context_, for_gpu(map), static_cast<float>(phi), most);
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const std::uint8_t* pixel = image.pixel(x, image.height - 1 - y);
          bad += pixel[2] != 255 ? 1 : 0;
          const double in = 0.5 * std::numbers::pi * x / 255.0, out = 0.5 * std::numbers::pi * y / 255.0;
          const dvec3 chi =
              map.factor({std::sin(in), 0.0, std::max(std::cos(in), 0.0)},
                         {std::sin(out) * std::cos(phi), std::sin(out) * std::sin(phi), std::max(std::cos(out), 0.0)});
          for (int c = 0; c < 2; ++c) {
            const double apart = std::abs(pixel[c] - 255.0 * std::sqrt(chi[c] / most));
            sum += apart;
            largest = std::max(largest, apart);
            far += apart > 3.0 ? 1 : 0;
            ++count;
          }
        }
    }
    const auto all = static_cast<double>(count);
    std::printf("  %s: mean %.3f, largest %.2f of 255 (square roots), %zu of %zu beyond 3, %zu not numbers\n",
                name_of(cure), sum / all, largest, far, count, bad);
    EXPECT_EQ(bad, 0u) << name_of(cure);
    EXPECT_LE(sum / all, 0.5) << name_of(cure);
    if (cure == CriticalAngleCure::clip) {
      EXPECT_LE(largest, 1.5);
    } else {
      // Cure B leaves the edge of the map with an infinite slope: just above the critical angle 1e-5 of a direction is
      // a whole node. With index 1 a pair of directions that both lie in the horizon has no half vector.
      EXPECT_LE(static_cast<double>(far) / all, mediump() ? 0.005 : 0.0015) << name_of(cure);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, MapOverGeometries, testing::ValuesIn(all_drivers),
                         [](const auto& info) { return driver_name(info.param); });

// ---- bytes and programs

TEST(MapBytes, KeepDigitsOverFourDecades) {
  constexpr std::uint32_t edge = 16;
  std::vector<glm::vec3> nodes;
  constexpr float most = 40.0f;
  const std::size_t count = std::size_t{edge} * (2 * edge - 1);
  for (std::size_t k = 0; k < count; ++k) {
    const float v = most * std::pow(3e4f, -static_cast<float>(k) / static_cast<float>(count));
    nodes.emplace_back(v, 0.5f * v, 0.0f);
  }
  const auto encoded = gles::encode_map({edge, 1.5, CriticalAngleCure::clip, nodes});
  ASSERT_TRUE(encoded);
  EXPECT_EQ(encoded->width, 16);
  EXPECT_EQ(encoded->height, 31);
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint8_t* t = &encoded->rgba[4 * k];
    const auto error = [&](std::size_t c, float wanted) {
      return std::abs(std::pow(double{encoded->scale} * t[3] / 255.0 * t[c] / 255.0, 2.0) / double{wanted} - 1.0);
    };
    EXPECT_LE(error(0, nodes[k].x), 0.01) << k;
    EXPECT_LE(error(1, nodes[k].y), 0.015) << k;
    EXPECT_EQ(t[2], 0) << k;
    sum += error(0, nodes[k].x);
  }
  std::printf("  mean relative error of the brightest channel: %.5f\n", sum / static_cast<double>(count));
  EXPECT_LE(sum / static_cast<double>(count), 0.0015);
}

TEST(MapBytes, OneValueIsExactAndBlackIsBlack) {
  for (const float value : {1.0f, 0.3f, 700.0f, 0.0f}) {
    const std::vector<glm::vec3> nodes(std::size_t{2} * 3, glm::vec3(value));
    const auto encoded = gles::encode_map({2, 1.5, CriticalAngleCure::clip, nodes});
    ASSERT_TRUE(encoded);
    EXPECT_GT(encoded->scale, 0.0f);
    const double root = double{encoded->scale} * encoded->rgba[3] / 255.0 * encoded->rgba[0] / 255.0;
    EXPECT_NEAR(root * root, double{value}, 1e-6 * double{value});
  }
}

Features rich(ShaderPath path, int lights) {
  Features f;
  f.lobes = 3;
  f.table = f.flakes = f.coat = f.refraction = f.visibility = f.irradiance = true;
  f.flake_taps = f.flake_cells = 4;
  f.path = path;
  f.narrow = 7;
  f.lights = f.flake_lights = lights;
  f.room_lights = f.less_mean_flakes = path == ShaderPath::mirror || path == ShaderPath::none;
  f.still_flakes = path == ShaderPath::sampled;
  f.orange_peel = true;
  return f;
}

TEST(MapPrograms, FitTheSmallestDriver) {
  gles::ContextInfo info;
  info.max_fragment_uniforms = 16;
  for (const MapUse use : {MapUse::clip, MapUse::slide})
    for (const ShaderPath path : {ShaderPath::none, ShaderPath::filtered, ShaderPath::mirror})
      for (int lights = 0; lights <= gles::usable_lights(info); ++lights)
        for (const bool highp : {true, false}) {
          Features f = rich(path, lights);
          f.map = use;
          if (highp) f.sparkle_lights = gles::usable_sparkle_lights(info, lights);
          if (!highp) f.flake_lights = 0;
          f.orange_peel = highp;
          const std::string text = preprocessed(gles::fragment_source(f.canonical(), highp));
          EXPECT_LE(packed_rows(used_variables(text, "uniform")), 16) << f.text();
          EXPECT_LE(used_samplers(text), 8) << f.text();
        }
}

TEST(MapPrograms, UseNoWordBeyondTheLanguage) {
  for (const char* file : {"isochromatic.glsl", "mapped_paint.glsl", "paint_fetch.glsl"})
    for (const char* word : {"dFdx", "dFdy", "fwidth", "texture2DLod", "texture2DGrad", "#extension", "textureCube",
                             "gl_FragDepth", "gl_FragData", "while"})
      EXPECT_EQ(gles::shader_text(file).find(word), std::string_view::npos) << file << " uses " << word;
}

TEST(MapPrograms, PaintsWithoutAMapHaveNothingOfIt) {
  for (const ShaderPath path : {ShaderPath::none, ShaderPath::filtered, ShaderPath::sampled, ShaderPath::mirror}) {
    Features f = rich(path, 2);
    const auto has = [](const Features& features, const char* word) {
      return preprocessed(gles::fragment_source(features.canonical(), true)).find(word) != std::string::npos;
    };
    for (const char* word : {"u_map", "isochromatic", "Isoline", "map_factor", "mapped"}) EXPECT_FALSE(has(f, word));
    f.map = MapUse::clip;
    EXPECT_TRUE(has(f, "u_map"));
    EXPECT_FALSE(has(f, "u_chi")) << "the map instead of the table";
  }
}

TEST(MapPrograms, CanonicalDropsMapsThatNobodyAsks) {
  Features f = rich(ShaderPath::filtered, 0);
  Features without = f;
  f.map = MapUse::clip;
  without.table = false;
  EXPECT_EQ(f.canonical(), without.canonical()) << "prefiltered light has chi in its albedo";
  f.path = ShaderPath::sampled;
  EXPECT_EQ(f.canonical().map, MapUse::clip);
  EXPECT_FALSE(f.canonical().table);
  f.path = ShaderPath::none;
  f.lights = 1;
  EXPECT_EQ(f.canonical().map, MapUse::clip);
  EXPECT_NE(f.text().find(", colour map"), std::string::npos);
  f.surface = packs::SurfaceKind::chrome;
  EXPECT_EQ(f.canonical().map, MapUse::none);
  f.surface = packs::SurfaceKind::paint;
  f.stripes = true;
  EXPECT_EQ(f.canonical().map, MapUse::none);
}

}  // namespace
}  // namespace lackwerk::test
