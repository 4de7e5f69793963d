#include "packs/store.hpp"

#include <algorithm>
#include <charconv>

#include "packs/minisign.hpp"
#include "packs/pack_id.hpp"
#include "packs/store_state.hpp"

namespace lackwerk::packs {
namespace {

const std::string staging = "staging", packs_folder = "packs", state_file = "state", new_state_file = "state.new";
/// One slot: changes are made one at a time, under the lock.
const std::string staged = staging + "/pack";
/// Copied in pieces of this size: the copy is hashed while it is written.
constexpr std::size_t piece_bytes = 256 * 1024;

std::string join(const std::string& folder, const std::string& name) { return folder + "/" + name; }

std::string version_name(std::uint64_t serial, std::span<const std::uint8_t, 64> hash) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string name = std::to_string(serial) + "-";
  // Eight bytes: two packs of one serial that are mistaken for each other would have to be made for it, and the
  // signature is checked again by whoever opens them.
  for (std::size_t k = 0; k < 8; ++k) {
    name += digits[hash[k] >> 4u];
    name += digits[hash[k] & 15u];
  }
  return name;
}

}  // namespace

struct Store::Staged {
  std::array<std::uint8_t, 64> hash{};
  std::vector<std::uint8_t> bytes;
  std::string signature;
};

const StoredPack* StoreState::find(const std::string& id) const {
  const auto found = std::find_if(packs.begin(), packs.end(), [&](const StoredPack& p) { return p.id == id; });
  return found == packs.end() ? nullptr : &*found;
}

Store::Store(Storage& storage, StoreSettings settings, PackCheck check)
    : storage_(storage), settings_(settings), check_(std::move(check)) {}

std::string Store::folder_of(const std::string& id, const StoredVersion& version) {
  return join(join(packs_folder, id), version.folder);
}

Result<StoreState> Store::state() const {
  const auto root = storage_.list("");
  if (!root) return tl::unexpected(root.error());
  const auto is_state = [](const Storage::Entry& entry) { return entry.name == state_file; };
  if (!*root || std::none_of((*root)->begin(), (*root)->end(), is_state)) return StoreState{};
  const auto text = read_all(state_file, max_state_bytes);
  if (!text) return tl::unexpected(text.error());
  return parse_store_state({reinterpret_cast<const char*>(text->data()), text->size()},
                           storage_.full_path(state_file).string());
}

Result<std::vector<std::uint8_t>> Store::read_all(const std::string& path, std::uint64_t most) const {
  auto reader = storage_.open(path);
  if (!reader) return tl::unexpected(reader.error());
  return read_source(**reader, most, storage_.full_path(path).string());
}

Result<std::array<std::uint8_t, 64>> Store::copy(const std::string& name, Storage::Reader& from, const std::string& to,
                                                 std::uint64_t most) {
  auto writer = storage_.create(to);
  if (!writer) return tl::unexpected(writer.error());
  FileHash hash;
  std::vector<std::uint8_t> piece(piece_bytes);
  for (std::uint64_t total = 0;;) {
    const auto n = from.read(piece);
    if (!n) return tl::unexpected(n.error());
    if (*n == 0) break;
    total += *n;
    if (total > most)
      return fail(name, "", "longer than " + std::to_string(most) + " bytes", "this is no pack of paints");
    const std::span<const std::uint8_t> part(piece.data(), *n);
    hash.add(part);
    if (auto written = (*writer)->write(part); !written) return tl::unexpected(written.error());
  }
  if (auto synced = (*writer)->sync(); !synced) return tl::unexpected(synced.error());
  return hash.finish();
}

