#include "packs/exhibit_pack.hpp"

namespace lackwerk::packs {

Result<ExhibitPack> ExhibitPack::from_bytes(std::vector<std::uint8_t> bytes, const std::string& file) {
  if (sealed_kind_of(bytes) == SealedKind::scan) {
    auto scans = ScanPack::from_bytes(std::move(bytes), file);
    if (!scans) return tl::unexpected(scans.error());
    return ExhibitPack(std::move(*scans));
  }
  auto paints = PaintPack::from_bytes(std::move(bytes), file);
  if (!paints) return tl::unexpected(paints.error());
  return ExhibitPack(std::move(*paints));
}

const std::string& ExhibitPack::id() const { return scans() != nullptr ? scans()->info().id : paints()->info().id; }

std::uint64_t ExhibitPack::serial() const {
  return scans() != nullptr ? scans()->info().serial : paints()->info().serial;
}

}  // namespace lackwerk::packs
