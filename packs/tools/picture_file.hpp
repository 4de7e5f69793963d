// A picture file as numbers: what every reader of pictures does first.
//
// Why it exists: pictures come from anywhere. The one place that opens them with OpenImageIO for reading as a whole,
// and bounds what they ask for before memory is taken. What the numbers mean is the caller's. Free function; any
// thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

struct PictureLimits {
  int width, height;          ///< pixels
  std::size_t pixels;         ///< in all
  int channels;               ///<
  const char* size_remedy;    ///< said where one of the first three is exceeded
  const char* broken_remedy;  ///< said where the pixels cannot be read
};

struct PictureFile {
  int width = 0, height = 0, channels = 0;
  bool is_linear = false;     ///< a floating-point format; otherwise whole numbers, here 0 to 1
  bool is_bytes = false;      ///< 8 bits a channel
  std::vector<float> values;  ///< width * height * channels, rows from the top
};

/// Formats that multiply colours by alpha are read as they are; `unassociated` divides by it. Errors: missing, not a
/// picture, beyond the limits, a data window that is not the picture, truncated.
[[nodiscard]] Result<PictureFile> read_picture(const std::filesystem::path& path, const PictureLimits& limits,
                                               bool unassociated = false);

}  // namespace lackwerk::packs
