// A picture the size of the panel in the GPU's memory, to be read by the CPU: for buffers that GL cannot draw into.
//
// Why it exists: dumb buffers and tests take the panel's pixels from memory. Core OpenGL ES 2.0. Owns its GL objects;
// destroy it while its context is current; one GL thread.
#pragma once

#include <array>
#include <cstdint>

#include "core/error.hpp"
#include "render_gles/context.hpp"
#include "render_gles/gl_object.hpp"

namespace lackwerk::kiosk {

class PanelTarget {
 public:
  /// Sizes in pixels, at least 1. `context` must be current and outlive the result. Error: larger than the driver can.
  [[nodiscard]] static Result<PanelTarget> create(const gles::Context& context, std::array<int, 2> size_px);

  /// For PresentPass::draw().
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }
  [[nodiscard]] std::array<int, 2> size_px() const { return size_px_; }
  /// Four bytes a pixel into `out`, size_px[0] * size_px[1] * 4 of them, row 0 first. Waits for the GPU.
  void read(std::uint8_t* out) const;

 private:
  const gles::GlApi* gl_ = nullptr;
  gles::GlObject framebuffer_, colour_;
  std::array<int, 2> size_px_{0, 0};
};

}  // namespace lackwerk::kiosk
