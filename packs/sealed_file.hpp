// The container of every pack file: a 64-byte header and a payload that is checked before anyone looks inside.
//
// Why it exists: paint, scene and scan packs share one way of being written (whole or not at all) and one way of being
// refused (any flipped bit, any missing or added byte). A SealedFile owns its mapping or its copy of the bytes and
// frees it; move-only. Reading is const: any number of threads. docs/pack-format.md lists the header byte by byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// Which root table the payload holds; stored as four characters, the same as the FlatBuffers file identifier.
enum class SealedKind { paint, scene, scan };

/// How an opened file stays in memory.
enum class Backing {
  map,   ///< mapped read-only: for files in the store, which nobody truncates (a pulled stick would be a SIGBUS)
  copy,  ///< read into memory: for files anywhere else
};

inline constexpr std::size_t sealed_header_bytes = 64;
inline constexpr std::uint32_t sealed_format_version = 1;
inline constexpr std::uint64_t max_paint_pack_bytes = 64ull << 20;
inline constexpr std::uint64_t max_scene_pack_bytes = 256ull << 20;
inline constexpr std::uint64_t max_scan_pack_bytes = max_paint_pack_bytes;
/// What store and kiosk take: a pack of paints or of scans.
inline constexpr std::uint64_t max_exhibit_bytes = max_paint_pack_bytes;

/// Largest whole file of a kind, header included.
[[nodiscard]] constexpr std::uint64_t max_file_bytes(SealedKind kind) {
  return kind == SealedKind::paint   ? max_paint_pack_bytes
         : kind == SealedKind::scene ? max_scene_pack_bytes
                                     : max_scan_pack_bytes;
}

/// BLAKE2b-256 as stored in the header.
using Digest = std::array<std::uint8_t, 32>;
[[nodiscard]] Digest digest_of(std::span<const std::uint8_t> bytes);

/// What the first bytes of a file say it is; nothing where it is no pack, or cannot be read. No promise that it opens.
[[nodiscard]] std::optional<SealedKind> sealed_kind_of(const std::filesystem::path& path);
/// The same of bytes that were read.
[[nodiscard]] std::optional<SealedKind> sealed_kind_of(std::span<const std::uint8_t> bytes);

class SealedFile {
 public:
  /// Opens and checks size limits, magic, version, kind, exact length, reserved bytes and the digest, in that order.
  /// Errors name the file and the header field. The payload's first byte is aligned to 16 bytes or better.
  [[nodiscard]] static Result<SealedFile> open(const std::filesystem::path& path, SealedKind kind, Backing backing);

  /// The same checks on bytes that were read elsewhere. `file` is for the errors.
  [[nodiscard]] static Result<SealedFile> from_bytes(std::vector<std::uint8_t> bytes, SealedKind kind,
                                                     const std::string& file);

  SealedFile(SealedFile&& other) noexcept;
  SealedFile& operator=(SealedFile&& other) noexcept;
  SealedFile(const SealedFile&) = delete;
  SealedFile& operator=(const SealedFile&) = delete;
  ~SealedFile();

  /// Everything after the header; valid, at the same address, for the life of this object (moves included).
  [[nodiscard]] std::span<const std::uint8_t> payload() const { return bytes_.subspan(sealed_header_bytes); }
  [[nodiscard]] std::uint64_t file_bytes() const { return bytes_.size(); }

 private:
  SealedFile() = default;
  [[nodiscard]] Result<void> load(int descriptor, std::size_t size, Backing backing, const std::string& file);

  std::span<const std::uint8_t> bytes_;  ///< the whole file, in `mapping_` or in `copy_`
  void* mapping_ = nullptr;
  std::vector<std::uint8_t> copy_;
};

/// Writes header and payload to a temporary file beside `path`, syncs it, renames it over `path` and syncs the folder:
/// after a crash there is the old file or the new one. The payload must not be empty nor past the kind's limit.
[[nodiscard]] Result<void> write_sealed_file(const std::filesystem::path& path, SealedKind kind,
                                             std::span<const std::uint8_t> payload);

}  // namespace lackwerk::packs
