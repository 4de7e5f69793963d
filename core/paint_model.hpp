// The paint model, the environment and the display transform in C++: the very texts of paint_model.glsl,
// environment.glsl and display.glsl, compiled at any scalar type.
//
// Why it exists: CPU reference, shader and precision tests must be the same text, or they test nothing. The struct
// below holds the shader's uniforms as members and its texture fetches over the same bytes the GPU gets; the GLSL is
// included inside it, so that its functions become members. A value that points to the caller's textures; use one per
// thread (it is cheap), never shared while being written.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <type_traits>

#include "core/colour.hpp"
#include "core/environment.hpp"
#include "core/paint_textures.hpp"

namespace lackwerk::core {

/// MAX_EXPONENT and LEAST of paint_model.glsl for floats of 32 bits and more, and for those of 16.
inline constexpr double max_exponent_wide = 126.0, max_exponent_16 = 15.0;
inline constexpr double least_wide = 1e-30, least_16 = 6.2e-5;

/// T: float or double (16-bit types need their own vectors: glm accepts only IEC 559 scalars).
template <class T, class V2 = glm::vec<2, T>, class V3 = glm::vec<3, T>, class V4 = glm::vec<4, T>>
struct PaintModel {
  using real = T;
  using vec2 = V2;
  using vec3 = V3;
  using vec4 = V4;

  /// The standard's floating types have 32 bits or more; others are taken to have 16.
  static constexpr bool is_wide = std::is_floating_point_v<T>;

  // ---- uniforms, as the shader has them
  vec3 u_diffuse{T(0)};
  vec4 u_lobe[3]{};    ///< s.rgb, F0
  vec3 u_inv_m{T(1)};  ///< 1/m per lobe
  real u_coat_ior = T(1);
  real u_refraction_ior = T(1);
  real u_table_size = T(1);
  real u_slice_count = T(0);
  real u_level_count = T(0);
  real u_bins_per_rad = T(1);
  vec2 u_flake_cells{T(0)};  ///< random cells per angle bin along theta_h and theta_i; 0: one for all angles
  vec3 u_lab_lo{T(0)}, u_lab_span{T(1)};
  vec4 u_room{T(0)};                               ///< centre, radius; see environment.glsl
  real u_environment_scale = T(0);                 ///< range times gain
  const PaintTextures* textures = &no_textures();  ///< never null
  const Environment* environment = nullptr;        ///< needed by the functions of environment.glsl alone

  const vec3 LINEAR_FROM_XYZ_R = linear_from_xyz_row(0);
  const vec3 LINEAR_FROM_XYZ_G = linear_from_xyz_row(1);
  const vec3 LINEAR_FROM_XYZ_B = linear_from_xyz_row(2);
  const real LAB_DELTA = T(lab_delta);
  /// Largest power of two a lobe may have, and the least number that is held in full: see lobe_shape.
  const real MAX_EXPONENT = T(is_wide ? max_exponent_wide : max_exponent_16),
             LEAST = T(is_wide ? least_wide : least_16);

  // ---- GLSL's built-in functions, at this scalar type; scalars of other namespaces bring their own
  static real sqrt(real x) {
    using std::sqrt;
    return sqrt(x);
  }
  static real exp2(real x) {
    using std::exp2;
    return exp2(x);
  }
  static real pow(real x, real y) {
    using std::pow;
    return pow(x, y);
  }
  static real cos(real x) {
    using std::cos;
    return cos(x);
  }
  static real sin(real x) {
    using std::sin;
    return sin(x);
  }
  static real abs(real x) {
    using std::abs;
    return abs(x);
  }
  static real log2(real x) {
    using std::log2;
    return log2(x);
  }
  static real floor(real x) {
    using std::floor;
    return floor(x);
  }
  static vec2 floor(vec2 v) { return vec2(floor(v.x), floor(v.y)); }
  static real fract(real x) { return x - floor(x); }
  static real atan(real y, real x) {
    using std::atan2;
    return atan2(y, x);
  }
  static real min(real a, real b) { return b < a ? b : a; }
  static real max(real a, real b) { return a < b ? b : a; }
  static vec3 max(vec3 a, vec3 b) { return vec3(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)); }
  static real clamp(real x, real lo, real hi) { return min(max(x, lo), hi); }
  static real mix(real a, real b, real t) { return a * (T(1) - t) + b * t; }
  static real dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static real length(vec3 a) { return sqrt(dot(a, a)); }
  static vec3 cross(vec3 a, vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  }
  static vec3 make_vec3(vec4 v) { return vec3(v.x, v.y, v.z); }

  // ---- texture fetches over the GPU's own bytes
  static real byte(std::uint8_t b) { return T(b) / T(255); }
  static vec4 texel(const std::uint8_t* p) { return vec4(byte(p[0]), byte(p[1]), byte(p[2]), byte(p[3])); }
  static int index(real x) { return static_cast<int>(x); }

  vec3 fetch_chi(real u, real v) const {
    const auto c = textures->sample_chi(static_cast<double>(u), static_cast<double>(v));
    return vec3(T(c.x), T(c.y), T(c.z));
  }
  vec3 fetch_mean(real bin_h, real bin_i) const {
    const auto m = textures->mean_at(index(bin_h), index(bin_i));
    return vec3(T(m.x), T(m.y), T(m.z));
  }
  vec4 fetch_slice(real bin_h, real bin_i) const { return texel(textures->slice_texel(index(bin_h), index(bin_i))); }
  vec4 fetch_rank(real step, real row) const { return texel(textures->rank_texel(index(step), index(row))); }
  vec4 fetch_corner(real x, real row) const { return texel(textures->corner_texel(index(x), index(row))); }
  vec2 fetch_random(real x, real y) const {
    const std::uint8_t* t = textures->random_texel(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
    return vec2(byte(t[0]), byte(t[1]));
  }

  vec4 fetch_environment(real x, real y) const {
    const auto t = filtered_texel(*environment, static_cast<double>(x), static_cast<double>(y));
    return vec4(T(t.x), T(t.y), T(t.z), T(t.w));
  }

// The shader's switches: in C++ everything is compiled in; zero weights and empty tables switch terms off.
#define LOBES 3
#define HAS_TABLE (1)
#define HAS_FLAKES (1)
#define HAS_COAT (1)
#define HAS_REFRACTION (1)
#define COLOUR_MAP (0)
#define FLAKE_TAPS 4
#define FLAKE_CELLS 4
#define R(x) static_cast<real>(x)
// clang-format off: the order is the shader's
#include "core/display.glsl"
#include "core/environment.glsl"
#include "core/paint_model.glsl"
// clang-format on
#undef LOBES
#undef HAS_TABLE
#undef HAS_FLAKES
#undef HAS_COAT
#undef HAS_REFRACTION
#undef COLOUR_MAP
#undef FLAKE_TAPS
#undef FLAKE_CELLS
#undef R
#undef MIN_COSINE
#undef ENV_STACK_X
#undef ENV_STACK_EDGE
#undef ENV_STACK_STEP

 private:
  /// One row of XYZ-to-linear with the white point folded in, so that the shader multiplies once.
  static vec3 linear_from_xyz_row(int row) {
    return vec3(T(xyz_to_rgb[row][0] * white_xyz[0]), T(xyz_to_rgb[row][1] * white_xyz[1]),
                T(xyz_to_rgb[row][2] * white_xyz[2]));
  }
};

}  // namespace lackwerk::core
