// Scan packs: points on straight paths between the scans of a series, opened, checked and used where they lie.
//
// Why it exists: the second exhibit (Golla 2021, chapter 4) comes to the kiosk by the same way as paints: one sealed,
// signed file. A ScanPack owns the mapping or copy its spans point into; move-only. Read-only after open(): any number
// of threads. Format: docs/pack-format.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/sealed_file.hpp"

namespace lackwerk::packs {

inline constexpr std::uint32_t scan_schema_version = 1;
inline constexpr std::size_t max_scans = 256;
inline constexpr std::size_t max_step_paths = 4'000'000;
inline constexpr std::size_t max_scan_text_bytes = 200;

/// One point's way through one step; memory as in the file, ready to be a vertex.
struct ScanPath {
  std::array<std::uint16_t, 4> from{}, to{};  ///< x, y, z along the pack's cube / 65535; size: 65535 is one spacing
  std::array<std::int8_t, 4> from_normal{}, to_normal{};  ///< unit vector * 127; sky seen, [0, 127]
  bool operator==(const ScanPath&) const = default;
};
static_assert(sizeof(ScanPath) == 24);

struct ScanStep {
  /// In no order of place: any first part of them is an even sample of the whole.
  std::span<const ScanPath> paths;
  std::uint32_t matched = 0, grown = 0, decayed = 0;  ///< segments, for information
};

/// One scan of the series.
struct ScanState {
  std::string name;
  double time = 0.0;
  std::uint32_t points = 0;
  bool operator==(const ScanState&) const = default;
};

struct ScanInfo {
  std::string id;                 ///< as PackInfo::id
  std::uint64_t serial = 0;       ///< as PackInfo::serial
  std::string name;               ///< shown
  std::string time_unit;          ///< shown behind a time: "days"; may be empty
  std::string tool_version;       ///< set by the writer
  glm::dvec3 low{0.0};            ///< lowest corner of the cube that all places lie in, units of the scans
  double edge = 1.0;              ///< of that cube, > 0
  double spacing = 0.0;           ///< between neighbouring points, [0, edge]
  int up = 2;                     ///< the vertical axis
  std::vector<ScanState> states;  ///< 2 to max_scans, times ascending
  bool operator==(const ScanInfo&) const = default;
};

struct ScanContents {
  ScanInfo info;
  std::vector<ScanStep> steps;  ///< one less than states
};

class ScanPack {
 public:
  /// Opens and checks: size, header and digest, FlatBuffers structure, then meaning. Errors name file and field. Use
  /// Backing::copy for files outside the store.
  [[nodiscard]] static Result<ScanPack> open(const std::filesystem::path& path, Backing backing = Backing::map);
  /// The same checks on the bytes of a whole file that was read, and verified, elsewhere.
  [[nodiscard]] static Result<ScanPack> from_bytes(std::vector<std::uint8_t> bytes, const std::string& file);

  [[nodiscard]] const ScanInfo& info() const { return contents_.info; }
  /// Valid for the life of this object; the spans stay where they are when it is moved.
  [[nodiscard]] const std::vector<ScanStep>& steps() const { return contents_.steps; }
  [[nodiscard]] std::uint64_t file_bytes() const { return file_.file_bytes(); }

 private:
  [[nodiscard]] static Result<ScanPack> from_file(Result<SealedFile> file, const std::string& name);
  ScanPack(SealedFile file, ScanContents contents) : file_(std::move(file)), contents_(std::move(contents)) {}
  SealedFile file_;
  ScanContents contents_;
};

/// What must hold before anyone draws it; reader and writer both ask. Names the first violation's field.
[[nodiscard]] Result<void> check_scan(const ScanContents& contents, const std::string& file);

/// Writes (and replaces) a pack. Contents that open() would refuse are refused here. The same contents give the same
/// bytes.
[[nodiscard]] Result<void> write_scan_pack(const std::filesystem::path& path, const ScanContents& contents);

/// The payload, unchecked: for the writer, and for tests of the reader.
[[nodiscard]] std::vector<std::uint8_t> encode_scan_pack(const ScanContents& contents);

}  // namespace lackwerk::packs
