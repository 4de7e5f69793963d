#include "render_gles/paint_gpu.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/directional_albedo.hpp"
#include "core/environment.hpp"

namespace lackwerk::gles {
namespace {

int real_lobes(const core::AnalyticPaint& paint) {
  return static_cast<int>(std::count_if(paint.lobes.begin(), paint.lobes.end(),
                                        [](const core::Lobe& lobe) { return lobe.s != glm::dvec3(0.0); }));
}

glm::vec3 narrow(const glm::dvec3& v) { return glm::vec3(v); }

/// Bit k: lobe k of some mix within the paints' span may be narrower than the stacked levels of the environment. m
/// blends linearly, so the narrowest paint bounds all of them.
int narrow_lobes(const core::InterpolatablePaint& paint) {
  int bits = 0;
  for (const auto& part : paint.paints)
    for (std::size_t k = 0; k < core::max_lobes; ++k) {
      // At grazing view a lobe is narrower across the plane of incidence; 0.7 covers its mean.
      const double m = 0.7 * part.analytic.lobes[k].m * part.analytic.refraction_ior;
      if (core::environment_level_of(m) < core::first_stacked_level) bits |= 1 << k;
    }
  return bits;
}

}  // namespace

void apply_shares(const GlApi& gl, const Program& program, const core::AnalyticPaint& paint,
                  const LightShares& shares) {
  const glm::vec3 diffuse = narrow(paint.diffuse) * shares.front();
  gl.Uniform3f(program.location("u_diffuse"), diffuse.x, diffuse.y, diffuse.z);
  std::array<float, 4 * core::max_lobes> lobes{};
  for (std::size_t k = 0; k < core::max_lobes; ++k) {
    const core::Lobe& lobe = paint.lobes[k];
    for (int c = 0; c < 3; ++c)
      lobes[4 * k + static_cast<std::size_t>(c)] = static_cast<float>(lobe.s[c]) * shares[k + 1];
    lobes[4 * k + 3] = static_cast<float>(lobe.f0);
  }
  // As many as the program has: a longer array than it declares is an error.
  if (const int count = program.size("u_lobe"); count > 0)
    gl.Uniform4fv(program.location("u_lobe"), count, lobes.data());
}

void apply_analytic(const GlApi& gl, const Program& program, const core::AnalyticPaint& paint) {
  const auto vector = [&](const char* name, const glm::vec3& v) {
    gl.Uniform3f(program.location(name), v.x, v.y, v.z);
  };
  const auto number = [&](const char* name, double v) { gl.Uniform1f(program.location(name), static_cast<float>(v)); };
  LightShares all{};
  all.fill(1.0f);
  apply_shares(gl, program, paint, all);
  glm::vec3 inv_m(1.0f);
  for (std::size_t k = 0; k < core::max_lobes; ++k)
    inv_m[static_cast<int>(k)] = static_cast<float>(1.0 / paint.lobes[k].m);
  vector("u_inv_m", inv_m);
  number("u_coat_ior", paint.coat_ior);
  number("u_refraction_ior", paint.refraction_ior);
}

Result<PaintGpu> PaintGpu::create(const Context& context, const core::InterpolatablePaint& paint, const PaintMap* map) {
  PaintGpu out(context.gl(), paint);
  for (const auto& part : paint.paints) {
    out.lobes_ = std::max(out.lobes_, real_lobes(part.analytic));
    out.table_ = out.table_ || part.analytic.table.has_value();
    out.coat_ = out.coat_ || part.analytic.coat_ior > 1.0;
    out.diffuse_ = out.diffuse_ || part.analytic.diffuse != glm::dvec3(0.0);
    out.refraction_ = out.refraction_ || part.analytic.refraction_ior > 1.0;
  }
  if (map != nullptr) {
    if (auto done = out.upload_map(*map, context.info().max_texture_size); !done) return tl::unexpected(done.error());
  }
  out.narrow_ = narrow_lobes(paint);
  out.contrast_ = core::flake_contrast(paint);
  out.textures_ = core::make_static_textures(paint);
  if (out.textures_.row_count > 0) {
    const int largest = context.info().max_texture_size;
    const int needed = std::max({core::random_edge, 3 * core::max_tuples_per_row, out.textures_.asked_rows});
    if (needed > largest)
      return fail("", "flakes",
                  "the pack needs textures of " + std::to_string(needed) + " texels an edge, " +
                      context.info().renderer + " has " + std::to_string(largest),
                  "draw without flakes, or build the pack with fewer mip levels");
    out.upload(out.slice_, core::angle_grid, core::angle_grid, out.textures_.slice.data(), true);
    out.upload(out.rank_, core::rank_table_steps, out.textures_.asked_rows, out.textures_.rank.data(), true);
    out.upload(out.random_, core::random_edge, core::random_edge, out.textures_.random.data(), true, GL_REPEAT,
               GL_LUMINANCE_ALPHA);
  }
  check_gl(context.gl(), "upload of a paint");
  return out;
}

void PaintGpu::upload(GlObject& texture, int width, int height, const void* texels, bool resized, GLenum wrap,
                      GLenum format) {
  gl_->ActiveTexture(GL_TEXTURE0);
  if (!texture) {
    texture = make_texture(*gl_);
    resized = true;
  }
  gl_->BindTexture(GL_TEXTURE_2D, texture.id());
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (resized) {
    const auto edge = static_cast<GLint>(wrap);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, edge);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, edge);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, format, GL_UNSIGNED_BYTE, texels);
  } else {
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format, GL_UNSIGNED_BYTE, texels);
  }
  ++uploads_.uploads;
  uploads_.bytes += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                    std::uint64_t{format == GL_RGBA ? 4u : 2u};
}

