// Draws the interface with Cairo and Pango into tiles: small pictures that are drawn anew only when what they show has
// changed, and placed on the picture by whoever composes it.
//
// Why it exists: on weak machines drawing text and curves costs more than the frame. What moves (puck, slider knobs)
// is a tile that stays as it is and gets another place. Owns its tiles' pixels; knows no GL; one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/import_report.hpp"
#include "kiosk/display/status.hpp"
#include "kiosk/display/ui/content.hpp"
#include "kiosk/display/ui/layout.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk::ui {

/// A tile that was drawn: premultiplied, sRGB values, in memory B, G, R, A (Cairo's ARGB32 on little-endian machines).
struct TileUpdate {
  std::uint32_t tile = 0;
  int width = 0, height = 0, stride_bytes = 0;
  const unsigned char* bgra = nullptr;  ///< valid until the next paint()
};

/// A tile on the picture, lowest first. Tiles are drawn one to one: `place` has the tile's size and whole pixels.
struct Sprite {
  std::uint32_t tile = 0;
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
  float opacity = 1.0f;
  bool operator==(const Sprite&) const = default;
};

struct Painted {
  std::vector<TileUpdate> updates;  ///< before the sprites are drawn
  std::vector<std::uint32_t> gone;  ///< tiles nobody shows any more
  std::vector<Sprite> sprites;
};

/// What the dealer's pages show besides the model.
struct DealerFacts {
  Status status;
  std::vector<std::string> log;        ///< last errors, newest first, one line each
  std::optional<ImportReport> import;  ///< of the last stick, since the machine was started
};

class Painter {
 public:
  /// Error: no font at all.
  [[nodiscard]] static Result<std::unique_ptr<Painter>> create();
  virtual ~Painter() = default;
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// A paint rendered with itself, for its swatch: square, RGB rows from the top, `edge_px` a side. Empty: a plain disc
  /// of the paint's mean colour until there is one.
  virtual void set_swatch(std::size_t paint, int edge_px, std::vector<std::uint8_t> rgb) = 0;
  /// Side of the picture set_swatch() wants on this surface, px.
  [[nodiscard]] virtual int swatch_edge_px(const Surface& surface, const Content& content) const = 0;

  /// The interface as it is now. `dealer`: null but on the dealer's screen. The result is valid until the next call;
  /// the same arguments give the same sprites and no updates.
  [[nodiscard]] virtual const Painted& paint(const Surface& surface, const Content& content, const Model& model,
                                             const DealerFacts* dealer) = 0;
  /// Tiles drawn since the beginning, for tests and figures.
  [[nodiscard]] virtual std::uint64_t tiles_drawn() const = 0;

 protected:
  Painter() = default;
};

}  // namespace lackwerk::kiosk::ui
