// Everything that has a place on the interface's screens: what can be touched, and the panels and lines of text
// between.
//
// Why it exists: layout() shows behaviour what can be touched; the painter needs the rest as well, from the same
// reckoning. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiosk/display/ui/metrics.hpp"

namespace lackwerk::kiosk::ui {

/// What lies on a screen without answering to a finger.
enum class Part : std::uint8_t {
  pad_glass,      ///< show: the pad's panel
  slider_glass,   ///< show: behind the sliders
  light_glass,    ///< show: behind light moods and dimmer
  dock_glass,     ///< show: behind compare and take home
  time_glass,     ///< show, scans: behind the slider of time and its words
  time_words,     ///< show, scans: the series' name and the time that is shown
  mix_name,       ///< show
  hint,           ///< show: the hand on the pad
  divider,        ///< show, comparing: between mix and nearest paint
  compare_left,   ///< label of the mix
  compare_right,  ///< label of the nearest paint
  card,           ///< take_home, about, pin, dealer: the panel all the rest is on
  title,          ///< of the card
  qr,             ///< take_home: the code with its quiet zone
  body,           ///< text of the card: name and code, provenance, the dealer's page
  digits,         ///< pin: the dots of what was typed
  value,          ///< dealer: what is between step_down and step_up; index: ScreenValue
  cross,          ///< dealer: the calibration's
  toast,          ///< on every screen: what came of a stick; nothing to touch
};

struct Piece {
  Part part = Part::card;
  int index = 0;
  Rect rect;
};

struct Arrangement {
  std::vector<Item> items;  ///< as layout() gives them
  std::vector<Piece> pieces;
  [[nodiscard]] std::optional<Rect> find(Part part) const;
};

[[nodiscard]] Arrangement arrange(const Surface& surface, const Content& content, const Model& model);

/// The parts arrange() is made of.
void arrange_show(const Metrics& metrics, const Surface& surface, const Content& content, const Model& model,
                  Arrangement& out);
void arrange_card(const Metrics& metrics, const Surface& surface, const Model& model, Arrangement& out);

}  // namespace lackwerk::kiosk::ui
