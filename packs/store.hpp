// The dealer's store: packs that were verified, of each the one in use and the one before.
//
// Why it exists: new paints reach a kiosk by a file, and neither a bad file, nor a pulled plug, nor two dealers at once
// may leave it without a paint. Layout below the root (docs/pack-format.md):
//     lock                              held while anything is changed
//     state                             which version of which pack is in use: one small file, replaced in one step
//     staging/                          copies that are not verified yet; swept at the next change
//     packs/ID/SERIAL-HASH/pack.lwp     and pack.lwp.minisig where it is signed
// A version is complete and on the medium before `state` names it, and goes only after `state` does not. Refers to its
// storage; one thread at a time, any number of processes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/keyring.hpp"
#include "packs/storage.hpp"

namespace lackwerk::packs {

inline constexpr std::size_t max_stored_packs = 64;
inline constexpr const char* stored_pack_file = "pack.lwp";
inline constexpr const char* stored_signature_file = "pack.lwp.minisig";

struct StoreSettings {
  std::uint64_t quota_bytes = 1ull << 30;       ///< of everything in it
  std::uint64_t most_pack_bytes = 64ull << 20;  ///< of one file: max_exhibit_bytes
  bool allow_unsigned = false;                  ///< a pack without a signature is taken; one with a bad one never
};

/// One version of a pack as it lies in the store.
struct StoredVersion {
  std::uint64_t serial = 0;
  std::string folder;  ///< "SERIAL-HASH"
  bool operator==(const StoredVersion&) const = default;
};

struct StoredPack {
  std::string id;
  StoredVersion current;
  std::optional<StoredVersion> previous;  ///< what rollback() goes back to
  bool operator==(const StoredPack&) const = default;
};

struct StoreState {
  std::vector<StoredPack> packs;  ///< by id
  std::string shown;              ///< the id of the pack the kiosk shows: the last one added or rolled back
  [[nodiscard]] const StoredPack* find(const std::string& id) const;
  bool operator==(const StoreState&) const = default;
};

/// What a pack's own content says of itself, after all its checks. Reads the bytes, never the file again.
struct PackSelf {
  std::string id;
  std::uint64_t serial = 0;
};
using PackCheck = std::function<Result<PackSelf>(std::vector<std::uint8_t> bytes, const std::string& file)>;

class Store {
 public:
  Store(Storage& storage, StoreSettings settings, PackCheck check);

  enum class Added { stored, already_there };
  struct AddResult {
    Added what = Added::stored;
    StoredPack pack;
    std::optional<KeyId> signed_by;
  };
  /// Copies both into the store, verifies the copies, and switches to them. `name`: of the source, for messages. `pack`
  /// and `signature` are read once, from their beginning; `signature` may be null. Errors: unsigned where that is not
  /// allowed, not verified, not a sound pack, the comment names another pack than the content, a serial that is not
  /// above the current one, no room, faults of disk and source. Whatever happens, what was in use stays in use until
  /// the new one is complete.
  [[nodiscard]] Result<AddResult> add(const std::string& name, Storage::Reader& pack, Storage::Reader* signature,
                                      const Keyring& keyring);
  /// Back to the version before. Error: there is none, or no such pack.
  [[nodiscard]] Result<StoredPack> rollback(const std::string& id);
  /// Error: no such pack.
  [[nodiscard]] Result<void> remove(const std::string& id);
  /// What is in use; an empty state where there is no store. Needs no lock.
  [[nodiscard]] Result<StoreState> state() const;
  /// Bytes of all files in it.
  [[nodiscard]] Result<std::uint64_t> bytes() const;

  /// Path of a version's folder, relative to the root.
  [[nodiscard]] static std::string folder_of(const std::string& id, const StoredVersion& version);

 private:
  struct Staged;
  [[nodiscard]] Result<Staged> stage(const std::string& name, Storage::Reader& pack, Storage::Reader* signature);
  [[nodiscard]] Result<std::array<std::uint8_t, 64>> copy(const std::string& name, Storage::Reader& from,
                                                          const std::string& to, std::uint64_t most);
  [[nodiscard]] Result<std::vector<std::uint8_t>> read_all(const std::string& path, std::uint64_t most) const;
  [[nodiscard]] Result<void> put_state(const StoreState& state);
  [[nodiscard]] Result<void> tidy(const StoreState& state);
  [[nodiscard]] Result<void> clear(const std::string& folder);
  [[nodiscard]] Result<void> need_folder(const std::string& path, const std::string& parent);

  Storage& storage_;
  StoreSettings settings_;
  PackCheck check_;
};

}  // namespace lackwerk::packs
