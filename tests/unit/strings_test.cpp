// The words of the interface, complete and honest in every language.
#include "kiosk/display/ui/strings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lackwerk::kiosk::ui {
namespace {

constexpr std::array all{Language::english, Language::german, Language::arabic};

/// Code points of UTF-8; fails the test on broken bytes.
std::vector<char32_t> code_points(std::string_view text) {
  std::vector<char32_t> out;
  std::size_t more = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (more > 0) {
      EXPECT_EQ(byte & 0xC0U, 0x80U) << text;
      out.back() = (out.back() << 6U) | (byte & 0x3FU);
      --more;
      continue;
    }
    EXPECT_NE(byte & 0xC0U, 0x80U) << text;
    more = byte >= 0xF0U ? 3 : byte >= 0xE0U ? 2 : byte >= 0xC0U ? 1 : 0;
    out.push_back(more == 3 ? byte & 0x07U : more == 2 ? byte & 0x0FU : more == 1 ? byte & 0x1FU : byte);
  }
  EXPECT_EQ(more, 0U) << text;
  return out;
}

bool is_arabic(char32_t c) { return c >= 0x0600 && c <= 0x06FF; }

TEST(Strings, EveryTextIsThereInEveryLanguage) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(Text::count_); ++k)
    for (const Language language : all) EXPECT_FALSE(code_points(text(static_cast<Text>(k), language)).empty());
}

TEST(Strings, ArabicIsWrittenInArabic) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(Text::count_); ++k) {
    const auto what = static_cast<Text>(k);
    if (what == Text::colour_difference) continue;  // the formula's name
    bool found = false;
    for (const char32_t c : code_points(text(what, Language::arabic))) found = found || is_arabic(c);
    EXPECT_TRUE(found) << text(what, Language::english);
  }
}

TEST(Strings, GermanHasItsUmlauts) {
  std::set<char32_t> seen;
  for (std::size_t k = 0; k < static_cast<std::size_t>(Text::count_); ++k)
    for (const char32_t c : code_points(text(static_cast<Text>(k), Language::german))) seen.insert(c);
  for (const char32_t c : {U'ä', U'ö', U'ü', U'ß'}) EXPECT_TRUE(seen.contains(c)) << static_cast<unsigned>(c);
}

TEST(Strings, PlaceholdersAreTheSameInAllLanguages) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(Text::count_); ++k) {
    const auto what = static_cast<Text>(k);
    const bool english = text(what, Language::english).find("{}") != std::string_view::npos;
    for (const Language language : all)
      EXPECT_EQ(text(what, language).find("{}") != std::string_view::npos, english) << text(what, language);
  }
  EXPECT_EQ(text_with(Text::pin_locked, Language::english, 30), "Locked for 30 s");
  EXPECT_EQ(text_with(Text::pin_refused, Language::german, 3), "Falsche PIN, noch 3 Versuche");
  EXPECT_EQ(text_with(Text::on, Language::english, 3), text(Text::on, Language::english));
}

TEST(Strings, SimulatedIsNeverCalledMeasured) {
  for (const Language language : all) {
    const std::string_view measured = provenance_text(core::Provenance::measured, language);
    for (const core::Provenance other : {core::Provenance::simulated, core::Provenance::published_fit})
      EXPECT_EQ(provenance_text(other, language).find(measured), std::string_view::npos);
    EXPECT_NE(provenance_text(core::Provenance::simulated, language),
              provenance_text(core::Provenance::published_fit, language));
  }
}

TEST(Strings, MixWordsAreAllThere) {
  for (const Language language : all) {
    const packs::MixWords words = mix_words(language);
    for (const std::string_view word :
         {words.calm, words.gentle, words.lively, words.white_flakes, words.list_separator})
      EXPECT_FALSE(word.empty());
  }
  EXPECT_EQ(mix_words(Language::english).lively, "lively");
}

TEST(Strings, StatesOfTheMachineAreTranslatedAndOthersKept) {
  EXPECT_EQ(state_text("running", Language::german), "läuft");
  EXPECT_EQ(state_text("gone", Language::english), "gone");
  EXPECT_EQ(state_text("dreaming", Language::arabic), "dreaming");
}

TEST(Strings, ShortNameLeavesOutWhatFollowsInBracketsOrAfterAComma) {
  EXPECT_EQ(short_name("Polaris Silber mit Klarlack (Guenther et al. 2005)"), "Polaris Silber mit Klarlack");
  EXPECT_EQ(short_name("Polaris Silber, clear coat 1.5"), "Polaris Silber");
  EXPECT_EQ(short_name("Opel Titan"), "Opel Titan");
  EXPECT_EQ(short_name("(nameless)"), "(nameless)");
  EXPECT_EQ(short_name(", odd"), ", odd");
  EXPECT_EQ(short_name(""), "");
}

TEST(Strings, MixNameBreaksBetweenItsPartsOnly) {
  EXPECT_EQ(set_mix_name("72 % Polaris, 28 % Opel Titan, lively", Language::english),
            "72\u00a0%\u00a0Polaris, 28\u00a0%\u00a0Opel\u00a0Titan, lively");
  // A part that is longer than a line may be broken.
  const std::string longest = "100 % Polaris Silber mit Klarlack (Guenther et al. 2005)";
  EXPECT_EQ(set_mix_name(longest, Language::german), longest);
  EXPECT_EQ(set_mix_name("", Language::english), "");
  EXPECT_EQ(set_mix_name("a, ", Language::english), "a, ");
}

TEST(Strings, ArabicMixNameKeepsItsPartsApart) {
  const std::string set = set_mix_name("72 % Polaris، متلألئ", Language::arabic);
  EXPECT_EQ(set, "\u206872\u00a0%\u00a0Polaris\u2069، \u2068متلألئ\u2069");
}

}  // namespace
}  // namespace lackwerk::kiosk::ui
