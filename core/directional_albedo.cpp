#include "core/directional_albedo.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

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

/// A half vector about +z whose density is D cos(theta) / pi (Guenther et al. 2005, 5.2: theta = atan(m sqrt(-ln u))),
/// so that exp(-tan^2/m^2) is 1 - u itself.
struct HalfVector {
  vec3 h;
  float tan_h, theta_h;
  float density;  ///< D cos(theta)
};
using HalfVectors = std::array<HalfVector, lattice_size>;

HalfVectors half_vectors(float m) {
  HalfVectors out;
  for (int k = 0; k < lattice_size; ++k) {
    const Point p = lattice(k);
    const float tan_h = m * std::sqrt(-std::log(1.0f - p.u));
    const float c = 1.0f / std::sqrt(1.0f + tan_h * tan_h);
    const float phi = 2.0f * std::numbers::pi_v<float> * p.v;
    out[static_cast<std::size_t>(k)] = {{tan_h * c * std::cos(phi), tan_h * c * std::sin(phi), c},
                                        tan_h,
                                        std::atan(tan_h),
                                        (1.0f - p.u) / (m * m * c * c * c)};
  }
  return out;
}

struct Terms {
  bool table = false;
  bool flakes = false;
};

/// One part of a paint at one viewing direction after the other: albedo and mean direction of light.
class Integrator {
 public:
  /// `m`: of a lobe or the flakes; the diffuse part has none.
  Integrator(Model& model, Terms terms, PaintTerm term, float m)
      : model_(model), terms_(terms), term_(term), halves_(half_vectors(m)) {}

  /// `resultant`: length of the mean of the directions, weighted by what they give; 1 = all from one direction.
  void entry(float co, vec3& albedo, float& lean, float& resultant) const {
    const vec3 n(0, 0, 1);
    const vec3 o(std::sqrt(std::max(1.0f - co * co, 0.0f)), 0.0f, co);
    const vec3 r(-o.x, 0.0f, o.z);
    const float eta = model_.u_refraction_ior;
    const vec3 inside = model_.refract_into(o, n, eta);
    vec3 sum(0.0f), towards(0.0f);
    for (int k = 0; k < lattice_size; ++k) {
      vec3 i;
      const vec3 weight =
          term_ == PaintTerm::diffuse ? diffuse(k, inside, i) : lobe(halves_[static_cast<std::size_t>(k)], inside, i);
      sum += weight;
      towards += i * (weight.x + weight.y + weight.z);
    }
    albedo = sum * (through_coat(co) / static_cast<float>(lattice_size));
    // towards = a n + b r in the plane of incidence.
    const float b = std::abs(r.x) > 1e-4f ? towards.x / r.x : towards.z;
    const float a = std::abs(r.x) > 1e-4f ? towards.z - b * r.z : 0.0f;
    lean = a + b > 0.0f ? std::clamp(b / (a + b), 0.0f, 1.0f) : 1.0f;
    const float total = sum.x + sum.y + sum.z;
    resultant = total > 0.0f ? std::min(glm::length(towards) / total, 1.0f) : 1.0f;
  }

 private:
  [[nodiscard]] float through_coat(float cosine) const {
    return 1.0f - model_.fresnel_dielectric(cosine, model_.u_coat_ior);
  }
  [[nodiscard]] vec3 chi(const Model::Geometry& g) const {
    return terms_.table ? model_.chi_factor(g.theta_h, g.theta_i) : vec3(1.0f);
  }

