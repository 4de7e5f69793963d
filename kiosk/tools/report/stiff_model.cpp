#include "kiosk/tools/report/stiff_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/colour.hpp"
#include "kiosk/tools/find_recipe.hpp"
#include "kiosk/tools/report/half_model.hpp"
#include "kiosk/tools/report/workbench.hpp"
#include "packs/tools/recipe.hpp"

namespace lackwerk::report {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
/// MIN_COSINE of paint_model.glsl is that of 89.9 degrees. Closer to it than this the cosine's own 16-bit grid, 2e-6 at
/// 3e-3, is a thousandth of it: past it lies the edge where a lobe is cut off.
constexpr double judged_deg = 89.79;

glm::dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double on_half_grid(double value) { return double{half_value(half_bits(static_cast<float>(value)))}; }
glm::dvec3 on_half_grid(const glm::dvec3& v) { return {on_half_grid(v.x), on_half_grid(v.y), on_half_grid(v.z)}; }

template <class Model>
glm::dvec3 factor_of(const core::AnalyticPaint& paint, const DirectionPair& at) {
  using T = typename Model::real;
  using V3 = typename Model::vec3;
  Model model;
  core::bind_model(core::InterpolatablePaint(), paint, core::no_textures(), model);
  const auto vector = [](const glm::dvec3& v) {
    return V3(T(static_cast<float>(v.x)), T(static_cast<float>(v.y)), T(static_cast<float>(v.z)));
  };
  const V3 factor = model.paint_factor(V3(T(0), T(0), T(1)), vector(at.light), vector(at.eye), {}, T(0), T(0));
  return {static_cast<double>(factor.x), static_cast<double>(factor.y), static_cast<double>(factor.z)};
}

using Real = long double;

Real plain_fresnel(Real cosine, Real index) {
  if (index == 1.0L) return 0.0L;
  const Real inside = std::sqrt(1.0L - (1.0L - cosine * cosine) / (index * index));
  const Real across = (cosine - index * inside) / (cosine + index * inside);
  const Real along = (index * cosine - inside) / (index * cosine + inside);
  return 0.5L * (across * across + along * along);
}

glm::vec<3, Real> plain_refracted(const glm::vec<3, Real>& d, Real index) {
  // Snell's law for the part across the normal; directions on the 16-bit grid are not exactly of length 1, and the
  // model takes their cosine as it stands.
  return {d.x / index, d.y / index, std::sqrt(1.0L - (1.0L - d.z * d.z) / (index * index))};
}

/// Where the model cuts lobes off: MIN_COSINE of paint_model.glsl.
constexpr Real least_cosine = 1.7e-3L;

/// The larger of relative and absolute difference: below 1 a radiance factor's absolute error is what shows.
double difference(const glm::dvec3& value, const glm::dvec3& reference) {
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double off = std::abs(value[c] - reference[c]) / std::max(1.0, std::abs(reference[c]));
    if (!(off <= worst)) worst = off;
  }
  return worst;
}

bool is_number(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Collects one figure over many pairs.
struct Spread {
  std::vector<double> values;
  double worst = -1.0;
  std::string where;
  void take(double value, const std::string& at) {
    values.push_back(value);
    if (std::isnan(worst) || value <= worst) return;
    worst = value;
    where = at;
  }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
  }
  [[nodiscard]] double p99() {
    if (values.empty()) return 0.0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }
};

void add(Findings& findings, const std::string& name, const char* measure, double worst, double bound,
         const std::string& where) {
  StiffCase found;
  found.kernel = "paint model";
  found.name = name;
  found.measure = measure;
  found.worst = worst;
  found.bound = bound;
  found.where = where;
  findings.stiff.push_back(std::move(found));
}

/// One lobe of weight 0.1 that no published paint has: at the ends of every parameter.
core::AnalyticPaint extreme_paint(double m, double f0, double coat, double refraction) {
  core::AnalyticPaint paint;
  paint.diffuse = glm::dvec3(0.05);
  paint.lobes[0] = {glm::dvec3(0.1), m, f0};
  paint.coat_ior = coat;
  paint.refraction_ior = refraction;
  return paint;
}

/// Lobes narrower than this are none in 16 bits: directions have steps of 5e-4 there, half the width of m = 1e-3.
constexpr double least_m_in_16_bits = 0.01;

