#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/signed_pack.hpp"
#include "packs/store.hpp"
#include "packs/store_places.hpp"

namespace lackwerk::tools {
namespace {

struct StoreOptions {
  std::string root = packs::default_store, keyring = packs::default_keyring;
  std::vector<std::string> files;  ///< of add
  std::string id;                  ///< of remove and rollback
  std::uint64_t quota_mb = packs::StoreSettings{}.quota_bytes >> 20u;
  bool allow_unsigned = false, json = false;
};

void print_json(const nlohmann::ordered_json& value) {
  print(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

nlohmann::ordered_json pack_json(const packs::StoredPack& pack, const std::string& shown) {
  nlohmann::ordered_json out{{"id", pack.id},
                             {"serial", pack.current.serial},
                             {"folder", packs::Store::folder_of(pack.id, pack.current)},
                             {"shown", pack.id == shown}};
  if (pack.previous) out["previous_serial"] = pack.previous->serial;
  return out;
}

packs::StoreSettings settings_of(const StoreOptions& options) {
  packs::StoreSettings settings;
  settings.quota_bytes = options.quota_mb << 20u;
  settings.allow_unsigned = options.allow_unsigned;
  return settings;
}

Result<packs::Store::AddResult> add_one(packs::Store& store, const StoreOptions& options, const std::string& file) {
  // A store that takes unsigned packs may have no keyring at all.
  std::error_code code;
  auto ring = options.allow_unsigned && !std::filesystem::exists(options.keyring, code)
                  ? Result<packs::Keyring>(packs::Keyring{})
                  : packs::Keyring::open(options.keyring);
  if (!ring) return tl::unexpected(ring.error());
  auto pack = packs::open_source(file);
  if (!pack) return tl::unexpected(pack.error());
  const std::filesystem::path beside = packs::signature_path(file);
  if (!std::filesystem::exists(std::filesystem::symlink_status(beside, code)))
    return store.add(file, **pack, nullptr, *ring);
  auto signature = packs::open_source(beside);
  if (!signature) return tl::unexpected(signature.error());
  return store.add(file, **pack, signature->get(), *ring);
}

int run_add(packs::Store& store, const StoreOptions& options) {
  int code = exit_done;
  for (const std::string& file : options.files) {
    const auto added = add_one(store, options, file);
    if (!added) {
      code = report(added.error());
      continue;
    }
    const bool is_new = added->what == packs::Store::Added::stored;
    if (options.json) {
      nlohmann::ordered_json out = pack_json(added->pack, added->pack.id);
      out["file"] = file;
      out["result"] = is_new ? "stored" : "already there";
      if (added->signed_by) out["key"] = packs::key_id_text(*added->signed_by);
      print_json(out);
    } else {
      print(added->pack.id + " " + std::to_string(added->pack.current.serial) +
            (is_new ? " is in use now" : " was there already") +
            (added->signed_by ? ", key " + packs::key_id_text(*added->signed_by) : ", unsigned"));
    }
  }
  return code;
}

int run_list(packs::Store& store, const StoreOptions& options) {
  const auto state = store.state();
  if (!state) return report(state.error());
  const auto bytes = store.bytes();
  if (!bytes) return report(bytes.error());
  if (options.json) {
    nlohmann::ordered_json out{{"root", options.root}, {"bytes", *bytes}, {"packs", nlohmann::json::array()}};
    for (const packs::StoredPack& pack : state->packs) out["packs"].push_back(pack_json(pack, state->shown));
    print_json(out);
    return exit_done;
  }
  if (state->packs.empty()) print(options.root + " is empty");
  for (const packs::StoredPack& pack : state->packs)
    print(pack.id + " " + std::to_string(pack.current.serial) +
          (pack.previous ? ", before it " + std::to_string(pack.previous->serial) : "") +
          (pack.id == state->shown ? ", shown" : ""));
  return exit_done;
}

int run_rollback(packs::Store& store, const StoreOptions& options) {
  const auto back = store.rollback(options.id);
  if (!back) return report(back.error());
  if (options.json)
    print_json(pack_json(*back, back->id));
  else
    print(back->id + " is back at " + std::to_string(back->current.serial));
  return exit_done;
}

int run_remove(packs::Store& store, const StoreOptions& options) {
  if (const auto removed = store.remove(options.id); !removed) return report(removed.error());
  if (options.json)
    print_json({{"id", options.id}, {"removed", true}});
  else
    print(options.id + " is removed");
  return exit_done;
}

/// One of the store's four commands on an opened store.
template <class Run>
void on_store(CLI::App& command, const std::shared_ptr<StoreOptions>& options, int& exit_code, Run run) {
  command.add_option("--root", options->root, "the store's folder")->capture_default_str();
  command.add_flag("--json", options->json, "print JSON");
  command.callback([options, &exit_code, run] {
    const auto disk = packs::open_disk(options->root);
    packs::Store store(*disk, settings_of(*options), packs::check_pack);
    exit_code = run(store, *options);
  });
}

}  // namespace

void add_store_command(CLI::App& app, int& exit_code) {
  const auto group = [&](const char* name, const char* what) -> CLI::App& {
    return *command_group(app, "store", "The dealer's store of verified packs").add_subcommand(name, what);
  };
  auto options = std::make_shared<StoreOptions>();
  CLI::App& add = group("add", "Verify packs, store them and show the last of them");
  add.add_option("PACK", options->files, "paint packs, each with PACK.minisig beside it")->required();
  add.add_option("--keyring", options->keyring, "folder of public keys (*.pub) that are trusted, and 'revoked'")
      ->capture_default_str();
  add.add_option("--quota-mb", options->quota_mb, "the store's size, MiB")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  add.add_flag("--allow-unsigned", options->allow_unsigned, "take packs without a signature");
  on_store(add, options, exit_code, run_add);
  on_store(group("list", "What is in the store"), options, exit_code, run_list);
  CLI::App& rollback = group("rollback", "Back to the version before, on purpose");
  rollback.add_option("ID", options->id, "id of the pack")->required();
  on_store(rollback, options, exit_code, run_rollback);
  CLI::App& remove = group("remove", "Take a pack and all its versions out of the store");
  remove.add_option("ID", options->id, "id of the pack")->required();
  on_store(remove, options, exit_code, run_remove);
}

}  // namespace lackwerk::tools