  /// Light from a cosine-distributed direction: density cos / pi cancels the cosine and the 1 / pi.
  vec3 diffuse(int k, const vec3& inside, vec3& i) const {
    const Point p = lattice(k);
    const float radius = std::sqrt(p.u), phi = 2.0f * std::numbers::pi_v<float> * p.v;
    i = vec3(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1.0f - p.u));
    const vec3 n(0, 0, 1);
    const auto g = model_.paint_geometry(n, model_.refract_into(i, n, model_.u_refraction_ior), inside);
    return model_.u_diffuse * chi(g) * through_coat(i.z);
  }

  /// Light that a half vector drawn below the coat sends to the eye.
  vec3 lobe(const HalfVector& half, const vec3& inside, vec3& i) const {
    const vec3 n(0, 0, 1);
    i = n;
    const float ho = glm::dot(half.h, inside);
    if (ho <= MIN_COSINE_VALUE || half.density <= 1e-20f) return vec3(0.0f);
    const vec3 in = half.h * (2.0f * ho) - inside;
    if (in.z <= MIN_COSINE_VALUE) return vec3(0.0f);
    // Out of the coat: Snell; what is totally reflected inside never came from outside.
    const float eta = model_.u_refraction_ior;
    const float sine2 = (1.0f - in.z * in.z) * eta * eta;
    if (sine2 >= 1.0f) return vec3(0.0f);
    i = vec3(in.x * eta, in.y * eta, std::sqrt(1.0f - sine2));
    // What paint_geometry(n, in, inside) gives, from the half vector that is known already.
    const Model::Geometry g{in.z, inside.z, half.h.z, ho, half.tan_h, half.theta_h, std::acos(std::min(ho, 1.0f))};
    // L = integral rho/pi E cos_out dw_out, and cos_out dw_out = eta^2 cos_in dw_in; divided by the density of `in`,
    // D cos(theta_h) / (4 pi h.o).
    vec3 rho(0.0f);
    if (term_ == PaintTerm::flakes) {
      rho = model_.flake_mean(g.theta_h, g.theta_i);
    } else {
      const int number = static_cast<int>(term_) - 1;
      const Model::vec4& s = model_.u_lobe[number];
      rho = vec3(s.x, s.y, s.z) *
            (model_.fresnel_schlick(g.ho, s.w) *
             model_.lobe_shape(g.tan_h, g.nh, g.ho, g.iz, g.oz, model_.u_inv_m[number], 1.0f)) *
            chi(g);
    }
    return rho * (through_coat(i.z) * eta * eta * in.z * 4.0f * ho / half.density);
  }

  static constexpr float MIN_COSINE_VALUE = 1.7e-3f;
  Model& model_;  // its functions, being GLSL too, cannot be const
  Terms terms_;
  PaintTerm term_;
  HalfVectors halves_;
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
    Integrator(model, {}, PaintTerm::lobe0, static_cast<float>(environment_levels[k].m))
        .entry(0.999f, albedo, lean, out[k]);
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

/// Fills the row of a part; `m` as Integrator takes it.
void fill_row(Model& model, Terms terms, PaintTerm term, double m, AlbedoRow& row) {
  const Integrator integrator(model, terms, term, static_cast<float>(m));
  for (std::size_t k = 0; k < albedo_columns; ++k) {
    const float root = (static_cast<float>(k) + 0.5f) / albedo_columns;
    integrator.entry(root * root, row.albedo[k], row.lean[k], row.resultant[k]);
    row.level[k] = level_of_resultant(row.resultant[k]);
  }
}

/// A part's numbers, as far as the paint's surface is concerned; nothing where it shows nothing.
std::optional<AlbedoSource::Part> part_of(const AnalyticPaint& analytic, int term, double flake_m) {
  AlbedoSource::Part part;
  if (term == 0) {
    if (analytic.diffuse == glm::dvec3(0.0)) return std::nullopt;
    part.lobe.s = analytic.diffuse;
  } else if (term == 4) {
    part.lobe.m = flake_m;
  } else {
    part.lobe = analytic.lobes[static_cast<std::size_t>(term) - 1];
    if (part.lobe.s == glm::dvec3(0.0)) return std::nullopt;
  }
  part.coat_ior = analytic.coat_ior;
  part.refraction_ior = analytic.refraction_ior;
  return part;
}

void integrate(Model& model, Terms terms, const AnalyticPaint& analytic, double flake_m, const PaintTextures& textures,
               AlbedoTable& out) {
  AlbedoSource& source = out.source;
  const bool same_chi = source.table_size == textures.table_size && source.chi_scale == textures.chi_scale &&
                        (textures.table_size == 0 || source.chi == textures.chi);
  const bool same_flakes = source.bins_per_rad == model.u_bins_per_rad && source.mean == textures.mean;
  for (int term = 0; term < paint_term_count; ++term) {
    const auto k = static_cast<std::size_t>(term);
    std::optional<AlbedoSource::Part> part = part_of(analytic, term, flake_m);
    if (term == 4 && !terms.flakes) part.reset();
    if (source.known[k] && source.parts[k] == part && (term == 4 ? same_flakes : same_chi)) continue;
    out.rows[k] = {};
    if (part) fill_row(model, terms, static_cast<PaintTerm>(term), part->lobe.m, out.rows[k]);
    source.parts[k] = part;
    source.known[k] = true;
  }
  source.table_size = textures.table_size;
  source.chi_scale = textures.chi_scale;
  if (textures.table_size > 0) source.chi = textures.chi;
  source.bins_per_rad = model.u_bins_per_rad;
  source.mean = textures.mean;
  source.flake_m = flake_m;
}

}  // namespace

AlbedoRow merged_lobes(const AlbedoTable& table) {
  AlbedoRow out;
  for (std::size_t k = 0; k < albedo_columns; ++k) {
    float weight = 0.0f;
    for (std::size_t term = 1; term < table.rows.size(); ++term) {
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
  integrate(model, terms, analytic, flake_roughness(paint, textures), textures, out);
}

void directional_albedo(const AnalyticPaint& analytic, AlbedoTable& out) {
  const InterpolatablePaint nothing;
  Model model;
  bind_model(nothing, analytic, no_textures(), model);
  integrate(model, {}, analytic, 1.0, no_textures(), out);
}

}  // namespace lackwerk::core
