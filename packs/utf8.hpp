// The letters of a UTF-8 text, one after the other.
//
// Why it exists: names come from strangers and go to a text renderer, into JSON and onto terminals. Who refuses them
// and who mends them must read the same letters. Pure; any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace lackwerk::packs {

struct Utf8Letter {
  char32_t point = 0;     ///< code point, [0, 0x10FFFF], no surrogate
  std::size_t bytes = 0;  ///< that it takes, [1, 4]
};

/// The first letter of `text`. Nothing: there is none, or its bytes are no well-formed UTF-8 (Unicode, table 3-7).
[[nodiscard]] std::optional<Utf8Letter> first_letter(std::string_view text);

/// C0, delete and C1.
[[nodiscard]] constexpr bool is_control(char32_t point) { return point < 0x20 || (point >= 0x7f && point < 0xa0); }

/// Well-formed UTF-8 without control characters.
[[nodiscard]] bool is_printable(std::string_view text);

}  // namespace lackwerk::packs
