#include "packs/minisign.hpp"

#include <sodium.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace lackwerk::packs {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view legacy{"Ed", 2}, prehashed{"ED", 2};
constexpr std::string_view untrusted_prefix = "untrusted comment:";
constexpr std::string_view trusted_prefix = "trusted comment: ";
/// Two bytes of algorithm, eight of key id, then the key or the signature.
constexpr std::size_t head_bytes = 2 + 8;
constexpr std::size_t public_bytes = head_bytes + 32, signature_bytes = head_bytes + 64;
/// Algorithm, key derivation, checksum kind (2 each); salt 32; limits 8 each; then id 8, key 64, checksum 32 under the
/// password.
constexpr std::size_t at_salt = 6, at_ops = 38, at_memory = 46, at_locked = 54;
constexpr std::size_t locked_bytes = 8 + 64 + 32, secret_bytes = at_locked + locked_bytes;
/// minisign's own default is 1 GiB; a file that wants more is not from there.
constexpr std::uint64_t most_scrypt_bytes = 2ull << 30;

/// The next line, without its end; a carriage return at its end goes too, for files that came through Windows.
std::optional<std::string_view> next_line(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string out(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(out.data(), out.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  out.resize(std::strlen(out.c_str()));
  return out;
}

std::optional<Bytes> from_base64(std::string_view text, std::size_t size) {
  Bytes out(size);
  std::size_t written = 0;
  const char* end = nullptr;
  if (sodium_base642bin(out.data(), out.size(), text.data(), text.size(), nullptr, &written, &end,
                        sodium_base64_VARIANT_ORIGINAL) != 0 ||
      written != size || end != text.data() + text.size())
    return std::nullopt;
  // Only one text for the same bytes: libsodium 1.0.18 ignores some bytes above 127.
  if (to_base64(out) != text) return std::nullopt;
  return out;
}

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view head) {
  return bytes.size() >= head.size() && std::memcmp(bytes.data(), head.data(), head.size()) == 0;
}

bool is_comment_text(std::string_view text) {
  return text.size() <= max_trusted_comment && std::all_of(text.begin(), text.end(), [](char c) {
           const auto u = static_cast<unsigned char>(c);
           return c == '\t' || (u >= 0x20 && u != 0x7f);
         });
}

/// What the comment's signature covers.
Bytes with_comment(const Signature& signature) {
  Bytes message(signature.over_hash.begin(), signature.over_hash.end());
  message.insert(message.end(), signature.trusted_comment.begin(), signature.trusted_comment.end());
  return message;
}

std::uint64_t read_le64(const std::uint8_t* at) {
  std::uint64_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// The second line of a key file that may be all there is.
std::string_view key_line(std::string_view text) {
  const auto first = next_line(text);
  if (!first) return {};
  if (first->substr(0, untrusted_prefix.size()) != untrusted_prefix) return *first;
  return next_line(text).value_or(std::string_view{});
}

/// Bytes that are wiped when they go.
struct Wiped {
  explicit Wiped(std::size_t size) : bytes(size) {}
  Wiped(const Wiped&) = delete;
  Wiped& operator=(const Wiped&) = delete;
  ~Wiped() { sodium_memzero(bytes.data(), bytes.size()); }
  Bytes bytes;
};

/// Over algorithm, id and key: says whether the password was right.
std::array<std::uint8_t, 32> key_checksum(std::span<const std::uint8_t> id_and_key) {
  std::array<std::uint8_t, 32> out{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, out.size());
  crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(legacy.data()), legacy.size());
  crypto_generichash_update(&state, id_and_key.data(), id_and_key.size());
  crypto_generichash_final(&state, out.data(), out.size());
  return out;
}

}  // namespace

std::string key_id_text(const KeyId& id) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string out;
  for (std::size_t k = id.size(); k-- > 0;) {
    out += digits[id[k] >> 4u];
    out += digits[id[k] & 15u];
  }
  // minisign prints the number without leading zeros, so one id in sixteen is shorter there.
  const std::size_t zeros = std::min(out.find_first_not_of('0'), out.size() - min_key_id_digits);
  return out.substr(zeros);
}

Result<KeyId> parse_key_id(std::string_view text, const std::string& file, const std::string& field) {
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() < min_key_id_digits || text.size() > 2 * sizeof(KeyId) || code != std::errc{} ||
      end != text.data() + text.size())
    return fail(file, field, "'" + std::string(text.substr(0, 40)) + "' is no key id",
                "write the (up to 16) hexadecimal digits that minisign prints");
  KeyId id{};
  std::memcpy(id.data(), &value, id.size());
  return id;
}

