#include "kiosk/display/log.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace lackwerk::kiosk {
namespace {

constexpr double repeat_after_ms = 60'000.0;
/// Different lines remembered for repeats: a flood of new texts must not grow the process.
constexpr std::size_t most_remembered = 256;
/// In memory only (tests).
constexpr std::size_t most_lines = 10'000;

std::string cleaned(const std::string& text) {
  std::string out = text;
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return out;
}

}  // namespace

void Log::write(Priority priority, const std::string& text) {
  const std::string line = cleaned(text);
  const double now = monotonic_ms();
  const std::lock_guard lock(mutex_);
  const auto said = said_.find(line);
  const bool repeated = said != said_.end() && now - said->second < repeat_after_ms;
  if (priority <= Priority::warning) {
    const auto same =
        std::find_if(problems_.begin(), problems_.end(), [&](const Entry& entry) { return entry.text == line; });
    Entry entry{now, priority, line, 1};
    if (same != problems_.end()) {
      entry.times = same->times + 1;
      problems_.erase(same);
    }
    problems_.push_back(std::move(entry));
    if (problems_.size() > kept) problems_.pop_front();
  }
  if (repeated) return;
  if (said_.size() >= most_remembered) said_.clear();
  said_[line] = now;
  if (to_ == nullptr) {
    if (lines_.size() < most_lines) lines_.push_back(line);
    return;
  }
  if (journal_)
    std::fprintf(to_, "<%d>%s\n", static_cast<int>(priority), line.c_str());
  else
    std::fprintf(to_, "lackwerk-kiosk: %s\n", line.c_str());
  std::fflush(to_);
}

std::vector<Log::Entry> Log::problems() const {
  const std::lock_guard lock(mutex_);
  return {problems_.begin(), problems_.end()};
}

std::vector<std::string> Log::lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

bool stderr_is_journal() {
  const char* stream = std::getenv("JOURNAL_STREAM");  // "device:inode", systemd.exec(5)
  struct stat here {};
  if (stream == nullptr || fstat(2, &here) != 0) return false;
  return std::to_string(here.st_dev) + ":" + std::to_string(here.st_ino) == stream;
}

double monotonic_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace lackwerk::kiosk
