#include "kiosk/display/import_notice.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "packs/small_file.hpp"

namespace lackwerk::kiosk {
namespace {

using Json = nlohmann::json;
using Outcome = ImportedFile::Outcome;

constexpr const char* remedy = "it is left out; plug the stick in again";
struct OutcomeWord {
  std::string_view word;
  Outcome outcome;
};
constexpr std::array<OutcomeWord, 3> outcomes{
    {{"stored", Outcome::stored}, {"already there", Outcome::already_there}, {"refused", Outcome::refused}}};

/// Code points that end a line or turn the direction of what follows: a name on a stick may hold them.
bool disturbs(char32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x200e && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069);
}

/// On one line, not longer than allowed. `text` is UTF-8: the parser has seen to that.
std::string shown_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length =
        std::min<std::size_t>(first < 0x80 ? 1 : (first < 0xe0 ? 2 : (first < 0xf0 ? 3 : 4)), text.size() - at);
    char32_t point = length == 1 ? first : first & (0x7fU >> length);
    for (std::size_t k = 1; k < length; ++k) point = point << 6 | (static_cast<unsigned char>(text[at + k]) & 0x3fU);
    const std::string_view shown = disturbs(point) ? "?" : text.substr(at, length);
    if (out.size() + shown.size() > max_import_text_bytes) break;
    out += shown;
    at += length;
  }
  return out;
}

/// Reads one key after the other and keeps the first that is wrong; an absent one is empty or 0.
class Reader {
 public:
  Reader(const Json& from, std::string& wrong) : from_(from), wrong_(wrong) {}

  void take(const char* key, std::string& to) const {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_string()) return refuse(key);
    to = shown_text(value->get_ref<const std::string&>());
  }
  template <class Number>
  void take_number(const char* key, Number& to) const {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_number_unsigned()) return refuse(key);
    const auto number = value->get<std::uint64_t>();
    if (!std::in_range<Number>(number)) return refuse(key);
    to = static_cast<Number>(number);
  }
  void take(const char* key, Outcome& to) const {
    const Json* value = find(key);
    const auto* known = std::find_if(outcomes.begin(), outcomes.end(), [&](const OutcomeWord& each) {
      return value != nullptr && value->is_string() && value->get_ref<const std::string&>() == each.word;
    });
    if (known == outcomes.end()) return refuse(key);
    to = known->outcome;
  }
  [[nodiscard]] const Json* find(const char* key) const {
    const auto at = from_.find(key);
    return at == from_.end() ? nullptr : &*at;
  }
  void refuse(const char* key) const {
    if (wrong_.empty()) wrong_ = key;
  }

 private:
  const Json& from_;
  std::string& wrong_;
};

ImportedFile file_of(const Json& json, std::string& wrong) {
  ImportedFile file;
  const Reader reader(json, wrong);
  reader.take("file", file.file);
  reader.take("result", file.outcome);
  reader.take("id", file.id);
  reader.take("key", file.key);
  reader.take("error", file.error);
  reader.take_number("serial", file.serial);
  return file;
}

}  // namespace

Result<ImportReport> parse_import(const std::string& text, const std::string& file) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return fail(file, "", "is damaged: no JSON object", remedy);
  ImportReport report;
  std::string wrong;
  const Reader reader(json, wrong);
  reader.take_number("time_s", report.time_s);
  reader.take("error", report.error);
  if (const Json* files = reader.find("files")) {
    if (!files->is_array() || files->size() > max_import_files) {
      reader.refuse("files");
    } else {
      for (const Json& each : *files) {
        if (each.is_object())
          report.files.push_back(file_of(each, wrong));
        else
          reader.refuse("files");
      }
    }
  }
  if (!wrong.empty()) return fail(file, wrong, "is not a value it can have", remedy);
  return report;
}

ImportNotice::ImportNotice(std::filesystem::path folder) : folder_(std::move(folder)) {
  // Before it is read: a change in between is seen twice, not missed.
  if (!folder_.empty()) watch_.watch(folder_);
}

Result<std::optional<ImportReport>> ImportNotice::poll(double now_ms, double wall_s) {
  std::optional<ImportReport> news;
  const bool first = !started_ms_;
  if (first) started_ms_ = now_ms;
  if (folder_.empty() || !(watch_.changed(import_file_name) || first)) return news;
  const std::filesystem::path file = folder_ / import_file_name;
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) return news;
  const auto text = packs::read_small_file(file, max_import_bytes);
  if (!text) return tl::unexpected(text.error());
  auto report = parse_import(*text, file.string());
  if (!report) return tl::unexpected(report.error());
  last_ = std::move(*report);
  // By its age, for the wall clock may have been set since the start; the report counts whole seconds.
  constexpr double rounding_s = 1.0;
  const double age_s = wall_s - static_cast<double>(last_->time_s);
  if (age_s <= (now_ms - *started_ms_) / 1e3 + rounding_s) news = last_;
  return news;
}

ui::Toast toast_of(const ImportReport& report) {
  ui::Toast toast;
  for (const ImportedFile& file : report.files) {
    switch (file.outcome) {
      case Outcome::stored:
        toast.stored.push_back(file.id);
        break;
      case Outcome::already_there:
        toast.known.push_back(file.id);
        break;
      case Outcome::refused:
        if (toast.refused++ == 0) toast.reason = file.error;
        break;
    }
  }
  if (toast.reason.empty()) toast.reason = report.error;
  return toast;
}

}  // namespace lackwerk::kiosk
