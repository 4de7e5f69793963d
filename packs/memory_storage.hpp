// A disk in memory that can lose what was not synced: the store's storage in tests.
//
// Why it exists: a power cut at any call, with any part of the unsynced writes lost, cannot be staged on a real disk.
// It is stricter than a file system: names that were made, renamed or removed last only from the sync of their folder
// on, one by one, and content only from the sync of its file on. Owns everything; one thread.
#pragma once

#include <map>
#include <random>

#include "packs/storage.hpp"

namespace lackwerk::packs {

/// What one call is to meet.
enum class DiskFault {
  none,
  power,      ///< from this call on nothing works; a write under way is half done
  full,       ///< no space left, for this call and all later writes
  io,         ///< this call only
  read_only,  ///< from this call on nothing can be changed
};

/// What a power cut leaves of what was not synced.
enum class Leftovers { nothing, everything, chance };

class MemoryStorage final : public Storage {
 public:
  MemoryStorage() = default;

  /// The `call`-th call from now on (1 is the next) meets this.
  void plan(DiskFault fault, std::uint64_t call);
  /// Calls since it was made.
  [[nodiscard]] std::uint64_t calls() const { return calls_; }
  /// A disk as it is found after the power came back. `seed`: of Leftovers::chance.
  [[nodiscard]] std::unique_ptr<MemoryStorage> after_power_cut(Leftovers leftovers, std::uint64_t seed) const;
  /// Every file's path and content, for comparing.
  [[nodiscard]] std::map<std::string, std::vector<std::uint8_t>> files() const;
  /// A reader of bytes, as a source.
  [[nodiscard]] static std::unique_ptr<Reader> source(std::vector<std::uint8_t> bytes, std::size_t fails_at = SIZE_MAX);

  [[nodiscard]] Result<std::unique_ptr<Lock>> lock() override;
  [[nodiscard]] Result<std::unique_ptr<Reader>> open(const std::string& path) override;
  [[nodiscard]] Result<std::unique_ptr<Writer>> create(const std::string& path) override;
  [[nodiscard]] Result<void> make_folder(const std::string& path) override;
  [[nodiscard]] Result<void> sync_folder(const std::string& path) override;
  [[nodiscard]] Result<void> rename(const std::string& from, const std::string& to) override;
  [[nodiscard]] Result<void> remove_file(const std::string& path) override;
  [[nodiscard]] Result<void> remove_folder(const std::string& path) override;
  [[nodiscard]] Result<std::optional<std::vector<Entry>>> list(const std::string& path) override;
  [[nodiscard]] std::filesystem::path full_path(const std::string& path) const override;

 private:
  friend class MemoryWriter;
  struct Content {
    std::vector<std::uint8_t> now, synced;
  };
  /// A folder has no content.
  using Tree = std::map<std::string, std::shared_ptr<Content>>;
  struct Change {
    enum class Kind { put, move, drop } kind = Kind::put;
    std::string path, to;
    std::shared_ptr<Content> content;
    bool synced = false;
  };

  static bool apply(Tree& tree, const Change& change);
  [[nodiscard]] Result<void> meet(const std::string& path, bool changes);
  [[nodiscard]] Result<void> change(Change change);

  Tree tree_;
  Tree base_;  ///< as it was found
  std::vector<Change> changes_;
  std::uint64_t calls_ = 0, fault_at_ = 0;
  DiskFault fault_ = DiskFault::none;
};

}  // namespace lackwerk::packs
