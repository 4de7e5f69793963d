#include "packs/memory_storage.hpp"

#include <algorithm>

namespace lackwerk::packs {
namespace {

std::string parent_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

tl::unexpected<Error> no_entry(const std::string& path) { return fail(path, "", "no such file or folder", ""); }

class MemoryReader final : public Storage::Reader {
 public:
  MemoryReader(std::vector<std::uint8_t> bytes, std::size_t fails_at) : bytes_(std::move(bytes)), fails_at_(fails_at) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] Result<std::size_t> read(std::span<std::uint8_t> into) override {
    const std::size_t count = std::min(into.size(), bytes_.size() - at_);
    if (at_ + count > fails_at_) return fail("", "", "input/output error", "check the disk");
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), count, into.begin());
    at_ += count;
    return count;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0, fails_at_;
};

}  // namespace

class MemoryWriter final : public Storage::Writer {
 public:
  MemoryWriter(MemoryStorage& storage, std::string path, std::shared_ptr<MemoryStorage::Content> content)
      : storage_(storage), path_(std::move(path)), content_(std::move(content)) {}
  [[nodiscard]] Result<void> write(std::span<const std::uint8_t> bytes) override {
    auto met = storage_.meet(path_, true);
    if (!met) bytes = bytes.first(bytes.size() / 2);
    content_->now.insert(content_->now.end(), bytes.begin(), bytes.end());
    return met;
  }
  [[nodiscard]] Result<void> sync() override {
    if (auto met = storage_.meet(path_, true); !met) return met;
    content_->synced = content_->now;
    return {};
  }

 private:
  MemoryStorage& storage_;
  std::string path_;
  std::shared_ptr<MemoryStorage::Content> content_;
};

void MemoryStorage::plan(DiskFault fault, std::uint64_t call) {
  fault_ = fault;
  fault_at_ = calls_ + call;
}

Result<void> MemoryStorage::meet(const std::string& path, bool changes) {
  ++calls_;
  if (fault_ == DiskFault::none || calls_ < fault_at_) return {};
  switch (fault_) {
    case DiskFault::power:
      return fail(path, "", "the power is off", "");
    case DiskFault::io:
      if (calls_ == fault_at_) return fail(path, "", "input/output error", "check the disk");
      break;
    case DiskFault::full:
      if (changes) return fail(path, "", "no space left on the disk", "make room on the disk");
      break;
    case DiskFault::read_only:
      if (changes) return fail(path, "", "read-only file system", "choose a root on a disk that can be written");
      break;
    case DiskFault::none:
      break;
  }
  return {};
}

bool MemoryStorage::apply(Tree& tree, const Change& change) {
  const auto has_folder = [&](const std::string& path) {
    if (path.empty()) return true;
    const auto found = tree.find(path);
    return found != tree.end() && found->second == nullptr;
  };
  const auto below = [](const std::string& path, const std::string& folder) {
    return path.size() > folder.size() && path.compare(0, folder.size(), folder) == 0 && path[folder.size()] == '/';
  };
  switch (change.kind) {
    case Change::Kind::put:
      if (!has_folder(parent_of(change.path)) || tree.count(change.path) != 0) return false;
      tree[change.path] = change.content;
      return true;
    case Change::Kind::drop: {
      const auto found = tree.find(change.path);
      if (found == tree.end()) return false;
      if (std::any_of(tree.begin(), tree.end(), [&](const auto& e) { return below(e.first, change.path); }))
        return false;
      tree.erase(found);
      return true;
    }
    case Change::Kind::move: {
      const auto found = tree.find(change.path);
      if (found == tree.end() || !has_folder(parent_of(change.to))) return false;
      const auto target = tree.find(change.to);
      if (target != tree.end() && (target->second == nullptr || found->second == nullptr)) return false;
      Tree moved;
      for (const auto& [path, content] : tree) {
        if (path == change.to) continue;
        if (path == change.path || below(path, change.path))
          moved[change.to + path.substr(change.path.size())] = content;
        else
          moved[path] = content;
      }
      tree = std::move(moved);
      return true;
    }
  }
  return false;
}

Result<void> MemoryStorage::change(Change change) {
  if (auto met = meet(change.path, true); !met) return met;
  if (!apply(tree_, change)) return fail(change.path, "", "not possible here", "");
  changes_.push_back(std::move(change));
  return {};
}

