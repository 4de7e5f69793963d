// The text of a store's `state` file.
//
// Why it exists: it is the one thing a store switches by, so it is read with suspicion. Line 1 is "lackwerk-store 1",
// then "shown ID" where there are packs, then a line "pack ID CURRENT PREVIOUS" each, by id; PREVIOUS is "-" where
// there is none. Pure; any thread.
#pragma once

#include <string_view>

#include "packs/store.hpp"

namespace lackwerk::packs {

/// 64 packs with the longest names take a third of this.
inline constexpr std::uint64_t max_state_bytes = 64 * 1024;

[[nodiscard]] std::string store_state_text(const StoreState& state);
/// Errors name the line.
[[nodiscard]] Result<StoreState> parse_store_state(std::string_view text, const std::string& file);
[[nodiscard]] tl::unexpected<Error> no_such_pack(const std::string& id);

}  // namespace lackwerk::packs
