#include "packs/store_state.hpp"

#include <algorithm>
#include <charconv>

#include "packs/pack_id.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::string_view head = "lackwerk-store 1";
constexpr std::string_view remedy = "remove the store's folder and add the packs again";

/// The next word of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

/// "SERIAL-HASH" with 16 small hexadecimal digits.
std::optional<StoredVersion> parse_version(std::string_view text) {
  StoredVersion version;
  const char* end = text.data() + text.size();
  const auto [next, code] = std::from_chars(text.data(), end, version.serial);
  const std::string_view rest = text.substr(static_cast<std::size_t>(next - text.data()));
  if (code != std::errc{} || rest.size() != 17 || rest.front() != '-' ||
      rest.find_first_not_of("0123456789abcdef", 1) != std::string_view::npos)
    return std::nullopt;
  version.folder = text;
  return version;
}

std::optional<StoredPack> parse_pack(std::string_view line) {
  StoredPack pack;
  if (next_word(line) != "pack") return std::nullopt;
  pack.id = next_word(line);
  const auto current = parse_version(next_word(line));
  const std::string_view before = next_word(line);
  if (!is_pack_id(pack.id) || !current || !line.empty()) return std::nullopt;
  pack.current = *current;
  if (before == "-") return pack;
  pack.previous = parse_version(before);
  if (!pack.previous) return std::nullopt;
  return pack;
}

}  // namespace

std::string store_state_text(const StoreState& state) {
  std::string text = std::string(head) + "\n";
  if (!state.packs.empty()) text += "shown " + state.shown + "\n";
  for (const StoredPack& pack : state.packs)
    text += "pack " + pack.id + " " + pack.current.folder + " " + (pack.previous ? pack.previous->folder : "-") + "\n";
  return text;
}

Result<StoreState> parse_store_state(std::string_view text, const std::string& file) {
  StoreState state;
  const std::string_view whole = text;
  if (text.empty()) return fail(file, "line 1", "is not of a store's state", std::string(remedy));
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    const auto bad = [&] {
      return fail(file, "line " + std::to_string(number), "is not of a store's state", std::string(remedy));
    };
    if (end == std::string_view::npos) return bad();
    text.remove_prefix(end + 1);
    if (number == 1) {
      if (line != head) return bad();
    } else if (number == 2) {
      if (next_word(line) != "shown") return bad();
      state.shown = line;
    } else {
      const auto pack = parse_pack(line);
      if (!pack || state.packs.size() == max_stored_packs ||
          (!state.packs.empty() && state.packs.back().id >= pack->id))
        return bad();
      state.packs.push_back(*pack);
    }
  }
  const bool shown_is_there = state.packs.empty() ? state.shown.empty() : state.find(state.shown) != nullptr;
  if (!shown_is_there) return fail(file, "line 2", "names a pack that is not there", std::string(remedy));
  // Whatever else a text may hide is found here: it must be what would have been written.
  if (store_state_text(state) != whole) return fail(file, "line 2", "is not of a store's state", std::string(remedy));
  return state;
}

tl::unexpected<Error> no_such_pack(const std::string& id) {
  return fail(id, "", "no such pack in the store", "lackwerk store list");
}

}  // namespace lackwerk::packs
