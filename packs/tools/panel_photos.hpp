// Photographs of a painted panel at known angles become a capture with flake slices.
//
// Why it exists: a camera on a stand, a lamp and a white tile are what most people have; flake captures must not need a
// laboratory. Values; any thread. Files are only read.
//
// The folder holds `photos.toml` (docs/import.md lists its keys) and the photographs. Each becomes a picture of the
// radiance factor, relative to a white reference photographed in the same place, on a grid of the panel's millimetres
// (photo_radiance.hpp, panel_grid.hpp). Per slice it is split into what lies under all flakes, a low quantile of the
// texels, and the flakes above it. The first becomes the capture's diffuse part, as a colour table over (theta_h,
// theta_i) whose nodes are the slices' nodes. What the split leaves over goes to the table, so that BRDF + mean flakes
// is the photograph's mean at every photographed node.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "packs/tools/capture.hpp"
#include "packs/tools/import_notes.hpp"

namespace lackwerk::packs {

/// Reads such a folder. `notes` get: how many slices were photographed, how many were filled from which distance, what
/// was saturated, how far photographs lie from their nodes. Errors name photos.toml's line and key, or the picture.
[[nodiscard]] Result<Capture> import_panel_photos(const std::filesystem::path& folder, ImportNotes* notes = nullptr);

}  // namespace lackwerk::packs
