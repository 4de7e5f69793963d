#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "core/colour.hpp"
#include "core/realise.hpp"
#include "kiosk/tools/report/stiff_numbers.hpp"
#include "kiosk/tools/report/synthetic_pack.hpp"
#include "kiosk/tools/report/workbench.hpp"

namespace lackwerk::report {

namespace {

constexpr const char* kernel = "weights";
/// Clusters a row: enough for tuples of every kind, few enough for a second in all.
constexpr int clusters = 12;

core::RealisedPaint realised(const core::InterpolatablePaint& paint, const std::vector<double>& weights) {
  core::RealisedPaint out;
  core::realise(paint, core::Weights::uniform(weights), out);
  return out;
}

std::vector<double> corner(std::size_t paints, std::size_t k) {
  std::vector<double> out(paints, 0.0);
  out[k] = 1.0;
  return out;
}

int steps_between(const core::QuantisedCuboid& one, const core::QuantisedCuboid& two) {
  int worst = 0;
  for (std::size_t c = 0; c < 6; ++c) worst = std::max(worst, std::abs(int{one.q[c]} - int{two.q[c]}));
  return worst;
}

int steps_between(const core::RealisedPaint& one, const core::RealisedPaint& two) {
  int worst = 0;
  for (std::size_t k = 0; k < one.corners.size(); ++k)
    worst = std::max(worst, steps_between(one.corners[k], two.corners[k]));
  return worst;
}

/// Golla & Klein 2018, eq. 14 and 15, on the 16-bit grid of level 0, in long double: the corner is the weighted sum; a
/// box that extrapolation turned inside out is its middle.
core::QuantisedCuboid blended(const core::InterpolatablePaint& paint, std::size_t row, std::size_t tuple,
                              const std::vector<double>& weights) {
  core::QuantisedCuboid out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    long double lo = 0.0L, hi = 0.0L;
    for (std::size_t k = 0; k < paint.paints.size(); ++k) {
      const auto& part = paint.paints[k];
      const core::QuantisedCuboid& own = part.clusters[part.cluster_begin[row] + part.tuple_cluster[tuple]];
      lo += static_cast<long double>(weights[k]) * own.q[2 * axis];
      hi += static_cast<long double>(weights[k]) * own.q[2 * axis + 1];
    }
    if (lo > hi) lo = hi = 0.5L * (lo + hi);
    const auto on_grid = [](long double v) {
      return static_cast<std::uint16_t>(std::lround(std::clamp(v, 0.0L, 65535.0L)));
    };
    out.q[2 * axis] = on_grid(lo);
    out.q[2 * axis + 1] = on_grid(hi);
  }
  return out;
}

/// Largest number of steps between level 0 as realised and as blended in long double.
int steps_off(const core::InterpolatablePaint& paint, const core::RealisedPaint& out,
              const std::vector<double>& weights) {
  int worst = 0;
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  for (std::size_t row = 0; row < slices; ++row)
    for (std::size_t t = paint.tuple_begin[row]; t < paint.tuple_begin[row + 1]; ++t)
      worst = std::max(
          worst, steps_between(out.corners[row * static_cast<std::size_t>(out.width) + t - paint.tuple_begin[row]],
                               blended(paint, row, t, weights)));
  return worst;
}

int inside_out(const core::RealisedPaint& out) {
  int count = 0;
  for (const core::QuantisedCuboid& box : out.corners)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (box.q[2 * axis] > box.q[2 * axis + 1]) ++count;
  return count;
}

/// Mean of linear sRGB over the boxes of a slice at level 0, by midpoints in long double: L, a and b uniform in a box.
glm::dvec3 numeric_mean(const core::InterpolatablePaint& paint, const core::RealisedPaint& out, std::size_t slice) {
  constexpr int steps = 200;  // midpoints of a cube are off by 1 / (4 steps^2) of its spread
  const glm::dvec3 lo = paint.range.lo, step = (glm::dvec3(paint.range.hi) - lo) / 65535.0;
  long double xyz[3] = {};
  const std::size_t begin = paint.tuple_begin[slice];
  for (std::size_t t = begin; t < paint.tuple_begin[slice + 1]; ++t) {
    const auto& q = out.corners[slice * static_cast<std::size_t>(out.width) + t - begin].q;
    const auto at = [&](std::size_t axis, int k) {
      const double share = (k + 0.5) / steps;
      const auto c = static_cast<glm::length_t>(axis);
      return lo[c] + step[c] * (q[2 * axis] + share * (q[2 * axis + 1] - q[2 * axis]));
    };
    long double sum[3] = {};
    for (int i = 0; i < steps; ++i) {
      const long double y = (static_cast<long double>(at(0, i)) + 16.0L) / 116.0L;
      sum[1] += core::lab_inverse(y) * steps;
      for (int j = 0; j < steps; ++j) {
        sum[0] += core::lab_inverse(y + static_cast<long double>(at(1, j)) / 500.0L);
        sum[2] += core::lab_inverse(y - static_cast<long double>(at(2, j)) / 200.0L);
      }
    }
    for (int c = 0; c < 3; ++c)
      xyz[c] += sum[c] * (static_cast<long double>(paint.mass[t]) / (static_cast<long double>(steps) * steps));
  }
  glm::dvec3 rgb(0.0);
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c)
      rgb[row] += core::xyz_to_rgb[row][c] * core::white_xyz[c] * static_cast<double>(xyz[c]) / paint.row_mass;
  return glm::max(rgb, glm::dvec3(0.0));
}

