#include "kiosk/display/interface_words.hpp"

#include <array>
#include <cstdio>

namespace lackwerk::kiosk {
namespace {

constexpr std::array languages{ui::Language::english, ui::Language::german, ui::Language::arabic};
constexpr int minutes_an_hour = 60;
constexpr std::size_t clock_length = 5;  // "08:00"

std::optional<int> minute_of(std::string_view clock) {
  if (clock.size() != clock_length || clock[2] != ':') return std::nullopt;
  const auto digit = [&](std::size_t k) { return clock[k] >= '0' && clock[k] <= '9' ? clock[k] - '0' : 100; };
  const int hour = 10 * digit(0) + digit(1);
  const int minute = 10 * digit(3) + digit(4);
  if (hour > 23 || minute > 59) return std::nullopt;
  return hour * minutes_an_hour + minute;
}

}  // namespace

const char* word_of(ui::Language language) {
  switch (language) {
    case ui::Language::german:
      return "de";
    case ui::Language::arabic:
      return "ar";
    case ui::Language::english:
      break;
  }
  return "en";
}

std::optional<ui::Language> language_of(std::string_view word) {
  for (const ui::Language language : languages)
    if (word == word_of(language)) return language;
  return std::nullopt;
}

std::vector<std::string> language_words() {
  std::vector<std::string> words;
  words.reserve(languages.size());
  for (const ui::Language language : languages) words.emplace_back(word_of(language));
  return words;
}

std::string text_of(const NightHours& night) {
  if (night.from == night.to) return {};
  std::array<char, 64> text{};  // more than four ints need
  std::snprintf(text.data(), text.size(), "%02d:%02d-%02d:%02d", night.from / minutes_an_hour,
                night.from % minutes_an_hour, night.to / minutes_an_hour, night.to % minutes_an_hour);
  return text.data();
}

std::optional<NightHours> night_hours_of(std::string_view text) {
  if (text.empty()) return NightHours{};
  if (text.size() != 2 * clock_length + 1 || text[clock_length] != '-') return std::nullopt;
  const auto from = minute_of(text.substr(0, clock_length));
  const auto to = minute_of(text.substr(clock_length + 1));
  if (!from || !to || *from == *to) return std::nullopt;
  return NightHours{*from, *to};
}

}  // namespace lackwerk::kiosk
