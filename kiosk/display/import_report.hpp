// What came of a stick: the importer's report, and the file it is told in.
//
// Why it exists: one process writes it and another reads it. The file's words, its limits and both directions stand
// together, without the store that only the importer needs. Values and free functions; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::kiosk {

inline constexpr const char* import_file_name = "import.json";
/// More than sixteen packs with the longest names and errors need.
inline constexpr std::size_t max_import_bytes = 65536;
inline constexpr std::size_t max_import_files = 64;
/// Of each text that is shown; the rest is left out.
inline constexpr std::size_t max_import_text_bytes = 256;

struct ImportedFile {
  enum class Outcome { stored, already_there, refused };
  std::string file;  ///< its name, without the folder
  Outcome outcome = Outcome::refused;
  std::string id, key;  ///< as verified; empty where it was refused
  std::uint64_t serial = 0;
  std::string error;  ///< one line; empty where it was not refused
};

struct ImportReport {
  std::vector<ImportedFile> files;  ///< by name
  std::string error;                ///< of the stick as a whole; empty where there is none
  std::int64_t time_s = 0;          ///< of the wall clock, seconds since 1970
  /// Whether anything is in use now that was not before.
  [[nodiscard]] bool has_news() const;
  [[nodiscard]] bool is_good() const;
};

/// What the kiosk shows for some seconds; keys as in docs/packs-and-store.md.
[[nodiscard]] std::string import_json(const ImportReport& report);
/// The reverse; unknown keys of a newer one are passed over, texts are cut to max_import_text_bytes and hold nothing
/// that changes lines or directions. `text`: at most max_import_bytes. `file` is for errors: no JSON, a value that is
/// none, too many files.
[[nodiscard]] Result<ImportReport> parse_import(const std::string& text, const std::string& file);

/// Replaces `folder`/import.json in one step, so that nobody reads half of it.
[[nodiscard]] Result<void> write_import(const std::filesystem::path& folder, const ImportReport& report);

}  // namespace lackwerk::kiosk
