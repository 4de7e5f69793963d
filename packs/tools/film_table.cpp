#include "packs/tools/film_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/colour.hpp"
#include "packs/tools/node_geometry.hpp"

namespace lackwerk::packs {
namespace {

double luminance(const glm::dvec3& rgb) {
  return core::rgb_to_xyz[1][0] * rgb.x + core::rgb_to_xyz[1][1] * rgb.y + core::rgb_to_xyz[1][2] * rgb.z;
}

glm::dvec3 clamp_gamut(const glm::dvec3& rgb) {
  return {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
}

}  // namespace

double film_luminance(const FilmStack& film) {
  return luminance(clamp_gamut(film_colour(film.layers, film.resin, 0.0)));
}

core::ColourTable film_table(const FilmStack& film, const core::AnalyticPaint& paint) {
  const std::size_t nodes = film.table_nodes;
  const double quarter = std::numbers::pi / 2.0;
  const double step = quarter / static_cast<double>(nodes - 1);
  const double most = quarter - 0.01;  // film and lobes are singular at exactly 90 degrees
  const double scale = film_luminance(film);
  core::ColourTable table{film.table_nodes, std::vector<glm::vec3>(nodes * nodes, glm::vec3(1.0f))};
  if (scale <= 0.0) return table;

  for (std::size_t bin_i = 0; bin_i < nodes; ++bin_i) {
    for (std::size_t bin_h = 0; bin_h < nodes; ++bin_h) {
      const double theta_h = std::min(static_cast<double>(bin_h) * step, most);
      const double theta_i = std::min({static_cast<double>(bin_i) * step, quarter - theta_h, most});
      const glm::dvec3 mirrored = clamp_gamut(film_colour(film.layers, film.resin, theta_i));
      const glm::dvec3 passed = clamp_gamut(glm::dvec3(1.0) - mirrored);
      const double base = luminance(paint.diffuse);
      const double lobes = std::max(luminance(node_factor(paint, theta_h, theta_i)) - base, 0.0);
      const double share = base + lobes > 0.0 ? lobes / (base + lobes) : 1.0;
      table.linear[bin_i * nodes + bin_h] = glm::vec3(mirrored / scale * share + passed * (1.0 - share));
    }
  }
  return table;
}

}  // namespace lackwerk::packs
