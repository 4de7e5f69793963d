// Finds a recipe by path or by the bare name of one that comes with the program.
//
// Why it exists: `capture` and `flake-life` take recipes alike. A free function; one thread.
#pragma once

#include <filesystem>
#include <string>

namespace lackwerk::tools {

/// A path as it stands, or a bare name found among the recipes that come with the program: the installed ones, then
/// those of a source tree around the program or the working folder.
[[nodiscard]] std::filesystem::path find_recipe(const std::string& name);

}  // namespace lackwerk::tools
