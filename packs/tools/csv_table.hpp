// A CSV file as cells of text, each knowing its line.
//
// Why it exists: instruments write CSV in every dialect; which one it is has nothing to do with what the cells mean.
// Values; any thread. Files are only read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

struct CsvCell {
  std::string text;      ///< without blanks and quotes around it
  std::size_t line = 0;  ///< from 1
};
/// A comment of the form "# key = value".
struct CsvSetting {
  std::string key, value;
  std::size_t line = 0;
};
struct CsvTable {
  std::vector<std::vector<CsvCell>> rows;  ///< the first is the header; all of one length
  std::vector<CsvSetting> settings;
  bool decimal_comma = false;  ///< the separator leaves commas free
};

/// At most 1 MiB, 1024 rows of 1024 cells. Separator: semicolon, tab or comma, the first of these that the header has.
/// Blank lines and lines from '#' are no rows; empty cells at the end of all rows are left out. Errors name the line:
/// empty, not text, too long, a row longer or shorter than the header.
[[nodiscard]] Result<CsvTable> read_csv(const std::filesystem::path& file);
/// From the text of a file; `file` names it in errors.
[[nodiscard]] Result<CsvTable> parse_csv(std::string_view text, const std::string& file);

/// Rows become columns.
[[nodiscard]] CsvTable transposed(const CsvTable& table);

/// A finite number, all of the text; with `decimal_comma` either sign of decimals. Nothing otherwise.
[[nodiscard]] std::optional<double> csv_number(std::string_view text, bool decimal_comma);

}  // namespace lackwerk::packs
