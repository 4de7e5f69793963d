// What an importer decided on the user's behalf.
//
// Why it exists: real folders lack pictures and hold rounded angles; what was filled, merged or taken as near enough is
// told, never hidden. Values; any thread.
#pragma once

#include <string>
#include <vector>

namespace lackwerk::packs {

/// One sentence each, without a full stop.
using ImportNotes = std::vector<std::string>;

}  // namespace lackwerk::packs