Result<void> PaintGpu::upload_map(const PaintMap& map, int largest) {
  auto encoded = encode_map(map);
  if (!encoded) return tl::unexpected(encoded.error());
  if (encoded->height > largest)
    return fail("", "map.edge",
                "needs a texture of " + std::to_string(encoded->height) + " texels an edge, the driver has " +
                    std::to_string(largest),
                "build the map with fewer nodes");
  upload(map_, encoded->width, encoded->height, encoded->rgba.data(), true);
  map_edge_ = encoded->width;
  map_scale_ = encoded->scale;
  map_uniforms_ = map_uniforms(map);
  map_use_ = map_uniforms_.towards_gloss == 0.0f ? MapUse::clip : MapUse::slide;
  return {};
}

void PaintGpu::upload_chi() {
  if (textures_.table_size > 0 && map_edge_ == 0)
    upload(chi_, textures_.table_size, textures_.table_size, textures_.chi.data(), false);
}

void PaintGpu::upload_flake_means() {
  if (textures_.row_count == 0) return;
  upload(mean_, core::angle_grid, core::angle_grid, textures_.mean.data(), false);
  flake_m_ = core::flake_roughness(*paint_, textures_);
}

void PaintGpu::bring(int finest_level) {
  if (textures_.row_count == 0) return;
  const int first = std::max(finest_level, 0);
  if (first >= current_from_) return;
  std::swap(realised_.corners, textures_.corner);
  core::realise_flake_levels(*paint_, weights_, std::max(first, 1), current_from_, realised_);
  std::swap(realised_.corners, textures_.corner);
  const int slices = paint_->layout.slice_count();
  const int width = 3 * textures_.width;
  if (!corner_) {
    upload(corner_, width, textures_.asked_rows, textures_.corner.data(), true);
  } else {
    const int row = first * slices, rows = (current_from_ - first) * slices;
    gl_->ActiveTexture(GL_TEXTURE0);
    gl_->BindTexture(GL_TEXTURE_2D, corner_.id());
    gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, row, width, rows, GL_RGBA, GL_UNSIGNED_BYTE,
                       textures_.corner_texel(0, row));
    count_upload(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) * 4);
  }
  current_from_ = first;
  check_gl(*gl_, "upload of single flakes");
}

Result<bool> PaintGpu::update(const core::Weights& weights) {
  if (auto checked = core::check_weights(*paint_, weights); !checked) return tl::unexpected(checked.error());
  const bool first = weights_.base.empty();
  const bool base = first || weights.base != weights_.base;
  const bool flakes = first || weights.flake_lightness != weights_.flake_lightness ||
                      weights.flake_colour != weights_.flake_colour || weights.flake_white != weights_.flake_white;
  if (!base && !flakes) return false;
  // One buffer of corners: update_textures swaps it back.
  std::swap(realised_.corners, textures_.corner);
  if (base) realised_.analytic = core::realise_analytic(*paint_, weights);
  if (flakes) core::realise_flake_means(*paint_, weights, realised_);
  core::update_textures(*paint_, realised_, textures_);
  if (base) upload_chi();
  if (flakes) {
    upload_flake_means();
    // The last level is one texel, which is the mean.
    current_from_ = std::max(paint_->level_count - 1, 1);
  }
  weights_ = weights;
  check_gl(*gl_, "upload of a realised paint");
  return true;
}

