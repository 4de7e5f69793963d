// Puts an imported model where our scenes stand, and looks at it.
//
// Why it exists: models lie, stand and measure as their makers liked; renderer, baking and cameras expect millimetres,
// z up, the nose along +x, tyres on z = 0. Pure functions over values; any thread.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/scene.hpp"

namespace lackwerk::packs {

enum class UpAxis { guess, y, z };

struct PlacementWish {
  UpAxis up = UpAxis::guess;
  bool in_metres = false;   ///< the format says so (glTF)
  bool up_is_y = false;     ///< likewise
  double length_mm = 0.0;   ///< of the longest horizontal side; 0 = by the unit
  double rotate_deg = 0.0;  ///< about z at the end, counter-clockwise from above
};

/// p_mm = turn * p + shift_mm; turn scales as well.
struct Placement {
  glm::dmat3 turn{1.0};
  glm::dvec3 shift_mm{0.0};
  std::string note;  ///< what was guessed: "up is z, the unit is centimetres, ..."
};

/// `positions`: all vertices of the model, finite. The longer horizontal side becomes x. Nose: +z of models whose up is
/// y, -y of those whose up is z (what glTF asks for and Blender does), where that is the longer side; else +x. Errors:
/// no extent, or no unit that gives a car.
[[nodiscard]] Result<Placement> place_model(const std::vector<glm::vec3>& positions, const PlacementWish& wish,
                                            const std::string& file);

/// The car's cameras (hero, side, rear, front, rim, macro, stripe), moved and scaled to the box of the parts, which
/// must not be empty. 'macro' looks at the paint from 150 mm.
[[nodiscard]] std::vector<Camera> framed_cameras(const std::vector<MeshPart>& parts);

}  // namespace lackwerk::packs
