// The light around the car: one environment at several roughnesses, in the form core ES 2.0 samples well.
//
// Why it exists: the builder prefilters a map once, the scene pack carries it, the renderer uploads the very bytes, and
// the CPU model reads the same bytes with the same filter. ES 2.0 has no cube map LOD and no float textures, so the
// levels are octahedral squares side by side in one RGBA8 texture, each with a border of one texel that repeats its
// neighbours across the fold: linear filtering shows no seam. Owns its bytes; read-only after it was made: any thread.
//
// Encoding: linear sRGB radiance = (rgb * a)^2 * range, rgb and a in [0, 1] as bytes; a is the smallest byte from
// 6 on with which the largest channel fits: the error is at most 1 % over 1 : 11,700 of the range and grows slowly
// below. Filtering happens on the bytes, as hardware does it; core/environment.glsl is the one decoder.
//
// Places: the map is painted on the inside of a room, a sphere of room_radius_mm around centre_mm cut off by the floor
// z = 0. A direction d at a point p sees the map where the ray meets the room, looked at from centre_mm. Radius 0: the
// map is infinitely far away.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace lackwerk::core {

/// One level: its Beckmann roughness m and its square in the atlas without the border, in texels.
struct EnvironmentLevel {
  double m;
  int x, y, edge;
};

/// Level 0 is the map itself. Level k is what a Beckmann lobe of roughness m mirrors at normal view: the mean of the
/// map over directions l around r, weighted by lobe_shape (paint_model.glsl) times n.l with
/// n = o = r (core/analysis/environment_filter.hpp).
/// Levels from `first_stacked_level` on have one edge and lie below each other, so that a shader finds them by
/// arithmetic.
inline constexpr int environment_level_count = 10;
inline constexpr int first_stacked_level = 2;
inline constexpr int stacked_edge = 96;
inline constexpr int environment_width = 872;
inline constexpr int environment_height = 784;  ///< eight stacked squares of 98 texels
inline constexpr std::array<EnvironmentLevel, environment_level_count> environment_levels = {{
    {0.0, 1, 1, 512},
    {0.02, 1, 515, 256},
    {0.04, 773, 1, 96},
    {0.08, 773, 99, 96},
    {0.14, 773, 197, 96},
    {0.22, 773, 295, 96},
    {0.34, 773, 393, 96},
    {0.50, 773, 491, 96},
    {0.75, 773, 589, 96},
    {1.00, 773, 687, 96},
}};

/// A light cut from the map: `radiance` is its irradiance at normal incidence over pi (what a white diffuser shows).
struct EnvironmentLight {
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< from centre_mm towards the light, unit length
  glm::vec3 radiance{0.0f};               ///< linear sRGB
  bool operator==(const EnvironmentLight&) const = default;
};
inline constexpr int environment_light_count = 64;

struct Environment {
  std::string name;                      ///< "studio", or the stem of the map's file
  glm::vec3 centre_mm{0.0f};             ///< where the map was taken
  float room_radius_mm = 0.0f;           ///< 0 = infinitely far
  float range = 1.0f;                    ///< largest radiance that can be stored, > 0
  std::vector<std::uint8_t> atlas;       ///< environment_width * environment_height RGBA8, row 0 first (v = 0)
  std::vector<EnvironmentLight> lights;  ///< environment_light_count leaves of a median cut, in the tree's order: the
                                         ///< l lights of a coarser cut (1, 4, 16) are sums of 64/l neighbours
  bool operator==(const Environment&) const = default;
};

/// The `count` lights (1, 4, 16 or 64; others are rounded down to one of them) of the median cut: radiances summed,
/// directions averaged by luminance. Sorted by falling luminance.
[[nodiscard]] std::vector<EnvironmentLight> lights_of(const Environment& environment, int count);

/// The same radiance from everywhere, far away: for tests and for scenes that do not care. 64 equal lights.
[[nodiscard]] Environment uniform_environment(glm::vec3 radiance);

/// Octahedral map (Cigolle et al. 2014): unit vector to [0, 1]^2 and back; +z is the middle.
[[nodiscard]] glm::dvec2 octahedral_from_direction(const glm::dvec3& d);
[[nodiscard]] glm::dvec3 direction_from_octahedral(const glm::dvec2& uv);

/// CIE luminance Y of linear sRGB.
[[nodiscard]] double luminance_of(const glm::dvec3& linear);

/// Encodes a radiance (>= 0; larger than range is clipped to it). See above.
void encode_radiance(const glm::dvec3& radiance, double range, std::uint8_t* rgba);
[[nodiscard]] glm::dvec3 decode_radiance(const glm::dvec4& rgba, double range);

/// The fractional level for a Beckmann roughness: linear in m between levels, clamped to [0, level_count - 1].
[[nodiscard]] double environment_level_of(double m);

/// What a linear filter with clamped edges reads at texel coordinates (x, y) of the atlas (texel centres at +0.5),
/// each channel in [0, 1].
[[nodiscard]] glm::dvec4 filtered_texel(const Environment& environment, double x, double y);

/// Draws directions from centre_mm with a density that follows the luminance of level 0. Built in some milliseconds
/// and owns its tables.
class EnvironmentSampler {
 public:
  explicit EnvironmentSampler(const Environment& environment);
  struct Sample {
    glm::dvec3 direction;  ///< unit, as seen from centre_mm
    double pdf;            ///< per steradian around centre_mm, > 0
  };
  /// u in [0, 1)^2; continuous in it except at texel borders.
  [[nodiscard]] Sample sample(const glm::dvec2& u) const;
  [[nodiscard]] double pdf(const glm::dvec3& direction) const;

 private:
  int edge_ = 0;
  std::vector<double> row_sum_;     ///< cumulative, edge_ + 1
  std::vector<double> column_sum_;  ///< cumulative within each row, edge_ * (edge_ + 1)
};

}  // namespace lackwerk::core
