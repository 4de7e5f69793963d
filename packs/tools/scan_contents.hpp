// From paths between scans to what a scan pack holds: 16-bit places, normals, sky, in an order that can be thinned.
//
// Why it exists: the kiosk uploads a step as it lies in the file. Functions over values; call from any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "packs/scan_pack.hpp"
#include "packs/tools/scan_builder.hpp"

namespace lackwerk::packs {

struct ScanNaming {
  std::string id;  ///< as ScanInfo::id
  std::uint64_t serial = 1;
  std::string name, time_unit;
};

/// A pack in memory. contents() points into it: valid while it lives unchanged.
struct BuiltScan {
  ScanInfo info;
  std::vector<std::vector<ScanPath>> paths;         ///< of each step
  std::vector<std::array<std::uint32_t, 3>> kinds;  ///< segments matched, grown, decayed of each step
  [[nodiscard]] ScanContents contents() const;
};

/// Places within half a step of 1/65535 of the cube around all scans and everything that falls; normals from 12
/// neighbours, sky over 16 cubes of three spacings. Decayed points shrink to nothing where they are to fade (`fades`),
/// else they keep their size. Paths in an order drawn from a fixed seed. `threads` as ScanSettings.
[[nodiscard]] BuiltScan scan_contents(const ScanSeries& series, const ScanNaming& naming, int up, bool fades,
                                      int threads);

}  // namespace lackwerk::packs
