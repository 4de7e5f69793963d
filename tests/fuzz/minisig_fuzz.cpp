// Fuzz target: any text as a signature, as a key, as a key id, and as what a signature says.
//
// Input: a byte that says which, then the text. A comment is signed here with a key of the ring, so that what comes
// after the two checks is reached. Whatever comes: no sanitizer finding, every refusal with its remedy, what is taken
// is written as the same again, and nothing verifies that the ring's key did not sign.
#include <sodium.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "packs/keyring.hpp"
#include "packs/minisign.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

std::string base64(std::span<const std::uint8_t> bytes) {
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the zero
  return text;
}

/// A key file without a password, the same in every run.
packs::SecretKey make_key() {
  require(sodium_init() >= 0);
  const std::array<std::uint8_t, 32> seed{1, 2, 3};
  std::array<std::uint8_t, 32> open{};
  std::array<std::uint8_t, 64> secret{};
  crypto_sign_seed_keypair(open.data(), secret.data(), seed.data());
  std::vector<std::uint8_t> bytes{'E', 'd', 0, 0, 'B', '2'};
  bytes.resize(54);
  bytes.insert(bytes.end(), {8, 7, 6, 5, 4, 3, 2, 1});
  bytes.insert(bytes.end(), secret.begin(), secret.end());
  bytes.resize(bytes.size() + 32);
  auto key = packs::SecretKey::parse(base64(bytes), "", "fuzz.key");
  require(key.has_value());
  return std::move(*key);
}

struct Maker {
  Maker() {
    packs::FileHash of;
    hash = of.finish();
  }
  packs::SecretKey key = make_key();
  packs::Keyring ring{{key.public_key()}, {}};
  std::array<std::uint8_t, 64> hash{};  ///< of the empty file
};

template <class T>
bool is_told(const Result<T>& result) {
  return result || (result.error().file == "fuzz" && !result.error().what.empty() && !result.error().remedy.empty());
}

bool same(const packs::Signature& a, const packs::Signature& b) {
  return a.id == b.id && a.over_hash == b.over_hash && a.trusted_comment == b.trusted_comment &&
         a.over_comment == b.over_comment;
}

void signature(const Maker& maker, std::string_view text) {
  const auto parsed = packs::parse_signature(text, "fuzz");
  require(is_told(parsed));
  const auto checked = maker.ring.check(text, maker.hash, "fuzz");
  require(is_told(checked));
  if (!parsed) {
    require(!checked);
    return;
  }
  require(parsed->trusted_comment.size() <= packs::max_trusted_comment);
  const auto again = packs::parse_signature(packs::signature_text(*parsed), "fuzz");
  require(again.has_value() && same(*again, *parsed));
  if (checked) require(parsed->id == maker.key.id());
}

void comment(const Maker& maker, std::string_view text) {
  const packs::Signature made = maker.key.sign(maker.hash, std::string(text));
  const auto checked = maker.ring.check(packs::signature_text(made), maker.hash, "fuzz");
  require(is_told(checked));
  if (checked) require(text == packs::trusted_comment(checked->id, checked->serial));
}

void keys(std::string_view text) {
  const auto key = packs::parse_public_key(text, "fuzz");
  require(is_told(key));
  // A locked one may ask for a gigabyte and seconds; the layout is the same without.
  if (!packs::SecretKey::is_locked(text)) require(is_told(packs::SecretKey::parse(text, "", "fuzz")));
  const auto id = packs::parse_key_id(text, "fuzz", "line 1");
  require(is_told(id));
  if (id) require(packs::parse_key_id(packs::key_id_text(*id), "fuzz", "line 1").value() == *id);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Maker maker;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      signature(maker, text);
      break;
    case 1:
      keys(text);
      break;
    default:
      comment(maker, text);
  }
  return 0;
}
