// Door mirrors.
//
// Why it exists: they break the outline of the cabin, and a car without them looks unfinished. Left side only; the
// caller mirrors it. Pure function.
#pragma once

#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

struct MirrorPatches {
  Patch cap;    ///< paint
  Patch base;   ///< trim: lower shell and stalk
  Patch glass;  ///< chrome
};

[[nodiscard]] MirrorPatches build_mirror();

}  // namespace lackwerk::packs::car
