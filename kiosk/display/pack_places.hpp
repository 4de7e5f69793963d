// Where the kiosk finds the packs it may show.
//
// Why it exists: configuration names them, pack_source.hpp opens them. Values; any thread.
#pragma once

#include <string>
#include <vector>

#include "packs/store_places.hpp"

namespace lackwerk::kiosk {

struct PackPlaces {
  std::vector<std::string> files;                ///< named packs: the first is shown. Empty: the store's
  std::string store = packs::default_store;      ///< root of the store
  std::string keyring = packs::default_keyring;  ///< folder of trusted keys
  bool mark_unsigned = true;                     ///< false: whoever named them answers for them
  bool allow_unsigned = false;                   ///< packs without a signature are shown, and marked
};

}  // namespace lackwerk::kiosk
