// Every word the interface shows, in every language.
//
// Why it exists: one table that is complete or does not compile; no text stands anywhere else. Constants; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/paint.hpp"
#include "kiosk/display/ui/model.hpp"
#include "packs/mix_code.hpp"

namespace lackwerk::kiosk::ui {

enum class Text : std::uint8_t {
  touch_to_begin,
  touch_to_stay,
  your_mix,
  nearest_paint,
  colour_difference,  ///< the name of the formula
  take_home_title,
  take_home_how,
  colour_and_gloss,  ///< a paint's lobes
  flakes,
  clear_coat,
  source,
  measured,
  published_fit,
  simulated,
  calm,
  gentle,
  lively,
  white_flakes,
  dealer,
  pin_prompt,
  pin_refused,  ///< {}: attempts left
  pin_locked,   ///< {}: seconds
  packs,
  status,
  devices,
  errors,
  screen,
  options,
  no_packs,
  unsigned_pack,
  unsigned_scans,
  no_devices,
  no_errors,
  new_paints,     ///< {}: their packs
  known_paints,   ///< {}: their packs
  packs_refused,  ///< {}: how many
  nothing_came,   ///< from a stick
  last_stick,
  stored,
  already_there,
  serial,  ///< {}: number
  brightness,
  test_pattern,
  back,
  calibrate,
  calibrate_how,
  calibration_failed,
  beyond,
  language,
  own_name,  ///< the language's own name for itself
  reduced_motion,
  on,
  off,
  state,
  output,
  renderer,
  mode,
  quality,
  frame_time,
  response_time,
  still,
  running,
  waiting_for_display,
  suspended,
  stopped,
  ready,
  waiting,
  refused,
  gone,
  one_event,
  events,  ///< {}: how many
  count_,
};

inline constexpr int languages = 3;

[[nodiscard]] std::string_view text(Text what, Language language);
/// The text with "{}" replaced by a number.
[[nodiscard]] std::string text_with(Text what, Language language, long long number);
/// The same by a machine's words (a pack's name), which keep their own direction.
[[nodiscard]] std::string text_with(Text what, Language language, std::string_view words);

/// Words of a mix's name.
[[nodiscard]] packs::MixWords mix_words(Language language);
/// Simulated is never called measured.
[[nodiscard]] std::string_view provenance_text(core::Provenance provenance, Language language);
[[nodiscard]] std::string_view page_text(DealerPage page, Language language);
/// A machine's word from the status ("running", "gone", ...) in the language; unknown words as they are.
[[nodiscard]] std::string_view state_text(std::string_view word, Language language);

/// A paint's name without what follows in brackets or after a comma ("Polaris Silber, clear coat 1.5"): for places
/// where the whole name is one tap away.
[[nodiscard]] std::string_view short_name(std::string_view name);
/// The name of a mix as it is set: lines break between its parts (but within long ones), and right to left each part
/// keeps its own direction, or numbers would join the paint before them.
[[nodiscard]] std::string set_mix_name(std::string_view mix_name, Language language);

[[nodiscard]] constexpr bool right_to_left(Language language) { return language == Language::arabic; }

}  // namespace lackwerk::kiosk::ui
