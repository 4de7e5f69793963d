// The paint model as a function of its parameters, with derivatives: what the fit turns.
//
// Why it exists: start search, Ceres and the report on a fit's condition must speak of the same vector of numbers. The
// model itself is paint_model.glsl's text (multi-lobe Cook-Torrance, Guenther et al. 2005, eq. 1, with D as in 5.2).
// Pure functions; any thread.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/analysis/brdf_fit_samples.hpp"
#include "core/paint.hpp"

namespace lackwerk::core {

/// Where each parameter stands: diffuse (one number per channel), then per lobe s (per channel), ln m, f0.
struct FitLayout {
  int lobes = 3;     ///< [0, max_lobes]
  int channels = 3;  ///< 3: colour per lobe; 1: grey lobes below a colour table

  [[nodiscard]] int count() const { return channels + lobes * (channels + 2); }
  [[nodiscard]] int s(int lobe, int channel) const { return channels + lobe * (channels + 2) + channel; }
  [[nodiscard]] int ln_m(int lobe) const { return s(lobe, channels); }
  [[nodiscard]] int f0(int lobe) const { return s(lobe, channels) + 1; }
  [[nodiscard]] double lower(int parameter) const;
  [[nodiscard]] double upper(int parameter) const;
  /// "diffuse.r", "lobe2.m", "lobe3.s" (grey). Lobes count from 1, by falling roughness.
  [[nodiscard]] std::string name(int parameter) const;
};

/// D G / (i_z o_z) of a lobe at a point, and its derivative by ln m.
struct LobeAtPoint {
  double shape = 0.0, by_ln_m = 0.0;
};
[[nodiscard]] LobeAtPoint lobe_at(const FitPoint& point, double m);

/// y at a point, and (if `jacobian` is not null) its derivatives, 3 rows of layout.count().
[[nodiscard]] glm::dvec3 model_at(const FitLayout& layout, const double* parameters, const FitPoint& point,
                                  double* jacobian = nullptr);

/// ln(dark + y) - ln(dark + target).
[[nodiscard]] glm::dvec3 log_error(const FitPoint& point, const glm::dvec3& y);

/// Parameters to a paint, lobes by falling roughness; lobes not used come last, with the last one's m and no weight.
[[nodiscard]] AnalyticPaint paint_of(const FitLayout& layout, std::span<const double> parameters);
/// The way back; the paint's table is not looked at. With one channel the green one is taken.
[[nodiscard]] std::vector<double> parameters_of(const FitLayout& layout, const AnalyticPaint& paint);

/// Where a point stands in a colour table: four nodes and their weights (bilinear, as paint_model.glsl's chi_factor).
struct TableTaps {
  std::size_t node[4];
  double weight[4];
};
[[nodiscard]] TableTaps table_taps(std::uint16_t num_theta, double theta_h, double theta_d);
/// chi there, at full precision (a pack holds it in 8 bits). (1, 1, 1) without a table.
[[nodiscard]] glm::dvec3 chi_at(const AnalyticPaint& paint, double theta_h, double theta_d);

/// The whole smooth part of a paint without coat and refraction as a BRDF. 0 where a direction is below the horizon.
[[nodiscard]] Brdf analytic_brdf(const AnalyticPaint& paint);

}  // namespace lackwerk::core
