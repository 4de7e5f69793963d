// The named points of view on the car.
//
// Why it exists: reference pictures, tests and the kiosk's walk-around use the same cameras. Pure function.
#pragma once

#include <vector>

#include "packs/scene.hpp"

namespace lackwerk::packs::car {

[[nodiscard]] std::vector<Camera> car_cameras();

}  // namespace lackwerk::packs::car
