#include "packs/sealed_file.hpp"

#include <fcntl.h>
#include <sodium.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace lackwerk::packs {
namespace {

static_assert(std::endian::native == std::endian::little, "packs are little-endian and are used as they lie in memory");

// Byte offsets of the header's fields.
constexpr std::size_t at_version = 8, at_kind = 12, at_payload_bytes = 16, at_reserved = 24, at_digest = 32;
constexpr std::string_view magic{"LACKWERK", 8};

struct KindWords {
  SealedKind kind;
  std::string_view code, name;
};
constexpr std::array<KindWords, 3> kinds = {{{SealedKind::paint, "LWPP", "paint pack"},
                                             {SealedKind::scene, "LWSC", "scene pack"},
                                             {SealedKind::scan, "LWSN", "scan pack"}}};
static_assert(kinds[static_cast<std::size_t>(SealedKind::scan)].kind == SealedKind::scan);

std::string_view kind_code(SealedKind kind) { return kinds[static_cast<std::size_t>(kind)].code; }
std::string_view kind_name(SealedKind kind) { return kinds[static_cast<std::size_t>(kind)].name; }

std::string reason() { return std::strerror(errno); }

template <class T>
T read_le(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Closes a file descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  /// Closes now and says whether the kernel reported a late write error.
  [[nodiscard]] bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

bool read_all(int fd, std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::read(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      if (n == 0) errno = EIO;  // the file shrank while we read it
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

Result<void> check_size(std::uint64_t size, SealedKind kind, const std::string& file) {
  if (size <= sealed_header_bytes)
    return fail(file, "size", std::to_string(size) + " bytes are too few for a pack",
                "the copy is cut short: copy it again");
  if (size > max_file_bytes(kind))
    return fail(file, "size",
                std::to_string(size) + " bytes; a " + std::string(kind_name(kind)) + " has at most " +
                    std::to_string(max_file_bytes(kind)),
                "build a smaller pack");
  return {};
}

Result<void> check_header(std::span<const std::uint8_t> bytes, SealedKind kind, const std::string& file) {
  const std::uint8_t* p = bytes.data();
  if (std::memcmp(p, magic.data(), magic.size()) != 0)
    return fail(file, "magic", "not a Lackwerk pack", "choose a file made by `lackwerk pack build` or `scene build`");
  const auto version = read_le<std::uint32_t>(p + at_version);
  if (version != sealed_format_version)
    return fail(file, "format_version", "container version " + std::to_string(version) + " is not known here",
                "update this program or make the pack again");
  if (std::memcmp(p + at_kind, kind_code(kind).data(), 4) != 0)
    return fail(file, "kind", "not a " + std::string(kind_name(kind)),
                "scene packs end in .lws, paint and scan packs in .lwp");
  const auto payload_bytes = read_le<std::uint64_t>(p + at_payload_bytes);
  const std::uint64_t present = bytes.size() - sealed_header_bytes;
  if (payload_bytes != present)
    return fail(file, "payload_bytes",
                std::to_string(payload_bytes) + " bytes announced, " + std::to_string(present) + " present",
                "the copy is cut short or longer than it should be: copy it again");
  if (std::any_of(p + at_reserved, p + at_digest, [](std::uint8_t b) { return b != 0; }))
    return fail(file, "reserved", "must be zero", "the file is damaged: copy it again");
  const Digest digest = digest_of(bytes.subspan(sealed_header_bytes));
  if (std::memcmp(digest.data(), p + at_digest, digest.size()) != 0)
    return fail(file, "digest", "the content does not match its BLAKE2b-256", "the file is damaged: copy it again");
  return {};
}

}  // namespace

Digest digest_of(std::span<const std::uint8_t> bytes) {
  Digest out{};
  // Idempotent and thread-safe; it picks the fastest code for this CPU. Hashing works (slower) should it fail.
  [[maybe_unused]] const int ready = sodium_init();
  crypto_generichash(out.data(), out.size(), bytes.data(), bytes.size(), nullptr, 0);
  return out;
}

std::optional<SealedKind> sealed_kind_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < sealed_header_bytes || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0) return {};
  for (const KindWords& known : kinds)
    if (std::memcmp(bytes.data() + at_kind, known.code.data(), known.code.size()) == 0) return known.kind;
  return {};
}

std::optional<SealedKind> sealed_kind_of(const std::filesystem::path& path) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  std::array<std::uint8_t, sealed_header_bytes> header{};
  if (fd.get() < 0 || !read_all(fd.get(), header)) return {};
  return sealed_kind_of(header);
}

