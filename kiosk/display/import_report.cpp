#include "kiosk/display/import_report.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "kiosk/display/json_fields.hpp"
#include "packs/storage.hpp"
#include "packs/utf8.hpp"

namespace lackwerk::kiosk {
namespace {

using Outcome = ImportedFile::Outcome;

constexpr const char* remedy = "it is left out; plug the stick in again";

constexpr const char* time_key = "time_s";
constexpr const char* good_key = "good";
constexpr const char* error_key = "error";
constexpr const char* files_key = "files";
constexpr const char* file_key = "file";
constexpr const char* result_key = "result";
constexpr const char* id_key = "id";
constexpr const char* serial_key = "serial";
constexpr const char* signed_by_key = "key";

/// By number of Outcome.
constexpr std::array<std::string_view, 3> outcome_words{"stored", "already there", "refused"};
static_assert(outcome_words.size() == static_cast<std::size_t>(Outcome::refused) + 1);

std::string_view word_of(Outcome outcome) { return outcome_words[static_cast<std::size_t>(outcome)]; }

std::optional<Outcome> outcome_of(std::string_view word) {
  const auto* known = std::find(outcome_words.begin(), outcome_words.end(), word);
  if (known == outcome_words.end()) return std::nullopt;
  return static_cast<Outcome>(known - outcome_words.begin());
}

/// Code points that end a line or turn the direction of what follows: a name on a stick may hold them.
bool disturbs(char32_t c) {
  return packs::is_control(c) || (c >= 0x200e && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069);
}

/// On one line, not longer than allowed. `text` is UTF-8: the parser has seen to that.
std::string shown_text(std::string_view text) {
  std::string out;
  while (const auto letter = packs::first_letter(text)) {
    const std::string_view shown = disturbs(letter->point) ? "?" : text.substr(0, letter->bytes);
    if (out.size() + shown.size() > max_import_text_bytes) break;
    out += shown;
    text.remove_prefix(letter->bytes);
  }
  return out;
}

void take_shown(const JsonFields& fields, const char* key, std::string& to) {
  if (const std::string* text = fields.text(key)) to = shown_text(*text);
}

ImportedFile file_of(const nlohmann::json& json, std::string& wrong) {
  ImportedFile file;
  const JsonFields fields(json, wrong);
  take_shown(fields, file_key, file.file);
  const std::string* word = fields.text(result_key);
  const auto outcome = word != nullptr ? outcome_of(*word) : std::nullopt;
  outcome ? void(file.outcome = *outcome) : fields.refuse(result_key);
  take_shown(fields, id_key, file.id);
  take_shown(fields, signed_by_key, file.key);
  take_shown(fields, error_key, file.error);
  fields.take(serial_key, file.serial);
  return file;
}

}  // namespace

bool ImportReport::has_news() const {
  return std::any_of(files.begin(), files.end(), [](const ImportedFile& f) { return f.outcome == Outcome::stored; });
}

bool ImportReport::is_good() const {
  return error.empty() &&
         std::none_of(files.begin(), files.end(), [](const ImportedFile& f) { return f.outcome == Outcome::refused; });
}

std::string import_json(const ImportReport& report) {
  nlohmann::ordered_json out{{time_key, report.time_s},
                             {good_key, report.is_good()},
                             {error_key, report.error},
                             {files_key, nlohmann::ordered_json::array()}};
  for (const ImportedFile& file : report.files) {
    nlohmann::ordered_json entry{{file_key, file.file}, {result_key, word_of(file.outcome)}};
    if (file.outcome == Outcome::refused)
      entry[error_key] = file.error;
    else
      entry.update({{id_key, file.id}, {serial_key, file.serial}, {signed_by_key, file.key}});
    out[files_key].push_back(std::move(entry));
  }
  // Names need not be UTF-8.
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<ImportReport> parse_import(const std::string& text, const std::string& file) {
  const auto json = parse_object(text, file, remedy);
  if (!json) return tl::unexpected(json.error());
  ImportReport report;
  std::string wrong;
  const JsonFields fields(*json, wrong);
  fields.take(time_key, report.time_s);
  take_shown(fields, error_key, report.error);
  if (const nlohmann::json* files = fields.find(files_key)) {
    if (!files->is_array() || files->size() > max_import_files) {
      fields.refuse(files_key);
    } else {
      for (const nlohmann::json& each : *files) {
        if (each.is_object())
          report.files.push_back(file_of(each, wrong));
        else
          fields.refuse(files_key);
      }
    }
  }
  if (!wrong.empty()) return fail(file, wrong, "is not a value it can have", remedy);
  return report;
}

Result<void> write_import(const std::filesystem::path& folder, const ImportReport& report) {
  const std::string text = import_json(report), name = import_file_name;
  // Of each process its own: two sticks may be imported at once.
  const std::string fresh = "." + name + "." + std::to_string(::getpid());
  const auto disk = packs::open_disk(folder);
  auto writer = disk->create(fresh);
  if (!writer) return tl::unexpected(writer.error());
  auto done = (*writer)->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (done) done = disk->rename(fresh, name);
  if (!done) {
    [[maybe_unused]] const auto removed = disk->remove_file(fresh);
  }
  return done;
}

}  // namespace lackwerk::kiosk
