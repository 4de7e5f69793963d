#include "kiosk/display/ui/tiles.hpp"

namespace lackwerk::kiosk::ui {
namespace {
/// No tile is larger than a picture may be; a surface that Cairo cannot make is left out.
constexpr int most_px = 8192;
}  // namespace

void TileStore::begin() {
  painted_.updates.clear();
  painted_.gone.clear();
  painted_.sprites.clear();
  for (auto& entry : tiles_) entry.second.shown = false;
}

cairo_t* TileStore::renewed(TileKind kind, int index, const Key& key, const Rect& rect, float opacity) {
  const int width = static_cast<int>(rect.width), height = static_cast<int>(rect.height);
  if (width < 1 || height < 1 || width > most_px || height > most_px) return nullptr;
  Tile& tile = tiles_[{kind, index}];
  const bool same_size = tile.surface && tile.width == width && tile.height == height;
  const bool same = same_size && tile.key == key.value();
  if (!same_size) {
    tile.surface.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
    if (cairo_surface_status(tile.surface.get()) != CAIRO_STATUS_SUCCESS) {
      tile.surface.reset();
      return nullptr;
    }
    tile.width = width;
    tile.height = height;
  }
  if (tile.id == 0) tile.id = next_id_++;
  tile.key = key.value();
  tile.shown = true;
  painted_.sprites.push_back({tile.id, static_cast<int>(rect.x), static_cast<int>(rect.y), width, height, opacity});
  if (same) return nullptr;
  drawing_ = &tile;
  cairo_t* cr = cairo_create(tile.surface.get());
  if (same_size) {
    cairo_set_operator(cr, CAIRO_OPERATOR_CLEAR);
    cairo_paint(cr);
    cairo_set_operator(cr, CAIRO_OPERATOR_OVER);
  }
  cairo_translate(cr, -static_cast<int>(rect.x), -static_cast<int>(rect.y));
  return cr;
}

void TileStore::drawn(cairo_t* cr) {
  cairo_destroy(cr);
  const Tile& tile = *drawing_;
  cairo_surface_flush(tile.surface.get());
  painted_.updates.push_back({tile.id, tile.width, tile.height, cairo_image_surface_get_stride(tile.surface.get()),
                              cairo_image_surface_get_data(tile.surface.get())});
  ++drawn_;
}

const Painted& TileStore::end() {
  for (auto it = tiles_.begin(); it != tiles_.end();) {
    if (it->second.shown) {
      ++it;
      continue;
    }
    if (it->second.id != 0) painted_.gone.push_back(it->second.id);
    it = tiles_.erase(it);
  }
  return painted_;
}

}  // namespace lackwerk::kiosk::ui
