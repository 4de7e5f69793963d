// A scene as plain data: what stands in the showroom, before any GPU sees it.
//
// Why it exists: the scene builder (tools) makes it, the scene pack stores it, the renderer uploads it. None of the
// three needs to know the others. It owns its arrays; it is a value and may be used from any thread.
//
// Axes: right-handed, millimetres. +x is the car's nose, +y its left side, +z up; z = 0 is the floor, the origin lies
// under the middle of the car.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace lackwerk::packs {

/// What a part is made of. The renderer has one shading rule for each; `paint` is the only one a pack changes.
enum class SurfaceKind : std::uint8_t {
  paint = 0,       ///< the car paint under test
  glass = 1,       ///< windows: dark tint, dielectric mirror, drawn blended after everything opaque
  chrome = 2,      ///< bright metal trim, mirrors of lamps
  rubber = 3,      ///< tyres, seals, shut-line gaps: dark and matt
  trim = 4,        ///< black plastic: grilles, cladding, lower bumpers, wipers
  rim = 5,         ///< wheel rims and brake discs: satin metal
  lamp_clear = 6,  ///< headlamp glass and its bright inside
  lamp_red = 7,    ///< tail lamps
  interior = 8,    ///< what little is seen through the glass: nearly black
  floor = 9,       ///< the showroom floor
};
inline constexpr std::uint8_t surface_kind_count = 10;

/// One indexed triangle mesh of one material. Arrays have equal length, except `indices` (a multiple of three).
struct MeshPart {
  std::string name;                             ///< "body", "window_front", ...: for messages only
  SurfaceKind kind = SurfaceKind::paint;        ///
  std::vector<glm::vec3> positions_mm;          ///< vertices, millimetres
  std::vector<glm::vec3> normals;               ///< unit length, pointing outward
  std::vector<std::uint8_t> ambient_occlusion;  ///< 255 = open, 0 = closed; empty = all open
  std::vector<std::uint32_t> indices;           ///< counter-clockwise seen from outside
};

/// A named point of view. Vertical field of view; the horizontal one follows from the picture's shape.
struct Camera {
  std::string name;
  glm::vec3 eye_mm{};
  glm::vec3 target_mm{};
  float vertical_fov_deg = 30.0f;  ///< (0, 120)
};

struct Scene {
  std::string name;
  std::vector<MeshPart> parts;
  std::vector<Camera> cameras;  ///< the first one is the default
};

}  // namespace lackwerk::packs
