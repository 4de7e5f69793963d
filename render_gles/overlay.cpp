#include "render_gles/overlay.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "render_gles/program.hpp"
#include "render_gles/shader_texts.hpp"

namespace lackwerk::gles {
namespace {

constexpr int most_tile_px = 4096;
constexpr int bytes_a_pixel = 4;
constexpr std::size_t corners_a_quad = 4, floats_a_corner = 4;

/// Texels one to one: neither blurred nor costly.
void sample_nearest(const GlApi& gl, bool nearest) {
  const GLint filter = nearest ? GL_NEAREST : GL_LINEAR;
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
}

bool is_plain(const OverlayLook& look) {
  return look.drift_x_px == 0 && look.drift_y_px == 0 && look.brightness == 1.0f && look.split < 0.0f &&
         look.held <= 0.0f;
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(Context& context) {
  // The constructor is private, so make_unique cannot be used.
  return std::unique_ptr<Overlay>(new Overlay(context));
}

Overlay::Overlay(Context& context)
    : context_(&context),
      gl_(&context.gl()),
      picture_(make(1, false)),
      fading_(make(1, true)),
      tile_(make(2, false)),
      faint_tile_(make(2, true)),
      dimming_(make(0, true)),
      vertices_(make_buffer(context.gl())) {}

Overlay::Program Overlay::make(int texture, bool factor) const {
  const std::string vertex = "#version 100\n" + std::string(shader_text("overlay_vertex.glsl"));
  const std::string fragment = shader_prelude(context_->info().fragment_highp) + "#define TEXTURE " +
                               std::to_string(texture) + "\n#define FACTOR " + (factor ? "1" : "0") + "\n" +
                               std::string(shader_text("overlay.glsl"));
  Program out;
  out.program = link_program(*gl_, vertex, fragment, {"a_corner", "a_at"}, "overlay");
  out.texture = gl_->GetUniformLocation(out.program.id(), "u_texture");
  out.factor = gl_->GetUniformLocation(out.program.id(), "u_factor");
  return out;
}

void Overlay::set_tile(std::uint32_t tile, int width, int height, int stride_bytes, const unsigned char* bgra) {
  const int row_bytes = width * bytes_a_pixel;
  check_at_most(1, std::min(width, height), "edge of a tile, px");
  check_at_most(std::max(width, height), std::min(most_tile_px, context_->info().max_texture_size),
                "edge of a tile, px");
  check_at_most(row_bytes, stride_bytes, "bytes from row to row of a tile");
  if (stride_bytes != row_bytes) {
    // Core ES 2.0 takes rows that follow each other only.
    rows_.resize(static_cast<std::size_t>(row_bytes) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
      std::copy_n(bgra + static_cast<std::ptrdiff_t>(y) * stride_bytes, row_bytes,
                  rows_.data() + static_cast<std::ptrdiff_t>(y) * row_bytes);
    bgra = rows_.data();
  }
  Tile& kept = tiles_[tile];
  check_at_most(tiles_.size(), max_tiles, "tiles of the overlay");
  const bool is_new = kept.width != width || kept.height != height;
  if (!kept.texture) kept.texture = make_texture(*gl_);
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, kept.texture.id());
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, bytes_a_pixel);
  if (is_new) {
    sample_nearest(*gl_, true);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, bgra);
  } else {
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bgra);
  }
  kept.width = width;
  kept.height = height;
  sent_bytes_ += static_cast<std::uint64_t>(row_bytes) * static_cast<std::uint64_t>(height);
}

void Overlay::drop_tile(std::uint32_t tile) { tiles_.erase(tile); }

Result<void> Overlay::fit(std::optional<Framebuffer>& target, const Framebuffer& picture) const {
  if (target && target->width() == picture.width() && target->height() == picture.height()) return {};
  target.reset();  // first, so that never both are there
  auto made = Framebuffer::create(*context_, picture.width(), picture.height(), PixelFormat::rgba8, false);
  if (!made) return tl::unexpected(made.error());
  target = std::move(*made);
  return {};
}

