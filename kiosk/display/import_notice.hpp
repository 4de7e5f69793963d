// What the kiosk tells of a stick: the importer's last report, as it comes.
//
// Why it exists: a dealer plugs in a stick and looks at the screen. The importer is another process and leaves its
// report in the runtime folder; our own unit writes it, yet it is bounded and checked like any file. Owns the watch of
// that folder and the last report; one thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "kiosk/display/folder_watch.hpp"
#include "kiosk/display/import_report.hpp"
#include "kiosk/display/ui/model.hpp"

namespace lackwerk::kiosk {

class ImportNotice {
 public:
  /// `folder`: where import.json will be; empty: nothing is watched.
  explicit ImportNotice(std::filesystem::path folder);

  /// A report that has come since the last call and was written since the first one. An older one is kept for last()
  /// without a word. `now_ms`: the kiosk's clock; `wall_s`: seconds since 1970, as the report counts them. Error: a
  /// report that is none; it is left out and told once.
  [[nodiscard]] Result<std::optional<ImportReport>> poll(double now_ms, double wall_s);

  [[nodiscard]] const std::optional<ImportReport>& last() const { return last_; }
  /// To poll for reading; -1 where nothing is watched.
  [[nodiscard]] int fd() const { return watch_.fd(); }

 private:
  std::filesystem::path folder_;
  FolderWatch watch_;
  std::optional<double> started_ms_;  ///< of the first poll()
  std::optional<ImportReport> last_;
};

/// What a visitor's screen says of it.
[[nodiscard]] ui::Toast toast_of(const ImportReport& report);

}  // namespace lackwerk::kiosk
