// An OpenGL ES 2.0 context on a graphics card's own buffers (GBM), with a window surface whose pictures a display
// engine can show.
//
// Why it exists: the shortest way from the GPU to the panel. The card's GBM device is the caller's and must outlive the
// context; buffers of the window are handed out by gbm_surface_lock_front_buffer() after swap(). Where the card has no
// GPU that draws, Mesa offers its software rasteriser the same way. One thread.
#pragma once

#include <cstdint>
#include <memory>

#include "render_gles/context.hpp"

struct gbm_device;
struct gbm_surface;

namespace lackwerk::gles {

class GbmContext : public Context {
 public:
  /// Makes it current without a window. Error: no EGL on GBM, no OpenGL ES 2.0, or no configuration that a display
  /// engine can show.
  [[nodiscard]] static Result<std::unique_ptr<GbmContext>> create(gbm_device* device, const ContextSettings& settings);

  /// The pixel format gbm_surface_create() must be given.
  [[nodiscard]] virtual std::uint32_t gbm_format() const = 0;
  /// From now on framebuffer 0 is this window; null: none. The surface stays the caller's and must outlive its use.
  /// Error: EGL refuses it.
  [[nodiscard]] virtual Result<void> set_window(gbm_surface* surface) = 0;
  /// Finishes the window's picture. Error: context lost.
  [[nodiscard]] virtual Result<void> swap() = 0;
};

}  // namespace lackwerk::gles
