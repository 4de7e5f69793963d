#include "packs/tools/camera_picture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/colour.hpp"
#include "packs/tools/picture_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr int max_side = 16384;
constexpr std::size_t max_pixels = std::size_t{1} << 26;  ///< 67 million: above any camera a panel is taken with
constexpr float least_white = 0.02f;

Result<PictureFile> read_safely(const std::filesystem::path& file) {
  const PictureLimits limits{max_side,
                             max_side,
                             max_pixels,
                             3,
                             "photographs have at most 16384 pixels a side, 2^26 in all",
                             "copy it from the camera again"};
  try {
    return read_picture(file, limits);
  } catch (const std::exception& error) {  // plug-ins of the picture library may throw
    return fail(file.string(), "", std::string("cannot be read: ") + error.what(), "save it again");
  }
}

Result<void> same_size(const CameraPicture& a, const CameraPicture& b, const std::string& file) {
  if (a.width == b.width && a.height == b.height) return {};
  return fail(file, "size",
              "is " + std::to_string(b.width) + " x " + std::to_string(b.height) + ", the photograph's " +
                  std::to_string(a.width) + " x " + std::to_string(a.height),
              "take both with the same camera settings");
}

}  // namespace

double CameraResponse::light(double number) const {
  switch (kind) {
    case Kind::linear:
      break;
    case Kind::srgb:
      return core::srgb_decode(number);
    case Kind::gamma:
      return std::pow(number, gamma);
    case Kind::table: {
      const auto above = std::upper_bound(points.begin(), points.end(), number,
                                          [](double x, const std::pair<double, double>& p) { return x < p.first; });
      if (above == points.begin()) return points.front().second;
      if (above == points.end()) return points.back().second;
      const auto below = above - 1;
      return below->second + (above->second - below->second) * (number - below->first) / (above->first - below->first);
    }
  }
  return number;
}

Result<CameraPicture> read_camera_picture(const std::filesystem::path& path, const CameraResponse& response) {
  const std::string file = path.string();
  if (!std::filesystem::exists(path)) return fail(file, "", "is missing", "check its name in photos.toml");
  const auto picture = read_safely(path);
  if (!picture) return tl::unexpected(picture.error());
  if (picture->channels != 3)
    return fail(file, "channels", "are " + std::to_string(picture->channels), "save it as RGB without alpha");
  CameraPicture out{picture->width, picture->height, {}, {}};
  out.light.resize(picture->values.size() / 3);
  out.clipped.resize(out.light.size());
  const auto width = static_cast<std::size_t>(picture->width);
  for (std::size_t k = 0; k < picture->values.size(); ++k) {
    const auto number = static_cast<double>(picture->values[k]);
    const auto where = [&] {
      return "pixel " + std::to_string(k / 3 % width) + "," + std::to_string(k / 3 / width) + " channel " +
             std::to_string(k % 3);
    };
    if (!std::isfinite(number)) return fail(file, where(), "is not a finite number", "save it again");
    if (number < 0.0)
      return fail(file, where(), "is negative", "save it without taking the dark off; name a dark instead");
    if (number > 1.0 && response.kind != CameraResponse::Kind::linear)
      return fail(file, where(), "is above 1", "this response is known from 0 to 1 only");
    out.light[k / 3][static_cast<int>(k % 3)] = static_cast<float>(response.light(number));
    if (!picture->is_linear && number >= response.saturation) out.clipped[k / 3] = 1;
  }
  return out;
}

Result<void> subtract_dark(CameraPicture& picture, const CameraPicture& dark, const std::string& dark_file) {
  if (auto ok = same_size(picture, dark, dark_file); !ok) return ok;
  for (std::size_t k = 0; k < picture.light.size(); ++k) picture.light[k] -= dark.light[k];
  return {};
}

Result<void> divide_by_white(CameraPicture& picture, const CameraPicture& white, double scale,
                             const std::string& white_file) {
  if (auto ok = same_size(picture, white, white_file); !ok) return ok;
  glm::dvec3 sum(0.0);
  std::size_t clipped = 0;
  for (std::size_t k = 0; k < white.light.size(); ++k) {
    sum += glm::dvec3(white.light[k]);
    clipped += white.clipped[k];
  }
  const glm::vec3 mean(sum / static_cast<double>(white.light.size()));
  if (clipped * 100 > white.light.size())
    return fail(white_file, "", "more than 1 % of the white is overexposed", "expose it shorter");
  for (int c = 0; c < 3; ++c)
    if (!(mean[c] > 0.0f))
      return fail(white_file, "channel " + std::to_string(c), "the white is black", "expose it longer");
  for (std::size_t k = 0; k < picture.light.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const float level = white.light[k][c];
      const bool lit = level > least_white * mean[c] && white.clipped[k] == 0;
      picture.light[k][c] = lit ? static_cast<float>(scale) * picture.light[k][c] / level : 0.0f;
      if (!lit) picture.clipped[k] = 1;
    }
  }
  return {};
}

}  // namespace lackwerk::packs
