#include "kiosk/display/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lackwerk::kiosk {
namespace {

bool is_scale(double value) { return value >= least_calibration_scale && value <= most_calibration_scale; }

bool is_plausible(const input::CalibrationMatrix& m) {
  // Mirrored and turned panels are legal: lengths and area count, not signs.
  return input::is_usable(m) && is_scale(std::hypot(m[0], m[3])) && is_scale(std::hypot(m[1], m[4])) &&
         std::abs(m[0] * m[4] - m[1] * m[3]) >= least_calibration_scale * least_calibration_scale;
}

}  // namespace

Point calibrated(const input::CalibrationMatrix& m, Point p) {
  return {m[0] * p[0] + m[1] * p[1] + m[2], m[3] * p[0] + m[4] * p[1] + m[5]};
}

input::CalibrationMatrix composed(const input::CalibrationMatrix& a, const input::CalibrationMatrix& b) {
  return {a[0] * b[0] + a[1] * b[3], a[0] * b[1] + a[1] * b[4], a[0] * b[2] + a[1] * b[5] + a[2],
          a[3] * b[0] + a[4] * b[3], a[3] * b[1] + a[4] * b[4], a[3] * b[2] + a[4] * b[5] + a[5]};
}

std::optional<input::CalibrationMatrix> fit_calibration(const std::vector<Point>& reported,
                                                        const std::vector<Point>& meant) {
  if (reported.size() != meant.size() || reported.size() < 3) return std::nullopt;
  const auto n = static_cast<double>(reported.size());
  // About the means the shift drops out and two unknowns an axis remain.
  Point from{}, to{};
  for (std::size_t k = 0; k < reported.size(); ++k)
    for (std::size_t axis = 0; axis < 2; ++axis) {
      from[axis] += reported[k][axis] / n;
      to[axis] += meant[k][axis] / n;
    }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  std::array<double, 2> x_to{}, y_to{};
  for (std::size_t k = 0; k < reported.size(); ++k) {
    const double x = reported[k][0] - from[0], y = reported[k][1] - from[1];
    xx += x * x;
    xy += x * y;
    yy += y * y;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      x_to[axis] += x * (meant[k][axis] - to[axis]);
      y_to[axis] += y * (meant[k][axis] - to[axis]);
    }
  }
  const double det = xx * yy - xy * xy;
  // On a line, to 1e-3 of a spread that crosses at 10 % and 90 % have.
  if (!(det > 1e-6 * std::max(xx * yy, 1e-6))) return std::nullopt;
  input::CalibrationMatrix m{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    m[3 * axis] = (x_to[axis] * yy - y_to[axis] * xy) / det;
    m[3 * axis + 1] = (y_to[axis] * xx - x_to[axis] * xy) / det;
    m[3 * axis + 2] = to[axis] - m[3 * axis] * from[0] - m[3 * axis + 1] * from[1];
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < reported.size(); ++k) {
    const Point at = calibrated(m, reported[k]);
    squares += std::pow(at[0] - meant[k][0], 2) + std::pow(at[1] - meant[k][1], 2);
  }
  if (!(std::sqrt(squares / n) <= most_calibration_residual) || !is_plausible(m)) return std::nullopt;
  return m;
}

}  // namespace lackwerk::kiosk
