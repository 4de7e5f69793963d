// Smooth versions of max, min and polyline: the alphabet the body is written in.
//
// Why it exists: a fillet made of a circle arc changes curvature abruptly and breaks the reflection running over it.
// The functions here are hyperbolas: every derivative is continuous, so highlights flow through every blend. Profiles
// keep the convexity of their control polyline, hence cannot wobble between control points the way an interpolating
// spline can.
//
// Everything is a value or a pure function; safe from any thread.
#pragma once

#include <cmath>
#include <vector>

namespace lackwerk::packs::car {

/// max(t, 0) with the corner rounded over about `rounding` on either side.
[[nodiscard]] inline double soft_ramp(double t, double rounding) {
  return 0.5 * (t + std::sqrt(t * t + rounding * rounding));
}

[[nodiscard]] inline double soft_max(double a, double b, double rounding) { return b + soft_ramp(a - b, rounding); }
[[nodiscard]] inline double soft_min(double a, double b, double rounding) { return b - soft_ramp(b - a, rounding); }

/// 0 below `from`, 1 above `to`, with continuous second derivatives; `from` may be greater than `to`.
[[nodiscard]] inline double smooth_step(double from, double to, double x) {
  const double t = std::fmin(1.0, std::fmax(0.0, (x - from) / (to - from)));
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// One corner of a control polyline.
struct ProfileKnot {
  double at = 0.0;        ///< abscissa, strictly rising along a profile
  double value = 0.0;     ///< height of the control polyline there
  double rounding = 0.0;  ///< how far the corner is rounded on either side; the two end knots ignore it
};

/// A polyline with individually rounded corners, continued straight beyond both ends.
class SoftProfile {
 public:
  explicit SoftProfile(const std::vector<ProfileKnot>& knots);  ///< needs at least two knots

  [[nodiscard]] double operator()(double x) const {
    double y = offset_ + slope_ * x;
    for (const Corner& corner : corners_) y += corner.turn * soft_ramp(x - corner.at, corner.rounding);
    return y;
  }

 private:
  struct Corner {
    double at, turn, rounding;
  };
  double offset_ = 0.0;
  double slope_ = 0.0;
  std::vector<Corner> corners_;
};

}  // namespace lackwerk::packs::car