FileHash::FileHash() {
  static_assert(sizeof(crypto_generichash_state) <= sizeof state_ && alignof(crypto_generichash_state) <= 64);
  [[maybe_unused]] const int ready = sodium_init();
  crypto_generichash_init(reinterpret_cast<crypto_generichash_state*>(state_.data()), nullptr, 0, 64);
}

void FileHash::add(std::span<const std::uint8_t> bytes) {
  crypto_generichash_update(reinterpret_cast<crypto_generichash_state*>(state_.data()), bytes.data(), bytes.size());
}

std::array<std::uint8_t, 64> FileHash::finish() {
  std::array<std::uint8_t, 64> out{};
  crypto_generichash_final(reinterpret_cast<crypto_generichash_state*>(state_.data()), out.data(), out.size());
  return out;
}

Result<PublicKey> parse_public_key(std::string_view text, const std::string& file) {
  const auto bytes = text.size() <= max_minisig_bytes ? from_base64(key_line(text), public_bytes) : std::nullopt;
  if (!bytes || !starts_with(*bytes, legacy))
    return fail(file, "", "no minisign public key", "name a .pub file of 'minisign -G', or its second line");
  PublicKey key;
  std::copy_n(bytes->begin() + 2, key.id.size(), key.id.begin());
  std::copy_n(bytes->begin() + head_bytes, key.key.size(), key.key.begin());
  return key;
}

Result<Signature> parse_signature(std::string_view text, const std::string& file) {
  const std::string remedy = "sign the file again with 'lackwerk pack sign' or 'minisign -S'";
  if (text.size() > max_minisig_bytes) return fail(file, "", "too long for a signature", remedy);
  const auto untrusted = next_line(text);
  if (!untrusted || untrusted->substr(0, untrusted_prefix.size()) != untrusted_prefix)
    return fail(file, "line 1", "does not begin with '" + std::string(untrusted_prefix) + "'", remedy);
  const auto first = from_base64(next_line(text).value_or(std::string_view{}), signature_bytes);
  if (!first) return fail(file, "line 2", "is no signature", remedy);
  if (starts_with(*first, legacy))
    return fail(file, "line 2", "a legacy signature, which is over the file itself and not over its hash",
                "sign it again; minisign 0.9 and later do it right unless -l is given");
  if (!starts_with(*first, prehashed)) return fail(file, "line 2", "of an unknown kind", remedy);
  const auto comment = next_line(text);
  if (!comment || comment->substr(0, trusted_prefix.size()) != trusted_prefix)
    return fail(file, "line 3", "does not begin with '" + std::string(trusted_prefix) + "'", remedy);
  Signature signature;
  signature.trusted_comment = comment->substr(trusted_prefix.size());
  if (!is_comment_text(signature.trusted_comment))
    return fail(file, "line 3", "longer than " + std::to_string(max_trusted_comment) + " bytes, or not plain text",
                remedy);
  const auto second = from_base64(next_line(text).value_or(std::string_view{}), signature.over_comment.size());
  if (!second) return fail(file, "line 4", "is no signature", remedy);
  if (!text.empty()) return fail(file, "line 5", "more than a signature", remedy);
  std::copy_n(first->begin() + 2, signature.id.size(), signature.id.begin());
  std::copy_n(first->begin() + head_bytes, signature.over_hash.size(), signature.over_hash.begin());
  std::copy_n(second->begin(), signature.over_comment.size(), signature.over_comment.begin());
  return signature;
}

std::string signature_text(const Signature& signature) {
  Bytes first(prehashed.begin(), prehashed.end());
  first.insert(first.end(), signature.id.begin(), signature.id.end());
  first.insert(first.end(), signature.over_hash.begin(), signature.over_hash.end());
  std::string out(untrusted_prefix);
  out += " signature from lackwerk, key " + key_id_text(signature.id) + "\n" + to_base64(first) + "\n";
  out += trusted_prefix;
  return out + signature.trusted_comment + "\n" + to_base64(signature.over_comment) + "\n";
}

