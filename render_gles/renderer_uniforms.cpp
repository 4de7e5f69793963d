// Renderer: what a program is compiled for and what it is told. Names are those of the shading texts.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "render_gles/renderer.hpp"

namespace lackwerk::gles {
namespace {

constexpr float m_per_mm = 0.001f;
constexpr GLint unit_environment = 6;
constexpr GLint unit_albedo = 7;
/// The chi table and the floor's mirror image never meet in one program: eight units are all ES 2.0 promises.
constexpr GLint unit_mirror = 0;
/// Half width of the floor's blur, in shares of the picture's height: about 2 degrees at the hero view.
constexpr float mirror_blur = 0.006f;

void bind_texture(const GlApi& gl, const Program& program, const char* name, GLint unit, GLuint texture) {
  const GLint location = program.location(name);
  if (location < 0) return;
  gl.Uniform1i(location, unit);
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(GL_TEXTURE_2D, texture);
}

/// Where a light of the environment stands on the room's wall or floor, m; its direction if the room is far away.
glm::vec3 sparkle_place(const core::Environment& room, const glm::vec3& direction) {
  if (room.room_radius_mm <= 0.0f) return direction;
  float reach = room.room_radius_mm;
  if (direction.z < -1e-4f) reach = std::min(reach, std::max(room.centre_mm.z, 0.0f) / -direction.z);
  return (room.centre_mm + direction * reach) * m_per_mm;
}

}  // namespace

bool Renderer::merges_lobes(const Lighting& lighting, const Pass& pass) {
  return lighting.quality.one_lobe && pass.path == ShaderPath::filtered && pass.lights.empty() &&
         pass.sparkle_lights == 0;
}

Features Renderer::features_of(const MeshBuffers::Draw& part, const Lighting& lighting, const Pass& pass) const {
  Features features;
  features.surface = part.surface;
  // The floor's shine is the mirror image, in still pictures too.
  features.path =
      part.surface == packs::SurfaceKind::floor && pass.path == ShaderPath::sampled ? ShaderPath::filtered : pass.path;
  features.output = pass.output;
  features.lights = static_cast<int>(pass.lights.size());
  features.stripes = lighting.stripes && !pass.mirrored;
  features.orange_peel = lighting.orange_peel_mrad > 0.0f && !pass.mirrored && context_.info().fragment_highp;
  features.visibility = part.visibility;
  features.irradiance = part.irradiance;
  features.floor_mirror = pass.floor_mirror;
  features.room_lights = in_room(pass);
  const Quality& quality = lighting.quality;
  if (part.surface == packs::SurfaceKind::paint) {
    features.flakes = quality.flakes != FlakeMode::off;
    features.flake_lights = std::clamp(pass.flake_lights, 0, features.lights);
    features.sparkle_lights = pass.sparkle_lights;
    features.still_flakes = pass.still_flakes;
    features.flake_taps = quality.flakes == FlakeMode::nearest ? 1 : 4;
    features.flake_cells = quality.flake_cross_fade ? 4 : 1;
    if (paint_) paint_->add_features(features);
    if (keep_.lobes) features.lobes = static_cast<int>(core::max_lobes);
    features.coat |= keep_.coat;
    features.refraction |= keep_.refraction;
    if (keep_.sharp_levels) features.narrow = 7;
    if (merges_lobes(lighting, pass)) {
      features.lobes = 1;
      features.narrow = features.narrow != 0 ? 1 : 0;
      features.flakes = features.table = features.refraction = false;
      features.map = MapUse::none;
    }
  } else {
    const core::AnalyticPaint& material = packs::material_of(part.surface).surface;
    features.lobes = material.lobes[0].s == glm::dvec3(0.0) ? 0 : 1;
    features.diffuse = material.diffuse != glm::dvec3(0.0);
    features.coat = material.coat_ior > 1.0;
    features.narrow = core::environment_level_of(0.7 * material.lobes[0].m) < core::first_stacked_level ? 1 : 0;
  }
  if (pass.cut > 0) {
    // What neither lights nor look-ups show is left out.
    const LightShares shares = shares_of(part.surface, pass);
    features.looked_up = shares.front() < 1.0f ? 16 : 0;
    int lit = 0;
    for (int k = 0; k < features.lobes; ++k) {
      const float share = shares[static_cast<std::size_t>(k) + 1];
      if (share < 1.0f) features.looked_up |= 1 << k;
      if (share > 0.0f) lit = k + 1;
    }
    if (shares.back() < 1.0f) features.looked_up |= 8;
    features.less_mean_flakes = shares.back() < 1.0f;
    const bool none = std::all_of(shares.begin(), shares.end(), [](float share) { return share <= 0.0f; });
    if (none && features.flake_lights == 0) features.lights = 0;
    if (features.path == ShaderPath::none) features.lobes = lit;
  }
  return features.canonical();
}

void Renderer::apply_frame(const Program& program, const Frame& frame, const Pass& pass, const glm::mat4& clip) const {
  const Lighting& lighting = frame.lighting;
  const auto vec3 = [&](const char* name, const glm::vec3& v) { gl_.Uniform3f(program.location(name), v.x, v.y, v.z); };
  const auto vec4 = [&](const char* name, const glm::vec4& v) {
    gl_.Uniform4f(program.location(name), v.x, v.y, v.z, v.w);
  };
  const auto number = [&](const char* name, float v) { gl_.Uniform1f(program.location(name), v); };
  program.use();
  gl_.UniformMatrix4fv(program.location("u_clip_from_world"), 1, GL_FALSE, &clip[0][0]);
  glm::vec3 eye = frame.view.eye_mm;
  if (pass.mirrored) eye.z = -eye.z;
  vec3("u_eye", eye);
  number("u_irradiance_range", irradiance_range_);
  number("u_gain", lighting.environment_gain);
  const float texels_per_m = paint_ && paint_->texel_mm() > 0.0f ? 1.0f / (paint_->texel_mm() * m_per_mm) : 0.0f;
  vec4("u_frame", {lighting.exposure, lighting.dither ? 1.0f : 0.0f,
                   pixel_size_per_mm(frame.view, frame.height) * texels_per_m, texels_per_m});
  vec4("u_backdrop", glm::vec4(pass.black ? glm::vec3(0.0f) : lighting.backdrop, 0.0f));
  vec4("u_room", glm::vec4(environment_.centre_mm, environment_.room_radius_mm) * m_per_mm);
  number("u_environment_root", std::sqrt(environment_.range * lighting.environment_gain));
  bind_texture(gl_, program, "u_environment", unit_environment, environment_texture_.id());
  bind_texture(gl_, program, "u_albedo", unit_albedo, materials_.texture());
  if (pass.floor_mirror && mirror_) {
    bind_texture(gl_, program, "u_mirror", unit_mirror, mirror_->texture());
    const auto width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
    vec4("u_mirror_step", {1.0f / width, 1.0f / height, mirror_blur * height / width, mirror_blur});
  }
  vec3("u_sample", pass.sample);
  number("u_peel", lighting.orange_peel_mrad * 1e-3f);
  number("u_peel_pixel", 1000.0f * pixel_size_per_mm(frame.view, frame.height));

  // Lights of a cut stand on the wall, also those of the floor: a near floor is no handful of points, but its light is
  // much the same everywhere. From the centre a piece of wall is seen squarely at the distance R: its strength there is
  // R / R^2 with a normal R long, hence the factor R.
  const bool room = in_room(pass);
  const float radius = environment_.room_radius_mm * m_per_mm;
  std::vector<glm::vec3> lights_at, radiances;
  for (const DirectionalLight& light : pass.lights) {
    lights_at.push_back(room ? environment_.centre_mm * m_per_mm + light.direction * radius : light.direction);
    radiances.push_back(room ? light.radiance * radius : light.radiance);
  }
  if (!pass.lights.empty()) {
    const auto count = static_cast<GLsizei>(pass.lights.size());
    gl_.Uniform3fv(program.location("u_light_at"), count, &lights_at.front().x);
    gl_.Uniform3fv(program.location("u_light"), count, &radiances.front().x);
  }
  // One of n lights stands for 4 pi R^2 / n of the wall, a disc of radius 2 R / sqrt(n): nearer than half of that it is
  // no point.
  if (room) number("u_light_reach", radius / std::sqrt(static_cast<float>(pass.cut)));
  std::vector<float> places, glints;
  for (int k = 0; k < pass.sparkle_lights; ++k) {
    const core::EnvironmentLight& light = sparkle_[static_cast<std::size_t>(k)];
    const glm::vec3 at = sparkle_place(environment_, light.direction);
    for (int c = 0; c < 3; ++c) {
      places.push_back(at[c]);
      glints.push_back(light.radiance[c] * lighting.environment_gain);
    }
  }
  if (pass.sparkle_lights > 0) {
    gl_.Uniform3fv(program.location("u_sparkle_at"), pass.sparkle_lights, places.data());
    gl_.Uniform3fv(program.location("u_sparkle"), pass.sparkle_lights, glints.data());
  }
}

void Renderer::apply_material(const Program& program, packs::SurfaceKind kind, const Frame& frame,
                              const Pass& pass) const {
  const bool merged = kind == packs::SurfaceKind::paint && merges_lobes(frame.lighting, pass);
  const TermScales& scales = merged ? materials_.merged_scales() : materials_.scales(kind);
  gl_.Uniform1f(program.location("u_albedo_row"), merged ? MaterialTable::merged_row() : MaterialTable::row(kind));
  const LightShares shares = shares_of(kind, pass);
  glm::vec4 looked_up = scales.albedo_scale;
  if (pass.cut > 0)
    for (int k = 0; k < 4; ++k) looked_up[k] *= 1.0f - shares[static_cast<std::size_t>(k) + 1];
  gl_.Uniform4fv(program.location("u_albedo_scale"), 1, &looked_up.x);
  gl_.Uniform1f(program.location("u_diffuse_scale"),
                scales.diffuse_scale * (pass.cut > 0 ? 1.0f - shares.front() : 1.0f));
  gl_.Uniform1f(program.location("u_less_mean"), 1.0f - shares.back());
  if (kind == packs::SurfaceKind::paint) {
    if (!paint_) return;
    paint_->apply(gl_, program);
    if (pass.cut > 0) apply_shares(gl_, program, paint_->analytic(), shares);
    return;
  }
  const packs::Material& material = packs::material_of(kind);
  apply_analytic(gl_, program, material.surface);
  if (pass.cut > 0) apply_shares(gl_, program, material.surface, shares);
  const glm::vec3 emission = material.emission * (pass.black ? 0.0f : frame.lighting.lamp_glow);
  gl_.Uniform3f(program.location("u_emission"), emission.x, emission.y, emission.z);
  gl_.Uniform1f(program.location("u_cover"), static_cast<float>(material.coverage));
}

}  // namespace lackwerk::gles
