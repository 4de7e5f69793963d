#include "render_gles/paint_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <limits>
#include <string>

namespace lackwerk::gles {
namespace {

constexpr std::uint32_t largest_edge = 1024;  // as core::ColourMapSettings
constexpr float largest_factor = 4e4f;        // times headroom^2 it is still a 16-bit float

/// The largest root is 204 of 255, so that the brightest nodes too have common factors to choose from; and 204 x 255 is
/// a product of bytes, so that a map of one value holds it exactly.
constexpr float headroom = 1.25f;
constexpr int most_candidates = 64;

struct Bytes {
  std::array<int, 3> rgb{};
  int common = 1;
};

/// The common factor whose products come nearest to all three roots (parts of 255^2). Above the least one there are
/// many: with the best of them errors are a few times smaller.
Bytes nearest_bytes(const glm::vec3& root) {
  const float brightest = std::max({root.x, root.y, root.z});
  const int least = std::clamp(static_cast<int>(std::ceil(brightest / 255.0f)), 1, 255);
  // Half as much again costs that much resolution; further on nothing is won.
  const int last = std::min({255, least + least / 2, least + most_candidates});
  Bytes best;
  float smallest = std::numeric_limits<float>::infinity();
  for (int common = least; common <= last; ++common) {
    Bytes tried;
    tried.common = common;
    float error = 0.0f;
    for (int c = 0; c < 3; ++c) {
      const auto factor = static_cast<float>(common);
      const int byte = std::min(static_cast<int>(std::lround(root[c] / factor)), 255);
      tried.rgb.at(static_cast<std::size_t>(c)) = byte;
      const float apart = static_cast<float>(byte) * factor - root[c];
      error += apart * apart;
    }
    if (error >= smallest) continue;
    smallest = error;
    best = tried;
  }
  return best;
}

}  // namespace

Result<MapTexture> encode_map(const PaintMap& map) {
  if (map.edge < 2 || map.edge > largest_edge)
    return fail("", "map.edge", "is " + std::to_string(map.edge), "give [2, 1024] nodes");
  const std::size_t height = 2 * std::size_t{map.edge} - 1;
  if (map.nodes.size() != map.edge * height)
    return fail("", "map.nodes", "are " + std::to_string(map.nodes.size()),
                "give edge x (2 edge - 1): " + std::to_string(map.edge * height));
  if (!(map.index >= 1.0 && map.index <= 2.5)) return fail("", "map.index", "is out of range", "give [1, 2.5]");
  float largest = 0.0f;
  for (const glm::vec3& node : map.nodes)
    for (int c = 0; c < 3; ++c) {
      // Written so that NaN fails it.
      if (!(node[c] >= 0.0f && node[c] <= largest_factor))
        return fail("", "map.nodes", "hold " + std::to_string(node[c]), "give [0, 40000]");
      largest = std::max(largest, node[c]);
    }
  MapTexture out;
  out.width = static_cast<int>(map.edge);
  out.height = static_cast<int>(height);
  out.scale = headroom * std::sqrt(std::max(largest, 1e-6f));
  out.rgba.reserve(map.nodes.size() * 4);
  for (const glm::vec3& node : map.nodes) {
    const Bytes bytes = nearest_bytes(glm::sqrt(node) * (65025.0f / out.scale));
    for (const int byte : bytes.rgb) out.rgba.push_back(static_cast<std::uint8_t>(byte));
    out.rgba.push_back(static_cast<std::uint8_t>(bytes.common));
  }
  return out;
}

MapUniforms map_uniforms(const PaintMap& map) {
  MapUniforms out;
  out.index = map.cure == core::CriticalAngleCure::index_one ? 1.0f : static_cast<float>(map.index);
  if (map.cure == core::CriticalAngleCure::slide) out.towards_gloss = 1.0f;
  if (map.cure == core::CriticalAngleCure::slide_along) out.towards_gloss = -1.0f;
  return out;
}

}  // namespace lackwerk::gles
