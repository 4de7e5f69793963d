#include "render_gles/screen_pass.hpp"

#include <array>

#include "render_gles/program.hpp"
#include "render_gles/shader_texts.hpp"

namespace lackwerk::gles {

ScreenPass::Shader ScreenPass::make(const Context& context, const char* file, const char* factor) {
  const GlApi& gl = context.gl();
  const std::string vertex = "#version 100\n" + std::string(shader_text("screen_vertex.glsl"));
  const std::string fragment = shader_prelude(context.info().fragment_highp) +
                               std::string(shader_text("display.glsl")) + "\n" + std::string(shader_text(file));
  Shader out;
  out.program = link_program(gl, vertex, fragment, {"a_corner"}, file);
  const auto location = [&](const char* name) { return gl.GetUniformLocation(out.program.id(), name); };
  out.first = location("u_first");
  out.second = location("u_second");
  out.factor = location(factor);
  out.alpha = location("u_alpha");
  out.dither = location("u_dither");
  return out;
}

ScreenPass::ScreenPass(const Context& context)
    : gl_(&context.gl()),
      copy_(make(context, "screen_copy.glsl", "u_factor")),
      smooth_(make(context, "screen_smooth.glsl", "u_pixel")),
      resolve_(make(context, "screen_resolve.glsl", "u_factors")),
      corners_(make_buffer(context.gl())) {
  // One triangle that covers the square [-1, 1]^2: no seam along a diagonal.
  static constexpr std::array<float, 6> corners = {-1, -1, 3, -1, -1, 3};
  gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_->BufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STATIC_DRAW);
}

void ScreenPass::draw(const Framebuffer& target, Blend blend) const {
  target.bind();
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Disable(GL_CULL_FACE);
  gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (blend == Blend::replace) {
    gl_->Disable(GL_BLEND);
  } else {
    gl_->Enable(GL_BLEND);
    if (blend == Blend::add) {
      gl_->BlendFunc(GL_ONE, GL_ONE);
    } else {
      gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
  }
  for (GLuint slot = 1; slot <= attribute_visible + 2; ++slot) gl_->DisableVertexAttribArray(slot);
  gl_->BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_->EnableVertexAttribArray(0);
  gl_->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->Disable(GL_BLEND);
}

void ScreenPass::copy(GLuint texture, const Framebuffer& target, float factor, Blend blend, float alpha) const {
  gl_->UseProgram(copy_.program.id());
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, texture);
  gl_->Uniform1i(copy_.first, 0);
  gl_->Uniform1f(copy_.factor, factor);
  gl_->Uniform1f(copy_.alpha, blend == Blend::alpha ? alpha : -1.0f);
  draw(target, blend);
}

void ScreenPass::smooth(const Framebuffer& source, const Framebuffer& target) const {
  gl_->UseProgram(smooth_.program.id());
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, source.texture());
  gl_->Uniform1i(smooth_.first, 0);
  gl_->Uniform2f(smooth_.factor, 1.0f / static_cast<float>(source.width()), 1.0f / static_cast<float>(source.height()));
  draw(target, Blend::replace);
}

void ScreenPass::resolve(GLuint first, GLuint second, glm::vec2 factors, bool dither, const Framebuffer& target,
                         float alpha) const {
  gl_->UseProgram(resolve_.program.id());
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, first);
  gl_->ActiveTexture(GL_TEXTURE1);
  gl_->BindTexture(GL_TEXTURE_2D, second);
  gl_->Uniform1i(resolve_.first, 0);
  gl_->Uniform1i(resolve_.second, 1);
  gl_->Uniform2f(resolve_.factor, factors.x, factors.y);
  gl_->Uniform1f(resolve_.dither, dither ? 1.0f : 0.0f);
  gl_->Uniform1f(resolve_.alpha, alpha);
  draw(target, alpha < 1.0f ? Blend::alpha : Blend::replace);
}

}  // namespace lackwerk::gles
