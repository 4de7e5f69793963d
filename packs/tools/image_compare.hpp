// How different two pictures are: CIEDE2000, pixel by pixel.
//
// Why it exists: golden images, the error report and `lackwerk compare` must judge pictures by the same numbers. Values
// and pure functions; any thread. Files are only read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// A picture in linear sRGB, rows from the top. Alpha is dropped.
struct LinearImage {
  int width = 0;   ///< [1, 16384]
  int height = 0;  ///< [1, 16384]
  std::vector<glm::vec3> pixels;
};

/// Reads any format OpenImageIO knows. Whole-number formats (PNG, JPEG) are taken as sRGB-encoded, floating-point ones
/// (OpenEXR, HDR) as linear; one or two channels are grey. Errors: missing, truncated, larger than 16384 or 64 million
/// pixels, a data window that is not the picture, pixels that are not finite.
[[nodiscard]] Result<LinearImage> read_image(const std::filesystem::path& path);

/// CIEDE2000 over the counted pixels, Lab under D65 with linear (1, 1, 1) as white. Percentiles are nearest-rank.
struct ImageDifference {
  std::size_t pixels = 0;  ///< counted
  double mean = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Which pixels count, one byte a pixel, 0 = not; empty = all.
using PixelMask = std::vector<std::uint8_t>;

/// Pixels that are white rather than black: green above half of what a display can show.
[[nodiscard]] PixelMask mask_of(const LinearImage& image);

/// Compares two pictures of one size (another size, of the mask too, is an Error naming both; so is a mask that counts
/// nothing). `map`, if given, gets the difference of each pixel, -1 where it does not count.
[[nodiscard]] Result<ImageDifference> compare_images(const LinearImage& a, const LinearImage& b,
                                                     std::vector<float>* map = nullptr, const PixelMask& mask = {});

}  // namespace lackwerk::packs
