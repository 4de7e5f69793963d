#include "core/analysis/reference_shading.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/check.hpp"
#include "core/directional_albedo.hpp"

namespace lackwerk::core {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

/// Rays leave this far above a surface, so that a coarse facet does not shadow itself: what the baker does.
constexpr double lift_mm = 1.5;
constexpr int most_panes = 16;  ///< glass surfaces along one ray
/// Samples whose gloss carries less than this share of what they find are not traced.
constexpr double least_gloss = 1e-7;

/// Light of every direction reflected by the flakes' mean at normal view: theta_h = theta_i = t, light from 2t.
double flake_albedo(PaintModel<double>& model) {
  constexpr int steps = 64;
  constexpr double dt = pi / 4.0 / steps;
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double t = (k + 0.5) * dt;
    sum += luminance_of(model.flake_mean(t, t)) * std::sin(2 * t) * std::cos(2 * t) * dt;
  }
  return 4.0 * sum;
}

/// What share of a lobe's light is better sought at the environment's bright spots than inside the lobe: a lobe much
/// narrower than the spots knows better. Any choice is unbiased; on the built-in car anything from
/// half to twice these numbers gives error bars within 5 %.
double environment_share(double m, double eta) {
  const double width = m * eta;
  return 0.6 * width * width / (width * width + 0.15 * 0.15);
}

}  // namespace

ReferenceShader::ReferenceShader(const World& world) : world_(world) {
  const ReferenceScene& scene = *world_.scene;
  room_.environment = scene.environment;
  room_.u_room = {dvec3(scene.environment->centre_mm), static_cast<double>(scene.environment->room_radius_mm)};
  room_.u_environment_scale = static_cast<double>(scene.environment->range) * world_.lighting->gain;
  if (scene.paint.pack != nullptr && scene.paint.pack->texel_mm > 0.0f)
    texels_per_mm_ = 1.0 / static_cast<double>(scene.paint.pack->texel_mm);
  for (const ReferenceMaterial& material : scene.materials) materials_.push_back(bind(material));
}

ReferenceShader::Material ReferenceShader::bind(const ReferenceMaterial& material) const {
  static const InterpolatablePaint nothing;
  const ReferencePaint& paint = world_.scene->paint;
  const bool known = paint.pack != nullptr && paint.analytic != nullptr && paint.textures != nullptr;
  check_equal(known || !material.is_paint, true, "painted meshes come with a paint");
  const auto bound = [&](bool matt, bool gloss) {
    Model model;
    if (material.is_paint && known)
      bind_model(*paint.pack, *paint.analytic, *paint.textures, model);
    else
      bind_model(nothing, material.surface, no_textures(), model);
    if (!matt) model.u_diffuse = dvec3(0.0);
    for (auto& lobe : model.u_lobe)
      if (!gloss) lobe = glm::dvec4(0.0, 0.0, 0.0, lobe.w);
    return model;
  };
  const AnalyticPaint& surface = material.is_paint ? *paint.analytic : material.surface;
  Material out{bound(true, true),
               bound(true, false),
               bound(false, true),
               material.emission,
               material.coverage,
               material.is_floor,
               material.is_paint,
               0.0,
               {},
               {}};
  out.matt_albedo = luminance_of(surface.diffuse);
  for (std::size_t k = 0; k < max_lobes; ++k) {
    out.part_albedo[k] = 4.0 * luminance_of(surface.lobes[k].s);  // times Fresnel: the share of light it mirrors
    out.part_m[k] = surface.lobes[k].m;
  }
  out.part_albedo[max_lobes] = flake_albedo(out.all);
  out.part_m[max_lobes] = material.is_paint ? flake_roughness(*paint.pack, *paint.textures) : 1.0;
  return out;
}

ReferenceShader::Surface ReferenceShader::surface_at(const ReferenceHit& hit, const dvec3& direction,
                                                     double travelled) {
  Surface s;
  s.material = &materials_[world_.scene->meshes[hit.mesh].material];
  s.p = world_.geometry->position(hit);
  s.open = world_.geometry->visibility(hit);
  s.o = -direction;
  s.n = world_.geometry->normal(hit);
  // Interpolated normals may turn away at silhouettes: bent back to just facing the eye, as in surface_fragment.glsl.
  const double co = glm::dot(s.n, s.o);
  if (co < 0.0) s.n = glm::normalize(s.n + s.o * (0.001 - co));
  s.texel = dvec2(0.0);
  s.lod = 0.0;
  if (s.material->paint) {
    Model& model = s.material->all;
    s.texel = model.surface_texel(s.p, s.n, texels_per_mm_);
    s.lod = model.surface_lod(travelled + hit.distance_mm, glm::dot(s.n, s.o), world_.pixel_per_mm * texels_per_mm_);
  }
  return s;
}

