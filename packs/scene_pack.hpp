// Scene packs: a packs::Scene in a sealed file.
//
// Why it exists: the car takes seconds to build and milliseconds to load, and the kiosk carries no mesh builder. Free
// functions over values; any thread. Format: docs/pack-format.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/scene.hpp"
#include "packs/sealed_file.hpp"

namespace lackwerk::packs {

/// Written. 1 had no light in it and is refused; 2 had ambient occlusion as well, which visibility and irradiance hold.
inline constexpr std::uint32_t scene_schema_version = 3;
inline constexpr std::uint32_t oldest_scene_schema_version = 2;  ///< read
/// Core ES 2.0 draws with 16-bit indices: no part of a scene pack has more vertices.
inline constexpr std::size_t max_part_vertices = 65535;
inline constexpr std::size_t max_scene_parts = 4096;
inline constexpr std::size_t max_scene_cameras = 64;
inline constexpr std::size_t max_scene_vertices = 4'000'000;
inline constexpr std::size_t max_scene_indices = 24'000'000;
inline constexpr float max_radiance = 1e6f;  ///< range of environment and irradiance, radiance of a light
inline constexpr float min_room_radius_mm = 100.0f, max_room_radius_mm = 1e6f;

/// Opens, checks (container, FlatBuffers structure, then meaning) and copies into a Scene. Positions come back bit for
/// bit, normals within 2e-5 of what was written and unit length, everything else exactly. Every part has at most
/// max_part_vertices. Errors name file and field.
[[nodiscard]] Result<Scene> read_scene_pack(const std::filesystem::path& path, Backing backing = Backing::map);

/// Writes (and replaces) a scene pack. Parts of more than max_part_vertices are split into several of the same name,
/// kind and detail. Refuses what read_scene_pack would refuse: numbers that are not finite or beyond 1e6 mm, normals
/// further than 1e-2 from unit length, arrays of unequal length, indices out of range, an environment that is not
/// whole, too many of anything.
[[nodiscard]] Result<void> write_scene_pack(const std::filesystem::path& path, const Scene& scene);

/// The payload, unchecked and unsplit (indices are cut to 16 bits): for the writer, and for tests of the reader.
[[nodiscard]] std::vector<std::uint8_t> encode_scene_pack(const Scene& scene);

/// Checks and copies a payload aligned to 4 bytes; `file` is for messages.
[[nodiscard]] Result<Scene> decode_scene_pack(std::span<const std::uint8_t> payload, const std::string& file);

}  // namespace lackwerk::packs
