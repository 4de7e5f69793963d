// The truth the renderer is judged against: the showroom picture by Monte Carlo integration at double precision.
//
// Why it exists: the renderer takes light from prefiltered levels, baked irradiance and a few lights; each of these is
// an approximation with a knob, and a knob's error can only be measured against something that has none of them. The
// integrator reads the very bytes the renderer reads (environment, visibility, paint textures) and evaluates the very
// text of the paint model, and integrates light over all directions by sampling, with an error bar per pixel.
//
// It owns nothing but its copies for Embree; scene, environment and textures must outlive the call. Starts and joins
// its own threads; the same seed and number of samples give the same bytes whatever their number.
//
// What is integrated at a point p of normal n towards o (bent to face the eye as the renderer does):
//   integral of rho(n, i, o)/pi (n.i) L(p, i) V(i) over i    rho: PaintModel::paint_factor (under the coat)
// + F(n.o) L(p, r) V(r)                                      the coat's mirror, r = mirrored o
// + sum of rho(n, l, o) (n.l) E/pi V(l)                      directional lights
// + emission * lamp_glow.
// Glass covers what lies behind it by coverage + (1 - coverage) F, in linear light.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/environment.hpp"
#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "core/paint_textures.hpp"

namespace lackwerk::core {

/// What meshes of one kind are made of.
struct ReferenceMaterial {
  AnalyticPaint surface;     ///< not read where `is_paint`
  bool is_paint = false;     ///< the paint under test, ReferenceScene::paint
  bool is_floor = false;     ///< fades into the backdrop with distance; its gloss mirrors the other meshes
  glm::dvec3 emission{0.0};  ///< radiance per unit of lamp_glow, linear sRGB
  double coverage = 1.0;     ///< < 1: blended over what lies behind, see above
};

/// An indexed triangle mesh, counter-clockwise seen from outside; its inside is not drawn.
struct ReferenceMesh {
  std::span<const glm::vec3> positions_mm;
  std::span<const glm::vec3> normals;  ///< as many, unit length
  /// Nine bytes a vertex, (byte - 128) / 64 each, as packs::Visibility; empty = all open.
  std::span<const std::uint8_t> visibility;
  std::span<const std::uint32_t> indices;  ///< a multiple of three, all < positions_mm.size()
  std::size_t material = 0;                ///< index into ReferenceScene::materials
};

/// The paint under test at some weights; pointers may be null where no mesh is painted.
struct ReferencePaint {
  const InterpolatablePaint* pack = nullptr;
  const AnalyticPaint* analytic = nullptr;  ///< realised
  const PaintTextures* textures = nullptr;  ///< realised
  bool single_flakes = true;                ///< false: the flakes' mean everywhere
};

struct ReferenceScene {
  std::vector<ReferenceMaterial> materials;
  std::vector<ReferenceMesh> meshes;
  const Environment* environment = nullptr;  ///< never null
  ReferencePaint paint;
};

/// The same projection as gles::View.
struct ReferenceView {
  glm::dvec3 eye_mm{0.0, -5000.0, 1500.0};
  glm::dvec3 target_mm{0.0};
  double vertical_fov_deg = 30.0;  ///< (0, 120)
};

/// Light from one direction everywhere; `radiance` is E/pi, what a white diffuser shows.
struct ReferenceLight {
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< towards the light, unit
  glm::dvec3 radiance{0.0};             ///< linear sRGB
};

struct ReferenceLighting {
  std::vector<ReferenceLight> lights;
  double gain = 1.0;         ///< brightness of the environment, >= 0
  double exposure = 1.0;     ///< scene-linear to display-linear, > 0
  double lamp_glow = 0.0;    ///< radiance of the car's own lamps
  glm::dvec3 backdrop{0.0};  ///< linear sRGB after exposure: what is seen past the floor, and what the floor fades to
};

/// How much of the light from a direction arrives at a point.
enum class ReferenceVisibility {
  baked,   ///< the visibility bytes, as the renderer sees them; only the floor's gloss is traced
  traced,  ///< rays: true shadows, and light from one surface to another
};

struct ReferenceOptions {
  int width = 1280, height = 720;  ///< pixels, [1, 8192]
  int samples = 256;               ///< a pixel; rounded up to a multiple of reference_batch, at least two of them
  double seconds = 0.0;            ///< > 0: stop before this time where the next batch would pass it (after two)
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one per core
  ReferenceVisibility visibility = ReferenceVisibility::baked;
  int bounces = 1;  ///< surfaces a traced ray may meet after the first, [0, 8]
};

struct ReferenceImage {
  int width = 0, height = 0;
  int samples = 0;                      ///< a pixel
  std::vector<glm::dvec3> mean;         ///< scene-linear sRGB before exposure; rows from top to bottom
  std::vector<glm::dvec3> error;        ///< standard error of `mean`, per channel
  std::vector<double> luminance_error;  ///< standard error of its luminance
  std::uint64_t paths = 0;              ///< camera rays: width * height * samples
  std::uint64_t rays = 0;               ///< all rays traced
  double seconds = 0.0;
};

/// `fraction` done of the whole, [0, 1]. Called from worker threads, one at a time.
using ReferenceProgress = std::function<void(double fraction, int samples_done)>;

/// Errors: no ray tracing device, sizes out of range, meshes that index beyond their arrays.
[[nodiscard]] Result<ReferenceImage> render_reference(const ReferenceScene& scene, const ReferenceView& view,
                                                      const ReferenceLighting& lighting,
                                                      const ReferenceOptions& options,
                                                      const ReferenceProgress& progress = {});

/// The picture as a screen shows it: exposure, display_transform, 8 bits (three a pixel), no dither.
[[nodiscard]] std::vector<std::uint8_t> reference_bytes(const ReferenceImage& image, double exposure);

/// Per pixel, how many 8-bit steps the shown picture moves when the mean moves by its standard error (the largest
/// channel's).
[[nodiscard]] std::vector<float> reference_error_steps(const ReferenceImage& image, double exposure);

}  // namespace lackwerk::core
