// What a pack may be called.
//
// Why it exists: ids stand in signatures, file names and the store's folders, so one rule decides for all. Pure; any
// thread.
#pragma once

#include <algorithm>
#include <string_view>

namespace lackwerk::packs {

inline constexpr std::size_t max_pack_id = 64;

/// [A-Za-z0-9][A-Za-z0-9._-]{0,63}
[[nodiscard]] constexpr bool is_pack_id(std::string_view id) {
  const auto is_alphanumeric = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  };
  return !id.empty() && id.size() <= max_pack_id && is_alphanumeric(id.front()) &&
         std::all_of(id.begin(), id.end(),
                     [&](char c) { return is_alphanumeric(c) || c == '.' || c == '_' || c == '-'; });
}

}  // namespace lackwerk::packs
