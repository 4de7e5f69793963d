// What a painter gives, put together on the CPU: tiles kept by number, sprites laid over a picture.
//
// Why it exists: tests and previews see the interface's pixels without a GL context. Owns copies; one thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "kiosk/display/ui/painter.hpp"
#include "render_gles/image.hpp"

namespace lackwerk::kiosk::ui {

class TileCanvas {
 public:
  struct Tile {
    int width = 0, height = 0;
    std::vector<unsigned char> bgra;  ///< premultiplied, without padding
  };

  /// Takes over what has changed. False: an update of no size, or a sprite without its tile or of another size.
  bool take(const Painted& painted) {
    bool good = true;
    for (const std::uint32_t tile : painted.gone) tiles_.erase(tile);
    for (const TileUpdate& update : painted.updates) {
      good = good && update.width > 0 && update.height > 0 && update.bgra != nullptr;
      Tile tile{update.width, update.height, {}};
      for (int y = 0; y < update.height; ++y) {
        const unsigned char* row = update.bgra + static_cast<std::ptrdiff_t>(y) * update.stride_bytes;
        tile.bgra.insert(tile.bgra.end(), row, row + static_cast<std::ptrdiff_t>(update.width) * 4);
      }
      tiles_[update.tile] = std::move(tile);
    }
    sprites_ = painted.sprites;
    for (const Sprite& sprite : sprites_) {
      const auto tile = tiles_.find(sprite.tile);
      good = good && tile != tiles_.end() && tile->second.width == sprite.width_px &&
             tile->second.height == sprite.height_px;
    }
    return good;
  }

  /// The sprites over a picture, lowest first; what is outside it is left out.
  void draw_over(gles::Image& picture) const {
    for (const Sprite& sprite : sprites_) {
      const Tile& tile = tiles_.at(sprite.tile);
      const int opacity = static_cast<int>(std::lround(sprite.opacity * 255.0f));
      const int left = std::max(0, -sprite.x_px), right = std::min(tile.width, picture.width - sprite.x_px);
      for (int y = std::max(0, -sprite.y_px); y < std::min(tile.height, picture.height - sprite.y_px); ++y)
        for (int x = left; x < right; ++x) {
          const unsigned char* from = tile.bgra.data() + 4 * (static_cast<std::ptrdiff_t>(y) * tile.width + x);
          std::uint8_t* to =
              picture.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(y + sprite.y_px) * picture.width + x + sprite.x_px);
          // Premultiplied over: what comes plus what is there times 1 - alpha, in 255ths.
          const int keep = 255 * 255 - from[3] * opacity;
          for (int c = 0; c < 3; ++c)
            to[c] = static_cast<std::uint8_t>(
                std::min(255, (from[2 - c] * opacity * 255 + to[c] * keep + 255 * 255 / 2) / (255 * 255)));
        }
    }
  }

  [[nodiscard]] const std::vector<Sprite>& sprites() const { return sprites_; }
  [[nodiscard]] const std::map<std::uint32_t, Tile>& tiles() const { return tiles_; }
  /// Pixels that are blended for one picture.
  [[nodiscard]] long long covered_px() const {
    long long sum = 0;
    for (const Sprite& sprite : sprites_) sum += static_cast<long long>(sprite.width_px) * sprite.height_px;
    return sum;
  }

 private:
  std::map<std::uint32_t, Tile> tiles_;
  std::vector<Sprite> sprites_;
};

}  // namespace lackwerk::kiosk::ui
