// What `lackwerk pack info --json` prints: every field of a paint pack and, under "fields", what each of them means.
//
// Why it exists: whoever reads the numbers by machine should not have to guess a unit, and a field that is added
// without a word about it should fail a test. Pure; one thread.
#pragma once

#include <nlohmann/json.hpp>

#include "packs/paint_pack.hpp"

namespace lackwerk::tools {

/// How the widths of the random cells were found, in words.
[[nodiscard]] const char* life_origin(const core::FlakeLife& life);

/// All fields that are not mass data (clusters, tuples and masses are counted, not listed), and "fields": an object
/// from each key's path ("paints[].lobes[].m") to its "unit" ("" where it has none) and "meaning".
[[nodiscard]] nlohmann::ordered_json pack_info_json(const packs::PaintPack& pack);

}  // namespace lackwerk::tools
