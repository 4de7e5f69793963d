// Takes packs from a stick into the store: what lackwerk-import@.service runs.
//
// Why it exists: a stick is a stranger. It is mounted read-only, looked at in one folder only, and never through a
// link; every size is known before a byte is read; what is shown of it are the store's own verdicts. Free functions;
// one thread, any number of processes (the store has a lock).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/import_report.hpp"
#include "packs/keyring.hpp"
#include "packs/sealed_file.hpp"
#include "packs/store.hpp"

namespace lackwerk::kiosk {

/// The one folder of a stick that is looked at; in capitals too, as some systems write short names.
inline constexpr const char* stick_folder = "lackwerk";

struct ImportLimits {
  std::size_t most_packs = 16;                               ///< the first by name
  std::uint64_t most_pack_bytes = packs::max_exhibit_bytes;  ///< of each
};

/// Every NAME.lwp (or .LWP) of `stick`/lackwerk that is a regular file with a regular NAME.lwp.minisig beside it goes
/// through Store::add, by name; all others of that name are refused with a reason. `stick`: where it is mounted.
[[nodiscard]] ImportReport import_folder(const std::filesystem::path& stick, packs::Store& store,
                                         const packs::Keyring& keyring, const ImportLimits& limits);

/// A line for each file, and one for the stick where that has a fault.
[[nodiscard]] std::string import_lines(const ImportReport& report);

struct ImportPlaces {
  std::filesystem::path stick, store, keyring;
  std::filesystem::path report;  ///< folder of import.json
};
/// All of it: store and keyring opened, packs imported, lines printed to standard output, import.json written. False:
/// something was refused. Error: of the report's folder.
[[nodiscard]] Result<bool> import_stick(const ImportPlaces& places);

}  // namespace lackwerk::kiosk