/// Columns [left, right) of `to` from `from`, moved by the drift. Copying costs a thirtieth of drawing on a software
/// rasteriser. What comes in from the border is not there yet.
void Overlay::copy(const Framebuffer& from, const Framebuffer& to, int left, int right, const OverlayLook& look) const {
  const int x0 = std::max(left, look.drift_x_px), x1 = std::min(right, to.width() + look.drift_x_px);
  const int lowest = std::max(0, -look.drift_y_px), rows = to.height() - std::abs(look.drift_y_px);
  if (x0 >= x1 || rows < 1) return;
  from.bind();
  gl_->BindTexture(GL_TEXTURE_2D, to.texture());
  // GL counts rows from below, the drift from above.
  gl_->CopyTexSubImage2D(GL_TEXTURE_2D, 0, x0, lowest, x0 - look.drift_x_px, lowest + look.drift_y_px, x1 - x0, rows);
}

void Overlay::add(const Quad& quad, const Drawn& how, const Framebuffer& target) {
  if (quad.left >= quad.right || quad.top >= quad.bottom) return;
  const double width = target.width(), height = target.height();
  for (const bool down : {false, true})
    for (const bool right : {false, true})
      for (const double value :
           {2.0 * (right ? quad.right : quad.left) / width - 1.0, 1.0 - 2.0 * (down ? quad.bottom : quad.top) / height,
            right ? quad.to[0] : quad.from[0], down ? quad.to[1] : quad.from[1]})
        corners_.push_back(static_cast<float>(value));
  drawn_.push_back(how);
}

/// What the drift brings in from the border, in columns [left, right): the edge, repeated by the texture's wrap mode.
void Overlay::add_borders(const Framebuffer& from, const Framebuffer& to, int left, int right,
                          const OverlayLook& look) {
  const int dx = look.drift_x_px, dy = look.drift_y_px;
  const double width = to.width(), height = to.height();
  const auto part = [&](double x0, double y0, double x1, double y1) {
    const double l = std::max<double>(x0, left), r = std::min<double>(x1, right);
    add({l, y0, r, y1, {(l - dx) / width, 1.0 - (y0 - dy) / height}, {(r - dx) / width, 1.0 - (y1 - dy) / height}},
        {&picture_, from.texture(), 1.0f}, to);
  };
  part(dx > 0 ? 0 : width + dx, 0, dx > 0 ? dx : width, height);
  part(0, dy > 0 ? 0 : height + dy, width, dy > 0 ? dy : height);
}

void Overlay::add_sprites(std::span<const OverlaySprite> sprites, const OverlayLook& look, const Framebuffer& target) {
  for (const OverlaySprite& sprite : sprites) {
    const auto found = tiles_.find(sprite.tile);
    if (found == tiles_.end() || sprite.opacity <= 0.0f) continue;
    const Tile& tile = found->second;
    const int across = std::min(sprite.width_px, tile.width), down = std::min(sprite.height_px, tile.height);
    const double left = sprite.x_px + look.drift_x_px, top = sprite.y_px + look.drift_y_px;
    const bool faint = sprite.opacity < 1.0f;
    add({left,
         top,
         left + across,
         top + down,
         {0.0, 0.0},
         {static_cast<double>(across) / tile.width, static_cast<double>(down) / tile.height}},
        {faint ? &faint_tile_ : &tile_, tile.texture.id(), std::min(sprite.opacity, 1.0f)}, target);
  }
}

