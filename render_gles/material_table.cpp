#include "render_gles/material_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lackwerk::gles {
namespace {

// The paint has seven rows, every other material the first three: it has one lobe. filtered_light.glsl divides by 64.
constexpr int texture_rows = 64;
constexpr int material_rows = 3;
constexpr int first_merged_row = albedo_row_count + material_rows * (packs::surface_kind_count - 1);
static_assert(first_merged_row + material_rows <= texture_rows);
/// Row of each paint term.
constexpr std::array<int, core::paint_term_count> row_of_term = {0, 1, 4, 5, 6};
constexpr float highest_level = core::environment_level_count - 1;

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

int first_row(packs::SurfaceKind kind) {
  return kind == packs::SurfaceKind::paint ? 0 : albedo_row_count + material_rows * (static_cast<int>(kind) - 1);
}

/// An entry between two columns of the tables, at texel `column` of the texture.
template <class T>
T between_columns(const std::array<T, core::albedo_columns>& entries, std::size_t column) {
  constexpr float per_texel = static_cast<float>(core::albedo_columns) / albedo_texels;
  const float at =
      std::clamp((static_cast<float>(column) + 0.5f) * per_texel - 0.5f, 0.0f, core::albedo_columns - 1.0f);
  const auto low = std::min(static_cast<std::size_t>(at), std::size_t{core::albedo_columns} - 2);
  const float w = at - static_cast<float>(low);
  return entries[low] * (1.0f - w) + entries[low + 1] * w;
}

void send(const GlApi& gl, const GlObject& texture, int row, int rows, const std::uint8_t* rgba) {
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, row, albedo_texels, rows, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

void set_filter(const GlApi& gl, GLint filter) {
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

TermScales encode_albedo(const core::AlbedoTable& table, std::vector<std::uint8_t>& rgba) {
  rgba.assign(std::size_t{albedo_row_count} * albedo_texels * 4, 0);
  const auto texel = [&](int row, std::size_t column) {
    return &rgba[(static_cast<std::size_t>(row) * albedo_texels + column) * 4];
  };
  TermScales out;
  for (int term = 0; term < core::paint_term_count; ++term) {
    const core::AlbedoRow& row = table[static_cast<std::size_t>(term)];
    float largest = 1e-6f;
    for (const glm::vec3& a : row.albedo) largest = std::max({largest, a.x, a.y, a.z});
    for (std::size_t k = 0; k < albedo_texels; ++k) {
      std::uint8_t* colour = texel(row_of_term[static_cast<std::size_t>(term)], k);
      const glm::vec3 albedo = between_columns(row.albedo, k);
      for (int c = 0; c < 3; ++c) colour[c] = byte_of(std::sqrt(std::max(albedo[c], 0.0f) / largest));
      if (term == 0) continue;
      // Lobes 0, 1 in row 2, lobe 2 and flakes in row 3: two bytes each.
      std::uint8_t* shape = texel(term <= 2 ? 2 : 3, k) + (term % 2 == 1 ? 0 : 2);
      shape[0] = byte_of(between_columns(row.lean, k));
      shape[1] = byte_of(between_columns(row.level, k) / highest_level);
    }
    if (term == 0) {
      out.diffuse_scale = largest;
    } else {
      out.albedo_scale[term - 1] = largest;
    }
  }
  return out;
}

MaterialTable::MaterialTable(const GlApi& gl) : texture_(make_texture(gl)) {
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture_.id());
  set_filter(gl, GL_NEAREST);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, albedo_texels, texture_rows, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  core::AlbedoTable table;
  for (int kind = 1; kind < packs::surface_kind_count; ++kind) {
    const auto surface = static_cast<packs::SurfaceKind>(kind);
    core::directional_albedo(packs::material_of(surface).surface, table);
    scales_[static_cast<std::size_t>(kind)] = encode_albedo(table, texels_);
    send(gl, texture_, first_row(surface), material_rows, texels_.data());
  }
}

std::size_t MaterialTable::set_paint(const GlApi& gl, const core::InterpolatablePaint& paint,
                                     const core::AnalyticPaint& analytic, const core::PaintTextures& textures) {
  core::directional_albedo(paint, analytic, textures, paint_table_);
  scales_[0] = encode_albedo(paint_table_, texels_);
  send(gl, texture_, 0, albedo_row_count, texels_.data());
  merged_table_[0] = paint_table_[0];
  merged_table_[1] = core::merged_lobes(paint_table_);
  std::size_t sent = texels_.size();
  merged_scales_ = encode_albedo(merged_table_, texels_);
  send(gl, texture_, first_merged_row, material_rows, texels_.data());
  sent += std::size_t{material_rows} * albedo_texels * 4;
  return sent;
}

float MaterialTable::merged_row() { return static_cast<float>(first_merged_row) + 0.5f; }

float MaterialTable::row(packs::SurfaceKind kind) { return static_cast<float>(first_row(kind)) + 0.5f; }

std::size_t MaterialTable::bytes() { return std::size_t{albedo_texels} * texture_rows * 4; }

GlObject upload_environment(const GlApi& gl, const core::Environment& environment) {
  GlObject texture = make_texture(gl);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  set_filter(gl, GL_LINEAR);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, core::environment_width, core::environment_height, 0, GL_RGBA,
                GL_UNSIGNED_BYTE, environment.atlas.data());
  check_gl(gl, "upload of an environment");
  return texture;
}

}  // namespace lackwerk::gles
