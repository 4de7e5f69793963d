// The dealer's PIN, kept as a salted hash.
//
// Why it exists: kiosk.toml can be read by whoever services the box; the PIN itself must not stand in it. The hash is
// libsodium's crypto_pwhash_str (argon2id), a text that carries its own salt and cost. Functions over values; any
// thread. Each call takes hash_memory_bytes and a good part of a second on a small board.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "kiosk/display/pin_pad.hpp"

namespace lackwerk::kiosk {

inline constexpr std::size_t least_pin_digits = 4;  // at most most_pin_digits: pin_pad.hpp

/// Cost of a hash: argon2id's m and t. RFC 9106 says how they trade; libsodium's "interactive" (64 MiB, 2 passes) is
/// too much memory for a box whose textures fill it, so 8 MiB are passed over 4 times: the same work as 32 MiB once,
/// 15 ms on a PC core and below a second on a Cortex-A7. A PIN has at most 40 bits anyway; what protects it is
/// that the screen takes few attempts and that the file is not public.
inline constexpr std::size_t hash_memory_bytes = std::size_t{8} << 20;
inline constexpr unsigned long long hash_passes = 4;

/// The text for `pin` in kiosk.toml; another one at each call, for the salt is random. Error: not 4 to 12 digits 0-9,
/// no memory, no libsodium.
[[nodiscard]] Result<std::string> hash_pin(std::string_view pin);

/// Whether `hash` is a text that hash_pin could have made: argon2id, complete, and of at most 16 MiB and 8 passes, so
/// that a mistyped cost cannot stop the kiosk.
[[nodiscard]] bool is_pin_hash(std::string_view hash);

/// Whether the PIN is the one of the hash. Takes the same time whatever digits are wrong. False for anything that is
/// no PIN or no hash, and if there is no memory.
[[nodiscard]] bool check_pin(const std::string& hash, std::string_view pin);

/// `--hash-pin`: one line with a PIN in, the line for kiosk.toml out. A line end behind the digits is taken off.
[[nodiscard]] Result<std::string> pin_line(std::string_view typed);

}  // namespace lackwerk::kiosk
