// Tells when a file has been put in its place in a folder.
//
// Why it exists: the store, the importer and others replace files by renaming; the kiosk sleeps until one of them does.
// Owns an inotify descriptor; one thread.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

namespace lackwerk::kiosk {

class FolderWatch {
 public:
  /// Watches nothing.
  FolderWatch() = default;
  ~FolderWatch();
  FolderWatch(FolderWatch&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FolderWatch& operator=(FolderWatch&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  /// Begins to watch; a second call changes nothing. A folder that is not there is not watched.
  void watch(const std::filesystem::path& folder);
  /// Whether a file of this name (empty: any) was renamed into the folder since the last call.
  [[nodiscard]] bool changed(std::string_view name = {});
  /// To poll for reading; -1 where nothing is watched.
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_ = -1;
};

}  // namespace lackwerk::kiosk