SealedFile::SealedFile(SealedFile&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})),
      mapping_(std::exchange(other.mapping_, nullptr)),
      copy_(std::move(other.copy_)) {}

SealedFile& SealedFile::operator=(SealedFile&& other) noexcept {
  // Swapped: what this object held goes when `other` does.
  std::swap(bytes_, other.bytes_);
  std::swap(mapping_, other.mapping_);
  std::swap(copy_, other.copy_);
  return *this;
}

SealedFile::~SealedFile() {
  if (mapping_ != nullptr) ::munmap(mapping_, bytes_.size());
}

Result<void> SealedFile::load(int descriptor, std::size_t size, Backing backing, const std::string& file) {
  if (backing == Backing::copy) {
    copy_.resize(size);
    if (!read_all(descriptor, copy_)) return fail(file, "", "cannot be read: " + reason(), "copy the file again");
    bytes_ = copy_;
    return {};
  }
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (address == MAP_FAILED) return fail(file, "", "cannot be mapped: " + reason(), "check the file system");
  mapping_ = address;
  bytes_ = {static_cast<const std::uint8_t*>(address), size};
  return {};
}

Result<SealedFile> SealedFile::open(const std::filesystem::path& path, SealedKind kind, Backing backing) {
  const std::string file = path.string();
  // O_NONBLOCK: a FIFO put where a pack should be must not stop the kiosk.
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) return fail(file, "", "cannot be opened: " + reason(), "check the path and its permissions");
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode))
    return fail(file, "", "is not a regular file", "give the path of a pack file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (auto sized = check_size(size, kind, file); !sized) return tl::unexpected(sized.error());
  SealedFile out;
  if (auto loaded = out.load(fd.get(), static_cast<std::size_t>(size), backing, file); !loaded)
    return tl::unexpected(loaded.error());
  if (auto checked = check_header(out.bytes_, kind, file); !checked) return tl::unexpected(checked.error());
  return out;
}

Result<SealedFile> SealedFile::from_bytes(std::vector<std::uint8_t> bytes, SealedKind kind, const std::string& file) {
  if (auto sized = check_size(bytes.size(), kind, file); !sized) return tl::unexpected(sized.error());
  SealedFile out;
  out.copy_ = std::move(bytes);
  out.bytes_ = out.copy_;
  if (auto checked = check_header(out.bytes_, kind, file); !checked) return tl::unexpected(checked.error());
  return out;
}

Result<void> write_sealed_file(const std::filesystem::path& path, SealedKind kind,
                               std::span<const std::uint8_t> payload) {
  const std::string file = path.string();
  if (payload.empty() || payload.size() > max_file_bytes(kind) - sealed_header_bytes)
    return fail(file, "size",
                std::to_string(payload.size()) + " bytes of payload; a " + std::string(kind_name(kind)) +
                    " has at most " + std::to_string(max_file_bytes(kind) - sealed_header_bytes),
                "put fewer or smaller things in");

  std::array<std::uint8_t, sealed_header_bytes> header{};
  const std::uint32_t version = sealed_format_version;
  const std::uint64_t payload_bytes = payload.size();
  const Digest digest = digest_of(payload);
  std::memcpy(header.data(), magic.data(), magic.size());
  std::memcpy(header.data() + at_version, &version, sizeof version);
  std::memcpy(header.data() + at_kind, kind_code(kind).data(), 4);
  std::memcpy(header.data() + at_payload_bytes, &payload_bytes, sizeof payload_bytes);
  std::memcpy(header.data() + at_digest, digest.data(), digest.size());

  // O_EXCL and a name of our own: two builders never write into the same temporary file, and no link is followed.
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::filesystem::path temporary;
  int raw = -1;
  for (int attempt = 0; attempt < 16 && raw < 0; ++attempt) {
    temporary = folder / ("." + path.filename().string() + "." + std::to_string(::getpid()) + "-" +
                          std::to_string(attempt) + ".tmp");
    raw = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (raw < 0 && errno != EEXIST) break;
  }
  Descriptor fd(raw);
  if (raw < 0) return fail(file, "", "cannot be written: " + reason(), "check that the folder exists and is writable");
  if (!write_all(raw, header) || !write_all(raw, payload) || ::fsync(raw) != 0 || !fd.close() ||
      ::rename(temporary.c_str(), path.c_str()) != 0) {
    const std::string why = reason();
    ::unlink(temporary.c_str());
    return fail(file, "", "cannot be written: " + why, "check free space and permissions");
  }
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0 || ::fsync(directory.get()) != 0)
    return fail(file, "", "is written, but its folder cannot be synced: " + reason(), "check the file system");
  return {};
}

}  // namespace lackwerk::packs
