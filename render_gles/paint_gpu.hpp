// The realised paint on the GPU: its textures and uniforms.
//
// Why it exists: while a customer drags, only what depends on the changed weights may travel to the GPU. This file
// knows which is which and counts it. Reads the paint through a pointer: whoever made it keeps it alive. Owns GL
// textures; destroy it while its context is current; one GL thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/flake_contrast.hpp"
#include "core/interpolatable_paint.hpp"
#include "core/paint_textures.hpp"
#include "core/realise.hpp"
#include "render_gles/light_shares.hpp"
#include "render_gles/paint_map.hpp"
#include "render_gles/program.hpp"

namespace lackwerk::gles {

/// What has been sent to the GPU so far.
struct UploadCount {
  std::uint64_t uploads = 0;  ///< calls that carried bytes
  std::uint64_t bytes = 0;
  bool operator==(const UploadCount&) const = default;
};

class PaintGpu {
 public:
  /// Uploads what depends on the pack alone. `context` must be current; it and `paint` must outlive the result.
  /// `map`, if any, is chi at all weights wherever light comes from one direction; it is copied. Prefiltered light goes
  /// on using the paint's own colour table, which should be the map's (core::paint_of_map).
  /// Error: a texture of the pack or the map is larger than the driver allows; a map that encode_map refuses.
  [[nodiscard]] static Result<PaintGpu> create(const Context& context, const core::InterpolatablePaint& paint,
                                               const PaintMap* map = nullptr);

  /// Realises the paint at these weights, but for the single flakes, which wait for bring(), and uploads what changed.
  /// Returns whether anything did. Error: weights that core::check_weights refuses; nothing has changed then.
  [[nodiscard]] Result<bool> update(const core::Weights& weights);

  /// Makes the single flakes of this mip level and all coarser ones those of the present weights: before anything is
  /// drawn that shows them. Realises and uploads the levels that are not yet. Most views are far from the finest level,
  /// and many show no single flake at all.
  void bring(int finest_level);

  /// Switches on what this pack needs, at any weights: lobes, table or map, flakes, coat, refraction.
  void add_features(Features& features) const;
  /// Sets the program's paint uniforms and binds the textures to units 0 to 5. The program must be in use.
  void apply(const GlApi& gl, const Program& program) const;
  /// What the pack did not need, and why; one line each.
  [[nodiscard]] std::vector<std::string> explain() const;

  [[nodiscard]] const UploadCount& uploads() const { return uploads_; }
  /// Counts what another part of the renderer sent because of this paint's weights.
  void count_upload(std::size_t bytes) {
    ++uploads_.uploads;
    uploads_.bytes += bytes;
  }
  [[nodiscard]] const core::InterpolatablePaint& source() const { return *paint_; }
  [[nodiscard]] bool has_flakes() const { return textures_.row_count > 0; }
  /// From this mip level on the sum of the flakes under a pixel varies by less than `contrast` of its mean.
  [[nodiscard]] double calm_level(double contrast) const { return core::calm_level(contrast_, contrast); }
  /// Bytes of its textures.
  [[nodiscard]] std::size_t bytes() const;
  /// Edge of a level-0 flake texel, mm; 0 without flakes.
  [[nodiscard]] float texel_mm() const { return paint_->texel_mm; }
  /// The numbers the GPU sees, for tests and for the CPU model. Valid until the next update; the corners are those of
  /// the levels that bring() has brought.
  [[nodiscard]] const core::PaintTextures& textures() const { return textures_; }
  [[nodiscard]] const core::AnalyticPaint& analytic() const { return realised_.analytic; }
  /// core::flake_roughness at the present weights; 1 without flakes.
  [[nodiscard]] double flake_roughness() const { return flake_m_; }
  /// True until the first successful update: there is nothing to draw yet.
  [[nodiscard]] bool pending() const { return weights_.base.empty(); }

 private:
  PaintGpu(const GlApi& gl, const core::InterpolatablePaint& paint) : gl_(&gl), paint_(&paint) {}
  void upload(GlObject& texture, int width, int height, const void* texels, bool resized,
              GLenum wrap = GL_CLAMP_TO_EDGE, GLenum format = GL_RGBA);
  [[nodiscard]] Result<void> upload_map(const PaintMap& map, int largest);
  void upload_chi();
  void upload_flake_means();

  const GlApi* gl_;
  const core::InterpolatablePaint* paint_;
  core::RealisedPaint realised_;
  core::PaintTextures textures_;
  core::Weights weights_;
  int lobes_ = 0;
  bool table_ = false, coat_ = false, refraction_ = false, diffuse_ = false;
  int narrow_ = 0;
  int current_from_ = 0;  ///< corners of this level and coarser ones are those of weights_
  MapUse map_use_ = MapUse::none;
  MapUniforms map_uniforms_;
  int map_edge_ = 0;  ///< 0: no map
  float map_scale_ = 1.0f;
  std::vector<double> contrast_;  ///< of the flakes, per mip level
  double flake_m_ = 1.0;
  GlObject chi_, map_, mean_, slice_, rank_, corner_, random_;
  UploadCount uploads_;
};

/// Sets the analytic part's uniforms (what the program has of u_diffuse, u_lobe, u_inv_m, the indices). The program
/// must be in use.
void apply_analytic(const GlApi& gl, const Program& program, const core::AnalyticPaint& paint);
/// Sets u_diffuse and u_lobe alone, each times its share of light_shares.hpp.
void apply_shares(const GlApi& gl, const Program& program, const core::AnalyticPaint& paint, const LightShares& shares);

}  // namespace lackwerk::gles
