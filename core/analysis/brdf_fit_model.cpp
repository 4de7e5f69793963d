#include "core/analysis/brdf_fit_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

using Model = PaintModel<double>;

constexpr double max_weight = 1e3;      // as captures allow
constexpr double max_tan_ratio = 16.0;  // where lobe_shape clamps tan(theta_h) / m

void bind(const AnalyticPaint& paint, Model& out) {
  out.u_diffuse = paint.diffuse;
  for (int k = 0; k < 3; ++k) {
    const Lobe& lobe = paint.lobes[static_cast<std::size_t>(k)];
    out.u_lobe[k] = glm::dvec4(lobe.s, lobe.f0);
    out.u_inv_m[k] = 1.0 / lobe.m;
  }
}

}  // namespace

double FitLayout::lower(int parameter) const {
  for (int k = 0; k < lobes; ++k)
    if (parameter == ln_m(k)) return std::log(min_roughness);
  return 0.0;
}

double FitLayout::upper(int parameter) const {
  for (int k = 0; k < lobes; ++k) {
    if (parameter == ln_m(k)) return 0.0;
    if (parameter == f0(k)) return 1.0;
  }
  return max_weight;
}

std::string FitLayout::name(int parameter) const {
  const auto with_channel = [&](const std::string& text, int channel) {
    return channels == 1 ? text : text + "." + "rgb"[channel];
  };
  if (parameter < channels) return with_channel("diffuse", parameter);
  const int lobe = (parameter - channels) / (channels + 2);
  const std::string prefix = "lobe" + std::to_string(lobe + 1) + ".";
  if (parameter == ln_m(lobe)) return prefix + "m";
  if (parameter == f0(lobe)) return prefix + "f0";
  return with_channel(prefix + "s", parameter - s(lobe, 0));
}

LobeAtPoint lobe_at(const FitPoint& point, double m) {
  const double inv_m = 1.0 / m;
  Model model;  // only its functions are used
  const double shape = model.lobe_shape(point.tan_h, point.nh, point.ho, point.iz, point.oz, inv_m, 1.0);
  const double ratio = point.tan_h * inv_m;
  // ln D = -2 ln m - tan^2/m^2 + ...; beyond the clamp the lobe is 0 in any case.
  return {shape, shape * (2.0 * ratio * ratio - 2.0) * (ratio < max_tan_ratio ? 1.0 : 0.0)};
}

glm::dvec3 model_at(const FitLayout& layout, const double* parameters, const FitPoint& point, double* jacobian) {
  const int n = layout.count();
  const auto channel = [&](int c) { return layout.channels == 1 ? 0 : c; };
  glm::dvec3 sum(0.0);
  if (jacobian != nullptr) std::fill(jacobian, jacobian + 3 * n, 0.0);
  for (int c = 0; c < 3; ++c) {
    sum[c] = parameters[channel(c)];
    if (jacobian != nullptr) jacobian[c * n + channel(c)] = point.scale * point.chi[c];
  }
  for (int k = 0; k < layout.lobes; ++k) {
    const LobeAtPoint lobe = lobe_at(point, std::exp(parameters[layout.ln_m(k)]));
    const double f0 = parameters[layout.f0(k)];
    const double fresnel = f0 + (1.0 - f0) * point.schlick;
    for (int c = 0; c < 3; ++c) {
      const double s = parameters[layout.s(k, channel(c))];
      sum[c] += s * fresnel * lobe.shape;
      if (jacobian == nullptr) continue;
      const double scale = point.scale * point.chi[c];
      double* row = jacobian + c * n;
      row[layout.s(k, channel(c))] = scale * fresnel * lobe.shape;
      row[layout.ln_m(k)] = scale * s * fresnel * lobe.by_ln_m;
      row[layout.f0(k)] = scale * s * (1.0 - point.schlick) * lobe.shape;
    }
  }
  return sum * point.chi * point.scale + point.known;
}

glm::dvec3 log_error(const FitPoint& point, const glm::dvec3& y) {
  glm::dvec3 out;
  for (int c = 0; c < 3; ++c) out[c] = std::log((point.dark + y[c]) / (point.dark + point.target[c]));
  return out;
}

