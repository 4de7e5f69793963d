#include "packs/tools/difference_picture.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "core/check.hpp"
#include "core/colour.hpp"

namespace lackwerk::packs {
namespace {

constexpr int gap_px = 8;
constexpr int line_px = 22;
constexpr int font_px = 14;
constexpr int bar_width_px = 320;
constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr glm::vec3 ground(0.13f);
constexpr glm::vec3 not_counted(0.35f);

/// Encoded colours, row by row.
struct Sheet {
  int width, height;
  std::vector<glm::vec3> pixels;

  Sheet(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), ground) {}
  glm::vec3& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

glm::vec3 shown(const glm::vec3& linear) {
  glm::vec3 out;
  for (int c = 0; c < 3; ++c)
    out[c] = static_cast<float>(core::srgb_encode(std::clamp(static_cast<double>(linear[c]), 0.0, 1.0)));
  return out;
}

/// Where a difference lies on the scale, [0, 1].
float place_of(float difference) { return std::sqrt(std::clamp(difference / map_scale_end, 0.0f, 1.0f)); }

bool write_text(OIIO::ImageBuf& buffer, int x, int y, const std::string& text) {
  const std::array<float, 3> grey = {0.88f, 0.88f, 0.88f};
  const bool written = OIIO::ImageBufAlgo::render_text(buffer, x, y + font_px + 2, text, font_px, font_file, grey);
  if (!written) (void)buffer.geterror();  // no such font: the pictures are still there
  return written;
}

void write_words(OIIO::ImageBuf& buffer, int width, int below, const std::string& note) {
  const std::array<const char*, 3> captions = {"A", "B", "CIEDE2000"};
  for (int k = 0; k < 3; ++k)
    if (!write_text(buffer, gap_px + k * (width + gap_px), below, captions[static_cast<std::size_t>(k)])) return;
  const std::array<const char*, 6> numbers = {"0", "0.5", "1", "2", "5", "10+"};
  for (const char* number : numbers) {
    const auto x = static_cast<int>(place_of(std::strtof(number, nullptr)) * static_cast<float>(bar_width_px - 1));
    write_text(buffer, gap_px + x, below + 2 * line_px, number);
  }
  write_text(buffer, gap_px, below + 3 * line_px, note);
}

}  // namespace

glm::vec3 map_colour(float difference) {
  static constexpr std::array<glm::vec3, 6> nodes = {glm::vec3(0.0f),
                                                     glm::vec3(0.12f, 0.10f, 0.50f),
                                                     glm::vec3(0.55f, 0.10f, 0.55f),
                                                     glm::vec3(0.90f, 0.25f, 0.20f),
                                                     glm::vec3(0.98f, 0.75f, 0.15f),
                                                     glm::vec3(1.0f)};
  const float at = place_of(difference) * static_cast<float>(nodes.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), nodes.size() - 2);
  return glm::mix(nodes[below], nodes[below + 1], at - static_cast<float>(below));
}

Result<void> write_difference_picture(const std::filesystem::path& path, const LinearImage& a, const LinearImage& b,
                                      const std::vector<float>& map, const std::string& note) {
  check_equal(a.pixels.size(), map.size(), "pixels of a difference map");
  check_equal(b.pixels.size(), map.size(), "pixels of a difference map");
  Sheet sheet(std::max(3 * (a.width + gap_px), bar_width_px + 7 * gap_px) + gap_px, a.height + gap_px + 5 * line_px);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const auto k = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
      sheet.at(gap_px + x, gap_px + y) = shown(a.pixels[k]);
      sheet.at(2 * gap_px + a.width + x, gap_px + y) = shown(b.pixels[k]);
      sheet.at(3 * gap_px + 2 * a.width + x, gap_px + y) = map[k] < 0.0f ? not_counted : map_colour(map[k]);
    }
  const int below = gap_px + a.height;
  for (int x = 0; x < bar_width_px; ++x)
    for (int y = 4; y < line_px; ++y) {
      const float place = static_cast<float>(x) / static_cast<float>(bar_width_px - 1);
      sheet.at(gap_px + x, below + line_px + y) = map_colour(place * place * map_scale_end);
    }
  OIIO::ImageBuf buffer(OIIO::ImageSpec(sheet.width, sheet.height, 3, OIIO::TypeDesc::FLOAT), sheet.pixels.data());
  write_words(buffer, a.width, below, note);
  buffer.set_write_format(OIIO::TypeDesc::UINT8);
  if (!buffer.write(path.string())) {
    std::string reason = buffer.geterror();
    const std::string other = OIIO::geterror();  // read in any case: OpenImageIO prints unread errors at exit
    if (reason.empty()) reason = other.empty() ? "unknown format" : other;
    return fail(path.string(), "", "cannot be written: " + reason, "give a name that ends in .png, check the folder");
  }
  return {};
}

}  // namespace lackwerk::packs
