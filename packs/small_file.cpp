#include "packs/small_file.hpp"

#include <fstream>

namespace lackwerk::packs {

Result<std::string> read_small_file(const std::filesystem::path& path, std::size_t most_bytes) {
  std::error_code code;
  const auto kind = std::filesystem::status(path, code);
  if (code || !std::filesystem::is_regular_file(kind))
    return fail(path.string(), "", code && code.value() != 0 ? code.message() : "not a regular file", "name a file");
  std::ifstream in(path, std::ios::binary);
  // One byte more than allowed is asked for, so that a file that grows meanwhile is found too.
  std::string text(most_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad()) return fail(path.string(), "", "cannot be read", "check its permissions and the disk");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > most_bytes)
    return fail(path.string(), "", "longer than " + std::to_string(most_bytes) + " bytes",
                "this is another kind of file");
  return text;
}

}  // namespace lackwerk::packs
