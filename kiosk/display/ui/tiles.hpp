// The painter's tiles: which there are, what each shows, and what has changed.
//
// Why it exists: a tile is drawn when its key changes and not otherwise. Owns the tiles' pixels; one thread.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

#include "kiosk/display/ui/draw_shapes.hpp"
#include "kiosk/display/ui/painter.hpp"

namespace lackwerk::kiosk::ui {

/// All that a tile's picture depends on but its size, as 64 bits (FNV-1a): two pictures share a key once in 2^32 tries.
class Key {
 public:
  template <class... Values>
  explicit Key(const Values&... values) {
    (add(values), ...);
  }
  template <class T>
  Key& add(const T& value) {
    if constexpr (std::is_convertible_v<T, std::string_view>) {
      const std::string_view text(value);
      bytes(text.data(), text.size());
      add(static_cast<std::uint64_t>(text.size()));
    } else if constexpr (std::is_same_v<T, Key>) {
      add(value.value_);
    } else if constexpr (std::is_same_v<T, Rect>) {
      add(value.x).add(value.y).add(value.width).add(value.height);
    } else {
      static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "a value without padding");
      bytes(&value, sizeof value);
    }
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void bytes(const void* data, std::size_t size) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < size; ++k) value_ = (value_ ^ at[k]) * 0x100000001b3U;
  }
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// What a tile is of; with an index.
enum class TileKind : std::uint8_t {
  panel,
  pad,
  name,
  label,
  swatch,
  puck,
  hint,
  knob,
  overlay,
  bracket,
  countdown,
  card,
  body,
};

class TileStore {
 public:
  void begin();
  /// A tile at `rect` (whole pixels). `draw(cr)` is called when key or size have changed; the context's units are the
  /// picture's pixels, as if the tile were at `rect`.
  template <class Draw>
  void show(TileKind kind, int index, const Key& key, const Rect& rect, Draw&& draw, float opacity = 1.0f) {
    if (cairo_t* cr = renewed(kind, index, key, rect, opacity)) {
      std::forward<Draw>(draw)(cr);
      drawn(cr);
    }
  }
  /// Tiles that were not shown since begin() are gone.
  [[nodiscard]] const Painted& end();
  [[nodiscard]] std::uint64_t tiles_drawn() const { return drawn_; }

 private:
  struct Tile {
    std::uint32_t id = 0;
    std::uint64_t key = 0;
    int width = 0, height = 0;
    CairoSurface surface;
    bool shown = false;
  };
  [[nodiscard]] cairo_t* renewed(TileKind kind, int index, const Key& key, const Rect& rect, float opacity);
  void drawn(cairo_t* cr);

  std::map<std::pair<TileKind, int>, Tile> tiles_;
  Tile* drawing_ = nullptr;
  Painted painted_;
  std::uint32_t next_id_ = 1;
  std::uint64_t drawn_ = 0;
};

}  // namespace lackwerk::kiosk::ui
