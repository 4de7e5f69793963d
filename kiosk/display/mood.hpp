// The light the showroom is shown in.
//
// Why it exists: kiosk, `lackwerk render` and the contact sheet must show the same room, and a visitor changes its
// light. Pure functions; any thread.
#pragma once

#include <array>
#include <string_view>

#include "packs/scene.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::kiosk {

/// What the picture is for; each has its own light.
enum class Mood {
  showroom,  ///< the built-in studio with spots
  sun,       ///< one hard light and little else: for macro views of the flakes
  stripes,   ///< stripe reflections instead of paint
};

[[nodiscard]] gles::Lighting lighting_of(Mood mood);

/// Close views live from the spot, whole cars from the soft boxes: the mood a camera of this name is usually shown in.
[[nodiscard]] Mood usual_mood(std::string_view camera_name);

/// What a visitor chooses, by the number of State::light().
enum class Light {
  studio,   ///< Mood::showroom
  sun,      ///< one hard light: the flakes sparkle, shadows are deep
  evening,  ///< little light, low and warm, cool in the shade
};

/// How near a camera is to the paint: 0: a whole car, 1: single flakes can be seen; continuous in between.
[[nodiscard]] double closeness(const packs::Camera& camera);

/// The light a visitor has chosen. `shares` of each Light by its number, at least 0, sum 1: one alone is that light
/// exactly; `dimmer`: [0, 1], day to showroom night. Near the paint a hard light comes in by itself, whatever was
/// chosen: in soft light flakes do not sparkle. Continuous in shares, `dimmer` and camera. By day in the studio it is
/// the usual mood of the scene's far and macro cameras.
[[nodiscard]] gles::Lighting lighting_of(const packs::Camera& camera, const std::array<double, 3>& shares,
                                         double dimmer);

}  // namespace lackwerk::kiosk
