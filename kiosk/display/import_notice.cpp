#include "kiosk/display/import_notice.hpp"

#include <utility>

#include "packs/small_file.hpp"

namespace lackwerk::kiosk {

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
      case ImportedFile::Outcome::stored:
        toast.stored.push_back(file.id);
        break;
      case ImportedFile::Outcome::already_there:
        toast.known.push_back(file.id);
        break;
      case ImportedFile::Outcome::refused:
        if (toast.refused++ == 0) toast.reason = file.error;
        break;
    }
  }
  if (toast.reason.empty()) toast.reason = report.error;
  return toast;
}

}  // namespace lackwerk::kiosk
