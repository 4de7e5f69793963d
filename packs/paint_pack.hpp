// Paint packs: the file a dealer loads, opened, checked and seen as a core::InterpolatablePaint.
//
// Why it exists: the kiosk realises straight from the mapped file, and must never believe a byte of it before it has
// been checked. A PaintPack owns the mapping its paint's spans point into; move-only. Read-only after open(): any
// number of threads. Format: docs/pack-format.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/interpolatable_paint.hpp"
#include "packs/paint_form.hpp"
#include "packs/sealed_file.hpp"

namespace lackwerk::packs {

/// Written into new packs; a reader refuses packs whose minimum_reader is above its own schema version.
inline constexpr std::uint32_t paint_schema_version = 4;
/// Version 2 adds the flakes' angular life, version 3 the limit of extrapolation, version 4 how a paint
/// came to its form and at what error; older readers may do without them.
inline constexpr std::uint32_t paint_minimum_reader = 1;
inline constexpr std::string_view pack_tool_version = "lackwerk " LACKWERK_VERSION;

/// What the builder measured on one paint: 1-Wasserstein distances in Lab between a slice and its clusters, and how far
/// the whole paint is from its measurement.
struct PaintError {
  float flake_w1_mean = 0.0f;         ///< over slices, level 0, Lab units; 0 without flakes
  float flake_w1_max = 0.0f;          ///< the worst slice
  std::vector<float> flake_w1_slice;  ///< one per slice
  FormError form;
  bool operator==(const PaintError&) const = default;
};

struct PackInfo {
  std::string id;            ///< [A-Za-z0-9][A-Za-z0-9._-]{0,63}: it stands in signatures and file names
  std::uint64_t serial = 0;  ///< the store refuses a lower one than it has
  std::string tool_version{pack_tool_version};
  std::uint32_t schema_version = paint_schema_version;
  std::uint32_t minimum_reader = paint_minimum_reader;
  double transport_cost = 0.0;     ///< mean over rows and paints, Lab units per unit of mass; 0 with one paint
  double beyond_limit = 0.0;       ///< [0, core::most_beyond]; 0 in packs of older versions too (core/beyond.hpp)
  std::vector<PaintError> errors;  ///< one per paint
  bool operator==(const PackInfo&) const = default;
};

/// All that goes into a pack. The spans of `paint` are the caller's memory.
struct PackContents {
  PackInfo info;
  core::InterpolatablePaint paint;
};

class PaintPack {
 public:
  /// Opens and checks: size, header and digest, FlatBuffers structure, then meaning. Nothing is used before it has
  /// passed. Errors name file and field. Use Backing::copy for files outside the store.
  [[nodiscard]] static Result<PaintPack> open(const std::filesystem::path& path, Backing backing = Backing::map);

  /// The same checks on the bytes of a whole file that was read, and verified, elsewhere. `file` is for the errors.
  [[nodiscard]] static Result<PaintPack> from_bytes(std::vector<std::uint8_t> bytes, const std::string& file);

  /// Valid for the life of this object; the spans stay where they are when it is moved.
  [[nodiscard]] const core::InterpolatablePaint& paint() const { return contents_.paint; }
  [[nodiscard]] const PackInfo& info() const { return contents_.info; }
  /// Size of the whole file.
  [[nodiscard]] std::uint64_t file_bytes() const { return file_.file_bytes(); }

 private:
  [[nodiscard]] static Result<PaintPack> from_file(Result<SealedFile> file, const std::string& name);
  PaintPack(SealedFile file, PackContents contents) : file_(std::move(file)), contents_(std::move(contents)) {}
  SealedFile file_;
  PackContents contents_;
};

/// Writes (and replaces) a pack. Contents that open() would refuse are refused here, naming the field. The same
/// contents give the same bytes.
[[nodiscard]] Result<void> write_paint_pack(const std::filesystem::path& path, const PackContents& contents);

/// Bytes one paint takes of the pack: clusters, tuple indices and colour table. `index` < paint.paints.size().
[[nodiscard]] std::uint64_t paint_bytes(const core::InterpolatablePaint& paint, std::size_t index);

}  // namespace lackwerk::packs
