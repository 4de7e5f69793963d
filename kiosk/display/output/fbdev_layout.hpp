// How the pixels of a framebuffer device lie in its memory, and writing them there.
//
// Why it exists: /dev/fb0 says where each channel's bits are, and old panels mean it: 565, blue first, padded lines.
// Checks come before memory is touched, because a driver's numbers are believed by mmap. Values; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/output/present_pass.hpp"

struct fb_var_screeninfo;  // from <linux/fb.h>
struct fb_fix_screeninfo;  //

namespace lackwerk::kiosk {

/// Bits of one channel, counted from the lowest of the pixel as a little-endian number.
struct FbChannel {
  unsigned offset = 0, length = 0;
  bool operator==(const FbChannel&) const = default;
};

struct FbLayout {
  std::array<int, 2> size_px{0, 0};
  int pixel_bytes = 0;         ///< 2 or 4
  std::size_t line_bytes = 0;  ///< from a pixel to the one below
  std::size_t start = 0;       ///< byte of the first pixel that is shown
  std::size_t map_bytes = 0;   ///< of the whole memory
  std::array<FbChannel, 3> rgb;
  double refresh_hz = 0.0;  ///< by the mode's timings; 0: not said
  bool operator==(const FbLayout&) const = default;

  /// Four bytes a pixel with one channel each: lines can be copied if the channels come in this order.
  [[nodiscard]] bool plain(ChannelOrder order) const;
};

/// Largest edge and memory believed: 8K with room for three pictures.
inline constexpr int most_fb_edge = 8192;
inline constexpr std::size_t most_fb_bytes = std::size_t{512} << 20;

/// What FBIOGET_VSCREENINFO and FBIOGET_FSCREENINFO said. `device` is for messages. Error: not packed true colour of 16
/// or 32 bits, channels that overlap or stick out, edges or sizes that are absurd or do not fit each other.
[[nodiscard]] Result<FbLayout> fb_layout(const fb_var_screeninfo& variable, const fb_fix_screeninfo& fixed,
                                         const std::string& device);

/// Writes lines of a picture. Channels of fewer than 8 bits get an ordered pattern (Bayer 8 x 8), or 565 would band.
class FbWriter {
 public:
  explicit FbWriter(const FbLayout& layout);

  /// How the picture must come: bgr where lines can then be copied.
  [[nodiscard]] ChannelOrder order() const { return order_; }
  /// `picture`: size_px[0] * size_px[1] pixels of four bytes in order(), upper line first. `memory`: map_bytes of them.
  void write(const std::uint8_t* picture, std::byte* memory) const;

 private:
  void write_line(const std::uint8_t* from, int y, std::byte* to) const;

  FbLayout layout_;
  ChannelOrder order_;
  bool copies_;
  std::vector<std::uint32_t> tables_;  ///< [channel][place in the pattern][8-bit value]: the channel's bits in place
};

}  // namespace lackwerk::kiosk
