#include "core/analysis/environment_build.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "core/analysis/environment_lights.hpp"
#include "core/analysis/studio.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A smooth room without any symmetry; its value changes by at most 1.3 per radian.
glm::dvec3 smooth_room(const glm::dvec3& d) {
  const double v = 1.2 + 0.5 * d.z + 0.3 * d.x * d.y - 0.2 * d.y * d.z + 0.25 * d.x;
  return {v, 0.7 * v + 0.1 * d.y, 1.5 - 0.4 * d.z};
}

LatLongMap map_of(int width, const Radiance& radiance) {
  LatLongMap map{"test", width, width / 2, {}};
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double azimuth = (0.5 - (x + 0.5) / width) * 2.0 * pi;
      const double down = (y + 0.5) / map.height * pi;
      map.pixels.emplace_back(
          radiance({std::sin(down) * std::cos(azimuth), std::sin(down) * std::sin(azimuth), std::cos(down)}));
    }
  }
  return map;
}

glm::dvec3 light_of(const LatLongMap& map) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x)
      sum += glm::dvec3(map.pixels[static_cast<std::size_t>(y * map.width + x)]) * pixel_solid_angle(map, y);
  }
  return sum;
}

glm::dvec3 light_of(const std::vector<EnvironmentLight>& lights) {
  glm::dvec3 sum(0.0);
  for (const EnvironmentLight& light : lights) sum += glm::dvec3(light.radiance) * pi;
  return sum;
}

double worst_of(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 r = glm::abs(a / b - glm::dvec3(1.0));
  return std::max({r.x, r.y, r.z});
}

PaintModel<double> model_of(const Environment& environment) {
  PaintModel<double> model;
  model.environment = &environment;
  model.u_environment_scale = static_cast<double>(environment.range);
  return model;
}

/// Mean of `radiance` around r as the level's definition says, by 300 x 300 directions.
glm::dvec3 brute_force(const Radiance& radiance, const glm::dvec3& r, double m) {
  const glm::dvec3 t = glm::normalize(glm::cross(std::abs(r.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), r));
  const glm::dvec3 b = glm::cross(r, t);
  const double last = std::min(pi / 2.0, 2.0 * std::atan(6.0 * m));
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  constexpr int steps = 300;
  PaintModel<double> model;
  for (int k = 0; k < steps * steps; ++k) {
    const int ring = k % steps, sector = k / steps;
    const double theta = (ring + 0.5) / steps * last;
    const double azimuth = (sector + 0.5) / steps * 2.0 * pi;
    const glm::dvec3 l = r * std::cos(theta) + (t * std::cos(azimuth) + b * std::sin(azimuth)) * std::sin(theta);
    const auto g = model.paint_geometry(r, l, r);  // the shader's own lobe, times n.l
    const double weight = model.lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, 1.0 / m, 1.0) * g.iz * std::sin(theta);
    sum += radiance(l) * weight;
    weights += weight;
  }
  return sum / weights;
}

TEST(EnvironmentBuild, MapConventionIsTheDocumentedOne) {
  LatLongMap map{"axes", 8, 4, std::vector<glm::vec3>(32, glm::vec3(0.0f))};
  for (std::size_t y = 1; y <= 2; ++y) {
    map.pixels[y * 8 + 3] = map.pixels[y * 8 + 4] = glm::vec3(1.0f, 0.0f, 0.0f);  // middle: nose
    map.pixels[y * 8 + 1] = map.pixels[y * 8 + 2] = glm::vec3(0.0f, 1.0f, 0.0f);  // left half: left side
  }
  for (std::size_t x = 0; x < 8; ++x) map.pixels[x] = glm::vec3(0.0f, 0.0f, 1.0f);  // top row: up
  const Radiance radiance = radiance_of(map);
  EXPECT_LT(glm::length(radiance({1.0, 0.0, 0.0}) - glm::dvec3(1, 0, 0)), 1e-9);
  EXPECT_LT(glm::length(radiance({0.0, 1.0, 0.0}) - glm::dvec3(0, 1, 0)), 1e-9);
  EXPECT_LT(glm::length(radiance({0.0, -1.0, 0.0})), 1e-9);
  EXPECT_LT(glm::length(radiance({-1.0, 0.0, 0.0})), 1e-9);
  EXPECT_LT(glm::length(radiance({0.0, 0.0, 1.0}) - glm::dvec3(0, 0, 1)), 1e-9);
}

