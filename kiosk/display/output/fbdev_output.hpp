// Pictures into /dev/fb0: the last resort where no DRM driver takes dumb buffers.
//
// Why it exists: old panels and odd drivers have nothing else. No page flips and, mostly, no vertical blank, so
// pictures may tear. Pictures are drawn wherever GL works and copied by the CPU. It does not touch the console (vt.hpp
// does): on a text console the kernel's cursor blinks through the picture. As output.hpp says: one thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kiosk/display/output.hpp"
#include "kiosk/display/output/seat.hpp"

namespace lackwerk::kiosk {

/// The device, so that a memory file and a function can play it.
struct FbdevCalls {
  std::function<Result<int>(const std::string& path)> open;  ///< for reading and writing; mmap(2) works on it
  /// ioctl(2): -1 and errno on failure.
  std::function<int(int fd, unsigned long request, void* data)> control;
};
[[nodiscard]] FbdevCalls fbdev_calls();

/// Opens /dev/fb0 with the settings' rotation, profile, test pattern and context settings; `settings.card` may name
/// another /dev/fb*. `seat`, which must outlive the output: it is polled and dispatched here, and while another session
/// has it nothing is written; the device itself is opened directly, because seat managers do not give it out. Error: no
/// such device, not permitted, a pixel layout that makes no sense, or no GL context.
[[nodiscard]] Result<std::unique_ptr<Output>> open_fbdev(const OutputSettings& settings, Log& log, Seat* seat = nullptr,
                                                         const FbdevCalls& calls = fbdev_calls());

}  // namespace lackwerk::kiosk
