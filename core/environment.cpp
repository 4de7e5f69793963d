#include "core/environment.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

// Below this alpha the code would gain digits nobody sees and lose smoothness: between two texels the hardware
// multiplies a filtered colour by a filtered alpha, and where alpha steps from k to k + 1 the product bulges by
// 1/(2 k (k + 1)) of the radiance. 6 keeps bulges under 1.2 % and steps under 1 % over four decades.
constexpr int least_alpha = 6;

glm::dvec4 texel(const Environment& e, int x, int y) {
  const std::uint8_t* p = &e.atlas[4 * (static_cast<std::size_t>(y) * environment_width + static_cast<std::size_t>(x))];
  return glm::dvec4(p[0], p[1], p[2], p[3]) / 255.0;
}

// Length of the point of the octahedron |x| + |y| + |z| = 1 in direction d. A piece da of the map's unit square is
// 4 da / r^3 steradians: the face has sqrt(3) times the area of its shadow on the square, stands 1/sqrt(3) from the
// centre, and is seen under the cosine 1/(sqrt(3) r) from the distance r.
double octahedron_radius(const glm::dvec3& d) {
  return glm::length(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
}

}  // namespace

glm::dvec2 octahedral_from_direction(const glm::dvec3& d) {
  const double s = 1.0 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  double x = d.x * s;
  double y = d.y * s;
  if (d.z < 0.0) {
    const double folded = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0);
    y = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
    x = folded;
  }
  return {x * 0.5 + 0.5, y * 0.5 + 0.5};
}

glm::dvec3 direction_from_octahedral(const glm::dvec2& uv) {
  double x = uv.x * 2.0 - 1.0;
  double y = uv.y * 2.0 - 1.0;
  const double z = 1.0 - std::abs(x) - std::abs(y);
  if (z < 0.0) {
    const double unfolded = (1.0 - std::abs(y)) * (x < 0.0 ? -1.0 : 1.0);
    y = (1.0 - std::abs(x)) * (y < 0.0 ? -1.0 : 1.0);
    x = unfolded;
  }
  return glm::normalize(glm::dvec3(x, y, z));
}

double luminance_of(const glm::dvec3& linear) {
  return rgb_to_xyz[1][0] * linear.x + rgb_to_xyz[1][1] * linear.y + rgb_to_xyz[1][2] * linear.z;
}

void encode_radiance(const glm::dvec3& radiance, double range, std::uint8_t* rgba) {
  glm::dvec3 root;
  for (int c = 0; c < 3; ++c) root[c] = std::sqrt(std::clamp(radiance[c] / range, 0.0, 1.0));
  const double largest = std::max({root.x, root.y, root.z});
  const int alpha = std::clamp(static_cast<int>(std::ceil(largest * 255.0 - 1e-9)), least_alpha, 255);
  for (int c = 0; c < 3; ++c) {
    rgba[c] = static_cast<std::uint8_t>(std::clamp(std::lround(root[c] * 65025.0 / alpha), 0L, 255L));
  }
  rgba[3] = static_cast<std::uint8_t>(alpha);
}

glm::dvec3 decode_radiance(const glm::dvec4& rgba, double range) {
  const glm::dvec3 root = glm::dvec3(rgba) * rgba.w;
  return root * root * range;
}

double environment_level_of(double m) {
  if (m <= environment_levels.front().m) return 0.0;
  for (std::size_t k = 1; k < environment_levels.size(); ++k) {
    const double low = environment_levels[k - 1].m;
    const double high = environment_levels[k].m;
    if (m < high) return static_cast<double>(k - 1) + (m - low) / (high - low);
  }
  return environment_level_count - 1.0;
}

glm::dvec4 filtered_texel(const Environment& environment, double x, double y) {
  const double fx = std::floor(x - 0.5);
  const double fy = std::floor(y - 0.5);
  const double wx = x - 0.5 - fx;
  const double wy = y - 0.5 - fy;
  const auto column = [](double c) { return static_cast<int>(std::clamp(c, 0.0, environment_width - 1.0)); };
  const auto row = [](double r) { return static_cast<int>(std::clamp(r, 0.0, environment_height - 1.0)); };
  const int x0 = column(fx);
  const int x1 = column(fx + 1.0);
  const int y0 = row(fy);
  const int y1 = row(fy + 1.0);
  const glm::dvec4 upper = texel(environment, x0, y0) * (1.0 - wx) + texel(environment, x1, y0) * wx;
  const glm::dvec4 lower = texel(environment, x0, y1) * (1.0 - wx) + texel(environment, x1, y1) * wx;
  return upper * (1.0 - wy) + lower * wy;
}

std::vector<EnvironmentLight> lights_of(const Environment& environment, int count) {
  check_equal(environment.lights.size(), static_cast<std::size_t>(environment_light_count), "lights of a median cut");
  const int kept = count >= 64 ? 64 : count >= 16 ? 16 : count >= 4 ? 4 : 1;
  const auto group = static_cast<std::size_t>(environment_light_count / kept);
  std::vector<EnvironmentLight> lights;
  lights.reserve(static_cast<std::size_t>(kept));
  for (int k = 0; k < kept; ++k) {
    glm::dvec3 radiance(0.0);
    glm::dvec3 direction(0.0);
    for (std::size_t i = 0; i < group; ++i) {
      const EnvironmentLight& leaf = environment.lights[static_cast<std::size_t>(k) * group + i];
      radiance += glm::dvec3(leaf.radiance);
      direction += glm::dvec3(leaf.direction) * luminance_of(glm::dvec3(leaf.radiance));
    }
    // Light from all sides has no mean direction: from above is as good as any. Black has none either.
    const double length = glm::length(direction);
    const bool known = length > 1e-6 * luminance_of(radiance) && length > 0.0;
    lights.push_back({known ? glm::vec3(direction / length) : glm::vec3(0.0f, 0.0f, 1.0f), glm::vec3(radiance)});
  }
  std::stable_sort(lights.begin(), lights.end(), [](const EnvironmentLight& a, const EnvironmentLight& b) {
    return luminance_of(glm::dvec3(a.radiance)) > luminance_of(glm::dvec3(b.radiance));
  });
  return lights;
}