void PaintGpu::add_features(Features& features) const {
  features.lobes = lobes_;
  features.table = table_ && map_edge_ == 0;
  features.map = map_use_;
  features.coat = coat_;
  features.refraction = refraction_;
  features.diffuse = diffuse_;
  features.narrow = narrow_;
  features.flakes = features.flakes && textures_.row_count > 0;
}

void PaintGpu::apply(const GlApi& gl, const Program& program) const {
  const auto vector = [&](const char* name, const glm::vec3& v) {
    gl.Uniform3f(program.location(name), v.x, v.y, v.z);
  };
  const auto number = [&](const char* name, double v) { gl.Uniform1f(program.location(name), static_cast<float>(v)); };
  apply_analytic(gl, program, realised_.analytic);

  const auto texture = [&](const char* name, GLint unit, const GlObject& object) {
    const GLint location = program.location(name);
    if (location < 0) return;
    gl.Uniform1i(location, unit);
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(GL_TEXTURE_2D, object.id());
  };
  texture("u_chi", 0, chi_);
  texture("u_map_nodes", 0, map_);  // never beside the table
  gl.Uniform4f(program.location("u_map"), map_uniforms_.index, map_uniforms_.towards_gloss,
               static_cast<float>(map_edge_ - 1), map_scale_);
  texture("u_mean", 1, mean_);
  texture("u_slice", 2, slice_);
  texture("u_rank", 3, rank_);
  texture("u_corner", 4, corner_);
  texture("u_random", 5, random_);
  number("u_table_size", std::max(textures_.table_size, 1));
  number("u_chi_scale", textures_.chi_scale);
  if (textures_.row_count == 0) return;
  gl.Uniform2f(program.location("u_corner_size"), static_cast<float>(3 * textures_.width),
               static_cast<float>(textures_.asked_rows));
  number("u_slice_count", paint_->layout.slice_count());
  number("u_level_count", paint_->level_count);
  number("u_bins_per_rad", 1.0 / paint_->layout.bin_width_rad());
  const std::array<double, 2> cells = paint_->flake_cells_per_bin();
  gl.Uniform2f(program.location("u_flake_cells"), static_cast<float>(cells[0]), static_cast<float>(cells[1]));
  vector("u_lab_lo", paint_->range.lo);
  vector("u_lab_span", paint_->range.hi - paint_->range.lo);
  number("u_flake_m", flake_m_);
}

std::size_t PaintGpu::bytes() const {
  const auto area = [](int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
  };
  std::size_t sum =
      map_edge_ > 0 ? area(map_edge_, 2 * map_edge_ - 1) : area(textures_.table_size, textures_.table_size);
  if (textures_.row_count == 0) return sum;
  sum += 2 * area(core::angle_grid, core::angle_grid) + area(core::rank_table_steps, textures_.asked_rows);
  return sum + area(3 * textures_.width, textures_.asked_rows) + area(core::random_edge, core::random_edge) / 2;
}

std::vector<std::string> PaintGpu::explain() const {
  std::vector<std::string> out;
  if (lobes_ < static_cast<int>(core::max_lobes))
    out.push_back("left out: " + std::to_string(static_cast<int>(core::max_lobes) - lobes_) + " of " +
                  std::to_string(core::max_lobes) + " lobes: no paint of the pack has more than " +
                  std::to_string(lobes_));
  if (map_edge_ > 0) {
    out.push_back("colour map: " + std::to_string(map_edge_) + " x " + std::to_string(2 * map_edge_ - 1) +
                  " nodes; prefiltered light shows the colour table instead");
  }
  if (!table_) out.emplace_back("left out: colour table: no paint of the pack has one");
  if (!coat_) out.emplace_back("left out: clear coat: no paint of the pack has one that mirrors (coat index 1)");
  if (!refraction_) out.emplace_back("left out: refraction: no paint of the pack bends directions (index 1)");
  if (textures_.row_count == 0) out.emplace_back("left out: flakes: no paint of the pack has any");
  return out;
}

}  // namespace lackwerk::gles
