// What a capture keeps of its measurement: brdf.exr and angles.csv.
//
// Why it exists: a fit's error can be told again only while its input is there. capture_io.cpp decides when; this knows
// the two formats (docs/capture.md). Files are read and written here only. Free functions; any thread.
//
// brdf.exr: float channels R, G, B, the BRDF in 1/sr; phi_d from left to right, rows theta_h * num_theta_d + theta_d
// from the top; -1 in all three is a hole. angles.csv: light_deg, aspecular_deg, L, a, b.
#pragma once

#include <filesystem>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/error.hpp"
#include "packs/tools/capture.hpp"

namespace lackwerk::packs {

/// Errors: missing, damaged, another size, no RGB, a value that is negative (and no hole), no number or beyond 1e9,
/// nothing but holes.
[[nodiscard]] Result<core::BrdfTable> read_brdf_image(const std::filesystem::path& file,
                                                      const core::BrdfTableSize& size);
[[nodiscard]] Result<void> write_brdf_image(const core::BrdfTable& table, const std::filesystem::path& file);

/// Errors name the line: other columns, no number, out of range, no readings at all.
[[nodiscard]] Result<std::vector<AngleReading>> read_readings(const std::filesystem::path& file);
/// Errors: as of reading, so that what is written comes back; and what the disk says.
[[nodiscard]] Result<void> write_readings(const std::vector<AngleReading>& readings, const std::filesystem::path& file);

}  // namespace lackwerk::packs
