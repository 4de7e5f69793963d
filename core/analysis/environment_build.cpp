#include "core/analysis/environment_build.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/analysis/environment_lights.hpp"
#include "core/check.hpp"

namespace lackwerk::core {
namespace {

float largest_channel(const OctahedralImage& image) {
  float largest = 0.0f;
  for (const glm::vec3& t : image.texels) largest = std::max({largest, t.x, t.y, t.z});
  return largest;
}

/// A texel as the encoder will store it, but not yet rounded: root of radiance over range, split into colour and alpha.
glm::vec4 code_of(const glm::vec3& radiance, float range) {
  glm::vec3 root;
  for (int c = 0; c < 3; ++c) root[c] = std::sqrt(radiance[c] / range);
  const float alpha = std::max({root.x, root.y, root.z, 6.0f / 255.0f});
  return glm::vec4(root / alpha, alpha);
}

/// Integral of tent * filtered picture around texel (x, y): over the four cells between its neighbours' middles, each
/// by 3 x 3 Gauss points (exact: the picture has degree 4 there, the tent 1).
glm::vec3 shown_in_tent(const std::vector<glm::vec4>& codes, int edge, int x, int y) {
  constexpr std::array<float, 3> node = {0.1127016654f, 0.5f, 0.8872983346f};
  constexpr std::array<float, 3> share = {5.0f / 18.0f, 8.0f / 18.0f, 5.0f / 18.0f};
  const std::size_t pitch = static_cast<std::size_t>(edge) + 2;
  const glm::vec4* middle = &codes[(static_cast<std::size_t>(y) + 1) * pitch + static_cast<std::size_t>(x) + 1];
  glm::vec3 sum(0.0f);
  for (int cell = 0; cell < 4; ++cell) {
    const glm::vec4& across = cell % 2 == 0 ? middle[-1] : middle[1];
    const glm::vec4* other = cell / 2 == 0 ? middle - pitch : middle + pitch;
    const glm::vec4& diagonal = cell % 2 == 0 ? other[-1] : other[1];
    for (std::size_t k = 0; k < 9; ++k) {
      const float u = node[k % 3];  // distance from the texel's own middle
      const float v = node[k / 3];
      const glm::vec4 t = (*middle * (1.0f - u) + across * u) * (1.0f - v) + (*other * (1.0f - u) + diagonal * u) * v;
      const glm::vec3 root = glm::vec3(t) * t.w;
      sum += root * root * (share[k % 3] * share[k / 3] * (1.0f - u) * (1.0f - v));
    }
  }
  return sum;
}

/// Every texel's share of the light around it: what a tent of one texel's reach takes, `side` from each neighbour
/// along an axis.
OctahedralImage in_tents(const OctahedralImage& image, float side) {
  OctahedralImage out(image.edge);
  for (int y = 0; y < image.edge; ++y) {
    for (int x = 0; x < image.edge; ++x) {
      const auto row = [&](int v) {
        return (image.at(x - 1, v) + image.at(x + 1, v)) * side + image.at(x, v) * (1.0f - 2.0f * side);
      };
      out.at(x, y) = (row(y - 1) + row(y + 1)) * side + row(y) * (1.0f - 2.0f * side);
    }
  }
  out.wrap_border();
  return out;
}

/// Per channel the least of a texel and its eight neighbours.
glm::vec3 least_around(const OctahedralImage& image, int x, int y) {
  glm::vec3 least = image.at(x, y);
  for (int k = 0; k < 9; ++k) least = glm::min(least, image.at(x - 1 + k % 3, y - 1 + k / 3));
  return least;
}

/// Texels whose filtered picture holds the light of `wanted`, tent by tent (the tents sum to 1, so the whole keeps its
/// light), by a few multiplicative steps; the small rest that they leave is made good everywhere. No texel falls below
/// its neighbourhood, or lamps would wear dark rings. `side` is 1/8 where wanted holds means over texels, 1/12 where it
/// holds samples of a smooth picture. `light`: integral over the sphere.
OctahedralImage texels_that_show(const OctahedralImage& wanted, float side, const glm::dvec3& light) {
  constexpr int steps = 6;
  const int edge = wanted.edge;
  const float range = largest_channel(wanted);
  const OctahedralImage target = in_tents(wanted, side);
  OctahedralImage texels = target;
  if (range <= 0.0f) return texels;
  OctahedralImage shown(edge);
  std::vector<glm::vec4> codes(texels.texels.size());
  for (int step = 0;; ++step) {
    std::transform(texels.texels.begin(), texels.texels.end(), codes.begin(),
                   [range](const glm::vec3& t) { return code_of(t, range); });
    for_each_row(edge, [&](int y) {
      for (int x = 0; x < edge; ++x) shown.at(x, y) = shown_in_tent(codes, edge, x, y) * range;
    });
    if (step == steps) break;
    for (int y = 0; y < edge; ++y) {
      for (int x = 0; x < edge; ++x) {
        const glm::vec3 least = least_around(wanted, x, y);
        for (int c = 0; c < 3; ++c) {
          if (shown.at(x, y)[c] <= 0.0f) continue;
          const float factor = std::clamp(target.at(x, y)[c] / shown.at(x, y)[c], 0.2f, 5.0f);
          texels.at(x, y)[c] = std::max(texels.at(x, y)[c] * factor, least[c]);
        }
      }
    }
    texels.wrap_border();
  }
  const glm::dvec3 rest = light / glm::max(sphere_integral(shown), glm::dvec3(1e-30));
  for (glm::vec3& t : texels.texels) t *= glm::vec3(rest);
  return texels;
}

/// Rounds a level into the atlas. Rough levels are so smooth that whole patches would round the same way and show
/// steps: there each texel's relative error is handed to its neighbours (Floyd & Steinberg 1976). In the sharp level
/// it would carry errors out of lamps.
void write_level(Environment& environment, int level, const OctahedralImage& image) {
  const EnvironmentLevel& place = environment_levels[static_cast<std::size_t>(level)];
  check_equal(image.edge, place.edge, "edge of an environment's level");
  const auto range = static_cast<double>(environment.range);
  OctahedralImage shown = image;
  std::vector<glm::dvec3> carried(image.texels.size() + static_cast<std::size_t>(image.edge), glm::dvec3(0.0));
  const std::size_t pitch = static_cast<std::size_t>(place.edge) + 2;
  for (int y = 0; y < place.edge && level > 0; ++y) {
    for (int x = 0; x < place.edge; ++x) {
      const std::size_t k = static_cast<std::size_t>(y) * pitch + static_cast<std::size_t>(x) + 1;
      const glm::dvec3 wanted = glm::dvec3(image.at(x, y)) * (1.0 + carried[k]);
      shown.at(x, y) = glm::vec3(wanted);
      std::array<std::uint8_t, 4> code{};
      encode_radiance(wanted, range, code.data());
      const glm::dvec3 got = decode_radiance(glm::dvec4(code[0], code[1], code[2], code[3]) / 255.0, range);
      for (int c = 0; c < 3; ++c) {
        const double error = wanted[c] > 0.0 ? std::clamp((wanted[c] - got[c]) / wanted[c], -0.02, 0.02) : 0.0;
        carried[k + 1][c] += error * 7.0 / 16.0;
        carried[k + pitch - 1][c] += error * 3.0 / 16.0;
        carried[k + pitch][c] += error * 5.0 / 16.0;
        carried[k + pitch + 1][c] += error * 1.0 / 16.0;
      }
    }
  }
  shown.wrap_border();
  for (int y = -1; y <= place.edge; ++y) {
    for (int x = -1; x <= place.edge; ++x) {
      const auto texel =
          std::size_t{environment_width} * static_cast<unsigned>(place.y + y) + static_cast<unsigned>(place.x + x);
      encode_radiance(glm::dvec3(shown.at(x, y)), range, &environment.atlas[4 * texel]);
    }
  }
}

}  // namespace

Environment build_environment(const std::string& name, const Radiance& radiance, const EnvironmentRoom& room,
                              int samples) {
  Environment environment;
  environment.name = name;
  environment.centre_mm = room.centre_mm;
  environment.room_radius_mm = room.radius_mm;
  environment.atlas.resize(std::size_t{4} * environment_width * environment_height);
  const OctahedralImage means = resampled(radiance, environment_levels[0].edge, samples);
  const glm::dvec3 light = sphere_integral(means);
  const OctahedralImage sharp = texels_that_show(means, 0.125f, light);
  const float largest = largest_channel(sharp);
  environment.range = largest > 0.0f ? largest : 1.0f;
  write_level(environment, 0, sharp);

  const std::vector<OctahedralImage> source = halvings(shown_means(environment, 0));
  for (int level = 1; level < environment_level_count; ++level) {
    const EnvironmentLevel& place = environment_levels[static_cast<std::size_t>(level)];
    write_level(environment, level,
                texels_that_show(beckmann_filtered(source, place.m, place.edge), 1.0f / 12.0f, light));
  }
  environment.lights = median_cut(source[1]);
  return environment;
}

Environment build_environment(const LatLongMap& map, const EnvironmentRoom& room) {
  check_equal(map.pixels.size(), static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height),
              "pixels of a lat-long map");
  const LatLongMap source = reduced(map, 2048);
  return build_environment(map.name, radiance_of(source), room, std::clamp(source.width / 256, 4, 32));
}

OctahedralImage shown_means(const Environment& environment, int level) {
  const EnvironmentLevel& place = environment_levels[static_cast<std::size_t>(level)];
  constexpr std::array<double, 4> node = {0.10566243, 0.39433757, 0.60566243, 0.89433757};  // two Gauss points a half
  OctahedralImage image(place.edge);
  for_each_row(place.edge, [&](int y) {
    for (int x = 0; x < place.edge; ++x) {
      glm::dvec3 sum(0.0);
      for (std::size_t k = 0; k < 16; ++k) {
        const glm::dvec4 t = filtered_texel(environment, place.x + x + node[k % 4], place.y + y + node[k / 4]);
        sum += decode_radiance(t, static_cast<double>(environment.range));
      }
      image.at(x, y) = glm::vec3(sum / 16.0);
    }
  });
  image.wrap_border();
  return image;
}

glm::dvec3 sphere_integral(const OctahedralImage& image) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < image.edge; ++y) {
    for (int x = 0; x < image.edge; ++x) sum += glm::dvec3(image.at(x, y)) * texel_solid_angle(image.edge, x, y);
  }
  return sum;
}

}  // namespace lackwerk::core
