// How different two pictures are: CIEDE2000, pixel by pixel.
//
// Why it exists: golden images, the error report and `lackwerk compare` must judge pictures by the same numbers. Values
// and pure functions; any thread. Files are only read, except by write_difference_map.
#pragma once

#include <cstddef>
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

/// CIEDE2000 over all pixels, Lab under D65 with linear (1, 1, 1) as white. Percentiles are nearest-rank.
struct ImageDifference {
  std::size_t pixels = 0;
  double mean = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Compares two pictures of one size (another size is an Error naming both). `map`, if given, gets the difference of
/// each pixel.
[[nodiscard]] Result<ImageDifference> compare_images(const LinearImage& a, const LinearImage& b,
                                                     std::vector<float>* map = nullptr);

/// Difference that is white in a map file.
inline constexpr float map_white_difference = 10.0f;

/// Writes a map as an 8-bit grey picture: black 0, white map_white_difference and above.
[[nodiscard]] Result<void> write_difference_map(const std::filesystem::path& path, int width, int height,
                                                const std::vector<float>& map);

}  // namespace lackwerk::packs
