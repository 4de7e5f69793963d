// What `lackwerk pack info` prints of a scan pack: its scans, its steps, and what every field means.
//
// Why it exists: whoever reads the numbers by machine should not have to guess a unit. Pure; one thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "packs/scan_pack.hpp"

namespace lackwerk::tools {

/// All fields (paths are counted, not listed), and "fields": an object from each key's path to its "unit" and
/// "meaning", as pack_info_json().
[[nodiscard]] nlohmann::ordered_json scan_info_json(const packs::ScanPack& pack);

/// Some lines for people, without the last line's end.
[[nodiscard]] std::string scan_info_text(const packs::ScanPack& pack);

}  // namespace lackwerk::tools
