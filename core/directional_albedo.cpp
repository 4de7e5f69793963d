#include "core/directional_albedo.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/paint_model.hpp"

namespace lackwerk::core {
namespace {

using Model = PaintModel<float>;
using glm::vec3;

/// Directions per entry, a Fibonacci number. Each follows its lobe, so that what is left to integrate is smooth but for
/// the edge of total reflection below a coat that bends: within 2 % of quadrature there, within 1 % elsewhere.
constexpr int lattice_size = 144;

struct Point {
  float u, v;
};
/// Fibonacci lattice shifted to the middle of its cells.
Point lattice(int k) {
  constexpr float golden = 0.618033988749895f;
  const float v = static_cast<float>(k) * golden;
  return {(static_cast<float>(k) + 0.5f) / lattice_size, v - std::floor(v)};
}

/// A half vector about +z whose density is D cos(theta) / pi (Guenther et al. 2005, 5.2: theta = atan(m sqrt(-ln u))).
vec3 beckmann_half(float m, Point p) {
  const float tan_h = m * std::sqrt(-std::log(1.0f - p.u));
  const float c = 1.0f / std::sqrt(1.0f + tan_h * tan_h);
  const float phi = 2.0f * std::numbers::pi_v<float> * p.v;
  return {tan_h * c * std::cos(phi), tan_h * c * std::sin(phi), c};
}

struct Terms {
  bool table = false;
  bool flakes = false;
};

/// One part at one viewing direction: albedo and mean direction of light.
class Integrator {
 public:
  Integrator(Model& model, Terms terms) : model_(model), terms_(terms) {}

  /// `resultant`: length of the mean of the directions, weighted by what they give; 1 = all from one direction.
  void entry(PaintTerm term, float m, float co, vec3& albedo, float& lean, float& resultant) const {
    const vec3 n(0, 0, 1);
    const vec3 o(std::sqrt(std::max(1.0f - co * co, 0.0f)), 0.0f, co);
    const vec3 r(-o.x, 0.0f, o.z);
    const float eta = model_.u_refraction_ior;
    const vec3 inside = model_.refract_into(o, n, eta);
    vec3 sum(0.0f), towards(0.0f);
    for (int k = 0; k < lattice_size; ++k) {
      vec3 i;
      const vec3 weight = term == PaintTerm::diffuse ? diffuse(k, o, inside, i) : lobe(term, m, k, o, inside, i);
      sum += weight;
      towards += i * (weight.x + weight.y + weight.z);
    }
    albedo = sum / static_cast<float>(lattice_size);
    // towards = a n + b r in the plane of incidence.
    const float b = std::abs(r.x) > 1e-4f ? towards.x / r.x : towards.z;
    const float a = std::abs(r.x) > 1e-4f ? towards.z - b * r.z : 0.0f;
    lean = a + b > 0.0f ? std::clamp(b / (a + b), 0.0f, 1.0f) : 1.0f;
    const float total = sum.x + sum.y + sum.z;
    resultant = total > 0.0f ? std::min(glm::length(towards) / total, 1.0f) : 1.0f;
  }

 private:
  [[nodiscard]] float coat(float ci, float co) const {
    return (1.0f - model_.fresnel_dielectric(ci, model_.u_coat_ior)) *
           (1.0f - model_.fresnel_dielectric(co, model_.u_coat_ior));
  }
  [[nodiscard]] vec3 chi(const Model::Geometry& g) const {
    return terms_.table ? model_.chi_factor(g.theta_h, g.theta_i) : vec3(1.0f);
  }

  /// Light from a cosine-distributed direction: density cos / pi cancels the cosine and the 1 / pi.
  vec3 diffuse(int k, const vec3& o, const vec3& inside, vec3& i) const {
    const Point p = lattice(k);
    const float radius = std::sqrt(p.u), phi = 2.0f * std::numbers::pi_v<float> * p.v;
    i = vec3(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1.0f - p.u));
    const vec3 n(0, 0, 1);
    const auto g = model_.paint_geometry(n, model_.refract_into(i, n, model_.u_refraction_ior), inside);
    return model_.u_diffuse * chi(g) * coat(i.z, o.z);
  }

  /// Light that a half vector drawn below the coat sends to the eye.
  vec3 lobe(PaintTerm term, float m, int k, const vec3& o, const vec3& inside, vec3& i) const {
    const vec3 n(0, 0, 1);
    i = n;
    const vec3 h = beckmann_half(m, lattice(k));
    const float ho = glm::dot(h, inside);
    if (ho <= MIN_COSINE_VALUE) return vec3(0.0f);
    const vec3 in = h * (2.0f * ho) - inside;
    if (in.z <= MIN_COSINE_VALUE) return vec3(0.0f);
    // Out of the coat: Snell; what is totally reflected inside never came from outside.
    const float eta = model_.u_refraction_ior;
    const float sine2 = (1.0f - in.z * in.z) * eta * eta;
    if (sine2 >= 1.0f) return vec3(0.0f);
    i = vec3(in.x * eta, in.y * eta, std::sqrt(1.0f - sine2));
    const auto g = model_.paint_geometry(n, in, inside);
    // L = integral rho/pi E cos_out dw_out, and cos_out dw_out = eta^2 cos_in dw_in; divided by the density of `in`,
    // D cos(theta_h) / (4 pi h.o).
    vec3 rho(0.0f);
    if (term == PaintTerm::flakes) {
      rho = model_.flake_mean(g.theta_h, g.theta_i);
    } else {
      const Model::vec4& s = model_.u_lobe[static_cast<int>(term) - 1];
      rho = vec3(s.x, s.y, s.z) *
            (model_.fresnel_schlick(g.ho, s.w) * model_.lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, 1.0f / m)) * chi(g);
    }
    const float x = g.tan_h / m;
    const float density = std::exp(-x * x) / (m * m * g.nh * g.nh * g.nh);  // D cos(theta_h)
    if (!(density > 1e-20f)) return vec3(0.0f);
    return rho * (coat(i.z, o.z) * eta * eta * in.z * 4.0f * ho / density);
  }