/// Double against the plain formulas, float against double, 16 bits against double, over all pairs.
void judge(const std::string& name, const core::AnalyticPaint& paint, const std::vector<DirectionPair>& pairs,
           Findings& findings) {
  const bool holds_16_bits = std::all_of(paint.lobes.begin(), paint.lobes.end(), [](const core::Lobe& lobe) {
    return lobe.s == glm::dvec3(0.0) || lobe.m >= least_m_in_16_bits;
  });
  Spread text, wide, single, half;
  int no_numbers = 0;
  std::string no_number_at;
  for (const DirectionPair& at : pairs) {
    const glm::dvec3 reference = model_factor(paint, at, ModelPrecision::long_double);
    const glm::dvec3 in_double = model_factor(paint, at, ModelPrecision::double_float);
    const glm::dvec3 in_float = model_factor(paint, at, ModelPrecision::single_float);
    const glm::dvec3 in_half = model_factor(paint, at, ModelPrecision::half);
    for (const glm::dvec3& value : {in_double, in_float, in_half})
      if (!is_number(value) && no_numbers++ == 0) no_number_at = at.where;
    text.take(difference(reference, plain_factor(paint, at)), at.where);
    wide.take(difference(in_double, reference), at.where);
    single.take(shown_difference(in_float, reference, at.light.z), at.where);
    half.take(shown_difference(in_half, in_double, at.light.z), at.where);
  }
  // The text's constants have the digits of a double.
  add(findings, name, "text at long double against plain formulas, relative (absolute below 1)", text.worst, 1e-11,
      text.where);
  // A direction's rounding of 1e-16 over the least m of 1e-4 is 1e-12 of tan/m, which exp(-(tan/m)^2) multiplies by at
  // most 2 tan/m where anything is left of it: 6.
  add(findings, name, "double against long double, relative (absolute below 1)", wide.worst, 1e-11, wide.where);
  // 24 bits give 2e-6 of a power of 30; half a step of 8 bits is CIEDE2000 of 0.1 at the least.
  add(findings, name, "float against long double, CIEDE2000", single.worst, 0.1, single.where);
  if (!holds_16_bits) {
    add(findings, name, "values that are no numbers", no_numbers, 0.0,
        no_numbers > 0 ? no_number_at
                       : "too narrow for 16 bits, which are off by CIEDE2000 " + digits(half.mean()) +
                             " in the mean, " + digits(half.worst) + " at " + half.where);
    return;
  }
  add(findings, name, "values that are no numbers", no_numbers, 0.0, no_number_at);
  add(findings, name, "16 bits against double, mean CIEDE2000", half.mean(), 1.0, half.where);
  const std::string where = half.where;
  add(findings, name, "16 bits against double, p99 CIEDE2000", half.p99(), 3.0, where);
}

/// Past the angle up to which 16 bits are judged, and past where the model cuts lobes off: numbers, whatever they are.
void judge_beyond(const std::string& name, const core::AnalyticPaint& paint, bool quick, Findings& findings) {
  Spread half;
  int no_numbers = 0;
  std::string where;
  for (const double limit : {89.85, 89.9, 89.95, 89.99, 89.999, 89.9999})
    for (const DirectionPair& at : direction_pairs(limit, quick)) {
      if (at.light.z >= std::cos(judged_deg * degree) && at.eye.z >= std::cos(judged_deg * degree)) continue;
      const glm::dvec3 in_double = model_factor(paint, at, ModelPrecision::double_float);
      for (const auto precision : {ModelPrecision::long_double, ModelPrecision::single_float, ModelPrecision::half})
        if (!is_number(model_factor(paint, at, precision)) && no_numbers++ == 0) where = at.where;
      if (!is_number(in_double) && no_numbers++ == 0) where = at.where;
      half.take(shown_difference(model_factor(paint, at, ModelPrecision::half), in_double, at.light.z), at.where);
    }
  add(findings, name + ", beyond 89.79 degrees", "values that are no numbers", no_numbers, 0.0,
      where.empty() ? "16 bits are off by CIEDE2000 " + digits(half.mean()) + " in the mean, " + digits(half.worst) +
                          " at " + half.where
                    : where);
}

std::vector<std::pair<std::string, core::AnalyticPaint>> extreme_paints() {
  std::vector<std::pair<std::string, core::AnalyticPaint>> out;
  for (const double m : {1e-4, 1e-3, 0.01, 0.05, 0.3, 1.0})
    for (const double index : {1.0, 1.05, 1.5, 2.5})
      out.emplace_back("m " + digits(m) + ", coat of " + digits(index), extreme_paint(m, 0.5, index, index));
  for (const double f0 : {0.0, 1.0}) out.emplace_back("F0 " + digits(f0), extreme_paint(0.1, f0, 1.5, 1.0));
  core::AnalyticPaint none = extreme_paint(0.1, 0.5, 1.5, 1.5);
  none.lobes[0] = core::Lobe{};
  out.emplace_back("no lobes", none);
  return out;
}

}  // namespace

std::vector<DirectionPair> direction_pairs(double limit_deg, bool quick) {
  std::vector<double> lights{0.0, 30.0, 60.0, 75.0, 85.0, 89.0, limit_deg};
  std::vector<double> tilts{0.0, 0.1, 0.5, 2.0, 10.0, 40.0};
  if (!quick) {
    lights = {0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0, 88.0, 89.0, 89.5, limit_deg};
    tilts = {0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0};
  }
  std::vector<DirectionPair> out;
  out.reserve(lights.size() * tilts.size() * 3);
  // A little more than the limit, for the grid of 16 bits moves it.
  const double least = 0.999 * std::cos(limit_deg * degree);
  for (const double light : lights)
    for (const double tilt : tilts)
      for (const double side : {0.0, 90.0, 180.0}) {
        const glm::dvec3 i = direction(light * degree, 0.0), h = direction(tilt * degree, side * degree);
        const glm::dvec3 o = 2.0 * glm::dot(i, h) * h - i;
        if (o.z < least) continue;
        out.push_back(
            {on_half_grid(i), on_half_grid(o),
             "light " + digits(light) + ", half vector " + digits(tilt) + " at " + digits(side) + " degrees"});
      }
  return out;
}