Result<void> check_signature(const Signature& signature, const PublicKey& key, std::span<const std::uint8_t, 64> hash,
                             const std::string& file) {
  if (signature.id != key.id)
    return fail(file, "", "signed with key " + key_id_text(signature.id) + ", not with " + key_id_text(key.id),
                "use the key of whoever made it");
  if (crypto_sign_verify_detached(signature.over_hash.data(), hash.data(), hash.size(), key.key.data()) != 0)
    return fail(file, "line 2", "the signature is not of this file", "copy the file and its signature again");
  const Bytes message = with_comment(signature);
  if (crypto_sign_verify_detached(signature.over_comment.data(), message.data(), message.size(), key.key.data()) != 0)
    return fail(file, "line 3", "the trusted comment was changed", "copy the signature again");
  return {};
}

bool SecretKey::is_locked(std::string_view text) {
  const auto bytes = text.size() <= max_minisig_bytes ? from_base64(key_line(text), secret_bytes) : std::nullopt;
  return bytes && (*bytes)[2] == 'S';
}

Result<SecretKey> SecretKey::parse(std::string_view text, std::string_view password, const std::string& file) {
  auto decoded = text.size() <= max_minisig_bytes ? from_base64(key_line(text), secret_bytes) : std::nullopt;
  if (!decoded || !starts_with(*decoded, legacy))
    return fail(file, "", "no minisign secret key", "name a .key file of 'minisign -G'");
  Wiped wiped(0);
  wiped.bytes.swap(*decoded);
  Bytes& bytes = wiped.bytes;
  const std::string_view derivation(reinterpret_cast<const char*>(bytes.data()) + 2, 2);
  std::uint8_t* locked = bytes.data() + at_locked;
  if (derivation == "Sc") {
    const std::uint64_t memory = read_le64(bytes.data() + at_memory);
    if (memory > most_scrypt_bytes)
      return fail(file, "",
                  "wants " + std::to_string(memory >> 20u) + " MiB to be unlocked, more than the 2048 allowed",
                  "make a key with minisign's own limits");
    Wiped stream(locked_bytes);
    if (crypto_pwhash_scryptsalsa208sha256(stream.bytes.data(), stream.bytes.size(), password.data(), password.size(),
                                           bytes.data() + at_salt, read_le64(bytes.data() + at_ops),
                                           static_cast<std::size_t>(memory)) != 0)
      return fail(file, "", "not enough memory to unlock it (" + std::to_string(memory >> 20u) + " MiB)",
                  "free some memory, or use a key without a password (minisign -G -W)");
    for (std::size_t k = 0; k < locked_bytes; ++k) locked[k] ^= stream.bytes[k];
  } else if (derivation != std::string_view("\0\0", 2)) {
    return fail(file, "", "locked in an unknown way", "name a .key file of 'minisign -G'");
  }
  // minisign leaves the checksum of a key without a password empty; there the two halves of the key must fit.
  const bool is_locked = derivation == "Sc";
  Wiped again(64);
  std::array<std::uint8_t, 32> public_half{};
  crypto_sign_seed_keypair(public_half.data(), again.bytes.data(), locked + 8);
  const auto checksum = key_checksum({locked, 8 + 64});
  if (sodium_memcmp(again.bytes.data(), locked + 8, 64) != 0 ||
      (is_locked && sodium_memcmp(checksum.data(), locked + 8 + 64, checksum.size()) != 0))
    return fail(file, "", is_locked ? "the password is wrong" : "the key is damaged",
                is_locked ? "try again" : "use the copy you kept");
  SecretKey key;
  std::copy_n(locked, key.id_.size(), key.id_.begin());
  std::copy_n(locked + 8, key.key_.size(), key.key_.begin());
  return key;
}

SecretKey::SecretKey(SecretKey&& other) noexcept : id_(other.id_), key_(other.key_) {
  sodium_memzero(other.key_.data(), other.key_.size());
}

SecretKey::~SecretKey() { sodium_memzero(key_.data(), key_.size()); }

PublicKey SecretKey::public_key() const {
  PublicKey key;
  key.id = id_;
  // libsodium keeps the public half behind the seed.
  std::copy_n(key_.begin() + 32, key.key.size(), key.key.begin());
  return key;
}

Signature SecretKey::sign(std::span<const std::uint8_t, 64> hash, const std::string& trusted_comment) const {
  Signature signature;
  signature.id = id_;
  signature.trusted_comment = trusted_comment;
  crypto_sign_detached(signature.over_hash.data(), nullptr, hash.data(), hash.size(), key_.data());
  const Bytes message = with_comment(signature);
  crypto_sign_detached(signature.over_comment.data(), nullptr, message.data(), message.size(), key_.data());
  return signature;
}

}  // namespace lackwerk::packs
