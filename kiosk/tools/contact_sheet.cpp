#include "kiosk/tools/contact_sheet.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace lackwerk::tools {
namespace {

constexpr int gap_px = 8;
constexpr int caption_px = 24;
constexpr int font_px = 15;
constexpr std::uint8_t ground = 34;
constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void paste(const gles::Image& from, gles::Image& into, int x, int y) {
  for (int row = 0; row < from.height; ++row) {
    const auto* begin = from.pixel(0, row);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(from.width) * 3,
              into.rgb.begin() + (static_cast<std::ptrdiff_t>(y + row) * into.width + x) * 3);
  }
}

void write_captions(gles::Image& sheet, const std::vector<Tile>& tiles, int columns, int cell_w, int cell_h) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(sheet.width, sheet.height, 3, OIIO::TypeDesc::UINT8), sheet.rgb.data());
  const float grey[3] = {0.85f, 0.85f, 0.85f};
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    const int x = gap_px + column * (cell_w + gap_px), y = gap_px + row * (cell_h + caption_px + gap_px);
    if (!OIIO::ImageBufAlgo::render_text(buffer, x + 2, y + cell_h + caption_px - 7, tiles[k].caption, font_px,
                                         font_file, grey)) {
      (void)buffer.geterror();  // no such font: the sheet is still a sheet
      return;
    }
  }
}

}  // namespace

gles::Image contact_sheet(const std::vector<Tile>& tiles, int columns) {
  int cell_w = 1, cell_h = 1;
  for (const Tile& tile : tiles) {
    cell_w = std::max(cell_w, tile.image.width);
    cell_h = std::max(cell_h, tile.image.height);
  }
  const int rows = (static_cast<int>(tiles.size()) + columns - 1) / columns;
  gles::Image sheet(gap_px + columns * (cell_w + gap_px), gap_px + rows * (cell_h + caption_px + gap_px));
  std::fill(sheet.rgb.begin(), sheet.rgb.end(), ground);
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    paste(tiles[k].image, sheet, gap_px + column * (cell_w + gap_px), gap_px + row * (cell_h + caption_px + gap_px));
  }
  write_captions(sheet, tiles, columns, cell_w, cell_h);
  return sheet;
}

gles::Image halved(const gles::Image& image) {
  gles::Image out(image.width / 2, image.height / 2);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const int sum = image.pixel(2 * x, 2 * y)[c] + image.pixel(2 * x + 1, 2 * y)[c] +
                        image.pixel(2 * x, 2 * y + 1)[c] + image.pixel(2 * x + 1, 2 * y + 1)[c];
        out.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x)) * 3 +
                static_cast<std::size_t>(c)] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
  return out;
}

}  // namespace lackwerk::tools
