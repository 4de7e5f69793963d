#include "core/analysis/mip_chain.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace lackwerk::core {

namespace {

/// What one texel of the next level covers along one axis: `count` texels from `first`, weights summing to 1.
struct Footprint {
  std::size_t first = 0;
  std::size_t count = 0;
  double weight[4] = {};  ///< an edge shrinks by less than 3, so at most 4 texels (3 whole ones or two cut ones)
};

/// Lengths are counted in 1/to of a texel, in integers: texel i of `from` is [i * to, (i + 1) * to).
std::vector<Footprint> footprints(std::size_t from, std::size_t to) {
  std::vector<Footprint> out(to);
  for (std::size_t n = 0; n < to; ++n) {
    const std::size_t begin = n * from;
    const std::size_t end = begin + from;
    out[n].first = begin / to;
    for (std::size_t i = out[n].first; i * to < end; ++i) {
      const std::size_t length = std::min(end, (i + 1) * to) - std::max(begin, i * to);
      out[n].weight[out[n].count++] = static_cast<double>(length) / static_cast<double>(from);
    }
  }
  return out;
}

std::vector<glm::vec3> shrink(const std::vector<glm::vec3>& texels, std::size_t from, std::size_t to) {
  const std::vector<Footprint> prints = footprints(from, to);
  std::vector<glm::vec3> out;
  out.reserve(to * to);
  for (const Footprint& y : prints) {
    for (const Footprint& x : prints) {
      glm::dvec3 sum(0.0);
      for (std::size_t j = 0; j < y.count; ++j) {
        const glm::vec3* row = texels.data() + (y.first + j) * from + x.first;
        for (std::size_t i = 0; i < x.count; ++i) sum += y.weight[j] * x.weight[i] * glm::dvec3(row[i]);
      }
      out.emplace_back(sum);
    }
  }
  return out;
}

}  // namespace

int mip_level_count(std::uint32_t edge) {
  int levels = 0;
  for (; edge > 0; edge /= 2) ++levels;
  return levels;
}

std::vector<MipLevel> mip_chain(std::vector<glm::vec3> level0, std::uint32_t edge) {
  check_at_most(1u, edge, "edge of a slice");
  check_equal(level0.size(), std::size_t{edge} * edge, "texels of a slice");
  std::vector<MipLevel> levels;
  levels.reserve(static_cast<std::size_t>(mip_level_count(edge)));
  levels.push_back({edge, std::move(level0)});
  while (levels.back().edge > 1) {
    const MipLevel& last = levels.back();
    const std::uint32_t next = std::max(1u, last.edge / 2);
    levels.push_back({next, shrink(last.texels, last.edge, next)});
  }
  return levels;
}

}  // namespace lackwerk::core
