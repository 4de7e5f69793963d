// What a frame shows: the camera, the light, and how flakes are drawn.
//
// Why it exists: these values are all that changes between frames besides the paint, so "has anything changed" is a
// comparison. Values; any thread.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "packs/scene.hpp"
#include "render_gles/mesh_buffers.hpp"

namespace lackwerk::gles {

inline constexpr int max_lights = 4;  ///< ES 2.0 guarantees only 16 fragment uniform vectors

struct View {
  glm::vec3 eye_mm{0.0f, -5000.0f, 1500.0f};
  glm::vec3 target_mm{0.0f};
  float vertical_fov_deg = 30.0f;  ///< (0, 120)
  glm::vec2 jitter_px{0.0f};       ///< shifts the picture by parts of a pixel, for supersampling; [-0.5, 0.5]
  bool operator==(const View&) const = default;

  /// A scene's camera.
  [[nodiscard]] static View from(const packs::Camera& camera) {
    return {camera.eye_mm, camera.target_mm, camera.vertical_fov_deg, {}};
  }
};

/// Light from one direction everywhere.
struct DirectionalLight {
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  ///< towards the light, unit length
  glm::vec3 radiance{0.0f};  ///< irradiance at normal incidence over pi, linear sRGB: what a white diffuser would show
  bool operator==(const DirectionalLight&) const = default;
};

/// How flakes are drawn. Each step costs more; the mean colour of a surface is the same from `mean` on.
enum class FlakeMode {
  off,       ///< lobes only: darker than the paint by the flakes' mean
  mean,      ///< their mean colour, no sparkle
  nearest,   ///< single flakes from the nearest angle slice
  bilinear,  ///< single flakes blended between the four slices around
};

/// Where the environment's light comes from in a moving picture.
enum class LightPath {
  none,      ///< the environment is switched off
  filtered,  ///< prefiltered levels per lobe, baked irradiance, single flakes of a few lights
  lights,    ///< directional lights cut from the environment with the full model, and its mirror image in the coat
};

/// How a moving picture is drawn: what the governor chooses. A still picture always takes the best of each.
struct Quality {
  LightPath path = LightPath::filtered;
  int cut_lights = 4;  ///< of LightPath::lights: 1, 4, 16 or 64
  FlakeMode flakes = FlakeMode::bilinear;
  bool flake_cross_fade = true;   ///< between angle cells; else flakes switch on and off in steps
  int flake_lights = max_lights;  ///< how many directional lights show single flakes; the rest show the mean
  bool one_lobe = false;          ///< all lobes and the mean flakes as one lobe, where no single flakes show
  int sparkle_lights = 1;    ///< how many lights of the environment show single flakes on the filtered path, [0, 4]
  bool floor_mirror = true;  ///< the car's image in the floor
  bool coarse = false;       ///< the scene's coarse detail level
  bool smooth_edges = true;  ///< a pass over the finished picture
  float scale = 1.0f;        ///< resolution of the moving picture over that of the screen, [0.25, 1]
  bool operator==(const Quality&) const = default;
};

struct Lighting {
  std::vector<DirectionalLight> lights;       ///< of the mood, besides the environment; at most max_lights
  float exposure = 1.0f;                      ///< scene-linear to display-linear, > 0
  float environment_gain = 1.0f;              ///< brightness of the environment, >= 0
  float lamp_glow = 0.0f;                     ///< radiance of the car's own lamps when switched on
  glm::vec3 backdrop{0.02f, 0.021f, 0.023f};  ///< linear sRGB after exposure; where the floor fades to
  bool stripes = false;                       ///< body designer's stripe reflections instead of paint
  bool dither = true;                         ///< half a step of noise against banding
  /// Waves in the clear coat's mirror image: rms tilt of its normal, milliradians, [0, 20]. 0 = none, and not compiled
  /// in. A car from the line has about 1 to 5. Needs 32-bit fragment floats; without them it is left out.
  float orange_peel_mrad = 0.0f;
  Quality quality;
  bool operator==(const Lighting&) const = default;
};

/// World (mm) to clip space. The depth range is fitted to `boxes`, so that 16 bits of depth suffice.
/// `width`, `height` in pixels.
[[nodiscard]] glm::mat4 clip_from_world(const View& view, int width, int height, std::span<const Box> boxes);

/// Edge of a pixel in mm per mm of distance: 2 tan(fov/2) / height.
[[nodiscard]] float pixel_size_per_mm(const View& view, int height);

/// Sub-pixel offsets in [-0.5, 0.5): the k-th of a Halton (2, 3) sequence; k = 0 is the middle.
[[nodiscard]] glm::vec2 halton_jitter(int k);

}  // namespace lackwerk::gles
