#include "kiosk/display/pack_source.hpp"

#include "packs/store.hpp"

namespace lackwerk::kiosk {

PackSource::PackSource(PackPlaces places) : places_(std::move(places)) {}

Result<ShownPack> PackSource::open_file(const std::filesystem::path& path) const {
  // A kiosk that takes unsigned packs may have no keyring at all; a signed pack then has nobody to vouch for it.
  std::error_code code;
  auto ring = places_.allow_unsigned && !std::filesystem::exists(places_.keyring, code)
                  ? Result<packs::Keyring>(packs::Keyring{})
                  : packs::Keyring::open(places_.keyring);
  if (!ring) return tl::unexpected(ring.error());
  auto opened = packs::open_signed_pack(path, *ring, places_.allow_unsigned);
  if (!opened) return tl::unexpected(opened.error());
  const bool is_signed = opened->signed_as.has_value();
  return ShownPack{std::move(opened->pack), path.string(), is_signed, is_signed || !places_.mark_unsigned};
}

Result<std::optional<ShownPack>> PackSource::open_stored() {
  const auto disk = packs::open_disk(places_.store);
  const packs::Store store(*disk, {}, packs::check_pack);
  const auto state = store.state();
  if (!state) return tl::unexpected(state.error());
  const packs::StoredPack* pack = state->find(state->shown);
  if (pack == nullptr) return std::optional<ShownPack>{};
  const std::string folder = packs::Store::folder_of(pack->id, pack->current);
  if (folder == shown_) return std::optional<ShownPack>{};
  auto opened = open_file(std::filesystem::path(places_.store) / folder / packs::stored_pack_file);
  if (!opened) return tl::unexpected(opened.error());
  shown_ = folder;
  return std::optional(std::move(*opened));
}

Result<ShownPack> PackSource::first() {
  if (!places_.files.empty()) return open_file(places_.files.front());
  // Before it is read: a change in between is seen twice, not missed. The store switches by renaming its `state` over
  // the old one. Where the root is not there yet, its parent is watched by nobody: a kiosk without any pack does not
  // start, systemd starts it again.
  watch_.watch(places_.store);
  auto stored = open_stored();
  if (!stored) return tl::unexpected(stored.error());
  if (!*stored)
    return fail(places_.store, "", "no pack is named and the store is empty",
                "lackwerk store add PACK.lwp, or name packs in kiosk.toml");
  return std::move(**stored);
}

Result<std::optional<ShownPack>> PackSource::poll() {
  if (!watch_.changed()) return std::optional<ShownPack>{};
  return open_stored();
}

}  // namespace lackwerk::kiosk
