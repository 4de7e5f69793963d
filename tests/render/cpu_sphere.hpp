// The sphere of support.hpp, shaded on the CPU at double precision by the very texts the shader is made of.
//
// Why it exists: two GPU backends agreeing says little if both are wrong. Only what surface_fragment.glsl adds around
// the model under directional lights is written again here (no studio, no dither, open everywhere). Test code.
#pragma once

#include <cstdint>
#include <vector>

#include "core/interpolatable_paint.hpp"
#include "render_gles/image.hpp"
#include "render_gles/paint_gpu.hpp"
#include "render_gles/view.hpp"

namespace lackwerk::test {

struct CpuPicture {
  gles::Image image;
  std::vector<std::uint8_t> mask;  ///< 1 where the surface faces the eye by more than `min_cosine`
  std::size_t hit = 0;             ///< pixels whose middle shows the sphere
  std::size_t compared = 0;        ///< of these, not masked as silhouette
};

/// `gpu` lends the textures and the analytic part as the GPU has them. Silhouette pixels (n.o <= min_cosine) are
/// shaded but masked: there, the mesh's chords and the sphere's arc differ by a good part of a pixel.
[[nodiscard]] CpuPicture shade_sphere(float radius_mm, const gles::View& view, const gles::Lighting& lighting,
                                      const core::InterpolatablePaint& paint, const gles::PaintGpu& gpu, int width,
                                      int height, double min_cosine = 0.15);

}  // namespace lackwerk::test