Environment uniform_environment(glm::vec3 radiance) {
  Environment e;
  e.name = "uniform";
  const float largest = std::max({radiance.x, radiance.y, radiance.z});
  e.range = largest > 0.0f ? largest : 1.0f;
  std::array<std::uint8_t, 4> code{};
  encode_radiance(glm::dvec3(radiance), static_cast<double>(e.range), code.data());
  e.atlas.resize(std::size_t{4} * environment_width * environment_height);
  for (std::size_t i = 0; i < e.atlas.size(); i += 4)
    std::copy(code.begin(), code.end(), e.atlas.begin() + static_cast<std::ptrdiff_t>(i));
  // 8 x 8 equal pieces of the sphere (height by azimuth), halved in turn: the bits of the number, taken alternately.
  for (int k = 0; k < environment_light_count; ++k) {
    const int azimuth = (k >> 5 & 1) << 2 | (k >> 3 & 1) << 1 | (k >> 1 & 1);
    const int height = (k >> 4 & 1) << 2 | (k >> 2 & 1) << 1 | (k & 1);
    const double z = 1.0 - (height + 0.5) / 4.0;
    const double a = (azimuth + 0.5) * pi / 4.0;
    const double s = std::sqrt(1.0 - z * z);
    e.lights.push_back({glm::vec3(glm::dvec3(s * std::cos(a), s * std::sin(a), z)), radiance / 16.0f});
  }
  return e;
}

EnvironmentSampler::EnvironmentSampler(const Environment& environment) : edge_(environment_levels[0].edge) {
  const EnvironmentLevel& level = environment_levels[0];
  const auto padded = static_cast<std::size_t>(edge_) + 2;
  std::vector<double> luminance(padded * padded);
  for (std::size_t y = 0; y < padded; ++y) {
    for (std::size_t x = 0; x < padded; ++x) {
      const glm::dvec4 t = texel(environment, level.x - 1 + static_cast<int>(x), level.y - 1 + static_cast<int>(y));
      luminance[y * padded + x] = luminance_of(decode_radiance(t, 1.0));
    }
  }
  // What a linear filter shows inside a texel comes from its eight neighbours, too: a black texel beside a lamp is not
  // black at its edge, and must be drawn. These are the filter's mean weights (3/4 of the middle, 1/8 of each side).
  const auto smooth = [&](std::size_t x, std::size_t y) {
    const double* p = &luminance[(y + 1) * padded + x + 1];
    const double* up = p - padded;
    const double* down = p + padded;
    return 0.5625 * p[0] + 0.09375 * (p[-1] + p[1] + up[0] + down[0]) +
           0.015625 * (up[-1] + up[1] + down[-1] + down[1]);
  };
  const auto edge = static_cast<std::size_t>(edge_);
  double mean = 0.0;
  for (const double l : luminance) mean += l / static_cast<double>(luminance.size());
  const double least = mean > 0.0 ? 1e-3 * mean : 1.0;  // nothing is impossible; a black map is drawn evenly
  row_sum_.assign(edge + 1, 0.0);
  column_sum_.assign(edge * (edge + 1), 0.0);
  for (std::size_t y = 0; y < edge; ++y) {
    double* sums = &column_sum_[y * (edge + 1)];
    for (std::size_t x = 0; x < edge; ++x) {
      const glm::dvec2 uv((static_cast<double>(x) + 0.5) / edge_, (static_cast<double>(y) + 0.5) / edge_);
      const double r = octahedron_radius(direction_from_octahedral(uv));
      sums[x + 1] = sums[x] + (smooth(x, y) + least) / (r * r * r);
    }
    row_sum_[y + 1] = row_sum_[y] + sums[edge];
  }
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const glm::dvec2& u) const {
  // The interval of cumulative sums that holds `target`, and the place inside it, [0, 1).
  const auto find = [this](const double* sums, double target, int& index) {
    const double* above = std::upper_bound(sums + 1, sums + edge_, target);
    index = static_cast<int>(above - sums) - 1;
    return std::clamp((target - sums[index]) / (sums[index + 1] - sums[index]), 0.0, 1.0 - 1e-12);
  };
  int row = 0;
  int column = 0;
  const double fy = find(row_sum_.data(), u.y * row_sum_.back(), row);
  const double* sums = &column_sum_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(edge_) + 1)];
  const double fx = find(sums, u.x * sums[edge_], column);
  const glm::dvec3 d = direction_from_octahedral({(column + fx) / edge_, (row + fy) / edge_});
  const double r = octahedron_radius(d);
  const double mass = (sums[column + 1] - sums[column]) / row_sum_.back();
  return {d, mass * edge_ * edge_ * r * r * r / 4.0};
}

double EnvironmentSampler::pdf(const glm::dvec3& direction) const {
  const glm::dvec2 uv = octahedral_from_direction(direction);
  const int column = std::clamp(static_cast<int>(uv.x * edge_), 0, edge_ - 1);
  const int row = std::clamp(static_cast<int>(uv.y * edge_), 0, edge_ - 1);
  const double* sums = &column_sum_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(edge_) + 1)];
  const double r = octahedron_radius(direction);
  return (sums[column + 1] - sums[column]) / row_sum_.back() * edge_ * edge_ * r * r * r / 4.0;
}

}  // namespace lackwerk::core
