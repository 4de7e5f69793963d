// A scene as plain data: what stands in the showroom, before any GPU sees it.
//
// Why it exists: the scene builder (tools) makes it, the scene pack stores it, the renderer uploads it. None of the
// three needs to know the others. It owns its arrays; it is a value and may be used from any thread.
//
// Axes: right-handed, millimetres. +x is the car's nose, +y its left side, +z up; z = 0 is the floor, the origin lies
// under the middle of the car.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/environment.hpp"

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

/// How much of the environment's light from direction d reaches a vertex, baked: V(d) = sum of nine coefficients times
/// (1, x, y, z, xy, yz, zx, x^2 - y^2, 3 z^2 - 1), clamped to [0, 1]. A coefficient is (byte - 128) / 64: 1 and 0 are
/// exact, so that an open vertex is exactly open. Fitted over the hemisphere of the vertex normal (what lies behind it
/// never counts). The floor does not block: light from below is the environment's own floor, darkened where the car
/// stands on it.
using Visibility = std::array<std::uint8_t, 9>;
inline constexpr Visibility open_visibility = {192, 128, 128, 128, 128, 128, 128, 128, 128};

/// Baked irradiance over pi (what a white diffuser shows there, visibility included), per channel: sqrt(value / range)
/// times 65535, with the scene's irradiance_range.
using Irradiance = std::array<std::uint16_t, 3>;

/// Detail levels a part is drawn at, as bits.
inline constexpr std::uint8_t detail_full = 1;    ///< still pictures, close views, strong GPUs
inline constexpr std::uint8_t detail_coarse = 2;  ///< moving pictures on weak machines, and the floor's mirror image

/// One indexed triangle mesh of one material. Arrays have equal length, except `indices` (a multiple of three).
struct MeshPart {
  std::string name;                       ///< "body", "window_front", ...: for messages only
  SurfaceKind kind = SurfaceKind::paint;  ///
  std::vector<glm::vec3> positions_mm;    ///< vertices, millimetres
  std::vector<glm::vec3> normals;         ///< unit length, pointing outward
  std::vector<std::uint32_t> indices;     ///< counter-clockwise seen from outside
  std::vector<Visibility> visibility;     ///< empty = all open
  std::vector<Irradiance> irradiance;     ///< empty = not baked: the renderer asks the environment's last level
  std::uint8_t detail = detail_full | detail_coarse;
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
  core::Environment environment = core::uniform_environment(glm::vec3(1.0f));
  float irradiance_range = 1.0f;  ///< of all parts' irradiance, > 0
};

}  // namespace lackwerk::packs
