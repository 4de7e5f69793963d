#include "kiosk/tools/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kiosk/tools/output.hpp"

namespace lackwerk::tools {
namespace {

constexpr double bar_interval_s = 0.1, line_interval_s = 5.0;
constexpr int bar_width = 24;

std::string duration_text(double seconds) {
  const long whole = std::lround(std::ceil(seconds));
  return whole < 120 ? std::to_string(whole) + " s" : std::to_string((whole + 59) / 60) + " min";
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_drawn_(start_) {}

Progress::~Progress() {
  if (drawn_ && terminal_) std::fputs("\r\033[K", stderr);
}

double Progress::elapsed_s() const { return seconds_between(start_, Clock::now()); }

void Progress::update(double fraction, std::string_view stage) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (seconds_between(last_drawn_, now) < (terminal_ ? bar_interval_s : line_interval_s)) return;
  last_drawn_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double passed = seconds_between(start_, now);
  const double remaining = fraction > 0.0 ? passed * (1.0 - fraction) / fraction : 0.0;
  if (terminal_)
    draw_bar(fraction, stage, remaining);
  else if (!quiet_)
    print(label_ + ": " + fixed(100.0 * fraction, 0) + " %, " + std::string(stage) + ", " + duration_text(remaining) +
          " left");
  drawn_ = true;
}

void Progress::draw_bar(double fraction, std::string_view stage, double remaining_s) {
  const auto full = static_cast<std::size_t>(std::lround(fraction * bar_width));
  const std::string bar = std::string(full, '#') + std::string(bar_width - full, '.');
  // Cut to a narrow terminal's width: a bar that wraps cannot be wiped.
  std::string line = label_ + " [" + bar + "] " + fixed(100.0 * fraction, 0) + " %  " + duration_text(remaining_s) +
                     " left  " + one_line(stage);
  if (line.size() > 79) line.resize(79);
  std::fputs(("\r" + line + "\033[K").c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace lackwerk::tools
