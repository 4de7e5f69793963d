// What the interface knows about the pack that is shown.
//
// Why it exists: behaviour and painter need names, provenance and limits, not paint data; tests make it by hand.
// Values; any thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/paint.hpp"

namespace lackwerk::packs {
class PaintPack;
}

namespace lackwerk::kiosk::ui {

struct PaintFacts {
  core::PaintIdentity identity;
  std::array<double, 3> srgb{0.5, 0.5, 0.5};  ///< display values of its mean colour at 45 degrees, [0, 1]
  double lively = 0.0;                        ///< spread of its flakes' lightness (core/character.hpp), Lab units
};

struct Content {
  std::string pack_id;
  std::uint64_t serial = 0;
  std::vector<PaintFacts> paints;  ///< 1 to core::max_paints
  /// How far beyond the measured paints a mix may go and still be physical; 0: not at all (core/beyond.hpp).
  double beyond_limit = 0.0;
  bool is_vouched = true;  ///< signed by a trusted maker, or named by whoever started the kiosk; else it is marked
  bool has_flakes = true;  ///< else sparkle and hue sliders are left out
};

/// The facts of an open pack. Takes a few milliseconds: once a pack, not once a frame.
[[nodiscard]] Content ui_content(const packs::PaintPack& pack);

}  // namespace lackwerk::kiosk::ui
