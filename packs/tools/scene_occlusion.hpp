// Ambient occlusion, baked once into the vertices.
//
// Why it exists: the kiosk's renderer has no ray tracing, but a car without a contact shadow floats. Fills
// `ambient_occlusion` of every part. Needs Embree 3. Deterministic: every vertex has its own fixed set of rays, so
// the number of worker threads does not change the result. Call it from one thread; it starts and joins its own.
#pragma once

#include "packs/scene.hpp"

namespace lackwerk::packs {

/// Glass does not cast occlusion. `rays_per_vertex` of 64 is a quick look, 256 is smooth.
void bake_ambient_occlusion(Scene& scene, int rays_per_vertex);

}  // namespace lackwerk::packs
