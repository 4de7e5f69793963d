#include "core/analysis/environment_filter.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>
#include <utility>

#include "core/environment.hpp"

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Steradians per unit of area of the map's unit square (environment.cpp derives it).
double density(const glm::dvec3& d) {
  const double r = 1.0 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  return 4.0 / (r * r * r);
}

/// beckmann_weight over the cosine, from the angle where it has fallen to exp(-16) up to 0.
class LobeTable {
 public:
  explicit LobeTable(double m) : last_rad_(std::min(pi / 2.0, 2.0 * std::atan(4.0 * m))) {
    const double lowest = std::cos(last_rad_);
    for (int k = 0; k <= steps; ++k) {
      const double cosine = lowest + (1.0 - lowest) * k / steps;
      weights_[static_cast<std::size_t>(k)] = static_cast<float>(beckmann_weight(std::acos(cosine), m) * m * m);
    }
    weights_[steps + 1] = weights_[steps];
    lowest_ = static_cast<float>(lowest);
    per_cosine_ = static_cast<float>(steps / (1.0 - lowest));
  }
  [[nodiscard]] double last_rad() const { return last_rad_; }
  /// 0 below the last angle; cosines a little above 1 are 1.
  [[nodiscard]] float operator()(float cosine) const {
    if (cosine <= lowest_) return 0.0f;
    const float x = std::min((cosine - lowest_) * per_cosine_, static_cast<float>(steps));
    const auto k = static_cast<std::size_t>(x);
    return weights_[k] + (weights_[k + 1] - weights_[k]) * (x - static_cast<float>(k));
  }

 private:
  static constexpr int steps = 4096;
  double last_rad_;
  float lowest_ = 0.0f;
  float per_cosine_ = 0.0f;
  std::array<float, steps + 2> weights_{};
};

/// Texels that lie together: a square of block_edge texels, in the map or in the result.
constexpr int block_edge = 8;
struct Block {
  glm::dvec3 axis;
  double reach_rad;  ///< no texel's middle lies further from the axis
};

Block block_around(int edge, int x, int y) {
  const auto direction = [edge](int u, int v) {
    return direction_from_octahedral({(u + 0.5) / edge, (v + 0.5) / edge});
  };
  const int last_x = std::min(x + block_edge, edge) - 1;
  const int last_y = std::min(y + block_edge, edge) - 1;
  Block block{glm::normalize(direction(x, y) + direction(last_x, y) + direction(x, last_y) + direction(last_x, last_y)),
              0.0};
  double least = 1.0;
  for (int v = y; v <= last_y; ++v) {
    for (int u = x; u <= last_x; ++u) least = std::min(least, glm::dot(block.axis, direction(u, v)));
  }
  block.reach_rad = std::acos(std::clamp(least, -1.0, 1.0));
  return block;
}

/// What the sum over the map needs of a texel.
struct Source {
  glm::vec3 direction;
  float solid_angle;
  glm::vec3 radiance;
};

/// The texels of a map block by block.
struct BlockedMap {
  std::vector<Block> blocks;
  std::vector<Source> sources;  ///< block_edge^2 for each block
};

BlockedMap blocked(const OctahedralImage& map) {
  BlockedMap out;
  for (int y = 0; y < map.edge; y += block_edge) {
    for (int x = 0; x < map.edge; x += block_edge) {
      out.blocks.push_back(block_around(map.edge, x, y));
      for (int k = 0; k < block_edge * block_edge; ++k) {
        const int u = x + k % block_edge;
        const int v = y + k / block_edge;
        const glm::dvec3 d = direction_from_octahedral({(u + 0.5) / map.edge, (v + 0.5) / map.edge});
        out.sources.push_back({glm::vec3(d), static_cast<float>(density(d)), map.at(u, v)});
      }
    }
  }
  return out;
}

/// The coarsest halving whose texels are still narrow beside the lobe (at most 0.23 m to 0.5 m wide; the lobe's
/// standard deviation is 1.4 m).
const OctahedralImage& narrow_enough(const std::vector<OctahedralImage>& source, double m) {
  std::size_t k = 0;
  while (k + 1 < source.size() && source[k + 1].edge >= 32 && source[k + 1].edge * m > 8.5) ++k;
  return source[k];
}

}  // namespace

void for_each_row(int count, const std::function<void(int)>& work) {
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int row = next++; row < count; row = next++) work(row);
  };
  const int helpers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16) - 1;
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(helpers));
  for (int i = 0; i < helpers; ++i) threads.emplace_back(run);
  run();
  for (std::thread& t : threads) t.join();
}

OctahedralImage::OctahedralImage(int edge_texels)
    : edge(edge_texels),
      texels(static_cast<std::size_t>(edge_texels + 2) * static_cast<std::size_t>(edge_texels + 2), glm::vec3(0.0f)) {}

const glm::vec3& OctahedralImage::at(int x, int y) const {
  return texels[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(edge + 2) + static_cast<std::size_t>(x + 1)];
}
glm::vec3& OctahedralImage::at(int x, int y) { return const_cast<glm::vec3&>(std::as_const(*this).at(x, y)); }

void OctahedralImage::wrap_border() {
  const int last = edge - 1;
  for (int k = 0; k < edge; ++k) {
    at(-1, k) = at(0, last - k);
    at(edge, k) = at(last, last - k);
    at(k, -1) = at(last - k, 0);
    at(k, edge) = at(last - k, last);
  }
  at(-1, -1) = at(last, last);
  at(edge, -1) = at(0, last);
  at(-1, edge) = at(last, 0);
  at(edge, edge) = at(0, 0);
}

