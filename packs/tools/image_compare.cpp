#include "packs/tools/image_compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/colour.hpp"
#include "packs/tools/picture_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr PictureLimits picture_limits{16384,
                                       16384,
                                       64'000'000,
                                       16,
                                       "use at most 16384 pixels an edge and 64 million in all",
                                       "the file is damaged: make it again"};

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

/// Decoding tables make an 8-bit picture as quick as a linear one.
std::array<float, 256> make_decode_table() {
  std::array<float, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k)
    table[k] = static_cast<float>(core::srgb_decode(static_cast<double>(k) / 255.0));
  return table;
}

}  // namespace

Result<LinearImage> read_image(const std::filesystem::path& path) {
  const std::string file = path.string();
  // Unassociated, or PNG colours come back multiplied by their alpha.
  const auto picture = read_picture(path, picture_limits, true);
  if (!picture) return tl::unexpected(picture.error());
  const auto channels = static_cast<std::size_t>(picture->channels);
  LinearImage out{picture->width, picture->height, {}};
  const std::size_t count = picture->values.size() / channels;
  const std::array<float, 256> table = make_decode_table();
  const auto decode = [&](float v) {
    if (picture->is_linear) return v;
    if (picture->is_bytes) return table[static_cast<std::size_t>(std::clamp(std::lround(v * 255.0f), 0l, 255l))];
    return static_cast<float>(core::srgb_decode(static_cast<double>(v)));
  };
  out.pixels.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const float* v = &picture->values[k * channels];
    const glm::vec3 pixel =
        channels < 3 ? glm::vec3(decode(v[0])) : glm::vec3(decode(v[0]), decode(v[1]), decode(v[2]));
    if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y) || !std::isfinite(pixel.z))
      return fail(file, "pixel " + std::to_string(k), "is not a finite number", "render it again");
    out.pixels[k] = pixel;
  }
  return out;
}

PixelMask mask_of(const LinearImage& image) {
  static const auto half = static_cast<float>(core::srgb_decode(0.5));
  PixelMask mask(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), mask.begin(),
                 [](const glm::vec3& pixel) { return static_cast<std::uint8_t>(pixel.y > half ? 1 : 0); });
  return mask;
}

Result<ImageDifference> compare_images(const LinearImage& a, const LinearImage& b, std::vector<float>* map,
                                       const PixelMask& mask) {
  if (a.width != b.width || a.height != b.height || a.pixels.size() != b.pixels.size())
    return fail("", "size", size_text(a.width, a.height) + " and " + size_text(b.width, b.height),
                "compare pictures of one size", ErrorKind::run);
  if (a.pixels.empty()) return fail("", "size", "the pictures are empty", "compare real pictures");
  if (!mask.empty() && mask.size() != a.pixels.size())
    return fail("", "mask", std::to_string(mask.size()) + " pixels for pictures of " + std::to_string(a.pixels.size()),
                "give a mask of the pictures' size");
  std::vector<float> difference;
  difference.reserve(a.pixels.size());
  if (map != nullptr) map->assign(a.pixels.size(), -1.0f);
  double sum = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    if (!mask.empty() && mask[k] == 0) continue;
    // Equal pixels are common in golden comparisons, and CIEDE2000 is slow.
    const double d = a.pixels[k] == b.pixels[k] ? 0.0
                                                : core::ciede2000(core::lab_from_linear(glm::dvec3(a.pixels[k])),
                                                                  core::lab_from_linear(glm::dvec3(b.pixels[k])));
    difference.push_back(static_cast<float>(d));
    if (map != nullptr) (*map)[k] = difference.back();
    sum += d;
  }
  if (difference.empty()) return fail("", "mask", "counts no pixel", "paint white what is to count");
  const std::size_t n = difference.size();
  const auto percentile = [&](std::size_t percent) {
    const std::size_t rank = (n * percent + 99) / 100;  // nearest rank, counted from 1
    const auto at = difference.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(difference.begin(), at, difference.end());
    return static_cast<double>(*at);
  };
  ImageDifference out;
  out.pixels = n;
  out.mean = sum / static_cast<double>(n);
  out.p95 = percentile(95);
  out.p99 = percentile(99);
  out.max = percentile(100);
  return out;
}

}  // namespace lackwerk::packs
