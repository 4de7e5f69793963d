// What pictures for a monitor are drawn into: the GPU's buffers, or buffers of the kernel that the CPU fills.
//
// Why it exists: the display's state machine needs only "draw this and give me a framebuffer number". A surface owns
// the GL context, the present pass and its buffers; the device must outlive it. One thread, the context's.
#pragma once

#include "core/error.hpp"
#include "kiosk/display/display_profile.hpp"
#include "kiosk/display/orientation.hpp"
#include "kiosk/display/output.hpp"
#include "kiosk/display/output/drm_device.hpp"

namespace lackwerk::kiosk {

/// What the present pass makes of a picture.
struct Look {
  Rotation rotation = Rotation::none;
  DisplayProfile profile;
  bool test_pattern = false, gamut_warning = false;
};

class KmsSurface {
 public:
  virtual ~KmsSurface() = default;
  KmsSurface(const KmsSurface&) = delete;
  KmsSurface& operator=(const KmsSurface&) = delete;

  [[nodiscard]] virtual Platform platform() const = 0;
  [[nodiscard]] virtual gles::Context& context() = 0;
  virtual void set_look(const Look& look) = 0;
  /// As Output::set_brightness(); apart from the look, which compiles a program.
  virtual void set_brightness(float brightness) = 0;
  /// New buffers. The display engine must have let go of the old ones. Error: no memory, or more than the driver can;
  /// there are no buffers then.
  [[nodiscard]] virtual Result<void> resize(std::array<int, 2> panel_px) = 0;
  /// Draws into a free buffer and returns its framebuffer, complete when the display engine reads it. 0: none is free.
  [[nodiscard]] virtual Result<DrmId> draw(const gles::Framebuffer& picture) = 0;
  /// The display engine reads these two (0: none); all others are free.
  virtual void keep(DrmId shown, DrmId queued) = 0;

 protected:
  KmsSurface() = default;
};

}  // namespace lackwerk::kiosk
