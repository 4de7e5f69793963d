// Where store and keyring are on an installed kiosk.
//
// Why it exists: kiosk, importer and tools must mean the same places. Constants.
#pragma once

namespace lackwerk::packs {

inline constexpr const char* default_store = "/var/lib/lackwerk/store";
inline constexpr const char* default_keyring = "/etc/lackwerk/keys";

}  // namespace lackwerk::packs