glm::vec3 OctahedralImage::filtered(double u, double v) const {
  const double x = u * edge - 0.5;
  const double y = v * edge - 0.5;
  const int ix = std::clamp(static_cast<int>(std::floor(x)), -1, edge - 1);
  const int iy = std::clamp(static_cast<int>(std::floor(y)), -1, edge - 1);
  const auto wx = static_cast<float>(x - ix);
  const auto wy = static_cast<float>(y - iy);
  return (at(ix, iy) * (1.0f - wx) + at(ix + 1, iy) * wx) * (1.0f - wy) +
         (at(ix, iy + 1) * (1.0f - wx) + at(ix + 1, iy + 1) * wx) * wy;
}

double texel_solid_angle(int edge, int x, int y) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int row = k / 2;
    const glm::dvec2 uv((x + (k % 2 + 0.5) / 2.0) / edge, (y + (row + 0.5) / 2.0) / edge);
    sum += density(direction_from_octahedral(uv)) / 4.0;
  }
  return sum / (static_cast<double>(edge) * edge);
}

OctahedralImage resampled(const Radiance& radiance, int edge, int samples) {
  OctahedralImage image(edge);
  for_each_row(edge, [&](int y) {
    for (int x = 0; x < edge; ++x) {
      glm::dvec3 sum(0.0);
      double weights = 0.0;
      for (int k = 0; k < samples * samples; ++k) {
        const double u = (x + (k % samples + 0.5) / samples) / edge;
        const int row = k / samples;
        const double v = (y + (row + 0.5) / samples) / edge;
        const glm::dvec3 d = direction_from_octahedral({u, v});
        const double weight = density(d);
        sum += radiance(d) * weight;
        weights += weight;
      }
      image.at(x, y) = glm::vec3(sum / weights);
    }
  });
  image.wrap_border();
  return image;
}

std::vector<OctahedralImage> halvings(OctahedralImage image) {
  std::vector<OctahedralImage> all;
  all.push_back(std::move(image));
  while (all.back().edge > 8 && all.back().edge % 2 == 0) {
    const OctahedralImage& fine = all.back();
    OctahedralImage half(fine.edge / 2);
    for (int y = 0; y < half.edge; ++y) {
      for (int x = 0; x < half.edge; ++x) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (int k = 0; k < 4; ++k) {
          const int u = 2 * x + k % 2;
          const int v = 2 * y + k / 2;
          const double weight = density(direction_from_octahedral({(u + 0.5) / fine.edge, (v + 0.5) / fine.edge}));
          sum += glm::dvec3(fine.at(u, v)) * weight;
          weights += weight;
        }
        half.at(x, y) = glm::vec3(sum / weights);
      }
    }
    half.wrap_border();
    all.push_back(std::move(half));
  }
  return all;
}

double beckmann_weight(double theta_rad, double m) {
  const double cosine = std::cos(theta_rad);
  if (cosine <= 0.0) return 0.0;
  const double nh2 = 0.5 + 0.5 * cosine;  // cos^2 of half the angle
  const double tan2 = (1.0 - nh2) / nh2;
  return std::exp(-tan2 / (m * m)) / (m * m * nh2 * nh2) * std::min(1.0, 2.0 * cosine);
}

OctahedralImage beckmann_filtered(const std::vector<OctahedralImage>& source, double m, int edge) {
  const LobeTable lobe(m);
  const BlockedMap map = blocked(narrow_enough(source, m));
  OctahedralImage image(edge);
  std::vector<float> least_cosine;  // between a texel and a block that it can see
  for (const Block& block : map.blocks) {
    const double reach = lobe.last_rad() + block.reach_rad + 1e-4;
    least_cosine.push_back(reach >= pi ? -2.0f : static_cast<float>(std::cos(reach)));
  }
  const int tiles = (edge + block_edge - 1) / block_edge;
  for_each_row(tiles * tiles, [&](int tile) {
    const int x0 = tile % tiles * block_edge;
    const int y0 = tile / tiles * block_edge;
    const Block here = block_around(edge, x0, y0);
    std::vector<std::size_t> near;  // blocks that any texel of the tile can see
    for (std::size_t b = 0; b < map.blocks.size(); ++b) {
      const double reach = lobe.last_rad() + here.reach_rad + map.blocks[b].reach_rad;
      if (reach >= pi || glm::dot(map.blocks[b].axis, here.axis) >= std::cos(reach)) near.push_back(b);
    }
    for (int y = y0; y < std::min(y0 + block_edge, edge); ++y) {
      for (int x = x0; x < std::min(x0 + block_edge, edge); ++x) {
        const glm::vec3 r(direction_from_octahedral({(x + 0.5) / edge, (y + 0.5) / edge}));
        glm::vec3 sum(0.0f);
        float weights = 0.0f;
        for (const std::size_t b : near) {
          if (glm::dot(r, glm::vec3(map.blocks[b].axis)) < least_cosine[b]) continue;
          const Source* from = &map.sources[b * block_edge * block_edge];
          for (int k = 0; k < block_edge * block_edge; ++k) {
            const float weight = lobe(glm::dot(r, from[k].direction)) * from[k].solid_angle;
            sum += from[k].radiance * weight;
            weights += weight;
          }
        }
        image.at(x, y) = sum / weights;
      }
    }
  });
  image.wrap_border();
  return image;
}

}  // namespace lackwerk::core
