#include "kiosk/display/pin.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace lackwerk::kiosk {
namespace {

// Bounds of a hash that is taken from a file: twice what hash_pin asks for.
constexpr unsigned max_memory_kib = 16 * 1024;
constexpr unsigned max_passes = 8;
constexpr std::size_t salt_bytes = crypto_pwhash_SALTBYTES, tag_bytes = 32;

/// Characters of `bytes` in base64 without padding.
constexpr std::size_t base64_length(std::size_t bytes) { return (bytes * 8 + 5) / 6; }

bool is_pin(std::string_view pin) {
  return pin.size() >= least_pin_digits && pin.size() <= most_pin_digits &&
         std::all_of(pin.begin(), pin.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool take(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

bool take_number(std::string_view& text, unsigned most) {
  unsigned value = 0;
  const auto [at, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || value < 1 || value > most) return false;
  text.remove_prefix(static_cast<std::size_t>(at - text.data()));
  return true;
}

bool take_base64(std::string_view& text, std::size_t length) {
  if (text.size() < length) return false;
  const auto inside = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' || c == '/';
  };
  const std::string_view part = text.substr(0, length);
  if (!std::all_of(part.begin(), part.end(), inside)) return false;
  text.remove_prefix(length);
  return true;
}

}  // namespace

bool is_pin_hash(std::string_view hash) {
  // "$argon2id$v=19$m=8192,t=4,p=1$<salt>$<tag>"
  return hash.size() < crypto_pwhash_STRBYTES && take(hash, "$argon2id$v=19$m=") && take_number(hash, max_memory_kib) &&
         take(hash, ",t=") && take_number(hash, max_passes) && take(hash, ",p=1$") &&
         take_base64(hash, base64_length(salt_bytes)) && take(hash, "$") &&
         take_base64(hash, base64_length(tag_bytes)) && hash.empty();
}

Result<std::string> hash_pin(std::string_view pin) {
  if (!is_pin(pin))
    return fail({}, "PIN", "must be 4 to 12 digits", "type digits 0 to 9 and nothing else", ErrorKind::usage);
  if (sodium_init() < 0) return fail({}, "PIN", "libsodium cannot start", "check the installation");
  std::array<char, crypto_pwhash_STRBYTES> text{};
  if (crypto_pwhash_str_alg(text.data(), pin.data(), pin.size(), hash_passes, hash_memory_bytes,
                            crypto_pwhash_ALG_ARGON2ID13) != 0)
    return fail({}, "PIN", "there is no memory to hash it", "free 8 MiB");
  return std::string(text.data());
}

bool check_pin(const std::string& hash, std::string_view pin) {
  if (!is_pin(pin) || !is_pin_hash(hash) || sodium_init() < 0) return false;
  // crypto_pwhash_str_verify() reads a whole buffer of STRBYTES.
  std::array<char, crypto_pwhash_STRBYTES> text{};
  std::copy(hash.begin(), hash.end(), text.begin());
  return crypto_pwhash_str_verify(text.data(), pin.data(), pin.size()) == 0;
}

Result<std::string> pin_line(std::string_view typed) {
  if (!typed.empty() && typed.back() == '\n') typed.remove_suffix(1);
  if (!typed.empty() && typed.back() == '\r') typed.remove_suffix(1);
  auto hash = hash_pin(typed);
  if (!hash) return hash;
  return "pin = \"" + *hash + "\"\n";
}

}  // namespace lackwerk::kiosk
