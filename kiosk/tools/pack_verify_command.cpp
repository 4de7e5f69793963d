#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/paint_pack.hpp"
#include "packs/scene_pack.hpp"
#include "packs/signed_pack.hpp"
#include "packs/small_file.hpp"

namespace lackwerk::tools {
namespace {

struct VerifyOptions {
  std::string pack, key, keyring;
  bool json = false;
};

struct Verified {
  const char* kind = "paint pack";
  std::optional<packs::SignedAs> signed_as;
};

/// A .pub file, or the line that is in one.
Result<packs::PublicKey> read_key(const std::string& name) {
  std::error_code code;
  if (!std::filesystem::exists(name, code)) return packs::parse_public_key(name, "--key");
  const auto text = packs::read_small_file(name, packs::max_minisig_bytes);
  if (!text) return tl::unexpected(text.error());
  return packs::parse_public_key(*text, name);
}

Result<packs::Keyring> open_ring(const VerifyOptions& options) {
  if (options.key.empty()) return packs::Keyring::open(options.keyring);
  const auto key = read_key(options.key);
  if (!key) return tl::unexpected(key.error());
  return packs::Keyring({*key}, {});
}

/// Whichever of the three kinds the file is; the paint pack's error where it is none.
Result<Verified> verify_content(const std::string& path) {
  const auto kind = packs::sealed_kind_of(std::filesystem::path(path));
  if (kind == packs::SealedKind::scan) {
    if (const auto scans = packs::ScanPack::open(path, packs::Backing::copy); !scans)
      return tl::unexpected(scans.error());
    return Verified{"scan pack", std::nullopt};
  }
  const auto paint = packs::PaintPack::open(path, packs::Backing::copy);
  if (paint) return Verified{};
  if (paint.error().field != "kind") return tl::unexpected(paint.error());
  if (const auto scene = packs::read_scene_pack(path, packs::Backing::copy); !scene)
    return tl::unexpected(scene.error());
  return Verified{"scene pack", std::nullopt};
}

Result<Verified> verify(const VerifyOptions& options) {
  if (options.key.empty() && options.keyring.empty()) return verify_content(options.pack);
  const auto ring = open_ring(options);
  if (!ring) return tl::unexpected(ring.error());
  const auto pack = packs::open_signed_pack(options.pack, *ring, false);
  if (!pack) return tl::unexpected(pack.error());
  return Verified{pack->pack.kind_name(), pack->signed_as};
}

int run_verify(const VerifyOptions& options) {
  const auto verified = verify(options);
  if (!verified) return report(verified.error());
  const auto& as = verified->signed_as;
  if (options.json) {
    nlohmann::ordered_json out{
        {"file", options.pack}, {"kind", verified->kind}, {"ok", true}, {"signed", as.has_value()}};
    if (as) out.update({{"id", as->id}, {"serial", as->serial}, {"key", packs::key_id_text(as->key)}});
    print(out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print(options.pack + ": " + verified->kind + ", whole and sound" +
          (as ? ", signed as " + as->id + " " + std::to_string(as->serial) + " with key " + packs::key_id_text(as->key)
              : "; its signature was not asked for"));
  }
  return exit_done;
}

}  // namespace

void add_pack_verify_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      command_group(app, "pack", "Paint packs").add_subcommand("verify", "Check a paint, scan or scene pack");
  command->add_option("PACK", options->pack, "file to check; its signature is PACK.minisig")->required();
  auto* key = command->add_option("--key", options->key, "minisign public key (file or text) that must have signed it");
  command->add_option("--keyring", options->keyring, "folder of such keys, any of which will do")->excludes(key);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_verify(*options); });
}

}  // namespace lackwerk::tools
