#include "packs/keyring.hpp"

#include <algorithm>
#include <charconv>

#include "packs/small_file.hpp"
#include "packs/storage.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::string_view id_key = "id=", serial_key = " serial=";
constexpr std::size_t max_revoked_bytes = 64 * 1024;

Result<SignedAs> parse_comment(const Signature& signature, const std::string& file) {
  const std::string_view text = signature.trusted_comment;
  SignedAs as;
  as.key = signature.id;
  const std::size_t at_serial = text.find(serial_key);
  if (text.substr(0, id_key.size()) == id_key && at_serial != std::string_view::npos) {
    as.id = text.substr(id_key.size(), at_serial - id_key.size());
    const std::string_view number = text.substr(at_serial + serial_key.size());
    const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), as.serial);
    if (code == std::errc{} && end == number.data() + number.size() && text == trusted_comment(as.id, as.serial))
      return as;
  }
  return fail(file, "line 3", "the trusted comment is not 'id=<id> serial=<n>'",
              "sign the pack with 'lackwerk pack sign', or minisign -S -t 'id=... serial=...'");
}

Result<std::vector<KeyId>> read_revoked(const std::filesystem::path& path) {
  std::vector<KeyId> revoked;
  std::error_code code;
  // Only where there certainly is none is nothing revoked: a list that cannot be read is no empty list.
  if (std::filesystem::symlink_status(path, code).type() == std::filesystem::file_type::not_found) return revoked;
  auto text = read_small_file(path, max_revoked_bytes);
  if (!text) return tl::unexpected(text.error());
  std::string_view rest = *text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view word = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    word = word.substr(0, word.find('#'));
    while (!word.empty() && std::string_view(" \t\r").find(word.back()) != std::string_view::npos)
      word.remove_suffix(1);
    while (!word.empty() && std::string_view(" \t").find(word.front()) != std::string_view::npos) word.remove_prefix(1);
    if (word.empty()) continue;
    const auto id = parse_key_id(word, path.string(), "line " + std::to_string(line));
    if (!id) return tl::unexpected(id.error());
    if (revoked.size() == max_revoked)
      return fail(path.string(), "", "more than " + std::to_string(max_revoked) + " keys", "remove old ones");
    revoked.push_back(*id);
  }
  return revoked;
}

}  // namespace

std::string trusted_comment(const std::string& id, std::uint64_t serial) {
  return std::string(id_key) + id + std::string(serial_key) + std::to_string(serial);
}

Result<void> check_signed_as(const SignedAs& as, const std::string& id, std::uint64_t serial, const std::string& file) {
  if (as.id == id && as.serial == serial) return {};
  return fail(
      file, "line 3",
      "is for " + as.id + " " + std::to_string(as.serial) + ", the pack is " + id + " " + std::to_string(serial),
      "sign the pack again");
}

Result<Keyring> Keyring::open(const std::filesystem::path& folder) {
  const auto entries = open_disk(folder)->list("");
  if (!entries) return tl::unexpected(entries.error());
  if (!*entries) return fail(folder.string(), "", "there is no such keyring", "put the makers' .pub files there");
  std::vector<std::filesystem::path> files;
  for (const Storage::Entry& entry : **entries) {
    if (std::filesystem::path(entry.name).extension() != ".pub") continue;
    if (files.size() == max_keys)
      return fail(folder.string(), "", "more than " + std::to_string(max_keys) + " keys", "remove those of no use");
    files.push_back(folder / entry.name);
  }
  Keyring ring;
  for (const std::filesystem::path& file : files) {
    auto text = read_small_file(file, max_minisig_bytes);
    if (!text) return tl::unexpected(text.error());
    auto key = parse_public_key(*text, file.string());
    if (!key) return tl::unexpected(key.error());
    ring.keys_.push_back(*key);
  }
  auto revoked = read_revoked(folder / revoked_file);
  if (!revoked) return tl::unexpected(revoked.error());
  ring.revoked_ = std::move(*revoked);
  return ring;
}

Result<SignedAs> Keyring::check(std::string_view text, std::span<const std::uint8_t, 64> hash,
                                const std::string& file) const {
  const auto signature = parse_signature(text, file);
  if (!signature) return tl::unexpected(signature.error());
  const std::string name = key_id_text(signature->id);
  if (std::find(revoked_.begin(), revoked_.end(), signature->id) != revoked_.end())
    return fail(file, "", "signed with key " + name + ", which is revoked", "ask its maker for one signed anew");
  // Two keys may share an id by chance or malice: any of them will do.
  auto last = fail(file, "", "signed with key " + name + ", which is not in the keyring",
                   "if its maker is to be trusted, put the .pub file into the keyring");
  for (const PublicKey& key : keys_) {
    if (key.id != signature->id) continue;
    const auto checked = check_signature(*signature, key, hash, file);
    if (checked) return parse_comment(*signature, file);
    last = tl::unexpected(checked.error());
  }
  return last;
}

}  // namespace lackwerk::packs
