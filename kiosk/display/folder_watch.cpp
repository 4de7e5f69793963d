#include "kiosk/display/folder_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace lackwerk::kiosk {

FolderWatch::~FolderWatch() {
  if (fd_ >= 0) ::close(fd_);
}

void FolderWatch::watch(const std::filesystem::path& folder) {
  if (fd_ >= 0) return;
  fd_ = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  if (fd_ >= 0 && ::inotify_add_watch(fd_, folder.c_str(), IN_MOVED_TO | IN_ONLYDIR) < 0) {
    ::close(fd_);
    fd_ = -1;
  }
}

bool FolderWatch::changed(std::string_view name) {
  if (fd_ < 0) return false;
  alignas(inotify_event) std::array<char, 4096> events{};
  bool changed = false;
  // The kernel hands over whole events; one with the longest name fits.
  for (ssize_t size = 0; (size = ::read(fd_, events.data(), events.size())) > 0;) {
    for (std::size_t at = 0; at + sizeof(inotify_event) <= static_cast<std::size_t>(size);) {
      inotify_event event{};
      std::memcpy(&event, events.data() + at, sizeof event);
      at += sizeof event;
      // The name is padded with zeros; an overflow of the queue has none, and may have lost any.
      const std::string_view padded(events.data() + at, event.len);
      at += event.len;
      changed |= name.empty() || (event.mask & IN_Q_OVERFLOW) != 0 || padded.substr(0, padded.find('\0')) == name;
    }
  }
  return changed;
}

}  // namespace lackwerk::kiosk
