#include "core/analysis/brdf_fit_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

constexpr double peak_deg = 3.0, near_deg = 20.0, grazing_deg = 75.0;

bool counts(const BrdfSample& sample) {
  if (!(sample.weight > 0.0) || !std::isfinite(sample.weight)) return false;
  for (int c = 0; c < 3; ++c) {
    if (!(sample.rgb[c] >= 0.0) || !std::isfinite(sample.rgb[c])) return false;
    if (!(sample.known[c] >= 0.0) || !std::isfinite(sample.known[c])) return false;
  }
  return sample.in.z >= fit_min_cosine && sample.out.z >= fit_min_cosine;  // false for NaN too
}

}  // namespace

const char* fit_region_name(FitRegion region) {
  switch (region) {
    case FitRegion::peak:
      return "peak";
    case FitRegion::near_specular:
      return "near-specular";
    case FitRegion::diffuse:
      return "diffuse";
    case FitRegion::grazing:
      break;
  }
  return "grazing";
}

FitPoint fit_point(const glm::dvec3& in, const glm::dvec3& out) {
  PaintModel<double> model;  // only its functions are used
  const auto g = model.paint_geometry({0.0, 0.0, 1.0}, in, out);
  constexpr double deg = std::numbers::pi / 180.0;
  FitPoint point;
  point.tan_h = g.tan_h, point.nh = g.nh, point.ho = g.ho, point.iz = g.iz, point.oz = g.oz;
  point.theta_h = g.theta_h;
  point.theta_d = std::clamp(g.theta_i, 0.0, std::max(0.0, std::numbers::pi / 2.0 - g.theta_h));
  point.schlick = model.fresnel_schlick(g.ho, 0.0);
  point.scale = std::sqrt(std::max(g.iz, 0.0) * std::max(g.oz, 0.0));
  point.region = std::min(g.iz, g.oz) < std::cos(grazing_deg * deg) ? FitRegion::grazing
                 : g.theta_h < peak_deg * deg                       ? FitRegion::peak
                 : g.theta_h < near_deg * deg                       ? FitRegion::near_specular
                                                                    : FitRegion::diffuse;
  return point;
}

FitPoint fit_point(const BrdfSample& sample) {
  FitPoint point = fit_point(sample.in, sample.out);
  point.target = sample.rgb * (std::numbers::pi * point.scale);
  point.known = sample.known * (std::numbers::pi * point.scale);
  point.dark = fit_dark + fit_dark_part * std::max({point.target.x, point.target.y, point.target.z});
  point.weight = sample.weight;
  return point;
}

FitPoints fit_points(std::span<const BrdfSample> samples) {
  FitPoints out;
  out.points.reserve(samples.size());
  for (const BrdfSample& sample : samples) {
    if (!counts(sample)) {
      ++out.masked;
      continue;
    }
    out.points.push_back(fit_point(sample));
  }
  return out;
}

std::vector<BrdfSample> table_samples(const BrdfTable& table, std::uint32_t count,
                                      const std::vector<std::uint8_t>& filled) {
  const BrdfTableSize size = table.size();
  const std::uint32_t wanted = std::max(1u, (count + size.theta_h - 1) / size.theta_h);
  const std::uint32_t tries = 8 * wanted;  // of a row's cells, a third is below the horizon; then holes
  // The plastic number's powers: the two steps that fill a square most evenly.
  constexpr double step_d = 0.7548776662466927, step_p = 0.5698402909980532;
  std::vector<BrdfSample> samples;
  samples.reserve(std::size_t{wanted} * size.theta_h);
  std::vector<std::uint8_t> taken(std::size_t{size.theta_d} * size.phi_d);
  for (std::uint32_t row = 0; row < size.theta_h; ++row) {
    std::fill(taken.begin(), taken.end(), std::uint8_t{0});
    std::uint32_t found = 0;
    for (std::uint32_t n = 0; n < tries && found < wanted; ++n) {
      const double at = static_cast<double>(std::uint64_t{row} * tries + n) + 0.5;
      const auto pick = [&](double step, std::uint32_t cells) {
        const double u = at * step - std::floor(at * step);
        return std::min(static_cast<std::size_t>(u * cells), std::size_t{cells} - 1);
      };
      const std::size_t within = pick(step_d, size.theta_d) * size.phi_d + pick(step_p, size.phi_d);
      const std::size_t cell = row * taken.size() + within;
      if (taken[within] != 0 || (cell < filled.size() && filled[cell] != 0)) continue;
      taken[within] = 1;
      const auto value = table.value(cell);
      if (!value) continue;
      const DirectionPair pair = directions(table.middle(cell));
      BrdfSample sample{pair.in, pair.out, glm::dvec3(*value), 1.0, glm::dvec3(0.0)};
      if (!counts(sample)) continue;
      samples.push_back(sample);
      ++found;
    }
  }
  return samples;
}

}  // namespace lackwerk::core
