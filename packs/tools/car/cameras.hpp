// The named points of view on the car.
//
// Why it exists: reference pictures, tests and the kiosk's walk-around use the same cameras. Pure function.
#pragma once

#include <vector>

#include "packs/scene.hpp"
#include "packs/tools/car/field.hpp"

namespace lackwerk::packs::car {

/// `body` places the close view exactly on the bonnet.
[[nodiscard]] std::vector<Camera> car_cameras(const Field& body);

}  // namespace lackwerk::packs::car
