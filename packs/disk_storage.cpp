#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "packs/storage.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> because(const fs::path& path, int code) {
  std::string remedy = "check the disk";
  if (code == ENOSPC || code == EDQUOT) remedy = "make room on the disk";
  if (code == EACCES || code == EPERM) remedy = "run as the store's owner, or choose another root";
  if (code == EROFS) remedy = "choose a root on a disk that can be written";
  if (code == ELOOP) remedy = "symbolic links are not followed: name the file itself";
  return fail(path.string(), "", std::strerror(code), remedy);
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool good() const { return fd_ >= 0; }

 private:
  int fd_;
};

class DiskReader final : public Storage::Reader {
 public:
  DiskReader(fs::path path, int fd, std::uint64_t size) : path_(std::move(path)), fd_(fd), size_(size) {}
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] Result<std::size_t> read(std::span<std::uint8_t> into) override {
    for (;;) {
      const ssize_t n = ::read(fd_.get(), into.data(), into.size());
      if (n >= 0) return static_cast<std::size_t>(n);
      if (errno != EINTR) return because(path_, errno);
    }
  }

 private:
  fs::path path_;
  Descriptor fd_;
  std::uint64_t size_;
};

class DiskWriter final : public Storage::Writer {
 public:
  DiskWriter(fs::path path, int fd) : path_(std::move(path)), fd_(fd) {}
  [[nodiscard]] Result<void> write(std::span<const std::uint8_t> bytes) override {
    while (!bytes.empty()) {
      const ssize_t n = ::write(fd_.get(), bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return because(path_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
  }
  [[nodiscard]] Result<void> sync() override {
    if (::fsync(fd_.get()) != 0) return because(path_, errno);
    return {};
  }

 private:
  fs::path path_;
  Descriptor fd_;
};

class DiskLock final : public Storage::Lock {
 public:
  explicit DiskLock(int fd) : fd_(fd) {}

 private:
  Descriptor fd_;  // closing it lets go
};

Result<std::unique_ptr<Storage::Reader>> open_regular(const fs::path& path) {
  // Without O_NONBLOCK a FIFO of the file's name would hold the store for ever.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return because(path, errno);
  struct stat found {};
  if (::fstat(fd, &found) != 0 || !S_ISREG(found.st_mode)) {
    ::close(fd);
    return fail(path.string(), "", "not a regular file", "name a file");
  }
  return std::make_unique<DiskReader>(path, fd, static_cast<std::uint64_t>(found.st_size));
}

class Disk final : public Storage {
 public:
  explicit Disk(fs::path root) : root_(std::move(root)) {}

  [[nodiscard]] Result<std::unique_ptr<Lock>> lock() override {
    std::error_code code;
    fs::create_directories(root_, code);
    if (code) return because(root_, code.value());
    const fs::path path = root_ / "lock";
    const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (fd < 0) return because(path, errno);
    auto held = std::make_unique<DiskLock>(fd);
    while (::flock(fd, LOCK_EX) != 0)
      if (errno != EINTR) return because(path, errno);
    return held;
  }
  [[nodiscard]] Result<std::unique_ptr<Reader>> open(const std::string& path) override {
    return open_regular(full_path(path));
  }
  [[nodiscard]] Result<std::unique_ptr<Writer>> create(const std::string& path) override {
    const fs::path full = full_path(path);
    const int fd = ::open(full.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (fd < 0) return because(full, errno);
    return std::make_unique<DiskWriter>(full, fd);
  }
  [[nodiscard]] Result<void> make_folder(const std::string& path) override {
    return done(path, ::mkdir(full_path(path).c_str(), 0755));
  }
  [[nodiscard]] Result<void> sync_folder(const std::string& path) override {
    const Descriptor fd(::open(full_path(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    return done(path, fd.good() ? ::fsync(fd.get()) : -1);
  }
  [[nodiscard]] Result<void> rename(const std::string& from, const std::string& to) override {
    return done(to, ::rename(full_path(from).c_str(), full_path(to).c_str()));
  }
  [[nodiscard]] Result<void> remove_file(const std::string& path) override {
    return done(path, ::unlink(full_path(path).c_str()));
  }
  [[nodiscard]] Result<void> remove_folder(const std::string& path) override {
    return done(path, ::rmdir(full_path(path).c_str()));
  }
  [[nodiscard]] Result<std::optional<std::vector<Entry>>> list(const std::string& path) override {
    const fs::path full = full_path(path);
    DIR* folder = ::opendir(full.c_str());
    if (folder == nullptr && errno == ENOENT) return std::optional<std::vector<Entry>>{};
    if (folder == nullptr) return because(full, errno);
    const std::unique_ptr<DIR, int (*)(DIR*)> closed(folder, ::closedir);
    std::vector<Entry> entries;
    for (;;) {
      errno = 0;
      const dirent* entry = ::readdir(folder);
      if (entry == nullptr && errno != 0) return because(full, errno);
      if (entry == nullptr) break;
      const std::string name = entry->d_name;
      if (name == "." || name == "..") continue;
      if (entries.size() == max_folder_entries)
        return fail(full.string(), "", "more than " + std::to_string(max_folder_entries) + " entries",
                    "this is not a store's folder, or somebody else writes there");
      struct stat found {};
      if (::fstatat(::dirfd(folder), name.c_str(), &found, AT_SYMLINK_NOFOLLOW) != 0)
        return because(full / name, errno);
      entries.push_back({name, S_ISDIR(found.st_mode), static_cast<std::uint64_t>(found.st_size)});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
    return std::optional(std::move(entries));
  }
  [[nodiscard]] fs::path full_path(const std::string& path) const override {
    return path.empty() ? root_ : root_ / path;
  }

 private:
  [[nodiscard]] Result<void> done(const std::string& path, int code) const {
    if (code != 0) return because(full_path(path), errno);
    return {};
  }

  fs::path root_;
};

}  // namespace

std::unique_ptr<Storage> open_disk(fs::path root) { return std::make_unique<Disk>(std::move(root)); }

Result<std::unique_ptr<Storage::Reader>> open_source(const fs::path& path) { return open_regular(path); }

Result<std::vector<std::uint8_t>> read_source(Storage::Reader& source, std::uint64_t most, const std::string& file) {
  if (source.size() > most)
    return fail(file, "size",
                std::to_string(source.size()) + " bytes, at most " + std::to_string(most) + " are allowed",
                "this is another kind of file");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(source.size()));
  for (std::size_t at = 0; at < bytes.size();) {
    const auto n = source.read(std::span(bytes).subspan(at));
    if (!n) return tl::unexpected(n.error());
    if (*n == 0) return fail(file, "size", "became shorter while it was read", "try again");
    at += *n;
  }
  return bytes;
}

}  // namespace lackwerk::packs
