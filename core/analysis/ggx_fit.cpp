#include "core/analysis/ggx_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/check.hpp"
#include "core/environment.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {

using glm::dvec3;

namespace {

/// Below this tangent nothing counts: the narrowest lobe (m = 1e-3) has 1e-6 of its energy there.
constexpr double least_tangent = 1e-6;
/// Candidates reach below what an engine can show, so that it can be told from what it can.
constexpr double least_candidate = 2e-4;
constexpr int candidate_count = 64;  ///< 14 % apart: the error has one valley, some 60 % wide at half its depth
/// A reflectance that is 1/250 of the smallest step of an 8-bit picture shows nothing.
constexpr double least_reflectance = 1e-6;

/// One direction of light, seen along the normal.
struct Node {
  double dx = 0.0;                                      ///< share of cos_i dw_i / pi: the step of sin^2(theta_out)
  double cosine = 0.0, tan_half = 0.0, cos_half = 0.0;  ///< outside: of i, of the half vector
  double engine_coat = 1.0;
  dvec3 lobes{0.0}, flakes{0.0};
  double luminance = 0.0;  ///< of both
};

/// The paint along a line of half vectors: with o = n the light inside stands at twice their angle, and outside
/// x = sin^2(theta_out) = eta^2 sin^2(2 theta_h) = 4 eta^2 t^2 / (1 + t^2)^2 with t = tan(theta_h); cos dw = pi dx.
std::vector<Node> nodes_of(const AnalyticPaint& paint, const MeanFlakes& flakes, std::optional<double> clearcoat,
                           int node_count) {
  AnalyticPaint bare = paint;
  bare.diffuse = dvec3(0.0);
  bare.table.reset();
  PaintModel<double> model;
  bind_model(InterpolatablePaint(), bare, no_textures(), model);
  const dvec3 n(0.0, 0.0, 1.0);
  const double eta = paint.refraction_ior;
  const double from = std::log(least_tangent);
  const double step = (std::log(std::tan(0.5 * std::asin(1.0 / eta))) - from) / node_count;
  const double seen_through = 1.0 - model.fresnel_dielectric(1.0, paint.coat_ior);
  std::vector<Node> out(static_cast<std::size_t>(node_count));
  for (int k = 0; k < node_count; ++k) {
    Node& node = out[static_cast<std::size_t>(k)];
    const double t = std::exp(from + (k + 0.5) * step), t2 = t * t, c2 = 1.0 / (1.0 + t2);
    const double sine_in = 2.0 * t * c2, sine_out = std::min(eta * sine_in, 1.0);
    node.dx = 8.0 * eta * eta * t2 * (1.0 - t2) * c2 * c2 * c2 * step;
    node.cosine = std::sqrt(1.0 - sine_out * sine_out);
    node.tan_half = sine_out / (1.0 + node.cosine);
    node.cos_half = 1.0 / std::sqrt(1.0 + node.tan_half * node.tan_half);
    const auto g = model.paint_geometry(n, dvec3(sine_in, 0.0, (1.0 - t2) * c2), n);
    const double through = seen_through * (1.0 - model.fresnel_dielectric(node.cosine, paint.coat_ior));
    node.engine_coat = clearcoat ? 1.0 - clearcoat_fresnel(1.0, *clearcoat) : through;
    node.lobes = model.lobes_factor(g, 1.0) * through;
    if (flakes) node.flakes = flakes(g.theta_h, g.theta_i) * through;
    node.luminance = luminance_of(node.lobes + node.flakes);
  }
  return out;
}

double engine_factor(const Node& node, double alpha) {
  return ggx_factor(alpha, node.tan_half, node.cos_half, node.cosine, 1.0) * node.engine_coat;
}

double engine_energy(const std::vector<Node>& nodes, double alpha) {
  double sum = 0.0;
  for (const Node& node : nodes) sum += engine_factor(node, alpha) * node.dx;
  return sum;
}

/// KN eq. 10 at the scale that keeps the energy: p ~ f cos, squares of values with their cosine, cos dw = pi dx.
double squared_error(const std::vector<Node>& nodes, double alpha, double energy) {
  const double scale = energy / engine_energy(nodes, alpha);
  double sum = 0.0;
  for (const Node& node : nodes) {
    const double d = scale * engine_factor(node, alpha) - node.luminance;
    sum += node.luminance * d * d * node.cosine * node.cosine * node.dx;
  }
  return sum;
}

double candidate(double k) { return std::exp(std::log(least_candidate) * (1.0 - k / (candidate_count - 1))); }

/// The best of a row of candidates, then the golden section between its neighbours until alpha is known to 1e-6.
double best_alpha(const std::vector<Node>& nodes, double energy) {
  const auto error = [&](double k) { return squared_error(nodes, candidate(k), energy); };
  int best = 0;
  double least = error(0);
  for (int k = 1; k < candidate_count; ++k)
    if (const double e = error(k); e < least) {
      least = e;
      best = k;
    }
  double lo = std::max(best - 1, 0), hi = std::min(best + 1, candidate_count - 1);
  const double ratio = 1.0 / std::numbers::phi;
  double a = hi - ratio * (hi - lo), b = lo + ratio * (hi - lo), at_a = error(a), at_b = error(b);
  while (hi - lo > 1e-5) {
    if (at_a <= at_b) {
      hi = b;
      b = a;
      at_b = at_a;
      at_a = error(a = hi - ratio * (hi - lo));
    } else {
      lo = a;
      a = b;
      at_a = at_b;
      at_b = error(b = lo + ratio * (hi - lo));
    }
  }
  // An edge of the row is an answer too; the section only comes near it.
  const double middle = 0.5 * (lo + hi);
  for (const double edge : {0.0, static_cast<double>(candidate_count - 1)})
    if (std::abs(middle - edge) < 1e-4) return candidate(edge);
  return candidate(middle);
}

}  // namespace

