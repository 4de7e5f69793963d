// Passes over the whole target: copy, add up, smooth, show.
//
// Why it exists: still pictures are sums of frames, and moving ones may be drawn smaller than the screen. Owns three
// programs and a buffer; destroy it while its context is current; one GL thread.
#pragma once

#include <glm/vec2.hpp>

#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"

namespace lackwerk::gles {

class ScreenPass {
 public:
  explicit ScreenPass(const Context& context);

  enum class Blend { replace, add, alpha };
  /// Draws `texture` times `factor` over all of `target`. Blend::alpha weighs it by `alpha`.
  void copy(GLuint texture, const Framebuffer& target, float factor, Blend blend, float alpha = 1.0f) const;
  /// Draws `source` over all of `target`, edges smoothed.
  void smooth(const Framebuffer& source, const Framebuffer& target) const;
  /// Shows first * factors[0] + second * factors[1] (scene-linear times exposure) through the display transform,
  /// weighed by `alpha` against what `target` holds.
  void resolve(GLuint first, GLuint second, glm::vec2 factors, bool dither, const Framebuffer& target,
               float alpha) const;

 private:
  struct Shader {
    GlObject program;
    GLint first = -1, second = -1, factor = -1, alpha = -1, dither = -1;
  };
  [[nodiscard]] static Shader make(const Context& context, const char* file, const char* factor);
  void draw(const Framebuffer& target, Blend blend) const;

  const GlApi* gl_;
  Shader copy_, smooth_, resolve_;
  GlObject corners_;
};

}  // namespace lackwerk::gles
