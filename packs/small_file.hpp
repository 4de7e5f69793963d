// Reads files that are small by nature: keys, signatures, lists.
//
// Why it exists: a limit before memory is taken, and one wording of what can go wrong. Free function; any thread.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace lackwerk::packs {

/// The whole of a regular file. Errors: not there, not a regular file, longer than `most_bytes`, cannot be read.
[[nodiscard]] Result<std::string> read_small_file(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace lackwerk::packs
