// The normal distribution's quantile function.
//
// Why it exists: random textures hold Gaussian values, and the fit of a flake's angular life needs the same thresholds
// the shader's ranks have. A pure function; any thread.
#pragma once

#include <cmath>

namespace lackwerk::core {

/// Quantile of the normal distribution for 0 < p <= 0.5 (the other half is its mirror image), relative error below
/// 1.2e-9. Source: P. J. Acklam, "An algorithm for computing the inverse normal cumulative distribution function",
/// 2003.
[[nodiscard]] inline double normal_lower_quantile(double p) {
  if (p < 0.02425) {
    const double q = std::sqrt(-2.0 * std::log(p));
    const double up = ((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838e+00) * q -
                        2.549732539343734e+00) *
                           q +
                       4.374664141464968e+00) *
                          q +
                      2.938163982698783e+00;
    const double down = (((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996e+00) * q +
                         3.754408661907416e+00) *
                            q +
                        1.0;
    return up / down;
  }
  const double q = p - 0.5;
  const double r = q * q;
  const double up = ((((-3.969683028665376e+01 * r + 2.209460984245205e+02) * r - 2.759285104469687e+02) * r +
                      1.383577518672690e+02) *
                         r -
                     3.066479806614716e+01) *
                        r +
                    2.506628277459239e+00;
  const double down = ((((-5.447609879822406e+01 * r + 1.615858368580409e+02) * r - 1.556989798598866e+02) * r +
                        6.680131188771972e+01) *
                           r -
                       1.328068155288572e+01) *
                          r +
                      1.0;
  return q * up / down;
}

/// The same for 0 < p < 1.
[[nodiscard]] inline double normal_quantile(double p) {
  return p > 0.5 ? -normal_lower_quantile(1.0 - p) : normal_lower_quantile(p);
}

}  // namespace lackwerk::core