const char* outcome_name(GgxOutcome outcome) {
  switch (outcome) {
    case GgxOutcome::fitted:
      return "fitted";
    case GgxOutcome::too_narrow:
      return "too narrow";
    case GgxOutcome::too_wide:
      return "too wide";
    case GgxOutcome::no_lobe:
      break;
  }
  return "no lobe";
}

double ggx_factor(double alpha, double tan_h, double nh, double iz, double oz) {
  const double a2 = alpha * alpha, nh2 = nh * nh, b = nh2 * (a2 + tan_h * tan_h);
  const double d = a2 / (b * b);  // pi D
  const double v = 0.5 / (iz * std::sqrt(oz * oz * (1.0 - a2) + a2) + oz * std::sqrt(iz * iz * (1.0 - a2) + a2));
  return d * v;
}

double clearcoat_factor(double ior) {
  const double root = (ior - 1.0) / (ior + 1.0);
  return std::min(root * root / 0.04, 1.0);  // 0.04: of the extension's 1.5
}

double clearcoat_fresnel(double cosine, double factor) {
  return factor * PaintModel<double>().fresnel_schlick(cosine, 0.04);
}

GgxFit fit_ggx(const AnalyticPaint& paint, const MeanFlakes& flakes, std::optional<double> clearcoat, int node_count) {
  check_at_most(2, node_count, "nodes of a fit");
  const std::vector<Node> nodes = nodes_of(paint, flakes, clearcoat, node_count);
  GgxFit fit;
  dvec3 of_lobes(0.0), of_flakes(0.0);
  double norm = 0.0;
  for (const Node& node : nodes) {
    of_lobes += node.lobes * node.dx;
    of_flakes += node.flakes * node.dx;
    norm += node.luminance * node.luminance * node.luminance * node.cosine * node.cosine * node.dx;
  }
  fit.energy = of_lobes + of_flakes;
  const double energy = luminance_of(fit.energy);
  if (!(energy > least_reflectance)) return fit;

  fit.least_alpha = best_alpha(nodes, energy);
  fit.outcome = fit.least_alpha < least_engine_alpha ? GgxOutcome::too_narrow
                : fit.least_alpha >= 1.0             ? GgxOutcome::too_wide
                                                     : GgxOutcome::fitted;
  fit.alpha = std::clamp(fit.least_alpha, least_engine_alpha, 1.0);
  const double unit = engine_energy(nodes, fit.alpha);
  fit.lobes = of_lobes / unit;
  fit.flakes = of_flakes / unit;
  fit.error = std::sqrt(squared_error(nodes, fit.alpha, energy) / norm);
  return fit;
}

}  // namespace lackwerk::core
