#include "kiosk/display/output/fbdev_layout.hpp"

#include <linux/fb.h>

#include <algorithm>
#include <cstring>

namespace lackwerk::kiosk {
namespace {

constexpr std::size_t pattern_edge = 8;
constexpr std::size_t pattern_places = pattern_edge * pattern_edge;
constexpr std::size_t values = 256;

/// Bayer 1973: bits of x ^ y and y, interleaved and reversed, are the place in the order 0 to 63.
std::size_t bayer(std::size_t x, std::size_t y) {
  std::size_t place = 0;
  for (std::size_t bit = 0; bit < 3; ++bit) place = place << 2 | ((x ^ y) >> bit & 1u) << 1 | (y >> bit & 1u);
  return place;
}

/// Bits a channel covers; it must be sound.
std::uint64_t mask(const FbChannel& c) { return ((std::uint64_t{1} << c.length) - 1u) << c.offset; }

/// Refreshes a second, from the time of a pixel (ps) and the lines and columns with their margins.
double refresh_of(const fb_var_screeninfo& v) {
  const double columns = static_cast<double>(v.xres) + v.left_margin + v.right_margin + v.hsync_len;
  const double lines = static_cast<double>(v.yres) + v.upper_margin + v.lower_margin + v.vsync_len;
  const double hz = v.pixclock > 0 ? 1e12 / (static_cast<double>(v.pixclock) * columns * lines) : 0.0;
  return hz >= 10.0 && hz <= 500.0 ? hz : 0.0;  // drivers without timings say anything
}

}  // namespace

bool FbLayout::plain(ChannelOrder order) const {
  const std::array<unsigned, 3> offsets =
      order == ChannelOrder::bgr ? std::array<unsigned, 3>{16, 8, 0} : std::array<unsigned, 3>{0, 8, 16};
  if (pixel_bytes != 4) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (rgb[k] != FbChannel{offsets[k], 8}) return false;
  return true;
}

Result<FbLayout> fb_layout(const fb_var_screeninfo& variable, const fb_fix_screeninfo& fixed,
                           const std::string& device) {
  const auto refuse = [&](const char* field, const std::string& what) {
    return fail(device, field, what, "set another mode with fbset, or use a DRM driver");
  };
  const auto edge = [](std::uint32_t n) { return n >= 1 && n <= static_cast<std::uint32_t>(most_fb_edge); };
  if (!edge(variable.xres) || !edge(variable.yres))
    return refuse("size", std::to_string(variable.xres) + "x" + std::to_string(variable.yres) +
                              " is not within 1x1 and " + std::to_string(most_fb_edge) + "x" +
                              std::to_string(most_fb_edge));
  if (variable.bits_per_pixel != 16 && variable.bits_per_pixel != 32)
    return refuse("bits_per_pixel", std::to_string(variable.bits_per_pixel) + " is neither 16 nor 32");
  if (fixed.type != FB_TYPE_PACKED_PIXELS || variable.grayscale != 0 || variable.nonstd != 0 ||
      (fixed.visual != FB_VISUAL_TRUECOLOR && fixed.visual != FB_VISUAL_DIRECTCOLOR))
    return refuse("type", "is not packed true colour");
  FbLayout out;
  out.size_px = {static_cast<int>(variable.xres), static_cast<int>(variable.yres)};
  out.pixel_bytes = static_cast<int>(variable.bits_per_pixel / 8);
  std::uint64_t used = 0;
  const std::array<const fb_bitfield*, 3> fields = {&variable.red, &variable.green, &variable.blue};
  for (std::size_t k = 0; k < 3; ++k) {
    const fb_bitfield& field = *fields[k];
    const FbChannel channel{field.offset, field.length};
    const bool fits = field.length >= 1 && field.length <= 8 && field.offset < variable.bits_per_pixel &&
                      field.offset + field.length <= variable.bits_per_pixel && field.msb_right == 0;
    if (!fits || (used & mask(channel)) != 0)
      return refuse("channels", "channel " + std::to_string(k) + " has " + std::to_string(field.length) +
                                    " bits from " + std::to_string(field.offset));
    used |= mask(channel);
    out.rgb[k] = channel;
  }
  out.line_bytes = fixed.line_length;
  out.map_bytes = fixed.smem_len;
  // 64 bits hold every product of two 32-bit numbers.
  const std::uint64_t line = std::uint64_t{variable.xres} * static_cast<std::uint64_t>(out.pixel_bytes);
  const std::uint64_t first = std::uint64_t{variable.yoffset} * fixed.line_length +
                              std::uint64_t{variable.xoffset} * static_cast<std::uint64_t>(out.pixel_bytes);
  const std::uint64_t last = first + std::uint64_t{variable.yres - 1} * fixed.line_length + line;
  if (fixed.line_length < line)
    return refuse("line_length", std::to_string(fixed.line_length) + " is less than a line");
  if (fixed.smem_len > most_fb_bytes || last > fixed.smem_len)
    return refuse("smem_len", std::to_string(fixed.smem_len) + " bytes do not hold the picture, which ends at " +
                                  std::to_string(last) + ", or are more than 512 MiB");
  out.start = first;
  out.refresh_hz = refresh_of(variable);
  return out;
}

FbWriter::FbWriter(const FbLayout& layout)
    : layout_(layout),
      order_(layout.plain(ChannelOrder::bgr) ? ChannelOrder::bgr : ChannelOrder::rgb),
      copies_(layout.plain(order_)) {
  if (copies_) return;
  tables_.resize(3 * pattern_places * values);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const FbChannel bits = layout.rgb[channel];
    const unsigned most = (1u << bits.length) - 1u;
    for (std::size_t place = 0; place < pattern_places; ++place) {
      // Thresholds lie in the middle of their 64ths, so that black stays black, white white, and the mean is kept.
      const double threshold = (static_cast<double>(place) + 0.5) / static_cast<double>(pattern_places);
      for (std::size_t value = 0; value < values; ++value) {
        const double exact = static_cast<double>(value) * most / 255.0;
        tables_[(channel * pattern_places + place) * values + value] = static_cast<std::uint32_t>(exact + threshold)
                                                                       << bits.offset;
      }
    }
  }
}

void FbWriter::write(const std::uint8_t* picture, std::byte* memory) const {
  const auto line = static_cast<std::size_t>(layout_.size_px[0]) * 4;
  for (int y = 0; y < layout_.size_px[1]; ++y) {
    const std::uint8_t* from = picture + static_cast<std::size_t>(y) * line;
    std::byte* to = memory + layout_.start + static_cast<std::size_t>(y) * layout_.line_bytes;
    if (copies_)
      std::memcpy(to, from, line);
    else
      write_line(from, y, to);
  }
}

void FbWriter::write_line(const std::uint8_t* from, int y, std::byte* to) const {
  std::array<const std::uint32_t*, pattern_edge> starts{};
  for (std::size_t x = 0; x < pattern_edge; ++x)
    starts[x] = &tables_[bayer(x, static_cast<std::size_t>(y) % pattern_edge) * values];
  constexpr std::size_t channel = pattern_places * values;
  for (std::size_t x = 0; x < static_cast<std::size_t>(layout_.size_px[0]); ++x, from += 4) {
    const std::uint32_t* table = starts[x % pattern_edge];
    const std::uint32_t pixel = table[from[0]] | table[channel + from[1]] | table[2 * channel + from[2]];
    // Little-endian machines only, as every one with this device that the kiosk runs on.
    std::memcpy(to, &pixel, static_cast<std::size_t>(layout_.pixel_bytes));
    to += layout_.pixel_bytes;
  }
}

}  // namespace lackwerk::kiosk
