#include "kiosk/display/import.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "packs/signed_pack.hpp"
#include "packs/storage.hpp"

namespace lackwerk::kiosk {
namespace {

using Outcome = ImportedFile::Outcome;
using Reader = packs::Storage::Reader;

constexpr std::string_view pack_ending = ".lwp", signature_ending = ".minisig";

/// Reads an open regular file, of the size it had.
class FileReader final : public Reader {
 public:
  FileReader(std::string name, int fd, std::uint64_t size) : name_(std::move(name)), fd_(fd), size_(size) {}
  ~FileReader() override { ::close(fd_); }
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] Result<std::size_t> read(std::span<std::uint8_t> into) override {
    for (;;) {
      const ssize_t n = ::read(fd_, into.data(), into.size());
      if (n >= 0) return static_cast<std::size_t>(n);
      if (errno != EINTR)
        return fail(name_, "", std::strerror(errno), "leave the stick in until it is done, or copy it again");
    }
  }

 private:
  std::string name_;
  int fd_;
  std::uint64_t size_;
};

/// Equal but for the case of A to Z: sticks are written by systems that do not tell it apart.
bool same_name(std::string_view one, std::string_view other) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [&](char a, char b) { return small(a) == small(b); });
}

bool is_pack_name(std::string_view name) {
  // Others put their own beside it: "._summer.lwp" and the like.
  return !name.starts_with('.') && name.size() > pack_ending.size() &&
         same_name(name.substr(name.size() - pack_ending.size()), pack_ending);
}

/// An open folder; what is opened in it is not followed anywhere else.
class Folder {
 public:
  explicit Folder(int fd) : folder_(::fdopendir(fd), ::closedir) {
    if (!folder_) ::close(fd);
  }

