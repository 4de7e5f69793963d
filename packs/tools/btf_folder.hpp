// A folder of flake pictures named by their angles becomes a capture.
//
// Why it exists: whoever has AxF's SDK, or a goniometer of their own, has CarPaint2's quantities and one picture per
// angle pair, in some format and some naming. This brings them in one to one. Values; any thread. Files are only read.
//
// The folder holds `paint.toml` with the capture's own keys (docs/capture.md; edge_texels may be left out) plus three
// in [flakes] that say what the pictures are:
//   unit        "radiance_factor": pi times the BRDF (as in captures), or "brdf": 1/sr (as in AxF: multiplied by pi
//   here) angle_unit  "deg" (as if absent) or "rad", of the angles in the file names angles      "inside" (as if
//   absent) the coat, or "outside": the pictures' angles before light enters it
// and pictures `th<theta_h>_ti<theta_i>.<ext>` in BTFflakes: th07.5_ti15.0.exr, th0_ti0.tif ("." is the folder itself).
// A fourth key, `scale`, multiplies all texels: for whole-number formats, whose white (1) stands for that value.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/error.hpp"
#include "packs/tools/capture.hpp"
#include "packs/tools/import_notes.hpp"

namespace lackwerk::packs {

/// The two angles in a picture's name, in the name's own unit.
struct NamedAngles {
  double theta_h = 0.0, theta_i = 0.0;
};
/// Of "th07.5_ti15.0": nothing where the stem is no such name. Decimal points only; no signs, no exponents.
[[nodiscard]] std::optional<NamedAngles> angles_of_name(std::string_view stem);

/// Reads such a folder. Each node of the layout needs its picture, each picture a node: angles inside the coat must
/// meet a node within 0.12 degrees (names are rounded to a tenth); angles outside are bent into the coat as in
/// node_geometry.hpp, and each node takes the nearest picture within half a bin. Errors name the missing node, the
/// extra picture, the odd size, the bad texel, the bad key.
[[nodiscard]] Result<Capture> import_btf_folder(const std::filesystem::path& folder, ImportNotes* notes = nullptr);

}  // namespace lackwerk::packs
