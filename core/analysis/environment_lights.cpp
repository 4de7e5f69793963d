#include "core/analysis/environment_lights.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <utility>

#include "core/check.hpp"

namespace lackwerk::core {
namespace {

constexpr double pi = 3.14159265358979323846;

/// One texel as a light: power is its radiance times its solid angle over pi.
struct Spot {
  glm::dvec3 direction;
  glm::dvec3 power;
  double luminance;
  std::size_t index;   ///< of the texel
  double along = 0.0;  ///< place on the axis of the cut under way
};

struct Sums {
  glm::dvec3 power{0.0};
  glm::dvec3 direction{0.0};  ///< weighted by luminance
  glm::dvec3 plain{0.0};      ///< not weighted
  double luminance = 0.0;
};

Sums sums_of(std::span<const Spot> spots) {
  Sums s;
  for (const Spot& spot : spots) {
    s.power += spot.power;
    s.direction += spot.direction * spot.luminance;
    s.plain += spot.direction;
    s.luminance += spot.luminance;
  }
  return s;
}

glm::vec3 unit_or_up(const glm::dvec3& v, double scale) {
  const double length = glm::length(v);
  return length > 1e-9 * scale && length > 0.0 ? glm::vec3(v / length) : glm::vec3(0.0f, 0.0f, 1.0f);
}

/// The direction in which the part's light is spread most: power iteration on its covariance. A black part is spread
/// by its texels alone.
glm::dvec3 longest_axis(std::span<const Spot> spots, const Sums& sums) {
  const bool black = sums.luminance <= 0.0;
  const double total = black ? static_cast<double>(spots.size()) : sums.luminance;
  const glm::dvec3 centre = (black ? sums.plain : sums.direction) / total;
  glm::dmat3 covariance(0.0);
  for (const Spot& spot : spots) {
    const glm::dvec3 d = spot.direction - centre;
    covariance += glm::outerProduct(d, d) * ((black ? 1.0 : spot.luminance) / total);
  }
  glm::dvec3 axis(0.61, 0.53, 0.59);  // no axis of symmetry of any lamp
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 next = covariance * axis;
    const double length = glm::length(next);
    if (length < 1e-30) break;
    axis = next / length;
  }
  return axis;
}

void cut(std::span<Spot> spots, double strength, int depth, std::vector<EnvironmentLight>& out) {
  const Sums sums = sums_of(spots);
  if (depth == 0) {
    const bool black = sums.luminance <= 0.0;
    out.push_back({black ? unit_or_up(sums.plain, 1.0) : unit_or_up(sums.direction, sums.luminance),
                   glm::vec3(sums.power * strength)});
    return;
  }
  if (spots.size() < 2) {
    cut(spots, 0.5 * strength, depth - 1, out);
    cut(spots, 0.5 * strength, depth - 1, out);
    return;
  }
  const glm::dvec3 axis = longest_axis(spots, sums);
  for (Spot& spot : spots) spot.along = glm::dot(spot.direction, axis);
  std::sort(spots.begin(), spots.end(),
            [](const Spot& a, const Spot& b) { return a.along != b.along ? a.along < b.along : a.index < b.index; });
  std::size_t middle = spots.size() / 2;
  if (sums.luminance > 0.0) {
    double below = 0.0;
    for (middle = 0; middle < spots.size(); ++middle) {
      const double next = below + spots[middle].luminance;
      if (next > 0.5 * sums.luminance) {
        if (next - 0.5 * sums.luminance < 0.5 * sums.luminance - below) ++middle;  // whichever half is nearer
        break;
      }
      below = next;
    }
    middle = std::clamp<std::size_t>(middle, 1, spots.size() - 1);
  }
  cut(spots.first(middle), strength, depth - 1, out);
  cut(spots.subspan(middle), strength, depth - 1, out);
}

}  // namespace

std::vector<EnvironmentLight> median_cut(const OctahedralImage& map, int halvings) {
  check_at_most(0, halvings, "halvings of a map");
  check_at_most(halvings, 16, "halvings of a map");
  std::vector<Spot> spots;
  spots.reserve(static_cast<std::size_t>(map.edge) * static_cast<std::size_t>(map.edge));
  for (int y = 0; y < map.edge; ++y) {
    for (int x = 0; x < map.edge; ++x) {
      const glm::dvec3 power = glm::dvec3(map.at(x, y)) * (texel_solid_angle(map.edge, x, y) / pi);
      spots.push_back({direction_from_octahedral({(x + 0.5) / map.edge, (y + 0.5) / map.edge}), power,
                       luminance_of(power), spots.size()});
    }
  }
  std::vector<EnvironmentLight> lights;
  lights.reserve(std::size_t{1} << static_cast<unsigned>(halvings));
  cut(spots, 1.0, halvings, lights);
  return lights;
}

}  // namespace lackwerk::core