std::unique_ptr<MemoryStorage> MemoryStorage::after_power_cut(Leftovers leftovers, std::uint64_t seed) const {
  std::mt19937_64 random(seed);
  const auto kept = [&](bool synced) {
    return synced || leftovers == Leftovers::everything || (leftovers == Leftovers::chance && (random() & 1u) != 0);
  };
  Tree tree = base_;
  for (const Change& change : changes_)
    if (kept(change.synced)) apply(tree, change);
  auto found = std::make_unique<MemoryStorage>();
  for (auto& [path, content] : tree) {
    if (content == nullptr) {
      found->base_[path] = nullptr;
      continue;
    }
    auto left = std::make_shared<Content>();
    // Of what was not synced there may be all, nothing, or a part with the rest unwritten.
    left->now = kept(false) ? content->now : content->synced;
    if (leftovers == Leftovers::chance && content->now != content->synced && (random() & 1u) != 0)
      std::fill(left->now.begin() + static_cast<std::ptrdiff_t>(left->now.size() / 3), left->now.end(),
                std::uint8_t{0});
    left->synced = left->now;
    found->base_[path] = left;
  }
  found->tree_ = found->base_;
  return found;
}

std::map<std::string, std::vector<std::uint8_t>> MemoryStorage::files() const {
  std::map<std::string, std::vector<std::uint8_t>> out;
  for (const auto& [path, content] : tree_)
    if (content != nullptr) out[path] = content->now;
  return out;
}

std::unique_ptr<Storage::Reader> MemoryStorage::source(std::vector<std::uint8_t> bytes, std::size_t fails_at) {
  return std::make_unique<MemoryReader>(std::move(bytes), fails_at);
}

Result<std::unique_ptr<Storage::Lock>> MemoryStorage::lock() {
  if (auto met = meet("lock", true); !met) return tl::unexpected(met.error());
  return std::make_unique<Lock>();
}

Result<std::unique_ptr<Storage::Reader>> MemoryStorage::open(const std::string& path) {
  if (auto met = meet(path, false); !met) return tl::unexpected(met.error());
  const auto found = tree_.find(path);
  if (found == tree_.end() || found->second == nullptr) return no_entry(path);
  return std::make_unique<MemoryReader>(found->second->now, SIZE_MAX);
}

Result<std::unique_ptr<Storage::Writer>> MemoryStorage::create(const std::string& path) {
  auto content = std::make_shared<Content>();
  if (auto made = change({Change::Kind::put, path, {}, content, false}); !made) return tl::unexpected(made.error());
  return std::make_unique<MemoryWriter>(*this, path, content);
}

Result<void> MemoryStorage::make_folder(const std::string& path) {
  return change({Change::Kind::put, path, {}, nullptr, false});
}

Result<void> MemoryStorage::sync_folder(const std::string& path) {
  if (auto met = meet(path, true); !met) return met;
  for (Change& change : changes_) {
    const std::string& named = change.kind == Change::Kind::move ? change.to : change.path;
    if (parent_of(named) == path) change.synced = true;
  }
  return {};
}

Result<void> MemoryStorage::rename(const std::string& from, const std::string& to) {
  return change({Change::Kind::move, from, to, nullptr, false});
}

Result<void> MemoryStorage::remove_file(const std::string& path) {
  return change({Change::Kind::drop, path, {}, nullptr, false});
}

Result<void> MemoryStorage::remove_folder(const std::string& path) {
  return change({Change::Kind::drop, path, {}, nullptr, false});
}

Result<std::optional<std::vector<Storage::Entry>>> MemoryStorage::list(const std::string& path) {
  if (auto met = meet(path, false); !met) return tl::unexpected(met.error());
  const auto folder = tree_.find(path);
  if (!path.empty() && folder == tree_.end()) return std::optional<std::vector<Entry>>{};
  if (!path.empty() && folder->second != nullptr) return fail(path, "", "not a folder", "");
  std::vector<Entry> entries;
  for (const auto& [name, content] : tree_)
    if (parent_of(name) == path)
      entries.push_back({name.substr(path.empty() ? 0 : path.size() + 1), content == nullptr,
                         content == nullptr ? 0 : content->now.size()});
  return std::optional(std::move(entries));
}

std::filesystem::path MemoryStorage::full_path(const std::string& path) const { return "memory:" + path; }

}  // namespace lackwerk::packs
