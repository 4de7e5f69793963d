#include "packs/tools/car/cameras.hpp"

namespace lackwerk::packs::car {

std::vector<Camera> car_cameras() {
  // Eye heights of someone kneeling to photograph the car: a high eye makes any car look small.
  return {
      {"hero", {4750.0f, 3150.0f, 1020.0f}, {130.0f, 20.0f, 610.0f}, 28.0f},
      {"side", {0.0f, 6900.0f, 950.0f}, {0.0f, 0.0f, 690.0f}, 24.0f},
      {"rear", {-4900.0f, 3200.0f, 1250.0f}, {-80.0f, 30.0f, 660.0f}, 29.0f},
      {"front", {6400.0f, 0.0f, 900.0f}, {1000.0f, 0.0f, 680.0f}, 24.0f},
      {"rim", {2900.0f, 2500.0f, 800.0f}, {1080.0f, 880.0f, 560.0f}, 28.0f},
      {"macro", {1660.0f, 150.0f, 990.0f}, {1540.0f, 120.0f, 890.0f}, 22.0f},
      {"stripe", {300.0f, 3900.0f, 1150.0f}, {-150.0f, 800.0f, 720.0f}, 30.0f},
  };
}

}  // namespace lackwerk::packs::car
