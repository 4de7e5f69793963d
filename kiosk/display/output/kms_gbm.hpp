// Pictures drawn by the GPU straight into buffers of the display engine.
#pragma once

#include <memory>

#include "kiosk/display/output/kms_surface.hpp"

namespace lackwerk::kiosk {

/// The device must outlive the result. Error: no GBM or no EGL on it (no driver, no permission for its render node).
[[nodiscard]] Result<std::unique_ptr<KmsSurface>> make_gbm_surface(KmsDevice& device,
                                                                   const gles::ContextSettings& settings);

}  // namespace lackwerk::kiosk
