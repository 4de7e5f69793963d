// The meaning of a scene: what must hold before anyone draws it.
//
// Why it exists: a digest proves that a file is what somebody wrote, and FlatBuffers that it is well formed; neither
// says that indices stay inside or that light is not negative. Reader and writer both call this. Pure; any thread.
#pragma once

#include <cstddef>
#include <string>

#include "packs/scene_pack.hpp"

namespace lackwerk::packs {

inline constexpr std::size_t max_scene_name_bytes = 200;
inline constexpr float max_unit_error = 1e-2f;  ///< by which a normal's length may miss 1

/// "parts[3]".
[[nodiscard]] std::string item_name(const char* name, std::size_t index);

/// The counts alone, for before memory is taken.
[[nodiscard]] Result<void> check_scene_counts(std::size_t parts, std::size_t cameras, std::size_t vertices,
                                              std::size_t indices, const std::string& file);
[[nodiscard]] Result<void> check_counts_of(const Scene& scene, const std::string& file);
[[nodiscard]] Result<void> check_environment_counts(std::size_t atlas_bytes, std::size_t lights,
                                                    const std::string& file);

/// Everything. The first violation is the Error: `file`, the field ("parts[1].normals[7]"), what is wrong, what to do.
[[nodiscard]] Result<void> check_scene(const Scene& scene, const std::string& file);

}  // namespace lackwerk::packs
