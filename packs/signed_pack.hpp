// A pack file with the signature beside it: verified first, parsed then, from the same bytes.
//
// Why it exists: kiosk, store and tools must agree on what "verified" means, and none may leave a gap between check and
// use. The file is read into memory once (2 to 64 MB, in milliseconds); a mapping could change under the check. Free
// functions; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "packs/exhibit_pack.hpp"
#include "packs/keyring.hpp"
#include "packs/storage.hpp"
#include "packs/store.hpp"

namespace lackwerk::packs {

struct OpenedPack {
  ExhibitPack pack;
  std::optional<SignedAs> signed_as;  ///< nothing: there is no signature, and that was allowed
};

/// What a signature file is called: PACK.minisig.
[[nodiscard]] std::filesystem::path signature_path(const std::filesystem::path& pack);

/// Opens a pack. With a signature beside it, that must verify with the keyring, whatever else is allowed. Errors: as
/// Keyring::check and ExhibitPack::from_bytes, unsigned where that is not allowed, or signed as another pack than it
/// is.
[[nodiscard]] Result<OpenedPack> open_signed_pack(const std::filesystem::path& path, const Keyring& keyring,
                                                  bool allow_unsigned);

/// What the store asks of a pack's bytes.
[[nodiscard]] Result<PackSelf> check_pack(std::vector<std::uint8_t> bytes, const std::string& file);

}  // namespace lackwerk::packs
