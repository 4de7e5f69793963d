// Whose packs are shown: a folder of public keys, and a list of those that are not trusted any more.
//
// Why it exists: a dealer may have several makers, and a key that was lost must stop counting at once. Read anew for
// every decision, so that a key that is taken away counts from the next pack on. Values; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/minisign.hpp"

namespace lackwerk::packs {

inline constexpr std::size_t max_keys = 64;
inline constexpr std::size_t max_revoked = 1024;
/// In the keyring's folder: a key id a line, # begins a comment.
inline constexpr const char* revoked_file = "revoked";

/// What a pack's trusted comment says, exactly `id=<id> serial=<n>`.
struct SignedAs {
  std::string id;
  std::uint64_t serial = 0;
  KeyId key{};
  bool operator==(const SignedAs&) const = default;
};
/// Error: signed as another pack than it is.
[[nodiscard]] Result<void> check_signed_as(const SignedAs& as, const std::string& id, std::uint64_t serial,
                                           const std::string& file);
[[nodiscard]] std::string trusted_comment(const std::string& id, std::uint64_t serial);

class Keyring {
 public:
  Keyring() = default;
  Keyring(std::vector<PublicKey> keys, std::vector<KeyId> revoked)
      : keys_(std::move(keys)), revoked_(std::move(revoked)) {}
  /// Every *.pub file of a folder, and `revoked` if it is there. Errors: the folder cannot be read, a file in it is no
  /// key (a keyring with a riddle in it is no keyring), too many.
  [[nodiscard]] static Result<Keyring> open(const std::filesystem::path& folder);

  /// Verifies before anything of the file is believed. `hash`: FileHash of the very bytes that will be used. Errors:
  /// not signed by a key of this ring, revoked, not this file, or a comment of another form.
  [[nodiscard]] Result<SignedAs> check(std::string_view signature, std::span<const std::uint8_t, 64> hash,
                                       const std::string& file) const;

  [[nodiscard]] const std::vector<PublicKey>& keys() const { return keys_; }
  [[nodiscard]] const std::vector<KeyId>& revoked() const { return revoked_; }

 private:
  std::vector<PublicKey> keys_;
  std::vector<KeyId> revoked_;
};

}  // namespace lackwerk::packs
