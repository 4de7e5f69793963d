// Two pictures and the map of their differences beside each other, for people.
//
// Why it exists: a number says that a picture has changed, this shows where and what. `lackwerk compare` and failing
// golden tests write it. A pure function but for the file it writes; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/tools/image_compare.hpp"

namespace lackwerk::packs {

/// CIEDE2000 at the bright end of the colour scale, which runs by the square root, so that 0.5 is told from 0.
inline constexpr float map_scale_end = 10.0f;

/// Colour of a difference on the map, encoded sRGB in [0, 1]: black, blue, red, yellow, white.
[[nodiscard]] glm::vec3 map_colour(float difference);

/// Writes a picture (the name's ending says which format; PNG is meant): A, B and the map of `map` (one CIEDE2000 a
/// pixel; negative = not counted, drawn grey), below them captions, the colour scale with its numbers and `note`.
/// Words need the font DejaVu Sans and are left out where it is missing. Linear colours beyond white are cut off.
/// Error: the file cannot be written.
[[nodiscard]] Result<void> write_difference_picture(const std::filesystem::path& path, const LinearImage& a,
                                                    const LinearImage& b, const std::vector<float>& map,
                                                    const std::string& note);

}  // namespace lackwerk::packs
