#include "core/analysis/environment_latlong.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::size_t place(const LatLongMap& map, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
}

/// Beyond a pole the picture goes on half a turn away.
const glm::vec3& wrapped(const LatLongMap& map, int x, int y) {
  if (y < 0 || y >= map.height) {
    y = y < 0 ? -1 - y : 2 * map.height - 1 - y;
    x += map.width / 2;
  }
  x %= map.width;
  return map.pixels[place(map, x < 0 ? x + map.width : x, y)];
}

/// Mean of the valid pixels in the smallest square around (x, y) that has any.
glm::vec3 mean_around(const LatLongMap& map, const std::vector<bool>& bad, int x, int y) {
  for (int reach = 1;; ++reach) {
    glm::dvec3 sum(0.0);
    int count = 0;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, map.height - 1); ++v) {
      for (int u = x - reach; u <= x + reach; ++u) {
        const std::size_t k = place(map, ((u % map.width) + map.width) % map.width, v);
        if (bad[k]) continue;
        sum += glm::dvec3(map.pixels[k]);
        ++count;
      }
    }
    if (count > 0) return glm::vec3(sum / static_cast<double>(count));
  }
}

Result<void> check_shape(const LatLongMap& map) {
  const std::string size = std::to_string(map.width) + "x" + std::to_string(map.height);
  if (map.width < 2 || map.height < 1) return fail(map.name, "size", size + " has no pixels", "use a lat-long map");
  if (std::abs(static_cast<std::int64_t>(map.width) - 2 * static_cast<std::int64_t>(map.height)) > 1)
    return fail(map.name, "size", size + " is not twice as wide as high", "use a lat-long (equirectangular) map");
  if (map.pixels.size() != static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height))
    return fail(map.name, "pixels", std::to_string(map.pixels.size()) + " do not make " + size, "read the file again");
  return {};
}

}  // namespace

double pixel_solid_angle(const LatLongMap& map, int y) {
  const double step = pi / map.height;
  return (std::cos(step * y) - std::cos(step * (y + 1))) * 2.0 * pi / map.width;
}

Result<MapRepairs> repair(LatLongMap& map) {
  if (auto ok = check_shape(map); !ok) return tl::unexpected(ok.error());
  MapRepairs repairs;
  std::vector<bool> bad(map.pixels.size(), false);
  bool light = false;
  for (std::size_t k = 0; k < map.pixels.size(); ++k) {
    glm::vec3& p = map.pixels[k];
    if (!finite(p)) {
      bad[k] = true;
      ++repairs.not_finite;
      continue;
    }
    if (p.x < 0.0f || p.y < 0.0f || p.z < 0.0f) {
      ++repairs.negative;
      for (int c = 0; c < 3; ++c) p[c] = std::max(p[c], 0.0f);
    }
    light = light || p.x > 0.0f || p.y > 0.0f || p.z > 0.0f;
  }
  if (!light) return fail(map.name, "pixels", "the map is black or has no valid pixel", "use a map that has light");
  const std::size_t broken = static_cast<std::size_t>(repairs.negative) + static_cast<std::size_t>(repairs.not_finite);
  if (broken * 100 > map.pixels.size())
    return fail(map.name, "pixels",
                std::to_string(repairs.negative) + " negative and " + std::to_string(repairs.not_finite) +
                    " infinite or undefined pixels are more than 1 %",
                "render or export the map again");
  if (repairs.not_finite == 0) return repairs;
  std::vector<std::pair<std::size_t, glm::vec3>> mended;  // all from valid pixels: the order does not matter
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (bad[place(map, x, y)]) mended.emplace_back(place(map, x, y), mean_around(map, bad, x, y));
    }
  }
  for (const auto& [k, value] : mended) map.pixels[k] = value;
  return repairs;
}

Radiance radiance_of(const LatLongMap& map) {
  return [&map](const glm::dvec3& d) {
    const double x = (0.5 - std::atan2(d.y, d.x) / (2.0 * pi)) * map.width - 0.5;
    const double y = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z) / pi * map.height - 0.5;
    const double fx = std::floor(x);
    const double fy = std::floor(y);
    const int ix = static_cast<int>(fx);
    const int iy = static_cast<int>(fy);
    const double wx = x - fx;
    const double wy = y - fy;
    return (glm::dvec3(wrapped(map, ix, iy)) * (1.0 - wx) + glm::dvec3(wrapped(map, ix + 1, iy)) * wx) * (1.0 - wy) +
           (glm::dvec3(wrapped(map, ix, iy + 1)) * (1.0 - wx) + glm::dvec3(wrapped(map, ix + 1, iy + 1)) * wx) * wy;
  };
}

LatLongMap reduced(LatLongMap map, int width) {
  while (map.width > width && map.width % 2 == 0 && map.height % 2 == 0) {
    LatLongMap half{map.name, map.width / 2, map.height / 2, {}};
    half.pixels.reserve(map.pixels.size() / 4);
    for (int y = 0; y < half.height; ++y) {
      const double upper = pixel_solid_angle(map, 2 * y);
      const double lower = pixel_solid_angle(map, 2 * y + 1);
      for (int x = 0; x < half.width; ++x) {
        const auto pair = [&](int row) {
          return glm::dvec3(map.pixels[place(map, 2 * x, row)]) + glm::dvec3(map.pixels[place(map, 2 * x + 1, row)]);
        };
        half.pixels.emplace_back((pair(2 * y) * upper + pair(2 * y + 1) * lower) / (2.0 * (upper + lower)));
      }
    }
    map = std::move(half);
  }
  return map;
}

}  // namespace lackwerk::core
