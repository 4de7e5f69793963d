// What a camera wrote, as light: response undone, dark taken off, divided by exposure, relative to a white.
//
// Why it exists: a flake slice is a radiance factor, and a photograph is not one until its white says so. Where the
// light stood still and the lens was the same, the quotient of both pictures cancels source, vignetting and sensor,
// pixel by pixel. Values; any thread. Files are only read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// From the numbers of a file, 0 to 1 where they are whole, to numbers in proportion to light.
struct CameraResponse {
  enum class Kind : std::uint8_t { linear, srgb, gamma, table };
  Kind kind = Kind::linear;
  double gamma = 2.2;                             ///< of Kind::gamma: light = number^gamma
  std::vector<std::pair<double, double>> points;  ///< of Kind::table: number, light; both rising, linear between
  /// Whole numbers from here on are clipped: 0.995 leaves the last code of 8 bits.
  double saturation = 0.995;
  [[nodiscard]] double light(double number) const;
};

/// Linear camera RGB, rows from the top.
struct CameraPicture {
  int width = 0, height = 0;
  std::vector<glm::vec3> light;
  std::vector<std::uint8_t> clipped;  ///< per pixel: 1 where a channel is
};

/// Errors: those of read_picture(), other than 3 channels, numbers that are not finite, negative, or (for a table)
/// outside it. At most 64 million pixels.
[[nodiscard]] Result<CameraPicture> read_camera_picture(const std::filesystem::path& file,
                                                        const CameraResponse& response);

/// picture - dark. Sizes must agree: an Error names `dark_file`. Noise leaves negative pixels; they are kept, for
/// means.
[[nodiscard]] Result<void> subtract_dark(CameraPicture& picture, const CameraPicture& dark,
                                         const std::string& dark_file);

/// Turns a picture into radiance factors, linear in camera RGB: light * `scale` / white. `scale` holds what the white
/// reflects, both exposures, and the cosines where the light stood elsewhere. Pixels where the white is below 2 % of
/// its mean become 0 and count as clipped: nothing was lit or seen there. An Error names `white_file` where the sizes
/// differ or the white is black.
[[nodiscard]] Result<void> divide_by_white(CameraPicture& picture, const CameraPicture& white, double scale,
                                           const std::string& white_file);

}  // namespace lackwerk::packs