Result<Store::Staged> Store::stage(const std::string& name, Storage::Reader& pack, Storage::Reader* signature) {
  if (auto made = need_folder(staging, ""); !made) return tl::unexpected(made.error());
  if (auto made = storage_.make_folder(staged); !made) return tl::unexpected(made.error());
  const auto hash = copy(name, pack, join(staged, stored_pack_file), settings_.most_pack_bytes);
  if (!hash) return tl::unexpected(hash.error());
  Staged out;
  if (signature != nullptr) {
    const std::string path = join(staged, stored_signature_file);
    if (auto copied = copy(name + ".minisig", *signature, path, max_minisig_bytes); !copied)
      return tl::unexpected(copied.error());
    const auto text = read_all(path, max_minisig_bytes);
    if (!text) return tl::unexpected(text.error());
    out.signature.assign(text->begin(), text->end());
  }
  // What is verified and used is what lies in the store, read back: neither the source nor what was meant to be
  // written.
  auto bytes = read_all(join(staged, stored_pack_file), settings_.most_pack_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  FileHash read_back;
  read_back.add(*bytes);
  out.hash = read_back.finish();
  if (out.hash != *hash) return fail(name, "", "the copy in the store differs from what was copied", "check the disk");
  out.bytes = std::move(*bytes);
  if (auto synced = storage_.sync_folder(staged); !synced) return tl::unexpected(synced.error());
  if (auto synced = storage_.sync_folder(staging); !synced) return tl::unexpected(synced.error());
  return out;
}

Result<Store::AddResult> Store::add(const std::string& name, Storage::Reader& pack, Storage::Reader* signature,
                                    const Keyring& keyring) {
  if (signature == nullptr && !settings_.allow_unsigned)
    return fail(name, "", "not signed", "put " + name + ".minisig beside it, or allow unsigned packs");
  const auto lock = storage_.lock();
  if (!lock) return tl::unexpected(lock.error());
  auto before = state();
  if (!before) return tl::unexpected(before.error());
  if (auto tidied = tidy(*before); !tidied) return tl::unexpected(tidied.error());
  const auto used = bytes();
  if (!used) return tl::unexpected(used.error());
  if (*used > settings_.quota_bytes || pack.size() > settings_.quota_bytes - *used)
    return fail(storage_.full_path("").string(), "",
                std::to_string(pack.size()) + " bytes do not fit: " + std::to_string(*used) + " of " +
                    std::to_string(settings_.quota_bytes) + " are taken",
                "remove a pack, or raise the quota");

  auto copy = stage(name, pack, signature);
  const auto refuse = [&](const Error& why) -> Result<AddResult> {
    // The first reason is the one to tell; what cannot be swept now is swept at the next change.
    [[maybe_unused]] const auto swept = clear(staging);
    return tl::unexpected(why);
  };
  if (!copy) return refuse(copy.error());
  AddResult result;
  std::optional<SignedAs> as;
  if (signature != nullptr) {
    auto checked = keyring.check(copy->signature, copy->hash, name + ".minisig");
    if (!checked) return refuse(checked.error());
    as = *checked;
    result.signed_by = as->key;
  }
  const auto self = check_(std::move(copy->bytes), name);
  if (!self) return refuse(self.error());
  if (!is_pack_id(self->id)) return refuse(fail(name, "id", "cannot be a folder's name", "rename the pack").value());
  if (as)
    if (auto same = check_signed_as(*as, self->id, self->serial, name + ".minisig"); !same) return refuse(same.error());

  const StoredVersion version{self->serial, version_name(self->serial, copy->hash)};
  StoreState after = *before;
  auto known =
      std::find_if(after.packs.begin(), after.packs.end(), [&](const StoredPack& p) { return p.id == self->id; });
  if (known != after.packs.end()) {
    if (known->current == version) {
      result.what = Added::already_there;
      result.pack = *known;
      after.shown = self->id;
      if (auto swept = clear(staging); !swept) return tl::unexpected(swept.error());
      if (after != *before)
        if (auto put = put_state(after); !put) return tl::unexpected(put.error());
      return result;
    }
    if (version.serial <= known->current.serial)
      return refuse(fail(name, "serial",
                         std::to_string(version.serial) + " is not above " + std::to_string(known->current.serial) +
                             ", which is in use",
                         "to go back on purpose: lackwerk store rollback " + self->id)
                        .value());
  } else if (after.packs.size() == max_stored_packs) {
    return refuse(fail(storage_.full_path("").string(), "", std::to_string(max_stored_packs) + " packs are in it",
                       "remove one first")
                      .value());
  }

  const std::string folder = join(packs_folder, self->id);
  if (auto made = need_folder(packs_folder, ""); !made) return refuse(made.error());
  if (auto made = need_folder(folder, packs_folder); !made) return refuse(made.error());
  // The version that rollback left may be this very one.
  if (auto cleared = clear(folder_of(self->id, version)); !cleared) return refuse(cleared.error());
  if (auto moved = storage_.rename(staged, folder_of(self->id, version)); !moved) return refuse(moved.error());
  if (auto synced = storage_.sync_folder(folder); !synced) return tl::unexpected(synced.error());
  if (known == after.packs.end()) {
    after.packs.push_back({self->id, version, std::nullopt});
    std::sort(after.packs.begin(), after.packs.end(),
              [](const StoredPack& a, const StoredPack& b) { return a.id < b.id; });
  } else {
    known->previous = known->current;
    known->current = version;
  }
  after.shown = self->id;
  if (auto put = put_state(after); !put) return tl::unexpected(put.error());
  if (auto tidied = tidy(after); !tidied) return tl::unexpected(tidied.error());
  result.pack = *after.find(self->id);
  return result;
}

Result<StoredPack> Store::rollback(const std::string& id) {
  const auto lock = storage_.lock();
  if (!lock) return tl::unexpected(lock.error());
  auto now = state();
  if (!now) return tl::unexpected(now.error());
  const auto known =
      std::find_if(now->packs.begin(), now->packs.end(), [&](const StoredPack& p) { return p.id == id; });
  if (known == now->packs.end()) return no_such_pack(id);
  if (!known->previous)
    return fail(id, "", "there is no version before " + std::to_string(known->current.serial),
                "add an older one by hand");
  std::swap(known->current, *known->previous);
  // What was left on purpose is not gone back to by accident: a second rollback would show it again.
  known->previous.reset();
  now->shown = id;
  if (auto put = put_state(*now); !put) return tl::unexpected(put.error());
  if (auto tidied = tidy(*now); !tidied) return tl::unexpected(tidied.error());
  return *now->find(id);
}

Result<void> Store::remove(const std::string& id) {
  const auto lock = storage_.lock();
  if (!lock) return tl::unexpected(lock.error());
  auto now = state();
  if (!now) return tl::unexpected(now.error());
  if (now->find(id) == nullptr) return no_such_pack(id);
  std::erase_if(now->packs, [&](const StoredPack& p) { return p.id == id; });
  if (now->shown == id) now->shown = now->packs.empty() ? "" : now->packs.front().id;
  if (auto put = put_state(*now); !put) return put;
  return tidy(*now);
}

Result<std::uint64_t> Store::bytes() const {
  std::uint64_t total = 0;
  std::vector<std::string> open{""};
  while (!open.empty()) {
    const std::string folder = open.back();
    open.pop_back();
    const auto entries = storage_.list(folder);
    if (!entries) return tl::unexpected(entries.error());
    if (!*entries) continue;
    for (const Storage::Entry& entry : **entries) {
      if (entry.folder)
        open.push_back(folder.empty() ? entry.name : join(folder, entry.name));
      else
        total += entry.bytes;
    }
  }
  return total;
}

Result<void> Store::put_state(const StoreState& state) {
  const auto root = storage_.list("");
  if (!root) return tl::unexpected(root.error());
  const auto is_left = [](const Storage::Entry& entry) { return entry.name == new_state_file; };
  if (*root && std::any_of((*root)->begin(), (*root)->end(), is_left))
    if (auto removed = storage_.remove_file(new_state_file); !removed) return removed;
  auto writer = storage_.create(new_state_file);
  if (!writer) return tl::unexpected(writer.error());
  const std::string text = store_state_text(state);
  if (auto written = (*writer)->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); !written)
    return written;
  if (auto synced = (*writer)->sync(); !synced) return synced;
  if (auto switched = storage_.rename(new_state_file, state_file); !switched) return switched;
  return storage_.sync_folder("");
}