TEST(EnvironmentBuild, RepairMendsAFewPixels) {
  LatLongMap map{"few", 64, 32, std::vector<glm::vec3>(2048, glm::vec3(2.0f))};
  map.pixels[5] = glm::vec3(std::numeric_limits<float>::quiet_NaN(), 1.0f, 1.0f);
  for (const std::size_t k : {700u, 701u, 702u, 764u, 765u, 766u, 828u, 829u, 830u})  // a whole square of 3 x 3
    map.pixels[k] = glm::vec3(std::numeric_limits<float>::infinity());
  map.pixels[1000] = glm::vec3(-1.0f, 3.0f, -0.5f);
  const auto repairs = repair(map);
  ASSERT_TRUE(repairs) << repairs.error().line();
  EXPECT_EQ(repairs->not_finite, 10);
  EXPECT_EQ(repairs->negative, 1);
  EXPECT_EQ(map.pixels[1000], glm::vec3(0.0f, 3.0f, 0.0f));
  for (const std::size_t k : {5u, 700u, 765u, 830u}) EXPECT_EQ(map.pixels[k], glm::vec3(2.0f)) << k;
}

TEST(EnvironmentBuild, RepairRefusesWhatItWouldHaveToGuess) {
  const auto refused = [](LatLongMap map, const char* field) {
    const auto repairs = repair(map);
    ASSERT_FALSE(repairs) << field;
    EXPECT_EQ(repairs.error().file, "bad.hdr");
    EXPECT_EQ(repairs.error().field, field);
    EXPECT_FALSE(repairs.error().remedy.empty());
  };
  const auto grey = [](int w, int h) {
    return LatLongMap{"bad.hdr", w, h, std::vector<glm::vec3>(static_cast<std::size_t>(w * h), glm::vec3(1.0f))};
  };
  refused({"bad.hdr", 0, 0, {}}, "size");
  refused({"bad.hdr", -4, -2, {}}, "size");
  refused(grey(100, 100), "size");
  refused(grey(102, 50), "size");
  LatLongMap odd = grey(101, 50);
  EXPECT_TRUE(repair(odd)) << "one pixel more is accepted";
  LatLongMap cut = grey(100, 50);
  cut.pixels.pop_back();
  refused(cut, "pixels");
  LatLongMap black = grey(100, 50);
  std::fill(black.pixels.begin(), black.pixels.end(), glm::vec3(0.0f));
  refused(black, "pixels");
  LatLongMap broken = grey(100, 50);
  for (std::size_t k = 0; k < 51; ++k) broken.pixels[k].y = -std::numeric_limits<float>::infinity();
  refused(broken, "pixels");
  std::fill(broken.pixels.begin(), broken.pixels.end(), glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  refused(broken, "pixels");
}

TEST(EnvironmentBuild, HalvingAMapKeepsItsLight) {
  const LatLongMap map = map_of(256, smooth_room);
  const LatLongMap small = reduced(map, 64);
  EXPECT_EQ(small.width, 64);
  EXPECT_LT(worst_of(light_of(small), light_of(map)), 1e-6);
}

TEST(EnvironmentBuild, TexelsCoverTheSphere) {
  double sum = 0.0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) sum += texel_solid_angle(64, x, y);
  }
  EXPECT_NEAR(sum / (4.0 * pi), 1.0, 1e-4);
}

TEST(EnvironmentBuild, BorderRepeatsTheOtherSideOfTheFold) {
  for (const int edge : {8, 96}) {
    const OctahedralImage image = resampled(smooth_room, edge, 1);
    for (int k = -1; k <= edge; ++k) {
      for (const int side : {-1, edge}) {
        // The border texel's own place lies outside the square: mirrored along the side, and along the other axis.
        const auto inside = [edge](double x, double y) {
          if (x < 0.0 || x > edge) {
            x = x < 0.0 ? -x : 2.0 * edge - x;
            y = edge - y;
          }
          if (y < 0.0 || y > edge) {
            y = y < 0.0 ? -y : 2.0 * edge - y;
            x = edge - x;
          }
          return direction_from_octahedral({x / edge, y / edge});
        };
        const glm::dvec3 left = smooth_room(inside(side + 0.5, k + 0.5));
        const glm::dvec3 up = smooth_room(inside(k + 0.5, side + 0.5));
        EXPECT_LT(glm::length(glm::dvec3(image.at(side, k)) - left), 1e-5) << side << ' ' << k;
        EXPECT_LT(glm::length(glm::dvec3(image.at(k, side)) - up), 1e-5) << side << ' ' << k;
      }
    }
  }
}

