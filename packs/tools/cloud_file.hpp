// Scans from files: xyz (text) and PLY (text, binary of either byte order).
//
// Why it exists: these are what scanners and CloudCompare write. Values; any thread. Files are only read, and nothing
// in them is believed: counts are checked against the file's own length before memory is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/analysis/point_cloud.hpp"
#include "core/error.hpp"

namespace lackwerk::packs {

/// At most 1 GiB and 8 million points. By extension: .ply, or text (.xyz, .txt, .asc) with "x y z" or "x y z label" a
/// line, separated by blanks, tabs, commas or semicolons; further columns are not read, a fourth one is a label where
/// it is a whole number on every line; lines from '#' or "//" and blank ones are skipped. PLY: vertex properties x, y,
/// z of any type, and `label`, `segment`, `class` or `scalar_Label` where there is one; other properties and elements
/// are skipped, lists only behind the vertices. Errors name the line (text) or vertex and property: not finite, beyond
/// 1e9, cut short, too many, no vertices, no such format.
[[nodiscard]] Result<core::PointCloud> read_cloud(const std::filesystem::path& file);
/// From the bytes of a file; `file` says which format, and names it in errors.
[[nodiscard]] Result<core::PointCloud> parse_cloud(std::span<const std::uint8_t> bytes,
                                                   const std::filesystem::path& file);

}  // namespace lackwerk::packs
