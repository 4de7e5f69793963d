// The meaning of a paint pack: what must hold before anyone realises or draws from it.
//
// Why it exists: a digest proves that a file is what somebody wrote, and FlatBuffers that it is well formed; neither
// says that probabilities sum to one or that indices stay inside. Reader and writer both call this. Pure; any thread.
#pragma once

#include <string>

#include "packs/paint_pack.hpp"

namespace lackwerk::packs {

/// Checks identity, versions, numbers, counts, indices, sums. The first violation is the Error: `file`, the field
/// ("paints[1].lobes[0].m"), what is wrong, what to do.
[[nodiscard]] Result<void> check_contents(const PackContents& contents, const std::string& file);

}  // namespace lackwerk::packs