dvec3 ReferenceShader::along(const dvec3& origin, const dvec3& direction, double travelled, int depth,
                             ReferenceNumbers& numbers) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  ++rays_;
  const auto hit = world_.geometry->first_hit(origin, direction, 0.0, endless, false);
  const dvec3 behind = hit          ? shade(*hit, direction, travelled, depth, numbers)
                       : depth == 0 ? world_.lighting->backdrop / world_.lighting->exposure
                                    : room_radiance(origin, direction);
  if (!world_.geometry->has_glass()) return behind;
  return through_glass(origin, direction, travelled, hit ? hit->distance_mm : endless, behind, depth, numbers);
}

dvec3 ReferenceShader::through_glass(const dvec3& origin, const dvec3& direction, double travelled, double end,
                                     const dvec3& behind, int depth, ReferenceNumbers& numbers) {
  dvec3 sum(0.0);
  double left = 1.0;  // share of what lies behind that still shows
  double from = 0.0;
  for (int pane = 0; pane < most_panes; ++pane) {
    ++rays_;
    const auto hit = world_.geometry->first_hit(origin, direction, from, end, true);
    if (!hit) break;
    const Surface s = surface_at(*hit, direction, travelled);
    sum += left * radiance(s, travelled + hit->distance_mm, depth, numbers);
    const Material& m = *s.material;
    const double f = s.material->all.fresnel_dielectric(std::max(glm::dot(s.n, s.o), 0.0), s.material->all.u_coat_ior);
    left *= (1.0 - m.coverage) * (1.0 - f);  // 1 - (coverage + (1 - coverage) F)
    from = hit->distance_mm + 1e-2 + 1e-6 * hit->distance_mm;
  }
  return sum + left * behind;
}

dvec3 ReferenceShader::shade(const ReferenceHit& hit, const dvec3& direction, double travelled, int depth,
                             ReferenceNumbers& numbers) {
  const Surface s = surface_at(hit, direction, travelled);
  // The floor fades into the hall: a device of the picture, exactly as in surface_fragment.glsl.
  double fade = 0.0;
  if (s.material->floor && depth == 0) {
    const double radius = std::sqrt(s.p.x * s.p.x + s.p.y * s.p.y);
    const double t = std::clamp((radius - 2800.0) / (6700.0 - 2800.0), 0.0, 1.0);
    fade = t * t * (3.0 - 2.0 * t);
  }
  const dvec3 hall = world_.lighting->backdrop * (fade / world_.lighting->exposure);
  if (fade >= 1.0) return hall;
  return radiance(s, travelled + hit.distance_mm, depth, numbers) * (1.0 - fade) + hall;
}

dvec3 ReferenceShader::radiance(const Surface& s, double travelled, int depth, ReferenceNumbers& numbers) {
  Material& m = *s.material;
  dvec3 sum = m.emission * world_.lighting->lamp_glow;
  const double co = glm::dot(s.n, s.o);
  if (m.all.u_coat_ior > 1.0) {
    const double f = m.all.fresnel_dielectric(std::max(co, 0.0), m.all.u_coat_ior);
    const dvec3 mirror = s.n * (2.0 * co) - s.o;
    sum += f * (is_traced() || m.floor ? traced(s, mirror, travelled, depth, numbers)
                                       : room_radiance(s.p, mirror) * open_part(s, mirror));
  }
  if (!world_.lighting->lights.empty()) sum += one_light(s, numbers.next().x);
  sum += one_direction(s, travelled, depth, numbers);
  return sum;
}

dvec3 ReferenceShader::one_light(const Surface& s, double u) {
  // One of the lights, by its share of what they all would give a white diffuser; divided by that share.
  double total = 0.0;
  for (const ReferenceLight& light : world_.lighting->lights)
    total += luminance_of(light.radiance) * std::max(glm::dot(s.n, light.direction), 0.0);
  double rest = u * total;
  for (const ReferenceLight& light : world_.lighting->lights) {
    const double share = luminance_of(light.radiance) * std::max(glm::dot(s.n, light.direction), 0.0);
    rest -= share;
    if (share <= 0.0 || rest > 0.0) continue;
    double open = 0.0;
    if (is_traced()) {
      ++rays_;
      open = world_.geometry->blocked(s.p + s.n * lift_mm, light.direction) ? 0.0 : 1.0;
    } else {
      open = open_part(s, light.direction);
    }
    if (open <= 0.0) return dvec3(0.0);
    const double flakes = s.material->paint && world_.scene->paint.single_flakes ? 1.0 : 0.0;
    return light.radiance * s.material->all.paint_factor(s.n, light.direction, s.o, s.texel, s.lod, flakes) *
           (glm::dot(s.n, light.direction) * open * total / share);
  }
  return dvec3(0.0);
}

