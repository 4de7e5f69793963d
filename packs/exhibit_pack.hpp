// A pack that a kiosk can show: paints or scans, told apart by what the file says it is.
//
// Why it exists: store, signatures, sticks and the kiosk treat both alike and need their name and number only. Owns the
// pack; move-only. Reading is const: any number of threads.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "packs/paint_pack.hpp"
#include "packs/scan_pack.hpp"

namespace lackwerk::packs {

class ExhibitPack {
 public:
  // Whoever has a pack has an exhibit.
  // NOLINTNEXTLINE(google-explicit-constructor,hicpp-explicit-conversions)
  ExhibitPack(PaintPack pack) : pack_(std::move(pack)) {}
  // NOLINTNEXTLINE(google-explicit-constructor,hicpp-explicit-conversions)
  ExhibitPack(ScanPack pack) : pack_(std::move(pack)) {}

  /// The bytes of a whole file, checked as their kind is. What says it is neither is refused as a paint pack is.
  [[nodiscard]] static Result<ExhibitPack> from_bytes(std::vector<std::uint8_t> bytes, const std::string& file);

  /// The pack, where it is one of that kind; null otherwise. At the same address until this is moved or assigned.
  [[nodiscard]] const PaintPack* paints() const { return std::get_if<PaintPack>(&pack_); }
  [[nodiscard]] const ScanPack* scans() const { return std::get_if<ScanPack>(&pack_); }

  [[nodiscard]] const std::string& id() const;
  [[nodiscard]] std::uint64_t serial() const;
  /// "paint pack" or "scan pack".
  [[nodiscard]] const char* kind_name() const { return scans() != nullptr ? "scan pack" : "paint pack"; }

 private:
  std::variant<PaintPack, ScanPack> pack_;
};

}  // namespace lackwerk::packs
