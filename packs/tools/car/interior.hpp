// What is seen through the glass: seats, dashboard, steering wheel, nearly black.
//
// Why it exists: a car whose windows show nothing behind them looks like a toy. Pure function, left and right side.
#pragma once

#include "packs/tools/car/patch.hpp"

namespace lackwerk::packs::car {

[[nodiscard]] Patch build_interior();

}  // namespace lackwerk::packs::car
