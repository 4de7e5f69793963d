// Reading TOML by key, with errors that name file, line and key.
//
// Why it exists: recipes and captures are typed by hand, so a wrong key must be answered with the line and the nearest
// right one, and a number with its range. Few files include this (toml++ is slow to compile).
// `Fields` borrows its table: keep the parsed document alive. The first error is kept, later reads return defaults, so
// callers read everything and check once. One thread.
#pragma once

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/vec3.hpp>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/edit_distance.hpp"
#include "core/error.hpp"
#include "core/paint.hpp"
#include "packs/toml_gate.hpp"

namespace lackwerk::packs {

inline constexpr std::uintmax_t max_toml_bytes = 1u << 20;

/// Parses a file of at most 1 MiB. Errors: missing, too long, not TOML (with the line).
[[nodiscard]] inline Result<toml::table> parse_toml(const std::filesystem::path& path) {
  std::error_code code;
  const auto bytes = std::filesystem::file_size(path, code);
  std::ifstream stream(path, std::ios::binary);
  if (code || !stream) return fail(path.string(), "", "cannot be read", "check the path and its permissions");
  if (bytes > max_toml_bytes) return fail(path.string(), "", "is longer than 1 MiB", "give a TOML text file");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (const auto refused = refused_by_gate(text))
    return fail(path.string(), "line " + std::to_string(refused->line), refused->what, "mend the TOML syntax");
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    return fail(path.string(), "line " + std::to_string(error.source().begin.line), std::string(error.description()),
                "mend the TOML syntax");
  }
}

/// The first error of one document.
struct FirstError {
  std::string file;
  std::optional<Error> error;

  void set(const std::string& field, std::string what, std::string remedy) {
    if (!error) error = Error{file, field, std::move(what), std::move(remedy), ErrorKind::run};
  }
};