  static constexpr float MIN_COSINE_VALUE = 1.7e-3f;
  Model& model_;  // its functions, being GLSL too, cannot be const
  Terms terms_;
};

/// Mean resultant length of each environment level, found by the same integration: a white lobe at normal view.
std::array<float, environment_level_count> level_resultants() {
  std::array<float, environment_level_count> out{};
  out[0] = 1.0f;
  for (std::size_t k = 1; k < out.size(); ++k) {
    AnalyticPaint white;
    white.lobes[0] = {glm::dvec3(1.0), environment_levels[k].m, 1.0};
    Model model;
    bind_model(InterpolatablePaint{}, white, no_textures(), model);
    vec3 albedo;
    float lean = 0.0f;
    Integrator(model, {}).entry(PaintTerm::lobe0, static_cast<float>(environment_levels[k].m), 0.999f, albedo, lean,
                                out[k]);
  }
  return out;
}

/// The level between whose neighbours' spreads (1 - resultant) a spread lies. Spreads grow with m^2, so their roots are
/// interpolated.
float level_of_resultant(float resultant) {
  static const std::array<float, environment_level_count> known = level_resultants();
  const float root = std::sqrt(std::max(1.0f - resultant, 0.0f));
  for (std::size_t k = 1; k < known.size(); ++k) {
    const float low = std::sqrt(std::max(1.0f - known[k - 1], 0.0f)), high = std::sqrt(std::max(1.0f - known[k], 0.0f));
    if (root <= high) return static_cast<float>(k - 1) + std::clamp((root - low) / (high - low), 0.0f, 1.0f);
  }
  return static_cast<float>(known.size() - 1);
}

void integrate(Model& model, Terms terms, const AnalyticPaint& analytic, double flake_m, AlbedoTable& out) {
  const Integrator integrator(model, terms);
  for (int term = 0; term < paint_term_count; ++term) {
    AlbedoRow& row = out[static_cast<std::size_t>(term)];
    row = {};
    const bool is_lobe = term >= 1 && term <= 3;
    const Lobe& lobe = analytic.lobes[static_cast<std::size_t>(is_lobe ? term - 1 : 0)];
    if (term == 0 && analytic.diffuse == glm::dvec3(0.0)) continue;
    if (is_lobe && lobe.s == glm::dvec3(0.0)) continue;
    if (term == 4 && !terms.flakes) continue;
    const double m = term == 4 ? flake_m : lobe.m;
    for (int k = 0; k < albedo_columns; ++k) {
      float resultant = 1.0f;
      const float root = (static_cast<float>(k) + 0.5f) / albedo_columns;
      integrator.entry(static_cast<PaintTerm>(term), static_cast<float>(m), root * root,
                       row.albedo[static_cast<std::size_t>(k)], row.lean[static_cast<std::size_t>(k)], resultant);
      row.resultant[static_cast<std::size_t>(k)] = resultant;
      row.level[static_cast<std::size_t>(k)] = level_of_resultant(resultant);
    }
  }
}

}  // namespace

AlbedoRow merged_lobes(const AlbedoTable& table) {
  AlbedoRow out;
  for (std::size_t k = 0; k < albedo_columns; ++k) {
    float weight = 0.0f;
    for (std::size_t term = 1; term < table.size(); ++term) {
      const AlbedoRow& row = table[term];
      const auto w = static_cast<float>(luminance_of(glm::dvec3(row.albedo[k])));
      out.albedo[k] += row.albedo[k];
      out.lean[k] += w * row.lean[k];
      out.resultant[k] += w * row.resultant[k];
      weight += w;
    }
    out.lean[k] = weight > 0.0f ? out.lean[k] / weight : 1.0f;
    out.resultant[k] = weight > 0.0f ? out.resultant[k] / weight : 1.0f;
    out.level[k] = level_of_resultant(out.resultant[k]);
  }
  return out;
}

double flake_roughness(const InterpolatablePaint& paint, const PaintTextures& textures) {
  if (textures.row_count == 0) return 1.0;
  constexpr int steps = 128;
  const double end = std::numbers::pi / 2.0 * 0.999;
  double sum = 0.0, sum_tan2 = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double t = (k + 0.5) / steps * end;
    const double at = t / paint.layout.bin_width_rad();
    const int low = static_cast<int>(at);
    const double w = at - low;
    const glm::dvec3 mu = textures.mean_at(low, 0) * (1.0 - w) + textures.mean_at(low + 1, 0) * w;
    const double weight = (mu.x + mu.y + mu.z) * std::cos(t) * std::sin(t);
    sum += weight;
    sum_tan2 += weight * std::tan(t) * std::tan(t);
  }
  return sum > 0.0 ? std::clamp(std::sqrt(sum_tan2 / sum), 0.05, 1.0) : 1.0;
}

void directional_albedo(const InterpolatablePaint& paint, const AnalyticPaint& analytic, const PaintTextures& textures,
                        AlbedoTable& out) {
  Model model;
  bind_model(paint, analytic, textures, model);
  const Terms terms{textures.table_size > 0, textures.row_count > 0};
  integrate(model, terms, analytic, flake_roughness(paint, textures), out);
}

void directional_albedo(const AnalyticPaint& analytic, AlbedoTable& out) {
  const InterpolatablePaint nothing;
  Model model;
  bind_model(nothing, analytic, no_textures(), model);
  integrate(model, {}, analytic, 1.0, out);
}

}  // namespace lackwerk::core
