// What a bare point needs to be seen as part of a surface: a normal, and how much of the sky it sees.
//
// Why it exists: scans bring places alone; splats of one brightness read as noise, not as a plant. Pure; any thread;
// same bytes for the same input.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace lackwerk::core {

/// The direction of least spread of each point's `neighbours` nearest ones (Hoppe et al. 1992), unit length, turned so
/// that it points upwards (`up`: 0, 1 or 2). Where there is no such direction (fewer than three neighbours, all in one
/// place or on one line): upwards, as far as a line allows.
[[nodiscard]] std::vector<glm::vec3> normals_of(std::span<const glm::dvec3> points, std::size_t neighbours, int up);

/// The part of a sky (brighter above, cosine about the vertical) that each point sees past the others, [0, 1]: rays
/// through cubes of edge `cube` that hold points, those next to the point left out, as far as `reach` cubes.
/// `cube` > 0.
[[nodiscard]] std::vector<float> sky_of(std::span<const glm::dvec3> points, double cube, int reach, int up);

}  // namespace lackwerk::core
