// Which pack the kiosk shows, and when that becomes another one.
//
// Why it exists: a dealer adds a pack while a visitor is at the screen. The store's folder is watched; a new pack is
// verified and parsed before anybody hears of it, and one that fails leaves the old one running. A pack named in
// kiosk.toml or on the command line is opened once and never changes. Owns the watch; one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "kiosk/display/folder_watch.hpp"
#include "kiosk/display/pack_places.hpp"
#include "packs/signed_pack.hpp"

namespace lackwerk::kiosk {

/// A pack that is ready to be shown.
struct ShownPack {
  packs::ExhibitPack pack;
  std::string file;  ///< where it was read
  bool is_signed = false;
  bool is_vouched = false;  ///< signed, or named by whoever started the kiosk
};

class PackSource {
 public:
  explicit PackSource(PackPlaces places);

  /// The pack to begin with. Errors: none named and none in the store, or it does not verify or parse.
  [[nodiscard]] Result<ShownPack> first();

  /// What has come since the last call: nothing, another pack, or why there is none. Call it when the descriptor is
  /// readable, or any time. Changes of the store settle first: a pack is opened once its `state` names it.
  [[nodiscard]] Result<std::optional<ShownPack>> poll();

  /// To poll for reading; -1 where nothing is watched.
  [[nodiscard]] int fd() const { return watch_.fd(); }

 private:
  [[nodiscard]] Result<std::optional<ShownPack>> open_stored();
  [[nodiscard]] Result<ShownPack> open_file(const std::filesystem::path& path) const;

  PackPlaces places_;
  FolderWatch watch_;
  std::string shown_;  ///< folder of the version that is shown, of the store
};

}  // namespace lackwerk::kiosk
