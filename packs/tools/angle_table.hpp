// Tables of six- and twelve-angle spectrophotometers, as CSV, become captures.
//
// Why it exists: most paint shops have such an instrument and nothing else. Its table says how a paint flops; it is
// what fits and whole measurements are compared with. Values; any thread. Files are only read.
//
// docs/import.md shows tables. One row per angle, or one column per angle (told by the header); columns in any order:
//   angle                        15as45, -15as45, 45as-15, 15as80 ... or two columns light_deg, aspecular_deg
//   L, a, b                      CIE Lab, D65, 2 degrees; or wavelengths in nm (400, 410nm, ...): reflectance factor
// Separator: semicolon, tab or comma (the first of these in the header); with the first two numbers may have decimal
// commas. Lines from '#' are comments; "# key = value" with the keys name, source, reflectance (factor, percent), order
// (aspecular-first, light-first), illuminant (D65) and observer (2) are read.
// "XasY" is X degrees from the mirror direction under light at Y degrees; makers also write the light first. Lights are
// at 15 or 45 degrees, which settles most names and, with them, the rest of a file.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// Reads a table into Capture::angles; is_fitted is false. Spectra become Lab by ASTM E308's sums (cie_observer.hpp).
/// Errors name file, line and column: not a table, unknown columns, angles that are ambiguous, double, or see below the
/// horizon, numbers that are none, negative reflectance, spectra that do not reach from 400 to 700 nm.
[[nodiscard]] Result<Capture> read_angle_table(const std::filesystem::path& file);
/// From the text of a file; `file` names it in errors, and the capture where the table does not.
[[nodiscard]] Result<Capture> parse_angle_table(std::string_view text, const std::filesystem::path& file);

}  // namespace lackwerk::packs
