// Signatures in minisign's own format, prehashed: the way the ecosystem already signs files.
//
// Why it exists: a dealer's pack must come from whom it says, and anybody must be able to check that with Debian's
// minisign as well. Legacy signatures (over the file itself, "Ed") are refused: a long file would have to be held in
// memory to check them. Pure functions over bytes (libsodium does the cryptography); any thread. Format: minisign's
// manual, section "Signature format" and "Public key format"; docs/pack-format.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace lackwerk::packs {

/// Longer files are no keys and no signatures.
inline constexpr std::size_t max_minisig_bytes = 4096;
inline constexpr std::size_t max_trusted_comment = 1024;

/// Eight bytes that name a key pair; chance, no secret.
using KeyId = std::array<std::uint8_t, 8>;
/// A shorter one is a slip of the hand: chance gives an id so many leading zeros once in 2^32 keys.
inline constexpr std::size_t min_key_id_digits = 8;
/// As minisign prints it: up to 16 hexadecimal digits without leading zeros, upper case, the last byte first.
[[nodiscard]] std::string key_id_text(const KeyId& id);
/// With leading zeros or without. Error (`file`, `field`): not min_key_id_digits to 16 hexadecimal digits.
[[nodiscard]] Result<KeyId> parse_key_id(std::string_view text, const std::string& file, const std::string& field);

struct PublicKey {
  KeyId id{};
  std::array<std::uint8_t, 32> key{};
  bool operator==(const PublicKey&) const = default;
};

struct Signature {
  KeyId id{};
  std::array<std::uint8_t, 64> over_hash{};     ///< Ed25519 over the BLAKE2b-512 of the file
  std::string trusted_comment;                  ///< without line end; no control characters but tabs
  std::array<std::uint8_t, 64> over_comment{};  ///< Ed25519 over over_hash and trusted_comment
};

/// Hashes a file piece by piece, as it is read anyway.
class FileHash {
 public:
  FileHash();
  void add(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::array<std::uint8_t, 64> finish();

 private:
  alignas(64) std::array<unsigned char, 384> state_{};  ///< libsodium's crypto_generichash_state
};

/// A key file's text, or its second line alone (as `minisign -P` takes it). `file` is for errors.
[[nodiscard]] Result<PublicKey> parse_public_key(std::string_view text, const std::string& file);
/// A .minisig file's text. Errors name line and remedy.
[[nodiscard]] Result<Signature> parse_signature(std::string_view text, const std::string& file);
/// The file minisign would have written.
[[nodiscard]] std::string signature_text(const Signature& signature);

/// Both signatures: over the hash, and over the comment. Error: another key, or either does not verify.
[[nodiscard]] Result<void> check_signature(const Signature& signature, const PublicKey& key,
                                           std::span<const std::uint8_t, 64> hash, const std::string& file);

/// An unlocked secret key; wiped when it goes.
class SecretKey {
 public:
  /// A key file of `minisign -G`, with (scrypt) or without (-W) a password. Takes as long as the key's scrypt limits
  /// say (minisign's default: seconds and a gigabyte). Errors: not a key, more memory wanted than 2 GiB, wrong
  /// password.
  [[nodiscard]] static Result<SecretKey> parse(std::string_view text, std::string_view password,
                                               const std::string& file);
  /// Whether parse() needs the password. False for what is no key at all.
  [[nodiscard]] static bool is_locked(std::string_view text);

  SecretKey(const SecretKey&) = delete;
  SecretKey& operator=(const SecretKey&) = delete;
  SecretKey(SecretKey&& other) noexcept;
  SecretKey& operator=(SecretKey&&) = delete;
  ~SecretKey();

  [[nodiscard]] const KeyId& id() const { return id_; }
  [[nodiscard]] PublicKey public_key() const;
  /// `trusted_comment`: as in Signature.
  [[nodiscard]] Signature sign(std::span<const std::uint8_t, 64> hash, const std::string& trusted_comment) const;

 private:
  SecretKey() = default;
  KeyId id_{};
  std::array<std::uint8_t, 64> key_{};
};

}  // namespace lackwerk::packs
