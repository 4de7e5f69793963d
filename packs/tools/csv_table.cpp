#include "packs/tools/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "packs/tools/whole_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::uintmax_t max_bytes = 1u << 20;  ///< twelve spectra at 1 nm are 50 kB
constexpr std::size_t max_cells = 1024;         ///< per row, and rows

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\r' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<CsvCell> cells_of(std::string_view line, char separator, std::size_t number) {
  std::vector<CsvCell> out;
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t k = 0; k <= line.size() && out.size() <= max_cells; ++k) {
    if (k < line.size() && line[k] == '"') quoted = !quoted;
    if (k < line.size() && (line[k] != separator || quoted)) continue;
    out.push_back({std::string(trimmed(line.substr(from, k - from))), number});
    from = k + 1;
  }
  return out;
}

char separator_of(std::string_view header) {
  for (const char separator : {';', '\t'})
    if (header.find(separator) != std::string_view::npos) return separator;
  return ',';
}

void note_setting(std::string_view comment, std::size_t number, std::vector<CsvSetting>& settings) {
  const std::size_t equals = comment.find('=');
  if (equals == std::string_view::npos || settings.size() >= max_cells) return;
  settings.push_back(
      {std::string(trimmed(comment.substr(0, equals))), std::string(trimmed(comment.substr(equals + 1))), number});
}

std::string line_text(std::size_t number) { return "line " + std::to_string(number); }

/// Programs often end all lines with separators.
void drop_empty_columns(std::vector<std::vector<CsvCell>>& rows) {
  const auto ends_empty = [](const std::vector<CsvCell>& row) { return row.size() > 1 && row.back().text.empty(); };
  while (!rows.empty() && std::all_of(rows.begin(), rows.end(), ends_empty))
    for (auto& row : rows) row.pop_back();
}

}  // namespace

Result<CsvTable> read_csv(const std::filesystem::path& path) {
  const auto bytes = read_whole_file(path, max_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_csv({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string());
}

Result<CsvTable> parse_csv(std::string_view text, const std::string& file) {
  if (text.find('\0') != std::string_view::npos)
    return fail(file, "", "is no text", "export the table as CSV (UTF-8 or plain ASCII)");
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // the mark of UTF-8

  CsvTable out;
  char separator = ',';
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view bare = trimmed(line);
    if (bare.starts_with('#')) {
      note_setting(bare.substr(1), number, out.settings);
      continue;
    }
    if (bare.empty()) continue;
    if (out.rows.empty()) separator = separator_of(line);
    auto row = cells_of(line, separator, number);
    if (row.size() > max_cells || out.rows.size() >= max_cells)
      return fail(file, line_text(number), "more than 1024 cells or rows", "give one paint's table");
    out.rows.push_back(std::move(row));
  }
  if (out.rows.empty()) return fail(file, "", "has no header line", "the first line names the columns");
  drop_empty_columns(out.rows);
  for (const auto& row : out.rows) {
    if (row.size() == out.rows[0].size()) continue;
    return fail(file, line_text(row[0].line),
                "has " + std::to_string(row.size()) + " cells, the header " + std::to_string(out.rows[0].size()),
                "give each row one cell per column; decimal commas need semicolons between the cells");
  }
  out.decimal_comma = separator != ',';
  return out;
}

CsvTable transposed(const CsvTable& table) {
  CsvTable out{{}, table.settings, table.decimal_comma};
  out.rows.resize(table.rows[0].size());
  for (const auto& row : table.rows)
    for (std::size_t k = 0; k < row.size(); ++k) out.rows[k].push_back(row[k]);
  return out;
}

std::optional<double> csv_number(std::string_view text, bool decimal_comma) {
  std::string plain(text);
  if (decimal_comma) std::replace(plain.begin(), plain.end(), ',', '.');
  if (plain.starts_with('+') && !plain.starts_with("+-")) plain.erase(0, 1);  // one sign
  double value = 0.0;
  const char* end = plain.data() + plain.size();
  const auto [stop, code] = std::from_chars(plain.data(), end, value);
  if (code != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace lackwerk::packs