/// Draws what was added, then dims all of it.
void Overlay::draw(const Framebuffer& target, float brightness) {
  const bool dim = brightness != 1.0f;
  if (dim) add({0.0, 0.0, static_cast<double>(target.width()), static_cast<double>(target.height())}, {}, target);
  target.bind();
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Disable(GL_CULL_FACE);
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_DITHER);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_->Enable(GL_BLEND);
  gl_->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_->BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.size() * sizeof(float)), corners_.data(),
                  GL_STREAM_DRAW);
  for (GLuint slot = 2; slot <= attribute_visible + 2; ++slot) gl_->DisableVertexAttribArray(slot);
  constexpr auto stride = static_cast<GLsizei>(floats_a_corner * sizeof(float));
  for (GLuint slot = 0; slot < 2; ++slot) {
    const std::size_t offset = slot * 2 * sizeof(float);
    gl_->EnableVertexAttribArray(slot);
    gl_->VertexAttribPointer(
        slot, 2, GL_FLOAT, GL_FALSE, stride,
        reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): an offset into the buffer
  }
  const auto quad = [this](std::size_t k) {
    gl_->DrawArrays(GL_TRIANGLE_STRIP, static_cast<GLint>(k * corners_a_quad), corners_a_quad);
  };
  const std::size_t sprites = drawn_.size() - (dim ? 1 : 0);
  const Program* used = nullptr;
  for (std::size_t k = 0; k < sprites; ++k) {
    const Drawn& how = drawn_[k];
    if (how.program != used) {
      used = how.program;
      gl_->UseProgram(used->program.id());
      gl_->Uniform1i(used->texture, 0);
    }
    if (used->factor >= 0) gl_->Uniform4f(used->factor, how.factor, how.factor, how.factor, how.factor);
    gl_->BindTexture(GL_TEXTURE_2D, how.texture);
    // A picture gets its own filter back, which other passes rely on. Tiles keep theirs.
    if (used == &picture_) sample_nearest(*gl_, true);
    quad(k);
    if (used == &picture_) sample_nearest(*gl_, false);
  }
  if (dim) {
    gl_->BlendFunc(GL_ZERO, GL_SRC_ALPHA);
    gl_->UseProgram(dimming_.program.id());
    gl_->Uniform4f(dimming_.factor, brightness, brightness, brightness, brightness);
    quad(sprites);
  }
  gl_->Disable(GL_BLEND);
  gl_->DisableVertexAttribArray(1);
  corners_.clear();
  drawn_.clear();
}

Result<void> Overlay::hold(const Framebuffer& picture) {
  if (auto fitted = fit(held_, picture); !fitted) return fitted;
  gl_->ActiveTexture(GL_TEXTURE0);
  copy(picture, *held_, 0, held_->width(), {});
  check_gl(*gl_, "overlay hold");
  return {};
}

void Overlay::let_go() { held_.reset(); }

Result<const Framebuffer*> Overlay::compose(const Framebuffer& picture, std::span<const OverlaySprite> sprites,
                                            const OverlayLook& look) {
  if (sprites.empty() && is_plain(look)) return &picture;
  if (auto fitted = fit(target_, picture); !fitted) return tl::unexpected(fitted.error());
  // A held picture of another size is of another panel.
  const bool usable = held_ && held_->width() == picture.width() && held_->height() == picture.height();
  const bool divided = look.split >= 0.0f && usable;
  const int width = target_->width();
  const int border =
      divided ? std::clamp(static_cast<int>(std::lround(look.split * static_cast<float>(width))) + look.drift_x_px, 0,
                           width)
              : 0;
  gl_->ActiveTexture(GL_TEXTURE0);
  copy(picture, *target_, border, width, look);
  add_borders(picture, *target_, border, width, look);
  if (divided) {
    copy(*held_, *target_, 0, border, look);
    add_borders(*held_, *target_, 0, border, look);
  }
  if (usable && look.held > 0.0f) {
    const double x = look.drift_x_px, y = look.drift_y_px;
    add({x, y, x + width, y + target_->height(), {0.0, 1.0}, {1.0, 0.0}},
        {&fading_, held_->texture(), std::min(look.held, 1.0f)}, *target_);
  }
  add_sprites(sprites, look, *target_);
  draw(*target_, std::clamp(look.brightness, 0.0f, 1.0f));
  check_gl(*gl_, "overlay");
  return &*target_;
}

}  // namespace lackwerk::gles
