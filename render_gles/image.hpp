// An 8-bit picture and its PNG file.
//
// Why it exists: frames read back, screenshots and golden images are all this. A value; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::gles {

/// Encoded for an sRGB display. Rows from top to bottom, three bytes a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  /// Black.
  Image(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}
  /// The three bytes of a pixel; x in [0, width), y in [0, height), y = 0 is the top row.
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return &rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3];
  }
  bool operator==(const Image&) const = default;
};

/// Edges beyond this are refused when reading.
inline constexpr int max_image_edge = 16384;

/// Writes an 8-bit RGB PNG that says it is sRGB. The same picture gives the same bytes. Error: cannot be written.
[[nodiscard]] Result<void> write_png(const Image& image, const std::string& path);

/// Reads any PNG as 8-bit sRGB; alpha is laid over black. Error: missing, not a PNG, damaged, or too large.
[[nodiscard]] Result<Image> read_png(const std::string& path);

}  // namespace lackwerk::gles
