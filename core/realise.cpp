#include "core/realise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/check.hpp"
#include "core/colour.hpp"
#include "core/flake_means.hpp"
#include "core/realise_corners.hpp"

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
  realise_flakes(paint, weights, out);
}

void realise_flakes(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out) {
  realise_flake_means(paint, weights, out);
  realise_flake_levels(paint, weights, 1, paint.level_count, out);
}

void realise_flake_means(const InterpolatablePaint& paint, const Weights& weights, RealisedPaint& out) {
  realise_level0(paint, weights, out);
  realise_means(paint, out);
}

void realise_flake_levels(const InterpolatablePaint& paint, const Weights& weights, int first, int last,
                          RealisedPaint& out) {
  realise_levels(paint, weights, first, last, out);
}

}  // namespace lackwerk::core
