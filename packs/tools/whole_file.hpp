// A whole binary file in memory, of bounded size: what the readers of measurements start from. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// Errors: missing, no plain file, empty, more than `most` bytes, cut while it was read.
[[nodiscard]] inline Result<std::vector<std::uint8_t>> read_whole_file(const std::filesystem::path& path,
                                                                       std::uintmax_t most) {
  std::error_code code;
  const std::string file = path.string();
  if (!std::filesystem::is_regular_file(path, code))
    return fail(file, "", std::filesystem::exists(path, code) ? "is no plain file" : "is not there", "check the path");
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  std::ifstream stream(path, std::ios::binary);
  if (code || !stream) return fail(file, "", "cannot be opened", "check its permissions");
  if (size == 0) return fail(file, "", "is empty", "copy or download it again");
  if (size > most)
    return fail(file, "", "has " + std::to_string(size) + " bytes, and at most " + std::to_string(most) + " are read",
                "check that this is the file you mean");
  std::vector<std::uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) return fail(file, "", "cannot be read to its end", "copy it again");
  return bytes;
}

}  // namespace lackwerk::packs