// Everything about one smooth environment: energy, prefilter against its definition, no seams, same bytes again.
TEST(EnvironmentBuild, SmoothRoomIsExactAndSeamless) {
  const Environment e = build_environment("smooth", smooth_room, {0.0f, glm::vec3(0.0f)}, 2);
  EXPECT_EQ(e.name, "smooth");
  auto model = model_of(e);
  const glm::dvec3 light = 4.0 * pi * glm::dvec3(1.2, 0.84, 1.5);  // all other terms cancel over the sphere
  for (int level = 0; level < environment_level_count; ++level)
    EXPECT_LT(worst_of(sphere_integral(shown_means(e, level)), light), 0.002) << level;

  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int level = 1; level < environment_level_count; ++level) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 r = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
      const double m = environment_levels[static_cast<std::size_t>(level)].m;
      worst = std::max(worst, worst_of(model.environment_at(r, level), brute_force(smooth_room, r, m)));
    }
    EXPECT_LT(worst, 0.01) << level << ": filter and rounding";
    RecordProperty("worst_level_" + std::to_string(level), std::to_string(worst));
  }

  // Great circles through the folds, the axes and both poles.
  constexpr double step = 0.002;
  const std::vector<std::pair<glm::dvec3, glm::dvec3>> circles = {
      {{1, 0, 0}, {0, 1, 0}},        {{1, 0, 0}, {0, 0, 1}},     {{0, 1, 0}, {0, 0, 1}},     {{0.6, 0.8, 0}, {0, 0, 1}},
      {{1, 0.01, 0}, {0, -0.01, 1}}, {{0.8, 0, 0.6}, {0, 1, 0}}, {{0, 0.6, -0.8}, {1, 0, 0}}};
  for (int level = 0; level < environment_level_count; ++level) {
    for (const auto& [a, b] : circles) {
      glm::dvec3 before = model.environment_at(a, level);
      for (double t = step; t < 2.0 * pi; t += step) {
        const glm::dvec3 now = model.environment_at(glm::normalize(a * std::cos(t) + b * std::sin(t)), level);
        ASSERT_LT(glm::length(now - before), 1.3 * step * 1.5 + 0.01 * glm::length(now)) << level << " at " << t;
        before = now;
      }
    }
  }
}

TEST(EnvironmentBuild, SameBytesTwice) {
  const auto room = [](const glm::dvec3& d) { return smooth_room(d) * (d.z > 0.9 ? 30.0 : 1.0); };
  const OctahedralImage source = resampled(room, 64, 2);
  EXPECT_EQ(resampled(room, 64, 2).texels, source.texels);
  const auto all = halvings(source);
  EXPECT_EQ(beckmann_filtered(all, 0.3, 48).texels, beckmann_filtered(all, 0.3, 48).texels);
}

// The lobe's definition as the header derives it, against the shader's text.
TEST(EnvironmentBuild, LobeIsTheShadersLobe) {
  PaintModel<double> model;
  for (const double m : {0.02, 0.34, 1.0}) {
    for (const double share : {0.0, 0.5, 1.5, 3.0}) {
      const double theta = std::min(2.0 * std::atan(share * m), 1.5);
      const glm::dvec3 n(0.0, 0.0, 1.0);
      const auto g = model.paint_geometry(n, glm::dvec3(std::sin(theta), 0.0, std::cos(theta)), n);
      const double text = model.lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, 1.0 / m, 1.0) * g.iz;
      EXPECT_NEAR(beckmann_weight(theta, m) / text, 1.0, 1e-9) << m << ' ' << theta;
    }
  }
  EXPECT_EQ(beckmann_weight(1.6, 0.5), 0.0);
}

TEST(EnvironmentBuild, FilterMatchesItsDefinition) {
  const auto source = halvings(resampled(smooth_room, 512, 1));
  std::mt19937 random(8);
  std::uniform_int_distribution<int> place(0, 15);
  for (const double m : {0.04, 0.14, 0.34, 0.75, 1.0}) {
    const OctahedralImage image = beckmann_filtered(source, m, 16);
    for (int i = 0; i < 3; ++i) {
      const int x = place(random);
      const int y = place(random);
      const glm::dvec3 r = direction_from_octahedral({(x + 0.5) / 16.0, (y + 0.5) / 16.0});
      EXPECT_LT(worst_of(glm::dvec3(image.at(x, y)), brute_force(smooth_room, r, m)), 0.002) << m;
    }
  }
}

