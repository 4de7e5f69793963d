// Puts a pack's header in front of a payload, in memory.
//
// Why it exists: no fuzzer guesses a BLAKE2b-256; with it in place the checks behind it are reached. Pure.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "packs/sealed_file.hpp"

namespace lackwerk::fuzz {

/// As write_sealed_file writes it. docs/pack-format.md has the header byte by byte.
inline std::vector<std::uint8_t> sealed(packs::SealedKind kind, std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> file(packs::sealed_header_bytes);
  const std::uint64_t bytes = payload.size();
  const packs::Digest digest = packs::digest_of(payload);
  std::memcpy(file.data(), "LACKWERK", 8);
  file[8] = packs::sealed_format_version;
  const char* word = kind == packs::SealedKind::paint ? "LWPP" : kind == packs::SealedKind::scene ? "LWSC" : "LWSN";
  std::memcpy(file.data() + 12, word, 4);
  std::memcpy(file.data() + 16, &bytes, sizeof bytes);
  std::memcpy(file.data() + 32, digest.data(), digest.size());
  file.insert(file.end(), payload.begin(), payload.end());
  return file;
}

}  // namespace lackwerk::fuzz
