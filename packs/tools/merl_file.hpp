// MERL's BRDF binaries (Matusik et al. 2003), read and written.
//
// Why it exists: MERL's hundred materials, several paints among them, are the best known measured BRDFs, and their form
// is what other instruments export. Published copies have holes. Values; any thread. Files are read and written here
// only.
//
// Layout, little-endian: three int32, 90 theta_h, 90 theta_d, 180 phi_d; then doubles, one plane each for R, G and B,
// phi_d fastest. Values times 1/1500, 1.15/1500, 1.66/1500 are the BRDF without its cosine, 1/sr, taken as linear sRGB
// as they are. A negative value marks a hole. Value (i, j, k) stands at the NODE theta_h = (i / 90)^2 pi/2,
// theta_d = j/90 pi/2, phi_d = k/180 pi (half a cell below a BrdfTable's middles).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/analysis/brdf_table.hpp"
#include "core/error.hpp"

namespace lackwerk::packs {

struct MerlMaterial {
  core::BrdfTable table;  ///< resampled at the middles, linearly between nodes
  /// Nodes with both directions above the horizon, and how many of them are holes in the file.
  std::size_t nodes = 0, holes = 0;
};

/// From the bytes of a file; `file` names it in errors. A middle is a hole where more than half of the nodes around it
/// are. `size`: only tests of small files give another than MERL's. Errors: cut or too long, other dimensions, values
/// that are no numbers or beyond 1e9, nothing but holes.
[[nodiscard]] Result<MerlMaterial> read_merl(std::span<const std::uint8_t> bytes, const std::string& file,
                                             const core::BrdfTableSize& size = {});
[[nodiscard]] Result<MerlMaterial> read_merl(const std::filesystem::path& path);

/// Angles of a node.
[[nodiscard]] core::HalfAngles merl_node(std::size_t node, const core::BrdfTableSize& size = {});

/// The bytes of a file that holds `brdf` at the nodes; -1 in all planes where a direction is below the horizon or a
/// channel is negative or no number.
[[nodiscard]] std::vector<std::uint8_t> merl_bytes(const core::Brdf& brdf, const core::BrdfTableSize& size = {});
[[nodiscard]] Result<void> write_merl(const core::Brdf& brdf, const std::filesystem::path& path);

}  // namespace lackwerk::packs
