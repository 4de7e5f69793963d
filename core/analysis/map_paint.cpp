#include "core/analysis/map_paint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/check.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

/// Samples of phi_d over a quarter turn: the map is reciprocal (phi_d + 180 degrees) and mirrors in the plane of
/// incidence (-phi_d), so the other three quarters show the same. Every 3.75 degrees, finer than 64 nodes of a map.
constexpr int phi_samples = 24;

/// Unit direction in air of one inside the coat; empty beyond the critical angle and below the horizon.
std::optional<glm::dvec3> in_air(const glm::dvec3& inside, double index) {
  const double x = inside.x * index, y = inside.y * index, across = x * x + y * y;
  if (inside.z <= 0.0 || across >= 1.0) return std::nullopt;
  return glm::dvec3(x, y, std::sqrt(1.0 - across));
}

/// Mean over phi_d of what the map says at this node; empty where no pair of directions reaches air.
std::optional<glm::dvec3> node(const ColourMap& map, double theta_h, double theta_d) {
  const ColourMapSettings& settings = map.settings();
  const double horizon = std::cos(settings.steepest);
  glm::dvec3 sum(0.0);
  int count = 0;
  for (int k = 0; k < phi_samples; ++k) {
    const double phi_d = (k + 0.5) / phi_samples * 0.5 * std::numbers::pi;
    const DirectionPair inside = directions({theta_h, theta_d, phi_d});
    const auto in = in_air(inside.in, settings.index), out = in_air(inside.out, settings.index);
    if (!in || !out || in->z < horizon || out->z < horizon) continue;
    const double carried = settings.carrier ? settings.carrier(*in, *out) : 1.0;
    sum += map.factor(*in, *out) / carried;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace

double coat_transmission(const glm::dvec3& in, const glm::dvec3& out, double index) {
  PaintModel<double> model;  // its functions, being GLSL too, cannot be static
  return (1.0 - model.fresnel_dielectric(in.z, index)) * (1.0 - model.fresnel_dielectric(out.z, index));
}

AnalyticPaint paint_of_map(const ColourMap& map, double coat_ior, std::uint16_t num_theta) {
  check_at_most(2, int{num_theta}, "nodes of a colour table");
  check_at_most(int{num_theta}, 256, "nodes of a colour table");
  const std::size_t edge = num_theta;
  const double step = 0.5 * std::numbers::pi / static_cast<double>(edge - 1);
  ColourTable table{num_theta, std::vector<glm::vec3>(edge * edge)};
  std::vector<glm::vec3> above;  // the row of the next smaller theta_i
  for (std::size_t i = 0; i < edge; ++i) {
    std::vector<glm::vec3> row(edge);
    std::optional<glm::dvec3> last;
    for (std::size_t h = 0; h < edge; ++h) {
      const auto here = node(map, static_cast<double>(h) * step, static_cast<double>(i) * step);
      if (here) last = here;
      // A row that reaches air nowhere shows what the row before it shows.
      row[h] = last || above.empty() ? glm::vec3(last.value_or(glm::dvec3(0.0))) : above[h];
    }
    std::copy(row.begin(), row.end(), table.linear.begin() + static_cast<std::ptrdiff_t>(i * edge));
    above = std::move(row);
  }
  AnalyticPaint out;
  out.diffuse = glm::dvec3(1.0);
  out.coat_ior = coat_ior;
  out.refraction_ior = map.settings().index;
  out.table = std::move(table);
  return out;
}

}  // namespace lackwerk::core
