#include "kiosk/display/mood.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace lackwerk::kiosk {
namespace {

/// What the sun leaves of the room's own light.
constexpr float sun_environment_gain = 0.25f;

/// Over the left shoulder of a visitor before the car's front left wing.
gles::DirectionalLight sun() { return {glm::normalize(glm::vec3(0.45f, 0.55f, 0.90f)), {0.95f, 0.92f, 0.86f}}; }

gles::Lighting studio() {
  gles::Lighting lighting;
  lighting.exposure = 0.85f;
  lighting.backdrop = {0.016f, 0.017f, 0.019f};
  lighting.lamp_glow = 0.9f;
  lighting.quality.flake_lights = 1;
  return lighting;
}

/// One light and the room around it: every mood has this form, so that any two can be blended.
struct Scheme {
  glm::vec3 direction;
  glm::vec3 radiance;  ///< of the light; 0: there is none
  float environment_gain;
  glm::vec3 backdrop;
  float lamp_glow;
};

/// By number of Light.
std::array<Scheme, 3> schemes() {
  const gles::Lighting day = studio();
  const Scheme bright{sun().direction, glm::vec3(0.0f), 1.0f, day.backdrop, day.lamp_glow};
  Scheme hard = bright;
  hard.radiance = 2.1f * sun().radiance;  // the eye that sees a whole car has no dark surround to compare with
  hard.environment_gain = 0.28f;
  Scheme low = bright;
  low.direction = glm::normalize(glm::vec3(0.30f, 0.85f, 0.34f));
  low.radiance = {1.35f, 0.72f, 0.34f};
  low.environment_gain = 0.17f;
  low.backdrop = {0.008f, 0.009f, 0.013f};
  low.lamp_glow = 1.4f;
  return {bright, hard, low};
}

/// The light that makes flakes sparkle, in a mood's own colour and no brighter than it.
Scheme near_scheme(const Scheme& far, int light) {
  Scheme out = far;
  out.direction = sun().direction;
  out.radiance = sun().radiance;
  if (light == static_cast<int>(Light::evening)) out.radiance *= glm::vec3(0.80f, 0.60f, 0.42f);
  out.environment_gain = std::min(far.environment_gain, sun_environment_gain);
  return out;
}

Scheme blend(const Scheme& a, const Scheme& b, float t) {
  return {glm::normalize(glm::mix(a.direction, b.direction, t)), glm::mix(a.radiance, b.radiance, t),
          glm::mix(a.environment_gain, b.environment_gain, t), glm::mix(a.backdrop, b.backdrop, t),
          glm::mix(a.lamp_glow, b.lamp_glow, t)};
}

}  // namespace

gles::Lighting lighting_of(Mood mood) {
  gles::Lighting lighting = studio();
  switch (mood) {
    case Mood::showroom:
      break;
    case Mood::sun:
      lighting.lights = {sun()};
      lighting.environment_gain = sun_environment_gain;
      break;
    case Mood::stripes:
      lighting.stripes = true;
      break;
  }
  return lighting;
}

Mood usual_mood(std::string_view camera_name) {
  if (camera_name == "macro") return Mood::sun;
  if (camera_name == "stripe") return Mood::stripes;
  return Mood::showroom;
}

double closeness(const packs::Camera& camera) {
  // Height of paint that the picture shows: half a metre of it is still a part of a car; in 60 mm, 0.1 mm texels of
  // flakes are larger than a pixel of 720 rows.
  constexpr double far_mm = 500.0, near_mm = 60.0;
  const double seen_mm = 2.0 * std::tan(glm::radians(static_cast<double>(camera.vertical_fov_deg)) / 2.0) *
                         static_cast<double>(glm::length(camera.eye_mm - camera.target_mm));
  const double t = std::clamp(std::log(far_mm / seen_mm) / std::log(far_mm / near_mm), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

gles::Lighting lighting_of(const packs::Camera& camera, const std::array<double, 3>& shares, double dimmer) {
  if (usual_mood(camera.name) == Mood::stripes) return lighting_of(Mood::stripes);
  const std::array<Scheme, 3> moods = schemes();
  const auto near = static_cast<float>(closeness(camera));
  // One after the other into what is there, each by its share of all so far: one alone is taken as it is.
  Scheme lit = moods[0];
  double so_far = 0.0;
  for (std::size_t k = 0; k < moods.size(); ++k) {
    if (shares[k] <= 0.0) continue;
    const Scheme one = blend(moods[k], near_scheme(moods[k], static_cast<int>(k)), near);
    so_far += shares[k];
    lit = so_far == shares[k] ? one : blend(lit, one, static_cast<float>(shares[k] / so_far));
  }
  // By night the room goes dark first, then what is pointed at the car; the car's own lamps stay.
  const auto night = static_cast<float>(std::clamp(dimmer, 0.0, 1.0));
  gles::Lighting out = studio();
  out.environment_gain = lit.environment_gain * (1.0f - 0.75f * night);
  out.backdrop = lit.backdrop * (1.0f - 0.85f * night);
  out.lamp_glow = lit.lamp_glow * (1.0f + 0.5f * night);
  const glm::vec3 radiance = lit.radiance * (1.0f - 0.5f * night);
  if (radiance != glm::vec3(0.0f)) out.lights = {{lit.direction, radiance}};
  return out;
}

}  // namespace lackwerk::kiosk
