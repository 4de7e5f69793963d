// Pictures drawn wherever GL works and copied by the CPU into buffers of the kernel: for cards whose GPU has no driver.
#pragma once

#include <memory>

#include "kiosk/display/output/kms_surface.hpp"

namespace lackwerk::kiosk {

/// The device must outlive the result. Error: no dumb buffers, or neither EGL nor OSMesa.
[[nodiscard]] Result<std::unique_ptr<KmsSurface>> make_dumb_surface(KmsDevice& device,
                                                                    const gles::ContextSettings& settings, Log& log);

/// A context that needs no card: EGL, else OSMesa; which one and why is logged. Error: neither works.
[[nodiscard]] Result<std::unique_ptr<gles::Context>> make_offscreen_context(const gles::ContextSettings& settings,
                                                                            Log& log);

}  // namespace lackwerk::kiosk
