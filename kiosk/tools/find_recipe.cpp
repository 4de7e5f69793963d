#include "kiosk/tools/find_recipe.hpp"

#include <vector>

namespace lackwerk::tools {
namespace {

namespace fs = std::filesystem;

/// Folders that may hold the recipes that come with the program: the installed one, then a source tree around the
/// program or the working folder.
std::vector<fs::path> recipe_folders() {
  std::vector<fs::path> out;
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code) out.push_back(program.parent_path().parent_path() / "share" / "lackwerk" / "recipes");
  for (fs::path start : {program.parent_path(), fs::current_path(code)})
    for (; !start.empty(); start = start.parent_path()) {
      out.push_back(start / "packs" / "recipes");
      if (start == start.root_path()) break;
    }
  return out;
}

}  // namespace

fs::path find_recipe(const std::string& name) {
  std::error_code code;
  if (fs::exists(name, code) || fs::path(name).has_parent_path()) return name;
  for (const fs::path& folder : recipe_folders())
    for (const char* ending : {"", ".toml"})
      if (fs::path found = folder / (name + ending); fs::is_regular_file(found, code)) return found;
  return name;
}

}  // namespace lackwerk::tools
