// The display transform in C++: the very text of core/display.glsl, as core/paint_model.hpp does it for the paint.
//
// Why it exists: the background is cleared to a colour that must meet what the floor fades into, and tests compare
// whole pixels. A stateless value; any thread.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace lackwerk::gles {

/// T: float or double.
template <class T>
struct DisplayModel {
  using real = T;
  using vec3 = glm::vec<3, T>;

  static real exp2(real x) { return std::exp2(x); }
  static real pow(real x, real y) { return std::pow(x, y); }
  static real fract(real x) { return x - std::floor(x); }
  static real max(real a, real b) { return a < b ? b : a; }
  static vec3 max(vec3 a, vec3 b) { return vec3(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)); }

#define R(x) static_cast<real>(x)
#include "core/display.glsl"
#undef R
};

}  // namespace lackwerk::gles
