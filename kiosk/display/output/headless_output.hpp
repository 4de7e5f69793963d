// A panel that nobody sees: for tests, recordings and machines without a display.
//
// Why it exists: the loop presents the same way everywhere, and what it presented must be readable, turned and coloured
// as a panel would get it. Never refuses. One thread, the context's.
#pragma once

#include <memory>

#include "kiosk/display/output.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::kiosk {

class HeadlessOutput : public Output {
 public:
  /// What was presented last, as the panel shows it; empty before the first.
  [[nodiscard]] virtual gles::Image last() const = 0;
};

/// `settings.platform`: surfaceless or osmesa; the panel is of settings.size_px. Error: no such context, or the size is
/// more than it can.
[[nodiscard]] Result<std::unique_ptr<HeadlessOutput>> make_headless_output(const OutputSettings& settings, Log& log);

}  // namespace lackwerk::kiosk
