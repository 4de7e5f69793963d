// A paint as glTF 2.0, for other people's renderers.
//
// Why it exists: an engine fit is worth what can be opened. A sphere under the material, as one .glb to drop into any
// viewer, and as .gltf with its binary and image beside it to take apart. Free functions; any thread. Files are written
// here only.
//
// Extensions used, none required: KHR_materials_clearcoat (the coat), KHR_materials_specular (the lobe's colour and the
// flakes), KHR_materials_ior (0: the lobe's colour is its own, no dielectric's). A reader that knows none of them shows
// the diffuse colour at the right roughness. Lengths in metres, y up, as the specification asks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/paint.hpp"
#include "packs/tools/engine_fit.hpp"

namespace lackwerk::packs {

/// Radius of the sphere, metres: a snooker ball and a half, 13 flake tiles of 24 mm around.
inline constexpr double engine_sphere_radius_m = 0.05;

/// Writes paint.glb, paint.gltf, paint.bin and, where the material has flakes, flakes.png into `folder` (made if
/// missing); an older flakes.png is removed otherwise. Names, source and provenance go into the material's extras. The
/// same input gives the same bytes. Errors: a file that cannot be written.
[[nodiscard]] Result<void> write_engine_material(const EngineMaterial& material, const core::PaintIdentity& identity,
                                                 const std::filesystem::path& folder);

}  // namespace lackwerk::packs