TEST(EnvironmentLights, KeepTheLightAtEveryCount) {
  const OctahedralImage map =
      resampled([](const glm::dvec3& d) { return smooth_room(d) + glm::dvec3(d.x > 0.95 ? 50.0 : 0.0); }, 128, 2);
  Environment e = uniform_environment(glm::vec3(1.0f));
  e.lights = median_cut(map);
  ASSERT_EQ(e.lights.size(), 64u);
  const glm::dvec3 light = sphere_integral(map);
  for (const int count : {1, 4, 16, 64}) {
    const auto lights = lights_of(e, count);
    EXPECT_LT(worst_of(light_of(lights), light), 1e-6) << count;
    for (const EnvironmentLight& l : lights) EXPECT_NEAR(glm::length(l.direction), 1.0f, 1e-6f);
  }
  double lamp = 0.0;  // a cap of solid angle 2 pi 0.05 and radiance 50: its lights point to it
  for (const EnvironmentLight& l : e.lights) lamp += l.direction.x > 0.95f ? static_cast<double>(l.radiance.y) : 0.0;
  EXPECT_GT(lamp, 0.9 * 50.0 * 0.1);
}

TEST(EnvironmentLights, ExtremeMaps) {
  OctahedralImage map(64);
  for (const EnvironmentLight& l : median_cut(map)) {
    EXPECT_EQ(l.radiance, glm::vec3(0.0f));
    EXPECT_NEAR(glm::length(l.direction), 1.0f, 1e-6f);
  }
  map.at(50, 9) = glm::vec3(1e5f, 9e4f, 8e4f);
  map.wrap_border();
  const auto sun = median_cut(map);
  const glm::vec3 direction(direction_from_octahedral({50.5 / 64.0, 9.5 / 64.0}));
  double in_sun = 0.0;
  for (const EnvironmentLight& l : sun) {
    EXPECT_FALSE(std::isnan(l.direction.x) || std::isnan(l.radiance.x));
    if (glm::dot(l.direction, direction) > 0.99999f) in_sun += static_cast<double>(l.radiance.x);
  }
  EXPECT_NEAR(in_sun * pi / (1e5 * texel_solid_angle(64, 50, 9)), 1.0, 1e-6);
}

TEST(EnvironmentBuild, SunInTheDarkKeepsItsLight) {
  LatLongMap map{"sun", 256, 128, std::vector<glm::vec3>(256 * 128, glm::vec3(0.0f))};
  map.pixels[30 * 256 + 77] = glm::vec3(1e4f, 9e3f, 8e3f);
  const Environment e = build_environment(map, {0.0f, glm::vec3(0.0f)});
  const glm::dvec3 light = light_of(map);
  for (const int level : {0, 1, 4, 9})
    EXPECT_LT(worst_of(sphere_integral(shown_means(e, level)), light), 0.01) << level;
  EXPECT_LT(worst_of(light_of(e.lights), light), 0.01);
}

TEST(EnvironmentBuild, BlackIsBlack) {
  const Environment e = build_environment(
      "black", [](const glm::dvec3&) { return glm::dvec3(0.0); }, {}, 1);
  EXPECT_EQ(e.range, 1.0f);
  EXPECT_EQ(sphere_integral(shown_means(e, 5)), glm::dvec3(0.0));
  EXPECT_EQ(light_of(e.lights), glm::dvec3(0.0));
}

TEST(Studio, IsFiniteSmoothAndLitFromAbove) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double above = 0.0;
  double below = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
    const glm::dvec3 radiance = studio_radiance(d);
    for (int c = 0; c < 3; ++c) {
      ASSERT_TRUE(std::isfinite(radiance[c]));
      ASSERT_GT(radiance[c], 0.005);
      ASSERT_LT(radiance[c], 200.0);
    }
    (d.z > 0.0 ? above : below) += radiance.y / 10000.0;
    const glm::dvec3 beside = studio_radiance(glm::normalize(d + glm::dvec3(1e-6, -1e-6, 1e-6)));
    ASSERT_LT(glm::length(beside - radiance), 0.2) << "no hard edges";
  }
  EXPECT_GT(above, 2.0 * below);
  EXPECT_GT(below, 0.1);
}

}  // namespace
}  // namespace lackwerk::core
