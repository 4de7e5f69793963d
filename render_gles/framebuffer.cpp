#include "render_gles/framebuffer.hpp"

#include <algorithm>
#include <vector>

namespace lackwerk::gles {
namespace {

constexpr GLenum half_float_oes = 0x8D61;
constexpr GLenum half_float_desktop = 0x140B;
constexpr GLint rgba16f_desktop = 0x881A;
constexpr GLenum depth24 = 0x81A6;  // GL_DEPTH_COMPONENT24 and GL_DEPTH_COMPONENT24_OES are the same number

bool complete(const GlApi& gl, GLuint depth, GLenum format, int width, int height) {
  gl.BindRenderbuffer(GL_RENDERBUFFER, depth);
  gl.RenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  while (gl.GetError() != GL_NO_ERROR) {
  }  // a refused format is an answer, not a broken invariant
  return status == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace

Result<Framebuffer> Framebuffer::create(const Context& context, int width, int height, PixelFormat format, bool depth) {
  const GlApi& gl = context.gl();
  const ContextInfo& info = context.info();
  const int largest = std::min(info.max_texture_size, info.max_renderbuffer_size);
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (width < 1 || height < 1 || width > largest || height > largest)
    return fail("", "size", size + " is not within 1x1 and " + std::to_string(largest) + "x" + std::to_string(largest),
                "choose a size that " + info.renderer + " can draw", ErrorKind::usage);

  const bool half = format == PixelFormat::rgba16f;
  if (half && !info.desktop &&
      !(info.has_extension("GL_OES_texture_half_float") && info.has_extension("GL_EXT_color_buffer_half_float")))
    return fail("", "framebuffer", info.renderer + " has no half-float targets", "use 8 bits");

  Framebuffer out;
  out.format_ = format;
  out.gl_ = &gl;
  out.width_ = width;
  out.height_ = height;
  out.colour_ = make_texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, out.colour_.id());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (half) {
    // ES names the type HALF_FLOAT_OES and takes the size from it; desktop GL has a sized internal format.
    gl.TexImage2D(GL_TEXTURE_2D, 0, info.desktop ? rgba16f_desktop : GLint{GL_RGBA}, width, height, 0, GL_RGBA,
                  info.desktop ? half_float_desktop : half_float_oes, nullptr);
  } else {
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  }
  out.framebuffer_ = make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.framebuffer_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, out.colour_.id(), 0);

  if (!depth) {
    const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    while (gl.GetError() != GL_NO_ERROR) {
    }  // a refused format is an answer, not a broken invariant
    if (status != GL_FRAMEBUFFER_COMPLETE)
      return fail("", "framebuffer", info.renderer + " refuses this format at " + size, "choose another backend");
    return out;
  }
  out.depth_ = make_renderbuffer(gl);
  out.depth_bits_ = 16;
  const bool offers24 = info.desktop || info.has_extension("GL_OES_depth24");
  if (offers24 && complete(gl, out.depth_.id(), depth24, width, height)) {
    out.depth_bits_ = 24;
  } else if (!complete(gl, out.depth_.id(), GL_DEPTH_COMPONENT16, width, height)) {
    return fail("", "framebuffer", info.renderer + " refuses this format with a depth buffer at " + size,
                "choose a smaller size or another backend");
  }
  return out;
}

std::size_t Framebuffer::bytes() const {
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  return pixels * ((format_ == PixelFormat::rgba16f ? 8u : 4u) +
                   (depth_bits_ > 16 ? 4u : static_cast<unsigned>(depth_bits_) / 8u));
}

void Framebuffer::bind() const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_->Viewport(0, 0, width_, height_);
}

Image Framebuffer::read() const {
  bind();
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  check_gl(*gl_, "read back");
  Image image(width_, height_);
  std::uint8_t* out = image.rgb.data();
  for (int y = height_ - 1; y >= 0; --y) {
    const std::uint8_t* row = &rgba[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) * 4];
    for (int x = 0; x < width_; ++x, row += 4) out = std::copy_n(row, 3, out);
  }
  return image;
}

}  // namespace lackwerk::gles
