// The disk under the store, as the few calls the store makes of it.
//
// Why it exists: "survives a power cut at any instruction" can only be tested where every call can be the last one and
// what was not synced can be lost. Paths are relative to the root, parts joined by '/', none of them "." or "..".
// Whoever makes a storage owns it; one thread at a time, several processes on the same root.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// Longer lists are refused: a store's folders hold some tens of entries.
inline constexpr std::size_t max_folder_entries = 4096;

class Storage {
 public:
  /// Reads a file piece by piece. Closed when it goes.
  class Reader {
   public:
    virtual ~Reader() = default;
    [[nodiscard]] virtual std::uint64_t size() const = 0;
    /// Up to `into`'s size; 0 at the end.
    [[nodiscard]] virtual Result<std::size_t> read(std::span<std::uint8_t> into) = 0;
  };
  class Writer {
   public:
    virtual ~Writer() = default;
    [[nodiscard]] virtual Result<void> write(std::span<const std::uint8_t> bytes) = 0;
    /// On the medium, not in a cache; then closed. Nothing may be written after it.
    [[nodiscard]] virtual Result<void> sync() = 0;
  };
  struct Entry {
    std::string name;
    bool folder = false;
    std::uint64_t bytes = 0;
  };
  /// Held as long as it lives; nobody else changes the store meanwhile.
  class Lock {
   public:
    virtual ~Lock() = default;
  };

  virtual ~Storage() = default;
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;

  /// Waits for another process to be done. Makes the root.
  [[nodiscard]] virtual Result<std::unique_ptr<Lock>> lock() = 0;
  /// A regular file, not through a symbolic link.
  [[nodiscard]] virtual Result<std::unique_ptr<Reader>> open(const std::string& path) = 0;
  /// A new file; one that is there already is an error.
  [[nodiscard]] virtual Result<std::unique_ptr<Writer>> create(const std::string& path) = 0;
  /// Error if it is there already.
  [[nodiscard]] virtual Result<void> make_folder(const std::string& path) = 0;
  [[nodiscard]] virtual Result<void> sync_folder(const std::string& path) = 0;
  /// A file over a file, or a folder to where nothing is. Atomic.
  [[nodiscard]] virtual Result<void> rename(const std::string& from, const std::string& to) = 0;
  [[nodiscard]] virtual Result<void> remove_file(const std::string& path) = 0;
  /// An empty one.
  [[nodiscard]] virtual Result<void> remove_folder(const std::string& path) = 0;
  /// What is in a folder, by name; nothing where there is no such folder.
  [[nodiscard]] virtual Result<std::optional<std::vector<Entry>>> list(const std::string& path) = 0;
  /// For messages and for opening what is there by other means.
  [[nodiscard]] virtual std::filesystem::path full_path(const std::string& path) const = 0;

 protected:
  Storage() = default;
};

/// The real one, below `root`.
[[nodiscard]] std::unique_ptr<Storage> open_disk(std::filesystem::path root);
/// A file anywhere, as a source of what is to be stored: regular, not through a symbolic link.
[[nodiscard]] Result<std::unique_ptr<Storage::Reader>> open_source(const std::filesystem::path& path);

/// Reads a source to its end. Errors: more than `most` bytes (before memory is taken), or a fault of the source.
/// `file` is for the errors.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_source(Storage::Reader& source, std::uint64_t most,
                                                            const std::string& file);

}  // namespace lackwerk::packs