  /// The names that `wanted` is true for, sorted. Error: of the disk, or too many entries to look through.
  template <class Wanted>
  [[nodiscard]] Result<std::vector<std::string>> names(Wanted wanted) const {
    const auto unreadable = [] { return fail(stick_folder, "", std::strerror(errno), "check the stick"); };
    if (!folder_) return unreadable();
    std::vector<std::string> names;
    for (std::size_t entries = 0;; ++entries) {
      errno = 0;
      const dirent* entry = ::readdir(folder_.get());
      if (entry == nullptr && errno != 0) return unreadable();
      if (entry == nullptr) break;
      if (entries == packs::max_folder_entries)
        return fail(stick_folder, "", "more than " + std::to_string(entries) + " files", "leave only packs in it");
      if (wanted(std::string_view(entry->d_name))) names.emplace_back(entry->d_name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  /// A folder in this one, not through a link; -1 and errno: it cannot be opened.
  [[nodiscard]] int open_folder(const std::string& name) const {
    if (!folder_) return -1;
    return ::openat(::dirfd(folder_.get()), name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  }

  /// A regular file of at most `most` bytes. A link, a pipe or a device of that name is refused and not touched.
  [[nodiscard]] Result<std::unique_ptr<Reader>> open(const std::string& name, std::uint64_t most) const {
    const int fd =
        ::openat(::dirfd(folder_.get()), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0 && errno == ENOENT)
      return fail(name, "", "is not there", "copy the pack and its signature to the stick");
    if (fd < 0 && errno == ELOOP) return fail(name, "", "is a symbolic link", "copy the file itself to the stick");
    if (fd < 0) return fail(name, "", std::strerror(errno), "check the stick");
    struct stat found {};
    const bool is_regular = ::fstat(fd, &found) == 0 && S_ISREG(found.st_mode);
    if (!is_regular || static_cast<std::uint64_t>(found.st_size) > most) {
      ::close(fd);
      if (!is_regular) return fail(name, "", "is not a regular file", "copy the file itself to the stick");
      return fail(name, "size",
                  std::to_string(found.st_size) + " bytes, at most " + std::to_string(most) + " are allowed",
                  "this is another kind of file");
    }
    return std::make_unique<FileReader>(name, fd, static_cast<std::uint64_t>(found.st_size));
  }

 private:
  std::unique_ptr<DIR, int (*)(DIR*)> folder_;
};

/// The stick's one folder, not through a link, however its name is spelled.
Result<Folder> open_stick(const std::filesystem::path& stick) {
  const int root = ::open(stick.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (root < 0) return fail(stick.string(), "", std::strerror(errno), "is the stick mounted?");
  const Folder top(root);
  int fd = top.open_folder(stick_folder);
  if (fd < 0 && errno == ENOENT) {
    // FAT finds LACKWERK by this name too; a file system that tells case apart does not.
    const auto spelled = top.names([](std::string_view name) { return same_name(name, stick_folder); });
    if (spelled && spelled->empty())
      return fail(stick_folder, "", "no such folder on the stick", "put the packs into a folder of this name");
    if (!spelled) return tl::unexpected(spelled.error());
    fd = top.open_folder(spelled->front());
  }
  if (fd < 0) return fail(stick_folder, "", std::strerror(errno), "make it a folder of its own");
  return Folder(fd);
}

Result<packs::Store::AddResult> add(const Folder& folder, const std::string& name, packs::Store& store,
                                    const packs::Keyring& keyring, const ImportLimits& limits) {
  auto pack = folder.open(name, limits.most_pack_bytes);
  if (!pack) return tl::unexpected(pack.error());
  // Whatever the store may take otherwise: from a stick nothing comes in without a signature.
  auto signature = folder.open(name + std::string(signature_ending), packs::max_minisig_bytes);
  if (!signature) return tl::unexpected(signature.error());
  return store.add(name, **pack, signature->get(), keyring);
}

std::int64_t now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Names are whatever a stick says: on one line, and nothing that a terminal obeys.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

}  // namespace

ImportReport import_folder(const std::filesystem::path& stick, packs::Store& store, const packs::Keyring& keyring,
                           const ImportLimits& limits) {
  ImportReport report;
  report.time_s = now_s();
  const auto stop = [&](const Error& why) {
    report.error = on_one_line(why.line());
    return report;
  };
  const auto folder = open_stick(stick);
  if (!folder) return stop(folder.error());
  auto names = folder->names(is_pack_name);
  if (!names) return stop(names.error());
  if (names->empty()) return stop({stick_folder, "", "no packs (*.lwp) in it", "copy packs and signatures there"});
  if (names->size() > limits.most_packs) {
    report.error = std::to_string(names->size()) + " packs on the stick; the first " +
                   std::to_string(limits.most_packs) + " by name were looked at";
    names->resize(limits.most_packs);
  }
  for (const std::string& name : *names) {
    ImportedFile& file = report.files.emplace_back();
    file.file = name;
    const auto added = add(*folder, name, store, keyring, limits);
    if (!added) {
      file.error = on_one_line(added.error().line());
      continue;
    }
    file.outcome = added->what == packs::Store::Added::stored ? Outcome::stored : Outcome::already_there;
    file.id = added->pack.id;
    file.serial = added->pack.current.serial;
    if (added->signed_by) file.key = packs::key_id_text(*added->signed_by);
  }
  return report;
}

std::string import_lines(const ImportReport& report) {
  std::string lines;
  for (const ImportedFile& file : report.files)
    lines += file.outcome == Outcome::refused
                 ? "refused: " + file.error + "\n"
                 : on_one_line(file.file) + ": " + file.id + " " + std::to_string(file.serial) + " is " +
                       (file.outcome == Outcome::stored ? "in use now" : "there already") + ", key " + file.key + "\n";
  if (!report.error.empty()) lines += report.error + "\n";
  return lines;
}

Result<bool> import_stick(const ImportPlaces& places) {
  const auto disk = packs::open_disk(places.store);
  packs::Store store(*disk, {}, packs::check_pack);
  const auto keyring = packs::Keyring::open(places.keyring);
  ImportReport report;
  if (keyring) {
    report = import_folder(places.stick, store, *keyring, {});
  } else {
    report.time_s = now_s();
    report.error = on_one_line(keyring.error().line());
  }
  std::fputs(import_lines(report).c_str(), stdout);
  if (auto written = write_import(places.report, report); !written) return tl::unexpected(written.error());
  return report.is_good();
}

}  // namespace lackwerk::kiosk
