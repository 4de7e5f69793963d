#include "kiosk/display/mood.hpp"

#include <glm/geometric.hpp>

namespace lackwerk::kiosk {
gles::Lighting lighting_of(Mood mood) {
  gles::Lighting lighting;
  lighting.exposure = 0.85f;
  lighting.backdrop = {0.016f, 0.017f, 0.019f};
  lighting.lamp_glow = 0.9f;
  lighting.quality.flake_lights = 1;
  switch (mood) {
    case Mood::showroom:
      break;
    case Mood::sun:
      // Over the left shoulder of a visitor before the car's front left wing.
      lighting.lights = {{glm::normalize(glm::vec3(0.45f, 0.55f, 0.90f)), {0.95f, 0.92f, 0.86f}}};
      lighting.environment_gain = 0.25f;
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