void judge(std::size_t paints, Findings& findings) {
  const auto made = synthetic_pack(paints, clusters);
  const std::string of = std::to_string(paints) + (paints == 1 ? " paint" : " paints");
  if (!made) {
    add_case(findings, kernel, of, "packs that cannot be built", 1.0, 0.0, made.error().line());
    return;
  }
  const core::InterpolatablePaint paint = made->view();
  int at_corners = 0, beside = 0;
  for (std::size_t k = 0; k < paints; ++k) {
    const core::RealisedPaint there = realised(paint, corner(paints, k));
    const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
    for (std::size_t row = 0; row < slices * paint.level_count; ++row)
      for (std::size_t t = paint.tuple_begin[row]; t < paint.tuple_begin[row + 1]; ++t)
        at_corners = std::max(
            at_corners,
            steps_between(there.corners[row * static_cast<std::size_t>(there.width) + t - paint.tuple_begin[row]],
                          blended(paint, row, t, corner(paints, k))));
    if (paints == 1) continue;
    std::vector<double> near = corner(paints, k);
    near[k] -= 1e-12;
    near[(k + 1) % paints] += 1e-12;
    beside = std::max(beside, steps_between(realised(paint, near), there));
  }
  add_case(findings, kernel, of + ", at each of them", "grid steps off the paint's own boxes", at_corners, 0.0);
  const std::vector<double> even(paints, 1.0 / static_cast<double>(paints));
  const core::RealisedPaint mix = realised(paint, even);
  add_case(findings, kernel, of + ", evenly mixed", "grid steps off eq. 14 and 15 in long double",
           steps_off(paint, mix, even), 1.0);
  double mean_off = 0.0;
  std::size_t mean_at = 0;
  for (const std::size_t slice : {std::size_t{0}, std::size_t{30}, std::size_t{66}}) {
    const glm::dvec3 reference = numeric_mean(paint, mix, slice), mean = mix.flake_mean[slice];
    const double off = glm::length(mean - reference) / glm::length(reference);
    if (off <= mean_off) continue;
    mean_off = off;
    mean_at = slice;
  }
  // 1 / (4 * 200^2) of the spread of cubes whose means are a fifth of their largest, and floats at the end.
  add_case(findings, kernel, of + ", evenly mixed", "mean of the flakes off its integral, relative", mean_off, 1e-4,
           "slice " + std::to_string(mean_at));
  std::vector<double> off_by_little = even;
  off_by_little[0] += 1e-7;
  add_case(findings, kernel, of + ", weights of sum 1 + 1e-7", "grid steps off the even mix",
           steps_between(realised(paint, off_by_little), mix), 1.0);
  if (paints == 1) return;
  add_case(findings, kernel, of + ", 1e-12 beside each of them", "grid steps off the paint", beside, 1.0);
  int turned = 0, far_off = 0;
  for (const double beyond : {1.5, 3.0}) {
    std::vector<double> far(paints, -(beyond - 1.0) / static_cast<double>(paints - 1));
    far[0] = beyond;
    const core::RealisedPaint out = realised(paint, far);
    turned += inside_out(out);
    far_off = std::max(far_off, steps_off(paint, out, far));
  }
  add_case(findings, kernel, of + ", extrapolated to 3", "boxes inside out", turned, 0.0);
  add_case(findings, kernel, of + ", extrapolated to 3", "grid steps off eq. 14 and 15 in long double", far_off, 1.0);
}

}  // namespace

void add_stiff_weights(Findings& findings) {
  for (std::size_t paints = 1; paints <= core::max_paints; ++paints) judge(paints, findings);
}

}  // namespace lackwerk::report
