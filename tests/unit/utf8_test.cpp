// Letters of UTF-8: every one is read back, and nothing else is one.
#include "packs/utf8.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace lackwerk::packs {
namespace {

/// As the standard writes a number below 2^21, in so many bytes: also where fewer would do.
std::string written(char32_t point, std::size_t bytes) {
  if (bytes == 1) return {static_cast<char>(point)};
  std::string out(bytes, '\0');
  for (std::size_t k = bytes - 1; k > 0; --k, point >>= 6) out[k] = static_cast<char>(0x80 | (point & 0x3f));
  out[0] = static_cast<char>(((0xf00 >> bytes) & 0xff) | point);
  return out;
}

std::size_t shortest(char32_t point) { return point < 0x80 ? 1 : point < 0x800 ? 2 : point < 0x10000 ? 3 : 4; }

bool is_surrogate(char32_t point) { return point >= 0xd800 && point < 0xe000; }

TEST(Utf8, EveryCodePointIsReadBackAndOnlyInItsShortestForm) {
  ASSERT_EQ(written(U'€', 3), "€");
  ASSERT_EQ(written(U'😀', 4), "😀");
  std::size_t letters = 0;
  for (char32_t point = 0; point < 0x200000; ++point)
    for (std::size_t bytes = shortest(point); bytes <= 4; ++bytes) {
      const auto letter = first_letter(written(point, bytes) + "x");
      const bool fine = bytes == shortest(point) && point <= 0x10ffff && !is_surrogate(point);
      ASSERT_EQ(letter.has_value(), fine) << static_cast<std::uint32_t>(point) << " in " << bytes;
      if (!letter) continue;
      ASSERT_EQ(letter->point, point);
      ASSERT_EQ(letter->bytes, bytes);
      ++letters;
    }
  EXPECT_EQ(letters, 0x110000u - 0x800u);
}

TEST(Utf8, WhatIsCutOrBrokenIsNone) {
  EXPECT_FALSE(first_letter(""));
  for (const char32_t point : {U'ä', U'€', U'😀'}) {
    const std::string whole = written(point, shortest(point));
    for (std::size_t bytes = 1; bytes < whole.size(); ++bytes) {
      EXPECT_FALSE(first_letter(std::string_view(whole).substr(0, bytes)));
      EXPECT_FALSE(first_letter(std::string_view(whole).substr(bytes))) << "begins in the middle";
      std::string broken = whole;
      broken[bytes] = 'a';
      EXPECT_FALSE(first_letter(broken));
    }
  }
  for (const char lead : {'\x80', '\xbf', '\xc0', '\xc1', '\xf5', '\xf8', '\xfe', '\xff'})
    EXPECT_FALSE(first_letter(lead + std::string("\x80\x80\x80\x80\x80")));
}

TEST(Utf8, ControlsAreThoseOfBothSetsAndDelete) {
  int controls = 0;
  for (char32_t point = 0; point < 0x10000; ++point) controls += is_control(point) ? 1 : 0;
  EXPECT_EQ(controls, 32 + 1 + 32);
  for (const char32_t point : {0x00, 0x1f, 0x7f, 0x80, 0x9f}) EXPECT_TRUE(is_control(point));
  for (const char32_t point : {0x20, 0x7e, 0xa0}) EXPECT_FALSE(is_control(point));
}

}  // namespace
}  // namespace lackwerk::packs
