#include "kiosk/display/output/panel_target.hpp"

#include <algorithm>

namespace lackwerk::kiosk {

Result<PanelTarget> PanelTarget::create(const gles::Context& context, std::array<int, 2> size_px) {
  const gles::GlApi& gl = context.gl();
  const auto [width, height] = size_px;
  const int largest = std::min(context.info().max_texture_size, context.info().max_renderbuffer_size);
  if (width < 1 || height < 1 || width > largest || height > largest)
    return fail("", "panel",
                std::to_string(width) + "x" + std::to_string(height) + " is more than " + context.info().renderer +
                    " can draw (" + std::to_string(largest) + " an edge)",
                "choose a smaller mode");
  PanelTarget out;
  out.gl_ = &gl;
  out.size_px_ = size_px;
  out.colour_ = gles::make_texture(gl);
  gl.BindTexture(GL_TEXTURE_2D, out.colour_.id());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  out.framebuffer_ = gles::make_framebuffer(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, out.framebuffer_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, out.colour_.id(), 0);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  while (gl.GetError() != GL_NO_ERROR) {
  }  // a refused size is an answer, not a broken invariant
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return fail("", "panel", context.info().renderer + " refuses a target of this size", "choose a smaller mode");
  gl.Viewport(0, 0, width, height);
  gl.ClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  return out;
}

void PanelTarget::read(std::uint8_t* out) const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, size_px_[0], size_px_[1], GL_RGBA, GL_UNSIGNED_BYTE, out);
  gles::check_gl(*gl_, "read the panel's picture");
}

}  // namespace lackwerk::kiosk
