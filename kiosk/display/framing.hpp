// How a camera's picture is cut for the panel at hand.
//
// Why it exists: cameras are made for a picture of 16 to 9. On an upright panel their vertical field of view would show
// the middle of the car only, and the interface lies where the wheels are. Pure; any thread.
#pragma once

#include "packs/scene.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::kiosk {

/// What the whole picture is kept free for.
enum class KeepFree { nothing, interface };

/// The view of `camera` on a picture of `width` x `height` px (each > 0): as wide as on 16 to 9, a little less on
/// upright ones, whose cars would be small; for the interface the car stands higher, and away from the pad. From 16 to
/// 9 on and for nothing it is the camera's own.
[[nodiscard]] gles::View framed(const packs::Camera& camera, int width, int height, KeepFree keep_free);

/// The view of a camera whose subject fits a square: as high as wide, the camera's field of view is that of the
/// picture's shorter edge. For the interface the subject stands above the slider at the lower edge.
[[nodiscard]] gles::View framed_square(const packs::Camera& camera, int width, int height, KeepFree keep_free);

}  // namespace lackwerk::kiosk
