// The light the showroom is shown in.
//
// Why it exists: kiosk, `lackwerk render` and the contact sheet must show the same room. Pure functions; any thread.
#pragma once

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

}  // namespace lackwerk::kiosk