Result<std::vector<std::pair<std::string, core::AnalyticPaint>>> published_paints() {
  std::vector<std::pair<std::string, core::AnalyticPaint>> out;
  for (const char* name : {"gu_2k_acrylack", "gu_blue", "gu_blue_matte", "gu_bmw_339", "gu_ford_f8", "gu_opel_titan",
                           "gu_polaris_silber", "gu_white"})
    for (const char* coat : {"", "_coated"}) {
      const auto recipe = packs::read_recipe(tools::find_recipe(std::string(name) + coat));
      if (!recipe) return tl::unexpected(recipe.error());
      out.emplace_back(recipe->identity.name, recipe->analytic);
    }
  return out;
}

glm::dvec3 model_factor(const core::AnalyticPaint& paint, const DirectionPair& at, ModelPrecision precision) {
  switch (precision) {
    case ModelPrecision::long_double:
      return factor_of<core::PaintModel<long double>>(paint, at);
    case ModelPrecision::double_float:
      return factor_of<core::PaintModel<double>>(paint, at);
    case ModelPrecision::single_float:
      return factor_of<core::PaintModel<float>>(paint, at);
    case ModelPrecision::half:
      break;
  }
  return factor_of<HalfModel>(paint, at);
}

glm::dvec3 plain_factor(const core::AnalyticPaint& paint, const DirectionPair& at) {
  using Vector = glm::vec<3, Real>;
  const Vector light(at.light), eye(at.eye);
  if (light.z <= 0.0L || eye.z <= 0.0L) return glm::dvec3(0.0);
  const Real coat = paint.coat_ior, index = paint.refraction_ior;
  const Real through = (1.0L - plain_fresnel(light.z, coat)) * (1.0L - plain_fresnel(eye.z, coat));
  const Vector i = plain_refracted(light, index), o = plain_refracted(eye, index);
  const Vector sum = i + o;
  const Real length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  const Real nh = sum.z / length, ho = 0.5L * length;
  const Real tan2 = (sum.x * sum.x + sum.y * sum.y) / (sum.z * sum.z);
  Vector factor(paint.diffuse);
  if (i.z > least_cosine && o.z > least_cosine)
    for (const core::Lobe& lobe : paint.lobes) {
      if (lobe.s == glm::dvec3(0.0)) continue;
      const Real m = lobe.m, f0 = lobe.f0;
      const Real d = std::exp(-tan2 / (m * m)) / (m * m * nh * nh * nh * nh);
      const Real f = f0 + (1.0L - f0) * std::pow(std::clamp(1.0L - ho, 0.0L, 1.0L), 5.0L);
      const Real g = std::min({1.0L, 2.0L * nh * i.z / ho, 2.0L * nh * o.z / ho});
      factor += Vector(lobe.s) * (d * f * g / (i.z * o.z));
    }
  return glm::dvec3(factor * through);
}

double shown_difference(const glm::dvec3& one, const glm::dvec3& two, double cosine) {
  const auto shown = [&](const glm::dvec3& factor) {
    glm::dvec3 out;
    for (int c = 0; c < 3; ++c) out[c] = std::clamp(factor[c] * cosine, 0.0, 1.0);
    return core::lab_from_linear(out);
  };
  return core::ciede2000(shown(one), shown(two));
}

void add_stiff_model(bool quick, Findings& findings) {
  const std::vector<DirectionPair> pairs = direction_pairs(judged_deg, quick);
  const auto published = published_paints();
  if (!published) {
    add(findings, "published paints", "recipes that cannot be read", 1.0, 0.0, published.error().line());
  } else {
    for (const auto& [name, paint] : *published) {
      judge(name, paint, pairs, findings);
      judge_beyond(name, paint, quick, findings);
    }
  }
  for (const auto& [name, paint] : extreme_paints()) {
    judge(name, paint, pairs, findings);
    judge_beyond(name, paint, quick, findings);
  }

  // Directions that cancel: i = -o has no half vector, and no light passes.
  int no_numbers = 0;
  for (const double theta : {0.0, 45.0, 89.0, 90.0})
    for (const auto precision : {ModelPrecision::long_double, ModelPrecision::double_float,
                                 ModelPrecision::single_float, ModelPrecision::half}) {
      const glm::dvec3 i = direction(theta * degree, 0.3);
      const glm::dvec3 factor = model_factor(extreme_paint(0.1, 0.5, 1.5, 1.5), {i, -i, {}}, precision);
      if (!is_number(factor) || factor != glm::dvec3(0.0)) ++no_numbers;
    }
  add(findings, "opposite directions", "values that are not 0", no_numbers, 0.0, "");
}

}  // namespace lackwerk::report
