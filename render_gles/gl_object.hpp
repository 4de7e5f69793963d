// Owning handles of GL objects.
//
// Why it exists: textures, buffers and programs are numbers that someone must delete, on the right context, once.
// An owner may be moved, not copied. Destroy it while its context is current; one GL thread.
#pragma once

#include <utility>

#include "render_gles/gl_api.hpp"

namespace lackwerk::gles {

class GlObject {
 public:
  using Deleter = void (*)(const GlApi&, GLuint);

  GlObject() = default;
  /// Takes over `id`; `gl` must outlive it.
  GlObject(const GlApi& gl, GLuint id, Deleter deleter) : gl_(&gl), id_(id), deleter_(deleter) {}
  GlObject(GlObject&& other) noexcept { swap(other); }
  GlObject& operator=(GlObject&& other) noexcept {
    swap(other);
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;
  ~GlObject() {
    if (id_ != 0) deleter_(*gl_, id_);
  }

  [[nodiscard]] GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  void swap(GlObject& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    std::swap(deleter_, other.deleter_);
  }
  const GlApi* gl_ = nullptr;
  GLuint id_ = 0;
  Deleter deleter_ = nullptr;
};

/// New objects on the current context.
[[nodiscard]] inline GlObject make_texture(const GlApi& gl) {
  GLuint id = 0;
  gl.GenTextures(1, &id);
  return {gl, id, [](const GlApi& g, GLuint k) { g.DeleteTextures(1, &k); }};
}
[[nodiscard]] inline GlObject make_buffer(const GlApi& gl) {
  GLuint id = 0;
  gl.GenBuffers(1, &id);
  return {gl, id, [](const GlApi& g, GLuint k) { g.DeleteBuffers(1, &k); }};
}
[[nodiscard]] inline GlObject make_framebuffer(const GlApi& gl) {
  GLuint id = 0;
  gl.GenFramebuffers(1, &id);
  return {gl, id, [](const GlApi& g, GLuint k) { g.DeleteFramebuffers(1, &k); }};
}
[[nodiscard]] inline GlObject make_renderbuffer(const GlApi& gl) {
  GLuint id = 0;
  gl.GenRenderbuffers(1, &id);
  return {gl, id, [](const GlApi& g, GLuint k) { g.DeleteRenderbuffers(1, &k); }};
}
[[nodiscard]] inline GlObject make_shader(const GlApi& gl, GLenum stage) {
  return {gl, gl.CreateShader(stage), [](const GlApi& g, GLuint k) { g.DeleteShader(k); }};
}
[[nodiscard]] inline GlObject make_program(const GlApi& gl) {
  return {gl, gl.CreateProgram(), [](const GlApi& g, GLuint k) { g.DeleteProgram(k); }};
}

}  // namespace lackwerk::gles
