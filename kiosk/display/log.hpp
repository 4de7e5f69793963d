// The kiosk's log: lines with priorities to standard error, as the journal reads them, and the last problems for the
// status page.
//
// Why it exists: an integrator reads the journal, a dealer the screen; both must tell the same story. No library: the
// journal's line format is a number in angle brackets (sd-daemon(3)). Whoever makes it owns it; any thread may write.
#pragma once

#include <cstddef>
#include <cstdio>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::kiosk {

/// syslog(3) numbers.
enum class Priority { error = 3, warning = 4, notice = 5, info = 6, debug = 7 };

class Log {
 public:
  /// `to`: where lines go, usually stderr; null keeps them in memory only (tests). `journal`: with priorities in front.
  explicit Log(std::FILE* to = stderr, bool journal = false) : to_(to), journal_(journal) {}

  /// One line; control characters are replaced. The same line again within a minute is counted, not repeated.
  void write(Priority priority, const std::string& text);
  void error(const Error& error) { write(Priority::error, error.line()); }
  void warning(const std::string& text) { write(Priority::warning, text); }
  void notice(const std::string& text) { write(Priority::notice, text); }
  void info(const std::string& text) { write(Priority::info, text); }

  /// Warnings and errors, newest last, at most `kept`.
  struct Entry {
    double at_ms = 0.0;  ///< CLOCK_MONOTONIC
    Priority priority = Priority::info;
    std::string text;
    int times = 1;
  };
  static constexpr std::size_t kept = 20;
  [[nodiscard]] std::vector<Entry> problems() const;
  /// All lines so far of a log without a file: for tests.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  mutable std::mutex mutex_;
  std::FILE* to_;
  bool journal_;
  std::deque<Entry> problems_;
  std::map<std::string, double> said_;  ///< when a line was last written, ms
  std::vector<std::string> lines_;
};

/// True when standard error goes to the journal (JOURNAL_STREAM names its device and inode).
[[nodiscard]] bool stderr_is_journal();

/// CLOCK_MONOTONIC in ms: the one clock of the kiosk.
[[nodiscard]] double monotonic_ms();

}  // namespace lackwerk::kiosk
