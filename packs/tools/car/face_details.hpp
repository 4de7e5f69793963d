// Small solid things at nose and tail: grille bars, intake blades, diffuser fins, the blank plate, roof aerial.
//
// Why it exists: depth at both faces of the car. They are placed on the body's own surface, so they follow any change
// of its shape. Both sides are built at once. Pure function.
#pragma once

#include "packs/tools/car/body_field.hpp"
#include "packs/tools/car/graphics_shape.hpp"
#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

struct FacePatches {
  Patch trim;
  Patch bright;  ///< chrome
  Patch paint;
};

[[nodiscard]] FacePatches build_face_details(const BodyField& body, const GraphicsShape& graphics);

}  // namespace lackwerk::packs::car