Result<void> Store::need_folder(const std::string& path, const std::string& parent) {
  const auto there = storage_.list(path);
  if (!there) return tl::unexpected(there.error());
  if (!*there)
    if (auto made = storage_.make_folder(path); !made) return made;
  // Also where it was there: whoever made it may have been cut off before this.
  return storage_.sync_folder(parent);
}

Result<void> Store::clear(const std::string& folder) {
  const auto entries = storage_.list(folder);
  if (!entries) return tl::unexpected(entries.error());
  if (!*entries) return {};
  for (const Storage::Entry& entry : **entries) {
    const std::string path = join(folder, entry.name);
    if (auto gone = entry.folder ? clear(path) : storage_.remove_file(path); !gone) return gone;
  }
  return storage_.remove_folder(folder);
}

Result<void> Store::tidy(const StoreState& state) {
  if (auto swept = clear(staging); !swept) return swept;
  const auto ids = storage_.list(packs_folder);
  if (!ids) return tl::unexpected(ids.error());
  if (!*ids) return {};
  for (const Storage::Entry& id : **ids) {
    const std::string folder = join(packs_folder, id.name);
    const StoredPack* pack = state.find(id.name);
    if (pack == nullptr) {
      if (auto gone = id.folder ? clear(folder) : storage_.remove_file(folder); !gone) return gone;
      continue;
    }
    const auto versions = storage_.list(folder);
    if (!versions) return tl::unexpected(versions.error());
    if (!*versions) continue;
    for (const Storage::Entry& version : **versions) {
      if (version.name == pack->current.folder || (pack->previous && version.name == pack->previous->folder)) continue;
      const std::string path = join(folder, version.name);
      if (auto gone = version.folder ? clear(path) : storage_.remove_file(path); !gone) return gone;
    }
  }
  return {};
}

}  // namespace lackwerk::packs
