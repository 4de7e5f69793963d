#include "input/device_text.hpp"

#include <algorithm>
#include <cstdint>

namespace lackwerk::input {
namespace {

constexpr std::size_t max_name_bytes = 80;
constexpr std::size_t max_notices = 32;

/// Bytes of the well-formed UTF-8 character at the start of `text` that is no control character; 0: none there.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(text[k]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  std::uint32_t point = lead & (0xffu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xc0) != 0x80) return 0;
    point = (point << 6) | (byte(k) & 0x3f);
  }
  // Overlong, surrogate, beyond Unicode, C1 control.
  const std::uint32_t least = length == 2 ? 0xa0 : length == 3 ? 0x800 : 0x10000;
  if (point < least || point > 0x10ffff || (point >= 0xd800 && point <= 0xdfff)) return 0;
  return length;
}

}  // namespace

std::string printable(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return "unnamed";
  text = text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_bytes(text);
    if (out.size() + std::max<std::size_t>(length, 1) > max_name_bytes) break;
    out += length == 0 ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

void Notices::add(bool problem, const std::string& text) {
  if (std::any_of(lines_.begin(), lines_.end(), [&](const Notice& line) { return line.text == text; })) return;
  if (lines_.size() == max_notices) {
    ++dropped_;
    return;
  }
  lines_.push_back({problem, text});
}

void Notices::take(std::vector<Notice>& out) {
  out.insert(out.end(), lines_.begin(), lines_.end());
  if (dropped_ > 0) out.push_back({true, std::to_string(dropped_) + " more lines about input devices were left out"});
  lines_.clear();
  dropped_ = 0;
}

}  // namespace lackwerk::input
