// The albedo texture of filtered_light.glsl, and the environment on the GPU.
//
// Why it exists: every surface of the car finds its directional albedo in one small texture; only the paint's five rows
// change with the weights. Owns GL textures; destroy it while its context is current; one GL thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "core/directional_albedo.hpp"
#include "packs/materials.hpp"
#include "render_gles/gl_object.hpp"
#include "render_gles/program.hpp"

namespace lackwerk::gles {

/// What filtered_light.glsl must know about one material besides its rows.
struct TermScales {
  float diffuse_scale = 0.0f;
  glm::vec4 albedo_scale{0.0f};  ///< lobes 0 to 2, flakes
  bool operator==(const TermScales&) const = default;
};

/// Texels a row: interpolated from the tables' columns, so that the nearest texel will do. Seven linear fetches were a
/// third of a software rasteriser's frame.
inline constexpr int albedo_texels = 256;
/// Seven rows of texels: diffuse, lobe 0, lean and level of lobes 0 and 1, of lobe 2 and the flakes, lobe 1, lobe 2,
/// flakes. In the others rgb = sqrt(albedo / scale). `rgba` gets albedo_row_count * albedo_texels texels.
inline constexpr int albedo_row_count = core::paint_term_count + 2;
[[nodiscard]] TermScales encode_albedo(const core::AlbedoTable& table, std::vector<std::uint8_t>& rgba);

class MaterialTable {
 public:
  MaterialTable() = default;
  /// Computes and uploads the rows of every material but the paint.
  explicit MaterialTable(const GlApi& gl);
  /// Computes and uploads the paint's rows. Returns the bytes sent.
  std::size_t set_paint(const GlApi& gl, const core::InterpolatablePaint& paint, const core::AnalyticPaint& analytic,
                        const core::PaintTextures& textures);
  [[nodiscard]] const TermScales& scales(packs::SurfaceKind kind) const {
    return scales_[static_cast<std::size_t>(kind)];
  }
  /// Of the paint's lobes and flakes as one lobe.
  [[nodiscard]] const TermScales& merged_scales() const { return merged_scales_; }
  /// First row of a material in the texture, plus a half.
  [[nodiscard]] static float row(packs::SurfaceKind kind);
  [[nodiscard]] static float merged_row();
  [[nodiscard]] GLuint texture() const { return texture_.id(); }
  [[nodiscard]] static std::size_t bytes();

 private:
  std::array<TermScales, packs::surface_kind_count> scales_{};
  TermScales merged_scales_;
  core::AlbedoTable paint_table_{}, merged_table_{};
  std::vector<std::uint8_t> texels_;
  GlObject texture_;
};

/// Uploads an environment's atlas with linear filtering.
[[nodiscard]] GlObject upload_environment(const GlApi& gl, const core::Environment& environment);

}  // namespace lackwerk::gles