ReferenceShader::Mixture ReferenceShader::mixture_at(const Surface& s) {
  Material& m = *s.material;
  Mixture mix;
  const double eta = m.all.u_refraction_ior;
  const double inside = glm::dot(s.n, refracted_in(s.o, s.n, eta));
  double total = m.matt_albedo;
  mix.environment = 0.6 * m.matt_albedo;
  for (std::size_t k = 0; k < glossy_parts; ++k) {
    const double fresnel = k < max_lobes ? m.all.fresnel_schlick(inside, m.all.u_lobe[k].w) : 1.0;
    const double albedo = m.part_albedo[k] * fresnel;
    const double share = environment_share(m.part_m[k], eta);
    mix.environment += share * albedo;
    mix.part[k] = (1.0 - share) * albedo;
    total += albedo;
  }
  if (!world_.room->reaches(s.p)) mix.environment = 0.0;
  // A twentieth at least is drawn by the cosine, which alone covers every direction whatever the rest.
  mix.cosine = std::max(0.4 * m.matt_albedo, 0.05 * total);
  const double sum = std::accumulate(mix.part.begin(), mix.part.end(), mix.environment + mix.cosine);
  if (sum <= 0.0) return {};
  mix.environment /= sum;
  mix.cosine /= sum;
  for (double& part : mix.part) part /= sum;
  return mix;
}

std::optional<dvec3> ReferenceShader::draw(const Surface& s, const Mixture& mix, const LobeSampler& lobes,
                                           const dvec2& u) const {
  // The first number chooses the density, and its place within the chosen share is used again: each density then gets
  // numbers that are as evenly spread as the whole.
  double at = u.x;
  const auto chosen = [&](double share) {
    if (at < share) {
      at /= share;
      return true;
    }
    at -= share;
    return false;
  };
  if (chosen(mix.environment)) return world_.room->sample(s.p, {at, u.y});
  for (std::size_t k = 0; k < glossy_parts; ++k)
    if (chosen(mix.part[k])) return lobes.sample({at, u.y}, s.material->part_m[k]);
  return sample_cosine(ReferenceFrame(s.n), {std::min(at / mix.cosine, 1.0), u.y});
}

dvec3 ReferenceShader::one_direction(const Surface& s, double travelled, int depth, ReferenceNumbers& numbers) {
  const Mixture mix = mixture_at(s);
  if (mix.cosine <= 0.0) return dvec3(0.0);  // a black surface
  Material& m = *s.material;
  const LobeSampler lobes(s.n, s.o, m.all.u_refraction_ior);
  const std::optional<dvec3> drawn = draw(s, mix, lobes, numbers.next());
  if (!drawn) return dvec3(0.0);
  const dvec3& d = *drawn;
  const double ci = glm::dot(s.n, d);
  if (ci <= 0.0) return dvec3(0.0);

  const dvec3 spot = room_.room_direction(s.p, d);
  double pdf = mix.cosine * ci / pi;
  if (mix.environment > 0.0) pdf += mix.environment * world_.room->pdf(s.p, d, spot);
  const LobeSampler::Target target = lobes.target(d);
  for (std::size_t k = 0; k < glossy_parts; ++k)
    if (mix.part[k] > 0.0) pdf += mix.part[k] * LobeSampler::pdf(target, m.part_m[k]);
  const double weight = ci / (pi * pdf);

  const double flakes = m.paint && world_.scene->paint.single_flakes ? 1.0 : 0.0;
  if (m.floor && !is_traced()) {
    dvec3 sum = m.matt.paint_factor(s.n, d, s.o, s.texel, s.lod, flakes) * weight * room_.environment_sharp(spot) *
                open_part(s, d);
    const dvec3 gloss = m.gloss.paint_factor(s.n, d, s.o, s.texel, s.lod, flakes) * weight;
    if (luminance_of(gloss) > least_gloss) sum += gloss * traced(s, d, travelled, depth, numbers);
    return sum;
  }
  if (is_traced())
    return m.all.paint_factor(s.n, d, s.o, s.texel, s.lod, flakes) * weight * traced(s, d, travelled, depth, numbers);
  const double open = open_part(s, d);
  if (open <= 0.0) return dvec3(0.0);
  return m.all.paint_factor(s.n, d, s.o, s.texel, s.lod, flakes) * (weight * open) * room_.environment_sharp(spot);
}

dvec3 ReferenceShader::traced(const Surface& s, const dvec3& d, double travelled, int depth,
                              ReferenceNumbers& numbers) {
  const dvec3 from = s.p + s.n * lift_mm;
  if (depth < world_.bounces) return along(from, d, travelled, depth + 1, numbers);
  ++rays_;
  return world_.geometry->blocked(from, d) ? dvec3(0.0) : room_radiance(s.p, d);
}

}  // namespace lackwerk::core