AnalyticPaint paint_of(const FitLayout& layout, std::span<const double> parameters) {
  const auto at = [&](int k) { return parameters[static_cast<std::size_t>(k)]; };
  const auto colour = [&](int first) {
    return layout.channels == 1 ? glm::dvec3(at(first)) : glm::dvec3(at(first), at(first + 1), at(first + 2));
  };
  AnalyticPaint paint;
  paint.diffuse = colour(0);
  const auto used = static_cast<std::size_t>(layout.lobes);
  for (int k = 0; k < layout.lobes; ++k)
    paint.lobes[static_cast<std::size_t>(k)] = {colour(layout.s(k, 0)),
                                                std::clamp(std::exp(at(layout.ln_m(k))), min_roughness, 1.0),
                                                std::clamp(at(layout.f0(k)), 0.0, 1.0)};
  std::stable_sort(paint.lobes.begin(), paint.lobes.begin() + static_cast<std::ptrdiff_t>(used),
                   [](const Lobe& a, const Lobe& b) { return a.m > b.m; });
  for (std::size_t k = used; k < max_lobes; ++k)
    paint.lobes[k] = {glm::dvec3(0.0), used > 0 ? paint.lobes[used - 1].m : 1.0, 1.0};
  return paint;
}

std::vector<double> parameters_of(const FitLayout& layout, const AnalyticPaint& paint) {
  std::vector<double> out(static_cast<std::size_t>(layout.count()));
  const auto put = [&](int first, const glm::dvec3& v) {
    const auto from = static_cast<std::size_t>(first);
    for (int c = 0; c < layout.channels; ++c)
      out[from + static_cast<std::size_t>(c)] = layout.channels == 1 ? v.y : v[c];
  };
  put(0, paint.diffuse);
  for (int k = 0; k < layout.lobes; ++k) {
    const Lobe& lobe = paint.lobes[static_cast<std::size_t>(k)];
    put(layout.s(k, 0), lobe.s);
    out[static_cast<std::size_t>(layout.ln_m(k))] = std::log(lobe.m);
    out[static_cast<std::size_t>(layout.f0(k))] = lobe.f0;
  }
  return out;
}

TableTaps table_taps(std::uint16_t num_theta, double theta_h, double theta_d) {
  const double quarter = std::numbers::pi / 2.0, last = num_theta - 1.0;
  const double h = std::clamp(theta_h / quarter, 0.0, 1.0) * last;
  const double i = std::clamp(std::min(theta_d, quarter - theta_h) / quarter, 0.0, 1.0) * last;
  const double h0 = std::min(std::floor(h), last - 1.0), i0 = std::min(std::floor(i), last - 1.0);
  const auto node = static_cast<std::size_t>(i0) * num_theta + static_cast<std::size_t>(h0);
  const double wh = h - h0, wi = i - i0;
  return {{node, node + 1, node + num_theta, node + num_theta + 1},
          {(1.0 - wh) * (1.0 - wi), wh * (1.0 - wi), (1.0 - wh) * wi, wh * wi}};
}

glm::dvec3 chi_at(const AnalyticPaint& paint, double theta_h, double theta_d) {
  if (!paint.table) return glm::dvec3(1.0);
  const TableTaps taps = table_taps(paint.table->num_theta, theta_h, theta_d);
  glm::dvec3 sum(0.0);
  for (int k = 0; k < 4; ++k) sum += glm::dvec3(paint.table->linear[taps.node[k]]) * taps.weight[k];
  return sum;
}

Brdf analytic_brdf(const AnalyticPaint& paint) {
  Model lobes;
  bind(paint, lobes);
  return [lobes, paint](const glm::dvec3& in, const glm::dvec3& out) mutable {
    if (!(in.z > 0.0 && out.z > 0.0)) return glm::dvec3(0.0);
    const auto g = lobes.paint_geometry({0.0, 0.0, 1.0}, in, out);
    return lobes.lobes_factor(g, 1.0) * chi_at(paint, g.theta_h, g.theta_i) / std::numbers::pi;
  };
}

}  // namespace lackwerk::core
