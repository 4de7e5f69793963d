// Where all pictures are drawn: a texture and a depth buffer of our own.
//
// Why it exists: with one kind of target both backends, the kiosk and the tests draw alike, and the kiosk can present
// the colour texture. Owns its GL objects; destroy it while its context is current; one GL thread.
#pragma once

#include <cstdint>

#include "core/error.hpp"
#include "render_gles/context.hpp"
#include "render_gles/gl_object.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::gles {

enum class PixelFormat {
  rgba8,
  rgba16f,  ///< half floats: OES_texture_half_float and EXT_color_buffer_half_float, or desktop GL
};

class Framebuffer {
 public:
  /// `width` and `height` in pixels, at least 1. `context` must be current and outlive the result. Without `depth`
  /// there is no depth buffer. Error: larger than the driver's limits, or the driver refuses the combination.
  [[nodiscard]] static Result<Framebuffer> create(const Context& context, int width, int height,
                                                  PixelFormat format = PixelFormat::rgba8, bool depth = true);

  /// Binds it for drawing and sets the viewport to all of it.
  void bind() const;
  /// The picture, rows from top to bottom, alpha dropped. Waits for the GPU. Leaves this framebuffer bound.
  [[nodiscard]] Image read() const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// 24 where OES_depth24 (or desktop GL) offers it, else core ES 2.0's 16; 0 without.
  [[nodiscard]] int depth_bits() const { return depth_bits_; }
  [[nodiscard]] PixelFormat format() const { return format_; }
  /// Bytes on the GPU, as far as they can be counted from outside.
  [[nodiscard]] std::size_t bytes() const;
  /// The colour texture, to present or to filter: no mip levels, row 0 at the bottom.
  [[nodiscard]] GLuint texture() const { return colour_.id(); }

 private:
  const GlApi* gl_ = nullptr;
  GlObject framebuffer_, colour_, depth_;
  int width_ = 0, height_ = 0, depth_bits_ = 0;
  PixelFormat format_ = PixelFormat::rgba8;
};

}  // namespace lackwerk::gles
