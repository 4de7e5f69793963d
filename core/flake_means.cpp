#include "core/flake_means.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/colour.hpp"
#include "core/lanes.hpp"

namespace lackwerk::core {
namespace {

/// Below this a half width counts as none: the differences below would have no digits left. Error below 1e-14.
constexpr double flat = 1e-7;

/// The part of E[lab_inverse(s)] that the cube s^3 does not have: 0 above the toe. s = c + U1 + U2 with U1, U2 uniform
/// in +-h1, +-h2. With u = delta - s > 0 the toe is s^3 + r(u), r(u) = u^3 - 3 delta u^2, so its mean is a difference
/// of antiderivatives of r, once for each of U1 and U2: exact, up to rounding. This is where one of them is flat.
double toe_mean_flat(double c, double h) {
  constexpr double d = lab_delta;
  const auto first = [](double s) {  // integral of r from 0 to u
    const double u = std::max(d - s, 0.0);
    return u * u * u * (u / 4.0 - d);
  };
  if (h < flat) {
    const double u = std::max(d - c, 0.0);
    return u * u * (u - 3.0 * d);
  }
  return (first(c - h) - first(c + h)) / (2.0 * h);
}

/// r integrated twice, from 0 to u = delta - s.
inline void add_second(const FourDoubles& s, double sign, FourDoubles& sum) {
  constexpr double d = lab_delta;
  FourDoubles u = d - s;
  u = u > 0.0 ? u : FourDoubles{};
  const FourDoubles square = u * u;
  sum += sign * (square * square * (u * (1.0 / 20.0) - d / 4.0));
}

/// Adds the toe's part to the lanes of `mean` whose boxes lie across it.
template <class Mask>
void add_toe(const FourDoubles& c, const FourDoubles& h1, const FourDoubles& h2, const Mask& across,
             FourDoubles& mean) {
  FourDoubles sum{};
  add_second(c - h1 - h2, 1.0, sum);
  add_second(c - h1 + h2, -1.0, sum);
  add_second(c + h1 - h2, -1.0, sum);
  add_second(c + h1 + h2, 1.0, sum);
  const Mask wide = across & (h1 >= flat) & (h2 >= flat);
  const FourDoubles area = 4.0 * h1 * h2;
  mean += wide ? sum / (wide ? area : FourDoubles{} + 1.0) : FourDoubles{};
  for (int lane = 0; lane < 3; ++lane)
    if (across[lane] != 0 && wide[lane] == 0) mean[lane] += toe_mean_flat(c[lane], std::max(h1[lane], h2[lane]));
}

/// From a row's boxes on the grid to the sums that Lab's formula is applied to: lane 0 for X (of L and a), 1 for Y (of
/// L alone), 2 for Z (of L and b). Each is uniform in middle +- half1 plus uniform in +- half2.
struct SumsOfBoxes {
  FourDoubles zero;       ///< middle where all of the grid's numbers are 0
  FourDoubles lightness;  ///< per number of L: half of its step, for middles are sums of two
  FourDoubles colour;     ///< the same of a (lane 0) and b (lane 2), with its sign

  explicit SumsOfBoxes(const LabRange& range) {
    const glm::dvec3 lo = range.lo, half = (glm::dvec3(range.hi) - lo) / (2.0 * 65535.0);
    const double y = (lo.x + 16.0) / 116.0;
    zero = FourDoubles{y + lo.y / 500.0, y, y - lo.z / 200.0, 0.0};
    const double step = half.x / 116.0;
    lightness = FourDoubles{step, step, step, 0.0};
    colour = FourDoubles{half.y / 500.0, 0.0, -half.z / 200.0, 0.0};
  }
};

/// E[lab_inverse] of one row's boxes, each times its mass, summed: X, Y, Z.
///
/// Most boxes lie above the toe, where the mean is a cube (the third moment of a symmetric sum is c^3 + 3 c variance),
/// or below, where it is a line; those across it are few.
glm::dvec3 summed_means(const SumsOfBoxes& sums, std::span<const std::uint32_t> mass, const QuantisedCuboid* tuple) {
  constexpr double d = lab_delta;
  FourDoubles total{};
  for (const std::uint32_t one : mass) {
    const auto& q = tuple->q;
    const FourInts ab_sum{q[2] + q[3], 0, q[4] + q[5], 0}, ab_extent{q[3] - q[2], 0, q[5] - q[4], 0};
    const double l_sum = q[0] + q[1], l_extent = q[1] - q[0], count = one;
    const FourDoubles c =
        sums.zero + sums.lightness * l_sum + sums.colour * __builtin_convertvector(ab_sum, FourDoubles);
    const FourDoubles h1 = sums.lightness * l_extent;
    FourDoubles h2 = sums.colour * __builtin_convertvector(ab_extent, FourDoubles);
    h2 = h2 < 0.0 ? -h2 : h2;
    FourDoubles mean = c + h1 + h2 <= d ? 3.0 * d * d * (c - 2.0 / 3.0 * d) : c * (c * c + h1 * h1 + h2 * h2);
    const auto across = (c - h1 - h2 < d) & (c + h1 + h2 > d);
    if ((across[0] | across[1] | across[2]) != 0) add_toe(c, h1, h2, across, mean);
    total += mean * count;
    ++tuple;
  }
  return {total[0], total[1], total[2]};
}

}  // namespace

// L, a, b are independent and uniform in each box, XYZ are functions of L, of L and a, and of L and b, so that three
// one-dimensional means do.
void realise_means(const InterpolatablePaint& paint, RealisedPaint& out) {
  const std::size_t slices = static_cast<std::size_t>(paint.level_count > 0 ? paint.layout.slice_count() : 0);
  out.flake_mean.assign(slices, glm::vec3(0.0f));
  const SumsOfBoxes sums(paint.range);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    const std::size_t begin = paint.tuple_begin[slice];
    const auto mass = paint.mass.subspan(begin, paint.tuple_begin[slice + 1] - begin);
    if (mass.empty()) continue;  // a row's masses sum to row_mass, which is above 0
    glm::dvec3 xyz = summed_means(sums, mass, out.corners.data() + slice * static_cast<std::size_t>(out.width));
    for (int c = 0; c < 3; ++c) xyz[c] *= white_xyz[c] / static_cast<double>(paint.row_mass);
    for (int c = 0; c < 3; ++c) {
      const double value = xyz_to_rgb[c][0] * xyz[0] + xyz_to_rgb[c][1] * xyz[1] + xyz_to_rgb[c][2] * xyz[2];
      out.flake_mean[slice][c] = static_cast<float>(std::max(value, 0.0));
    }
  }
}

}  // namespace lackwerk::core
