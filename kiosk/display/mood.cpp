#include "kiosk/display/mood.hpp"

#include <glm/geometric.hpp>

namespace lackwerk::kiosk {
namespace {

gles::DirectionalLight spot(glm::vec3 towards, glm::vec3 radiance) { return {glm::normalize(towards), radiance}; }

}  // namespace

gles::Lighting lighting_of(Mood mood) {
  gles::Lighting lighting;
  lighting.exposure = 0.85f;
  lighting.backdrop = {0.016f, 0.017f, 0.019f};
  lighting.lamp_glow = 0.9f;
  // Key over the left shoulder of a visitor before the car's front left wing, a cool edge from behind, a warm fill.
  lighting.lights = {spot({0.55f, 0.62f, 0.90f}, {0.95f, 0.93f, 0.90f}),
                     spot({-0.75f, 0.35f, 0.55f}, {0.38f, 0.40f, 0.44f}),
                     spot({0.25f, -0.80f, 0.60f}, {0.22f, 0.21f, 0.20f})};
  lighting.flake_lights = 1;
  switch (mood) {
    case Mood::showroom:
      break;
    case Mood::sun:
      lighting.lights = {spot({0.45f, 0.55f, 0.90f}, {0.95f, 0.92f, 0.86f})};
      lighting.studio_gain = 0.25f;
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

}  // namespace lackwerk::kiosk
