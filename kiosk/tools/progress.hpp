// How far a long command has come: a bar with percentage and remaining time.
//
// Why it exists: building a pack takes seconds to minutes, and silence looks like a hang. On a terminal the bar lives
// on stderr and is wiped when the object goes, so that an error is still one line. Without a terminal there is a plain
// line on stdout every few seconds (stderr stays for errors), and none with `quiet` (JSON output). update() may be
// called from any thread; the object belongs to one.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace lackwerk::tools {

class Progress {
 public:
  /// `label` stands before the bar ("capture"). `quiet`: no plain lines.
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` done of the whole, [0, 1]; `stage` says of what. Draws at most ten times a second.
  void update(double fraction, std::string_view stage);

  [[nodiscard]] double elapsed_s() const;

 private:
  using Clock = std::chrono::steady_clock;
  void draw_bar(double fraction, std::string_view stage, double remaining_s);

  const std::string label_;
  const bool quiet_;
  const bool terminal_;
  const Clock::time_point start_;
  std::mutex mutex_;
  Clock::time_point last_drawn_;
  bool drawn_ = false;
};

}  // namespace lackwerk::tools
