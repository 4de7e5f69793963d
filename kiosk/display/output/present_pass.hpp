// The last pass: the finished picture, turned as the panel is mounted and taken to the panel's own colours.
//
// Why it exists: every output (a KMS surface, a dumb buffer, /dev/fb0) needs the same turn and the same profile, and a
// test pattern that goes the same way as pictures do. Core OpenGL ES 2.0. Owns its program, its lookup tables and the
// test pattern; destroy it while its context is current; one GL thread.
#pragma once

#include <array>

#include "kiosk/display/display_profile.hpp"
#include "kiosk/display/orientation.hpp"
#include "render_gles/context.hpp"
#include "render_gles/framebuffer.hpp"
#include "render_gles/gl_object.hpp"

namespace lackwerk::kiosk {

/// Which colour the first byte of a pixel gets. bgr: what XRGB8888 memory wants after glReadPixels(GL_RGBA).
enum class ChannelOrder { rgb, bgr };

class PresentPass {
 public:
  /// `context` must be current and outlive the pass.
  explicit PresentPass(gles::Context& context);

  /// From the next draw() on. `profile` must have passed check_profile(). An sRGB profile copies byte for byte.
  /// `test_pattern`: drawn in the picture's place. `gamut_warning`: colours the panel cannot show are hatched.
  void set(Rotation rotation, const DisplayProfile& profile, bool test_pattern = false, bool gamut_warning = false);

  /// From the next draw() on: a factor on the picture's display values, [0, 1]; the test pattern stays as it is.
  void set_brightness(float brightness) { brightness_ = brightness; }

  /// Draws `picture`, of picture_size(rotation, panel_px), over all of the target: a panel of `panel_px`. Another size
  /// is stretched. `target_framebuffer`: 0 is the window surface. `flip_y`: the panel's upper row becomes the target's
  /// row 0, as memory that is read back wants it; a window surface wants false. Alpha becomes 1. Leaves the target
  /// bound, blending and depth test off.
  void draw(const gles::Framebuffer& picture, std::array<int, 2> panel_px, GLuint target_framebuffer, bool flip_y,
            ChannelOrder order = ChannelOrder::rgb);

 private:
  struct Program {
    gles::GlObject program;
    GLint picture = -1, tables = -1, panel = -1, bgr = -1, brightness = -1;
  };
  [[nodiscard]] Program make(bool profile, bool warning) const;
  void upload_corners();
  void upload_tables();
  void upload_pattern(std::array<int, 2> size_px);

  const gles::Context* context_;
  const gles::GlApi* gl_;
  Program program_;
  gles::GlObject corners_, tables_, pattern_;
  Rotation rotation_ = Rotation::none;
  DisplayProfile profile_;
  bool show_pattern_ = false;
  int table_size_ = 0;
  float brightness_ = 1.0f;
  std::array<int, 2> pattern_px_{0, 0};
};

}  // namespace lackwerk::kiosk