/// A TOML table whose keys are known. Unknown keys are errors at once.
class Fields {
 public:
  /// `prefix` names the table in errors ("flakes.", "lobe 2.", "" at the top).
  Fields(FirstError& first, const toml::table& table, std::string prefix, const std::vector<std::string_view>& known)
      : first_(first), table_(table), prefix_(std::move(prefix)) {
    for (const auto& [key, node] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      const auto near = std::min_element(known.begin(), known.end(), [&k = key](auto a, auto b) {
        return edit_distance(k.str(), a) < edit_distance(k.str(), b);
      });
      const auto line = key.source().begin ? key.source().begin.line : node.source().begin.line;
      first_.set("line " + std::to_string(line) + ", " + prefix_ + std::string(key.str()), "unknown key",
                 near == known.end() ? "remove it" : "did you mean " + std::string(*near) + "?");
    }
  }

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }

  [[nodiscard]] std::string text(std::string_view key) {
    const auto value = node(key, true) ? table_[key].value<std::string>() : std::nullopt;
    if (!value || value->empty()) wrong(key, "must be a text", "write " + std::string(key) + " = \"...\"");
    return value.value_or("");
  }

  [[nodiscard]] bool flag(std::string_view key, bool absent) {
    if (!has(key)) return absent;
    const auto value = table_[key].as_boolean();
    if (value == nullptr) wrong(key, "must be true or false", "");
    return value != nullptr && value->get();
  }

  /// A finite number in [lo, hi].
  [[nodiscard]] double number(std::string_view key, double lo, double hi) {
    return node(key, true) ? checked(key, table_.get(key), lo, hi) : lo;
  }
  [[nodiscard]] double number_or(std::string_view key, double absent, double lo, double hi) {
    return has(key) ? checked(key, table_.get(key), lo, hi) : absent;
  }
  [[nodiscard]] std::int64_t whole(std::string_view key, std::int64_t lo, std::int64_t hi) {
    const double value = number(key, static_cast<double>(lo), static_cast<double>(hi));
    if (value != std::floor(value)) wrong(key, "must be a whole number", "");
    return static_cast<std::int64_t>(value);
  }

  [[nodiscard]] std::vector<double> numbers(std::string_view key, double lo, double hi, std::size_t most) {
    std::vector<double> out;
    const toml::array* list = array(key, most);
    if (list == nullptr) return out;
    for (const toml::node& entry : *list) out.push_back(checked(key, &entry, lo, hi));
    return out;
  }

  /// Three numbers, linear sRGB.
  [[nodiscard]] glm::dvec3 rgb(std::string_view key, double lo, double hi) {
    const auto list = numbers(key, lo, hi, 3);
    if (list.size() != 3) return wrong(key, "must be three numbers", "write [red, green, blue]"), glm::dvec3(lo);
    return {list[0], list[1], list[2]};
  }

  [[nodiscard]] core::Provenance provenance(std::string_view key) {
    const std::string word = text(key);
    if (word == "measured") return core::Provenance::measured;
    if (word == "published-fit") return core::Provenance::published_fit;
    if (word != "simulated") wrong(key, "unknown provenance", "use measured, published-fit or simulated");
    return core::Provenance::simulated;
  }

  /// A sub-table, or nothing where it is absent.
  [[nodiscard]] std::optional<Fields> table(std::string_view key, const std::vector<std::string_view>& known) {
    if (!has(key)) return std::nullopt;
    const toml::table* inner = table_[key].as_table();
    if (inner == nullptr) return wrong(key, "must be a table", "write [" + std::string(key) + "]"), std::nullopt;
    return Fields(first_, *inner, prefix_ + std::string(key) + ".", known);
  }

  /// An array of at most `most` tables ([[key]]).
  [[nodiscard]] std::vector<Fields> tables(std::string_view key, const std::vector<std::string_view>& known,
                                           std::size_t most) {
    std::vector<Fields> out;
    const toml::array* list = array(key, most);
    if (list == nullptr) return out;
    for (const toml::node& entry : *list) {
      if (!entry.is_table()) return wrong(key, "must hold tables", "write [[" + std::string(key) + "]]"), out;
      out.emplace_back(first_, *entry.as_table(),
                       prefix_ + std::string(key) + " " + std::to_string(out.size() + 1) + ".", known);
    }
    return out;
  }

  /// Three numbers per entry, at most `most` entries.
  [[nodiscard]] std::vector<glm::dvec3> rgb_list(std::string_view key, double lo, double hi, std::size_t most) {
    std::vector<glm::dvec3> out;
    const toml::array* list = array(key, most);
    if (list == nullptr) return out;
    for (const toml::node& entry : *list) {
      const toml::array* row = entry.as_array();
      if (row == nullptr || row->size() != 3) return wrong(key, "must hold [red, green, blue] entries", ""), out;
      out.emplace_back(checked(key, row->get(0), lo, hi), checked(key, row->get(1), lo, hi),
                       checked(key, row->get(2), lo, hi));
    }
    return out;
  }

  /// Notes an error at a key, with its line where the key exists.
  void wrong(std::string_view key, std::string what, std::string remedy) {
    const toml::node* at = table_.get(key);
    const auto& source = at != nullptr ? at->source() : table_.source();
    std::string field = prefix_ + std::string(key);
    if (source.begin) field = "line " + std::to_string(source.begin.line) + ", " + field;
    first_.set(field, std::move(what), std::move(remedy));
  }

 private:
  bool node(std::string_view key, bool required) {
    if (!has(key) && required) wrong(key, "is missing", "add it");
    return has(key);
  }
  const toml::array* array(std::string_view key, std::size_t most) {
    if (!node(key, true)) return nullptr;
    const toml::array* list = table_[key].as_array();
    if (list == nullptr) return wrong(key, "must be a list", "write [...]"), nullptr;
    if (list->size() > most) return wrong(key, "has more than " + std::to_string(most) + " entries", ""), nullptr;
    return list;
  }
  double checked(std::string_view key, const toml::node* at, double lo, double hi) {
    const auto value = at->is_number() ? at->value<double>() : std::nullopt;
    if (value && std::isfinite(*value) && *value >= lo && *value <= hi) return *value;
    std::ostringstream range;
    range << "give a number in [" << lo << ", " << hi << "]";
    wrong(key, value ? "is out of range" : "is not a number", range.str());
    return lo;
  }

  FirstError& first_;
  const toml::table& table_;
  std::string prefix_;
};

/// Lobes in falling roughness, as AnalyticPaint wants them; unused ones (after `count`) get s = 0 and the roughness of
/// the last used one, so that the order holds.
inline void order_lobes(core::AnalyticPaint& paint, std::size_t count) {
  auto& lobes = paint.lobes;
  std::stable_sort(lobes.begin(), lobes.begin() + static_cast<std::ptrdiff_t>(count),
                   [](const core::Lobe& a, const core::Lobe& b) { return a.m > b.m; });
  for (std::size_t k = count; k < lobes.size(); ++k) {
    if (k > 0) lobes[k] = lobes[k - 1];
    lobes[k].s = glm::dvec3(0.0);
  }
}

}  // namespace lackwerk::packs
