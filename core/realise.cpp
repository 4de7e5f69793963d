#include "core/realise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "core/level_balance.hpp"

namespace lackwerk::core {

namespace {

using WeightArray = std::array<double, max_paints>;

/// A paint's real lobes (s != 0) by falling roughness.
struct SortedLobes {
  std::array<const Lobe*, max_lobes> lobe{};
  std::size_t count = 0;
};

bool is_real(const Lobe& lobe) { return lobe.s != glm::dvec3(0.0); }

SortedLobes sort_lobes(const AnalyticPaint& paint) {
  SortedLobes sorted;
  for (const Lobe& lobe : paint.lobes) {
    if (!is_real(lobe)) continue;
    std::size_t place = sorted.count++;
    for (; place > 0 && sorted.lobe[place - 1]->m < lobe.m; --place) sorted.lobe[place] = sorted.lobe[place - 1];
    sorted.lobe[place] = &lobe;
  }
  return sorted;
}

/// What a lobe that a paint lacks counts as: s = 0, and m and F0 of its partners, so that fading it out changes its
/// strength and not its shape. The partners count by their weight; the small constant keeps the result continuous
/// where no partner has any.
Lobe stand_in(const std::array<const Lobe*, max_paints>& partners, const WeightArray& weights, std::size_t paints) {
  Lobe lobe{glm::dvec3(0.0), 0.0, 0.0};
  double total = 0.0;
  for (std::size_t k = 0; k < paints; ++k) {
    if (partners[k] == nullptr) continue;
    const double weight = std::max(weights[k], 0.0) + 1e-3;
    lobe.m += weight * partners[k]->m;
    lobe.f0 += weight * partners[k]->f0;
    total += weight;
  }
  lobe.m /= total;
  lobe.f0 /= total;
  return lobe;
}

void blend_lobes(const InterpolatablePaint& paint, const WeightArray& weights, AnalyticPaint& out) {
  const std::size_t paints = paint.paints.size();
  std::array<SortedLobes, max_paints> sorted;
  for (std::size_t k = 0; k < paints; ++k) sorted[k] = sort_lobes(paint.paints[k].analytic);

  std::array<Lobe, max_lobes> blended{};
  for (std::size_t slot = 0; slot < max_lobes; ++slot) {
    std::array<const Lobe*, max_paints> partners{};
    bool any = false;
    for (std::size_t k = 0; k < paints; ++k) {
      if (slot < sorted[k].count) partners[k] = sorted[k].lobe[slot];
      any = any || partners[k] != nullptr;
    }
    if (!any) continue;
    const Lobe absent = stand_in(partners, weights, paints);
    Lobe sum{glm::dvec3(0.0), 0.0, 0.0};
    for (std::size_t k = 0; k < paints; ++k) {
      const Lobe& lobe = partners[k] != nullptr ? *partners[k] : absent;
      sum.s += weights[k] * lobe.s;
      sum.m += weights[k] * lobe.m;
      sum.f0 += weights[k] * lobe.f0;
    }
    blended[slot] = sum;
  }
  out.lobes = blended;
}

/// chi of a table at node (bin_h, bin_i) of a grid of `edge` nodes, in Lab; bilinear in Lab between its own nodes.
glm::vec3 table_lab(const ColourTable& table, int edge, int bin_h, int bin_i) {
  const int own = table.num_theta;
  const auto node = [&](int h, int i) {
    return lab_from_linear(
        table.linear[static_cast<std::size_t>(i) * static_cast<std::size_t>(own) + static_cast<std::size_t>(h)]);
  };
  if (own == edge) return node(bin_h, bin_i);
  const float scale = static_cast<float>(own - 1) / static_cast<float>(edge - 1);
  const float x = static_cast<float>(bin_h) * scale;
  const float y = static_cast<float>(bin_i) * scale;
  const int x0 = std::min(static_cast<int>(x), own - 2);
  const int y0 = std::min(static_cast<int>(y), own - 2);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const glm::vec3 lower = node(x0, y0) * (1.0f - fx) + node(x0 + 1, y0) * fx;
  const glm::vec3 upper = node(x0, y0 + 1) * (1.0f - fx) + node(x0 + 1, y0 + 1) * fx;
  return lower * (1.0f - fy) + upper * fy;
}

/// Blends chi. The result has a table whenever any paint has one, whatever the weights, and always of the largest
/// size among them: a renderer need not rebuild anything during a drag.
void blend_tables(const InterpolatablePaint& paint, const WeightArray& weights, AnalyticPaint& out) {
  int edge = 0;
  for (const auto& part : paint.paints)
    if (part.analytic.table) edge = std::max<int>(edge, part.analytic.table->num_theta);
  if (edge < 2) {
    out.table.reset();
    return;
  }
  if (!out.table) out.table.emplace();
  out.table->num_theta = static_cast<std::uint16_t>(edge);
  out.table->linear.resize(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    const auto& table = paint.paints[k].analytic.table;
    bool alone = weights[k] == 1.0;
    for (std::size_t other = 0; other < max_paints; ++other) alone = alone && (other == k || weights[other] == 0.0);
    if (alone && table && table->num_theta == edge) {
      std::copy(table->linear.begin(), table->linear.end(), out.table->linear.begin());
      return;
    }
  }
  std::size_t index = 0;
  for (int bin_i = 0; bin_i < edge; ++bin_i) {
    for (int bin_h = 0; bin_h < edge; ++bin_h, ++index) {
      glm::vec3 lab(0.0f);
      for (std::size_t k = 0; k < paint.paints.size(); ++k) {
        if (weights[k] == 0.0) continue;
        const auto& table = paint.paints[k].analytic.table;
        lab += static_cast<float>(weights[k]) *
               (table ? table_lab(*table, edge, bin_h, bin_i) : glm::vec3(100.0f, 0.0f, 0.0f));
      }
      out.table->linear[index] = linear_from_lab(lab);
    }
  }
}

/// Blends all parameters as the weights say, whether they stay in their ranges or not.
void blend_unclamped(const InterpolatablePaint& paint, const Weights& weights, AnalyticPaint& out) {
  WeightArray base{};
  std::copy(weights.base.begin(), weights.base.end(), base.begin());
  glm::dvec3 diffuse(0.0);
  double coat = 0.0;
  double refraction = 0.0;
  for (std::size_t k = 0; k < paint.paints.size(); ++k) {
    diffuse += base[k] * paint.paints[k].analytic.diffuse;
    coat += base[k] * paint.paints[k].analytic.coat_ior;
    refraction += base[k] * paint.paints[k].analytic.refraction_ior;
  }
  out.diffuse = diffuse;
  out.coat_ior = coat;
  out.refraction_ior = refraction;
  blend_lobes(paint, base, out);
  blend_tables(paint, base, out);
}

void clamp_analytic(AnalyticPaint& out) {
  for (int c = 0; c < 3; ++c) out.diffuse[c] = std::max(out.diffuse[c], 0.0);
  out.coat_ior = std::max(out.coat_ior, 1.0);
  out.refraction_ior = std::max(out.refraction_ior, 1.0);
  for (Lobe& lobe : out.lobes) {
    for (int c = 0; c < 3; ++c) lobe.s[c] = std::max(lobe.s[c], 0.0);
    lobe.m = std::clamp(lobe.m, min_roughness, 1.0);
    lobe.f0 = std::clamp(lobe.f0, 0.0, 1.0);
  }
  // Extrapolation may change the order of roughness; a sum of lobes does not care, the paint's contract does.
  const auto before = [](const Lobe& one, const Lobe& two) { return is_real(one) && (!is_real(two) || one.m > two.m); };
  for (std::size_t last = 1; last < max_lobes; ++last)
    for (std::size_t i = last; i > 0 && before(out.lobes[i], out.lobes[i - 1]); --i)
      std::swap(out.lobes[i], out.lobes[i - 1]);
  if (!out.table) return;
  for (glm::vec3& chi : out.table->linear) chi = {std::max(chi.x, 0.0f), std::max(chi.y, 0.0f), std::max(chi.z, 0.0f)};
}

void blend_analytic(const InterpolatablePaint& paint, const Weights& weights, AnalyticPaint& out) {
  blend_unclamped(paint, weights, out);
  clamp_analytic(out);
}

/// Weighted corners of one paint's clusters of one row: four floats of minima (L, a, b, -), then four of maxima.
using WeightedClusters = std::array<float, max_clusters_per_row * 8>;

void weigh_clusters(std::span<const QuantisedCuboid> clusters, float lightness, float colour, WeightedClusters& out) {
  float* to = out.data();
  for (const QuantisedCuboid& cuboid : clusters) {
    to[0] = lightness * static_cast<float>(cuboid.q[0]);
    to[1] = colour * static_cast<float>(cuboid.q[2]);
    to[2] = colour * static_cast<float>(cuboid.q[4]);
    to[3] = 0.0f;
    to[4] = lightness * static_cast<float>(cuboid.q[1]);
    to[5] = colour * static_cast<float>(cuboid.q[3]);
    to[6] = colour * static_cast<float>(cuboid.q[5]);
    to[7] = 0.0f;
    to += 8;
  }
}

/// Blended corners of one row, minima and maxima apart. One spare float: each tuple is written four wide.
struct RowCorners {
  std::array<float, max_tuples_per_row * 3 + 1> lo;
  std::array<float, max_tuples_per_row * 3 + 1> hi;
  std::array<float, max_tuples_per_row> lightness_lo, lightness_hi;  ///< L once more, side by side
};

/// Scales a row's boxes to the mean luminance of level 0 of their slice (level_balance.hpp).
void balance_row(double level0, double strength, std::span<const std::uint32_t> mass, const LabRange& range,
                 RowCorners& corners) {
  const std::size_t tuples = mass.size();
  const double own = mean_luminance(std::span(corners.lightness_lo).first(tuples),
                                    std::span(corners.lightness_hi).first(tuples), mass, range);
  const LabGain gain(row_gain(level0, own, strength), range);
  for (std::size_t t = 0; t < tuples; ++t)
    for (auto* corner : {&corners.lo, &corners.hi}) {
      float* q = corner->data() + 3 * t;
      q[0] = gain.lightness(q[0]);
      q[1] = gain.colour(q[1], 0);
      q[2] = gain.colour(q[2], 1);
    }
}

/// Takes colour out of a row's boxes: a and b scaled by 1 - white. Scaling about a = b = 0 commutes with the balance of
/// levels, and L stays, so that luminance does too. A grid whose range leaves 0 out gives the nearest it has.
void whiten_row(double white, const LabRange& range, std::size_t tuples, RowCorners& corners) {
  const auto kept = static_cast<float>(1.0 - white);
  std::array<float, 2> added{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto c = static_cast<glm::length_t>(axis + 1);
    const double span = static_cast<double>(range.hi[c]) - static_cast<double>(range.lo[c]);
    // The grid's number for 0; a range without width has only one colour anyway.
    const double zero = span > 0.0 ? -static_cast<double>(range.lo[c]) / span * 65535.0 : 0.0;
    added[axis] = static_cast<float>(white * zero);
  }
  for (std::size_t t = 0; t < tuples; ++t)
    for (auto* corner : {&corners.lo, &corners.hi})
      for (std::size_t axis = 0; axis < 2; ++axis) {
        float& q = (*corner)[3 * t + 1 + axis];
        q = kept * q + added[axis];
      }
}

/// Rounds to the 16-bit grid. Where extrapolation turned a box inside out, it has shrunk to its middle: that keeps
/// min <= max, is continuous in the weights and leaves upright boxes untouched to the bit.
void round_row(const RowCorners& corners, std::size_t tuples, QuantisedCuboid* out) {
  static_assert(std::endian::native == std::endian::little, "min and max are stored as one 32-bit word");
  std::array<std::uint32_t, max_tuples_per_row * 3> words;
  constexpr float to_nearest = 0.5f;  // what follows is never negative
  const std::size_t count = tuples * 3;
  for (std::size_t i = 0; i < count; ++i) {
    const float middle = 0.5f * (corners.lo[i] + corners.hi[i]);
    const float lo = std::min(corners.lo[i], middle);
    const float hi = std::max(corners.hi[i], middle);
    const int lo_q = static_cast<int>(std::min(std::max(lo, 0.0f), 65535.0f) + to_nearest);
    const int hi_q = static_cast<int>(std::min(std::max(hi, 0.0f), 65535.0f) + to_nearest);
    words[i] = static_cast<std::uint32_t>(lo_q) | static_cast<std::uint32_t>(hi_q) << 16;
  }
  for (std::size_t t = 0; t < tuples; ++t)
    out[t] = std::bit_cast<QuantisedCuboid>(std::array{words[3 * t], words[3 * t + 1], words[3 * t + 2]});
}

/// Far beyond any useful extrapolation; keeps every sum below finite.
float bounded(double weight) { return static_cast<float>(std::clamp(weight, -1e6, 1e6)); }

void realise_corners(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out) {
  const std::size_t rows = static_cast<std::size_t>(paint.row_count());
  const std::size_t paints = paint.paints.size();
  std::size_t width = 0;
  for (std::size_t row = 0; row < rows; ++row)
    width = std::max<std::size_t>(width, paint.tuple_begin[row + 1] - paint.tuple_begin[row]);
  check_at_most(width, static_cast<std::size_t>(max_tuples_per_row), "tuples of a row");
  out.width = static_cast<int>(width);
  out.corners.resize(rows * width);

  std::array<WeightedClusters, max_paints> weighted;
  RowCorners corners;
  const double strength = balance_strength(weights.flake_lightness);
  const double white = std::clamp(weights.flake_white, 0.0, 1.0);
  const auto slices = static_cast<std::size_t>(paint.layout.slice_count());
  out.level0_luminance.resize(strength > 0.0 ? slices : 0);
  std::size_t slice = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin = paint.tuple_begin[row];
    const std::size_t tuples = paint.tuple_begin[row + 1] - begin;
    std::array<const std::uint8_t*, max_paints> cluster_of{};
    for (std::size_t k = 0; k < paints; ++k) {
      const auto& part = paint.paints[k];
      const std::size_t clusters = part.cluster_begin[row + 1] - part.cluster_begin[row];
      check_at_most(clusters, static_cast<std::size_t>(max_clusters_per_row), "clusters of a row");
      weigh_clusters(part.clusters.subspan(part.cluster_begin[row], clusters), bounded(weights.flake_lightness[k]),
                     bounded(weights.flake_colour[k]), weighted[k]);
      cluster_of[k] = part.tuple_cluster.data() + begin;
    }
    for (std::size_t t = 0; t < tuples; ++t) {
      float sum[8] = {};
      for (std::size_t k = 0; k < paints; ++k) {
        const float* from = weighted[k].data() + std::size_t{8} * cluster_of[k][t];
        for (int i = 0; i < 8; ++i) sum[i] += from[i];
      }
      for (std::size_t i = 0; i < 4; ++i) corners.lo[3 * t + i] = sum[i];
      for (std::size_t i = 0; i < 4; ++i) corners.hi[3 * t + i] = sum[4 + i];
      corners.lightness_lo[t] = sum[0];
      corners.lightness_hi[t] = sum[4];
    }
    if (strength > 0.0) {
      const auto mass = paint.mass.subspan(begin, tuples);
      if (row < slices)
        out.level0_luminance[row] = mean_luminance(std::span(corners.lightness_lo).first(tuples),
                                                   std::span(corners.lightness_hi).first(tuples), mass, paint.range);
      else
        balance_row(out.level0_luminance[slice], strength, mass, paint.range, corners);
    }
    if (white > 0.0) whiten_row(white, paint.range, tuples, corners);
    QuantisedCuboid* to = out.corners.data() + row * width;
    round_row(corners, tuples, to);
    std::fill(to + tuples, to + width, QuantisedCuboid{});
    if (++slice == slices) slice = 0;
  }
}

/// The part of E[lab_inverse(s)] that the cube s^3 does not have: 0 above the toe. s = c + U1 + U2 with U1, U2 uniform
/// in +-h1, +-h2. With u = delta - s > 0 the toe is s^3 + r(u), r(u) = u^3 - 3 delta u^2, so its mean is a difference
/// of antiderivatives of r: exact, up to rounding (boxes thinner than 1e-7 count as flat, error below 1e-14).
double toe_mean(double c, double h1, double h2) {
  constexpr double d = lab_delta;
  constexpr double flat = 1e-7;
  const auto first = [](double s) {  // integral of r from 0 to u
    const double u = std::max(d - s, 0.0);
    return u * u * u * (u / 4.0 - d);
  };
  const auto second = [](double s) {  // and once more
    const double u = std::max(d - s, 0.0);
    return u * u * u * u * (u / 20.0 - d / 4.0);
  };
  if (h1 < h2) std::swap(h1, h2);
  if (h1 < flat) {
    const double u = std::max(d - c, 0.0);
    return u * u * (u - 3.0 * d);
  }
  if (h2 < flat) return (first(c - h1) - first(c + h1)) / (2.0 * h1);
  return (second(c - h1 - h2) - second(c - h1 + h2) - second(c + h1 - h2) + second(c + h1 + h2)) / (4.0 * h1 * h2);
}

/// E[lab_inverse(s)] for s as above. The third moment of a symmetric sum is c^3 + 3 c variance.
double inverse_mean(double c, double h1, double h2) {
  constexpr double d = lab_delta;
  if (c + h1 + h2 <= d) return 3.0 * d * d * (c - 2.0 / 3.0 * d);
  const double cube = c * (c * c + h1 * h1 + h2 * h2);
  return c - h1 - h2 >= d ? cube : cube + toe_mean(c, h1, h2);
}

/// Mean linear RGB of each slice at level 0: L, a, b are independent and uniform in each box, XYZ are functions of
/// L, of L and a, and of L and b, so that three one-dimensional means do.
void realise_means(const InterpolatablePaint& paint, RealisedPaint& out) {
  const std::size_t slices = static_cast<std::size_t>(paint.level_count > 0 ? paint.layout.slice_count() : 0);
  out.flake_mean.assign(slices, glm::vec3(0.0f));
  const glm::dvec3 lo = paint.range.lo;
  const glm::dvec3 step = (glm::dvec3(paint.range.hi) - lo) / (2.0 * 65535.0);  // halves: middles are sums of two
  for (std::size_t slice = 0; slice < slices; ++slice) {
    const QuantisedCuboid* tuple = out.corners.data() + slice * static_cast<std::size_t>(out.width);
    double xyz[3] = {};
    std::uint64_t total = 0;
    for (std::size_t t = paint.tuple_begin[slice]; t < paint.tuple_begin[slice + 1]; ++t, ++tuple) {
      const auto& q = tuple->q;
      const double mass = paint.mass[t];
      const double y = (lo.x + step.x * (q[0] + q[1]) + 16.0) / 116.0;
      const double y_half = step.x * (q[1] - q[0]) / 116.0;
      const double a = (lo.y + step.y * (q[2] + q[3])) / 500.0;
      const double b = (lo.z + step.z * (q[4] + q[5])) / 200.0;
      xyz[0] += mass * inverse_mean(y + a, y_half, step.y * (q[3] - q[2]) / 500.0);
      xyz[1] += mass * inverse_mean(y, y_half, 0.0);
      xyz[2] += mass * inverse_mean(y - b, y_half, step.z * (q[5] - q[4]) / 200.0);
      total += paint.mass[t];
    }
    if (total == 0) continue;
    for (int c = 0; c < 3; ++c) xyz[c] *= white_xyz[c] / static_cast<double>(total);
    for (int c = 0; c < 3; ++c) {
      const double value = xyz_to_rgb[c][0] * xyz[0] + xyz_to_rgb[c][1] * xyz[1] + xyz_to_rgb[c][2] * xyz[2];
      out.flake_mean[slice][c] = static_cast<float>(std::max(value, 0.0));
    }
  }
}

Result<void> check_group(const std::vector<double>& group, std::size_t paints, const char* field) {
  if (group.size() != paints)
    return fail({}, field, std::to_string(group.size()) + " weights for " + std::to_string(paints) + " paints",
                "give one weight per paint", ErrorKind::usage);
  double sum = 0.0;
  for (const double weight : group) {
    if (!std::isfinite(weight)) return fail({}, field, "a weight is not a finite number", {}, ErrorKind::usage);
    sum += weight;
  }
  if (!(std::abs(sum - 1.0) <= weight_sum_tolerance))
    return fail({}, field, "weights sum to " + std::to_string(sum), "make them sum to 1", ErrorKind::usage);
  return {};
}

}  // namespace

