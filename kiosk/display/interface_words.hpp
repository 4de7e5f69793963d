// How the interface's choices are written: in kiosk.toml, on the command line and in the dealer's file.
//
// Why it exists: three readers must take the same words. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/display/experience_settings.hpp"

namespace lackwerk::kiosk {

/// "en", "de", "ar" (ISO 639-1).
[[nodiscard]] const char* word_of(ui::Language language);
[[nodiscard]] std::optional<ui::Language> language_of(std::string_view word);
/// In the order of the enumeration.
[[nodiscard]] std::vector<std::string> language_words();

/// "20:00-08:00"; empty: never.
[[nodiscard]] std::string text_of(const NightHours& night);
/// Nothing for anything else; the same time twice is refused too, for nobody can tell which day is meant.
[[nodiscard]] std::optional<NightHours> night_hours_of(std::string_view text);

}  // namespace lackwerk::kiosk
