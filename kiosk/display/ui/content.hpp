// What the interface knows about the pack that is shown.
//
// Why it exists: behaviour and painter need names, provenance and limits, not paint data; tests make it by hand.
// Values; any thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/paint.hpp"

namespace lackwerk::packs {
class PaintPack;
class ScanPack;
}  // namespace lackwerk::packs

namespace lackwerk::kiosk::ui {

struct PaintFacts {
  core::PaintIdentity identity;
  std::array<double, 3> srgb{0.5, 0.5, 0.5};  ///< display values of its mean colour at 45 degrees, [0, 1]
  double lively = 0.0;                        ///< spread of its flakes' lightness (core/character.hpp), Lab units
};

/// A series of scans, as the slider of time shows it.
struct ScanFacts {
  std::string name;           ///< of what grows
  std::string time_unit;      ///< "days"; may be empty
  std::vector<double> times;  ///< of the scans, ascending, at least two
  /// The time at a position of the slider, [0, 1].
  [[nodiscard]] double time_at(double position) const {
    return times.front() + position * (times.back() - times.front());
  }
};

struct Content {
  std::string pack_id;
  std::uint64_t serial = 0;
  std::vector<PaintFacts> paints;  ///< 1 to core::max_paints
  /// How far beyond the measured paints a mix may go and still be physical; 0: not at all (core/beyond.hpp).
  double beyond_limit = 0.0;
  bool is_vouched = true;  ///< signed by a trusted maker, or named by whoever started the kiosk; else it is marked
  bool has_flakes = true;  ///< else sparkle and hue sliders are left out
  /// Scans are shown and no paints: the slider is time, and all that is about paints is left out. `paints` then has one
  /// entry with the series' name.
  std::optional<ScanFacts> scans{};
};

/// The facts of an open pack. Takes a few milliseconds: once a pack, not once a frame.
[[nodiscard]] Content ui_content(const packs::PaintPack& pack);
[[nodiscard]] Content ui_content(const packs::ScanPack& pack);

}  // namespace lackwerk::kiosk::ui