Result<void> check_weights(const InterpolatablePaint& paint, const Weights& weights) {
  const std::size_t paints = paint.paints.size();
  if (auto ok = check_group(weights.base, paints, "weights.base"); !ok) return ok;
  if (auto ok = check_group(weights.flake_lightness, paints, "weights.flake_lightness"); !ok) return ok;
  if (auto ok = check_group(weights.flake_colour, paints, "weights.flake_colour"); !ok) return ok;
  if (!(weights.flake_white >= 0.0 && weights.flake_white <= 1.0))  // so that NaN is refused
    return fail({}, "weights.flake_white", std::to_string(weights.flake_white) + " is outside [0, 1]",
                "0 leaves the flakes their colour, 1 takes it out", ErrorKind::usage);
  return {};
}

AnalyticPaint extrapolate_analytic(const InterpolatablePaint& paint, const Weights& weights) {
  AnalyticPaint out;
  blend_unclamped(paint, weights, out);
  return out;
}

AnalyticPaint realise_analytic(const InterpolatablePaint& paint, const Weights& weights) {
  AnalyticPaint out;
  blend_analytic(paint, weights, out);
  return out;
}

std::array<double, 2> InterpolatablePaint::flake_cells_per_bin() const {
  const double bin_deg = layout.num_theta > 0 ? 90.0 / layout.num_theta : 0.0;
  const auto cells = [&](float cell_deg) { return cell_deg < widest_cell_deg ? bin_deg / double{cell_deg} : 0.0; };
  std::array<double, 2> sum{};
  int counted = 0;
  const auto measured = [](const PaintPart& part) { return part.life.origin != LifeOrigin::assumed; };
  const bool any = std::any_of(paints.begin(), paints.end(), measured);
  for (const PaintPart& part : paints) {
    if (any && !measured(part)) continue;
    sum = {sum[0] + cells(part.life.cell_h_deg), sum[1] + cells(part.life.cell_i_deg)};
    ++counted;
  }
  return {sum[0] / std::max(counted, 1), sum[1] / std::max(counted, 1)};
}

void realise(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out) {
  check_at_most(paint.paints.size(), static_cast<std::size_t>(max_paints), "paints of a pack");
  check_equal(weights.base.size(), paint.paints.size(), "base weights");
  check_equal(weights.flake_lightness.size(), paint.paints.size(), "flake lightness weights");
  check_equal(weights.flake_colour.size(), paint.paints.size(), "flake colour weights");
  blend_analytic(paint, weights, out.analytic);
  realise_corners(paint, weights, out);
  realise_means(paint, out);
}

}  // namespace lackwerk::core
