#include "packs/utf8.hpp"

namespace lackwerk::packs {

std::optional<Utf8Letter> first_letter(std::string_view text) {
  if (text.empty()) return std::nullopt;
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return Utf8Letter{lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return std::nullopt;
  char32_t point = lead & (0x7fu >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xc0u) != 0x80u) return std::nullopt;
    point = point << 6 | (byte(k) & 0x3fu);
  }
  // Written longer than needed, a surrogate, beyond Unicode; of two bytes the lead has told.
  const char32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (point < least || point > 0x10ffff || (point >= 0xd800 && point <= 0xdfff)) return std::nullopt;
  return Utf8Letter{point, bytes};
}

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const auto letter = first_letter(text);
    if (!letter || is_control(letter->point)) return false;
    text.remove_prefix(letter->bytes);
  }
  return true;
}

}  // namespace lackwerk::packs
