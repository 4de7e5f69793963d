// Fuzz target: any text as the store's state file.
//
// Input: the text. Whatever comes: no sanitizer finding, every refusal with its line, and a state that is taken names
// folders that stay below the store, each pack once, and is written as the same state again.
#include <cstddef>
#include <string_view>

#include "packs/pack_id.hpp"
#include "packs/store_state.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lackwerk;
  using fuzz::require;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto state = packs::parse_store_state(text, "fuzz");
  if (!state) {
    require(state.error().file == "fuzz" && state.error().field.rfind("line ", 0) == 0 &&
            !state.error().remedy.empty());
    return 0;
  }
  require(state->packs.size() <= packs::max_stored_packs);
  const auto is_folder = [](const packs::StoredVersion& version) {
    return version.folder.find('/') == std::string::npos && version.folder.rfind("..", 0) != 0 &&
           std::stoull(version.folder) == version.serial;
  };
  for (std::size_t k = 0; k < state->packs.size(); ++k) {
    const packs::StoredPack& pack = state->packs[k];
    require(packs::is_pack_id(pack.id) && is_folder(pack.current));
    require(!pack.previous || is_folder(*pack.previous));
    require(state->find(pack.id) == &pack);
  }
  require(state->packs.empty() || state->find(state->shown) != nullptr);
  const auto again = packs::parse_store_state(packs::store_state_text(*state), "again");
  require(again.has_value() && *again == *state);
  return 0;
}
