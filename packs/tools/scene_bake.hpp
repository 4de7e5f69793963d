// What light does around the car, baked once into the vertices.
//
// Why it exists: the kiosk's renderer has no ray tracing, but a car without a contact shadow floats, and a wheel well
// that mirrors the sky glows. Fills `visibility` and `irradiance` of every part and the scene's
// `irradiance_range`, from the scene's own environment. Needs Embree 3. Deterministic: every vertex has its own fixed
// set of rays, so the number of worker threads does not change the result. Call it from one thread; it starts and joins
// its own.
#pragma once

#include <cstddef>
#include <functional>

#include "packs/scene.hpp"

namespace lackwerk::packs {

struct BakeSettings {
  int rays_per_vertex = 192;  ///< [1, 4096]; 64 is a quick look
  int threads = 0;            ///< 0 = as many as the machine has; no effect on the result
};

/// How well nine bytes stand for what was traced.
struct BakeReport {
  std::size_t vertices = 0;
  double fit_error_mean = 0.0;  ///< over the vertices, of each one's mean |fit - traced| over its rays, [0, 1]
  double fit_error_p95 = 0.0;
};

/// Called now and then with the share done, [0, 1], from any of the threads, perhaps at once.
using BakeProgress = std::function<void(double)>;

/// Glass and floor block nothing. Where the scene has a floor, directions that end on it see it as bright as the share
/// of the sky that reaches it there.
BakeReport bake_scene(Scene& scene, const BakeSettings& settings = {}, const BakeProgress& progress = {});

}  // namespace lackwerk::packs
