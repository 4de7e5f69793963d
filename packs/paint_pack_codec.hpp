// Between PackContents and the FlatBuffers bytes of a paint pack.
//
// Why it exists: paint_pack.cpp guards, this file translates; tests use it to make packs no honest writer would make.
// Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "packs/paint_pack.hpp"

namespace lackwerk::packs {

/// The payload of a pack with these contents, unchecked. Deterministic.
[[nodiscard]] std::vector<std::uint8_t> encode_paint_pack(const PackContents& contents);

/// Checks the FlatBuffers structure and every count that decides how much memory is taken, then translates. Spans of
/// the result point into `payload`, which must be aligned to 8 bytes. Values are not judged here: see check_contents.
[[nodiscard]] Result<PackContents> decode_paint_pack(std::span<const std::uint8_t> payload, const std::string& file);

}  // namespace lackwerk::packs
