// What the store costs a dealer: `add` besides fsync, and from a signed file to a pack that can be drawn.
// Usage: store_bench PACK [RUNS]
//
// Syncing is left out of `add`, for it measures the disk and not this program; it is timed beside it. Medians with
// their counts.
#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "packs/signed_pack.hpp"

namespace {

using namespace lackwerk;
namespace fs = std::filesystem;

/// A disk whose syncs are not waited for.
class Unsynced final : public packs::Storage {
 public:
  explicit Unsynced(Storage& disk) : disk_(disk) {}
  Result<std::unique_ptr<Lock>> lock() override { return disk_.lock(); }
  Result<std::unique_ptr<Reader>> open(const std::string& path) override { return disk_.open(path); }
  Result<std::unique_ptr<Writer>> create(const std::string& path) override {
    auto writer = disk_.create(path);
    if (!writer) return tl::unexpected(writer.error());
    return std::make_unique<UnsyncedWriter>(std::move(*writer));
  }
  Result<void> make_folder(const std::string& path) override { return disk_.make_folder(path); }
  Result<void> sync_folder(const std::string& /*path*/) override { return {}; }
  Result<void> rename(const std::string& from, const std::string& to) override { return disk_.rename(from, to); }
  Result<void> remove_file(const std::string& path) override { return disk_.remove_file(path); }
  Result<void> remove_folder(const std::string& path) override { return disk_.remove_folder(path); }
  Result<std::optional<std::vector<Entry>>> list(const std::string& path) override { return disk_.list(path); }
  [[nodiscard]] fs::path full_path(const std::string& path) const override { return disk_.full_path(path); }

 private:
  class UnsyncedWriter final : public Writer {
   public:
    explicit UnsyncedWriter(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}
    Result<void> write(std::span<const std::uint8_t> bytes) override { return writer_->write(bytes); }
    Result<void> sync() override { return {}; }

   private:
    std::unique_ptr<Writer> writer_;
  };
  Storage& disk_;
};

[[noreturn]] void give_up(const Error& error) {
  std::fprintf(stderr, "store_bench: %s\n", error.line().c_str());
  std::exit(1);
}

/// Signs `pack` with a key of its own; returns the ring that trusts it.
packs::Keyring sign(const fs::path& pack) {
  if (sodium_init() < 0) give_up({"", "", "libsodium does not start", ""});
  std::array<std::uint8_t, 32> open{};
  std::array<std::uint8_t, 64> secret{};
  crypto_sign_keypair(open.data(), secret.data());
  std::vector<std::uint8_t> bytes{'E', 'd', 0, 0, 'B', '2'};
  bytes.resize(62);
  bytes.insert(bytes.end(), secret.begin(), secret.end());
  bytes.resize(bytes.size() + 32);
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  const auto key = packs::SecretKey::parse(text.c_str(), "", "bench.key");
  if (!key) give_up(key.error());
  auto source = packs::open_source(pack);
  if (!source) give_up(source.error());
  auto content = packs::read_source(**source, packs::max_paint_pack_bytes, pack.string());
  if (!content) give_up(content.error());
  packs::FileHash hash;
  hash.add(*content);
  const auto self = packs::check_pack(std::move(*content), pack.string());
  if (!self) give_up(self.error());
  std::ofstream(packs::signature_path(pack))
      << packs::signature_text(key->sign(hash.finish(), packs::trusted_comment(self->id, self->serial)));
  return packs::Keyring({key->public_key()}, {});
}

void add(packs::Storage& storage, const fs::path& pack, const packs::Keyring& ring) {
  packs::Store store(storage, {}, packs::check_pack);
  auto source = packs::open_source(pack), signature = packs::open_source(packs::signature_path(pack));
  if (!source) give_up(source.error());
  if (!signature) give_up(signature.error());
  const auto added = store.add(pack.string(), **source, signature->get(), ring);
  if (!added) give_up(added.error());
}

void timed(const char* name, double limit_ms, int runs, const std::function<void()>& before,
           const std::function<void()>& act) {
  std::vector<double> times_ms;
  for (int k = 0; k < runs; ++k) {
    before();
    const auto start = std::chrono::steady_clock::now();
    act();
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times_ms.begin(), times_ms.end());
  const double median = times_ms[times_ms.size() / 2];
  std::printf("%-34s median %.1f ms of %d (%.1f to %.1f)", name, median, runs, times_ms.front(), times_ms.back());
  if (limit_ms > 0.0) std::printf(", limit %.0f ms: %s", limit_ms, median <= limit_ms ? "reached" : "MISSED");
  std::printf("\n");
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    std::fprintf(stderr, "usage: store_bench PACK [RUNS]\n");
    return 2;
  }
  const int runs = count > 2 ? std::max(1, std::atoi(words[2])) : 21;
  const fs::path folder = fs::temp_directory_path() / ("lackwerk-store-bench-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const fs::path pack = folder / "p.lwp", root = folder / "store";
  fs::copy_file(words[1], pack);
  const packs::Keyring ring = sign(pack);
  std::printf("pack of %.2f MB\n", static_cast<double>(fs::file_size(pack)) * 1e-6);
  const auto disk = packs::open_disk(root);
  Unsynced unsynced(*disk);
  const auto empty = [&] { fs::remove_all(root); };
  timed("store add, besides fsync", 500.0, runs, empty, [&] { add(unsynced, pack, ring); });
  timed("store add, with fsync", 0.0, runs, empty, [&] { add(*disk, pack, ring); });
  timed(
      "signed file to usable pack", 20.0, runs, [] {},
      [&] {
        const auto opened = packs::open_signed_pack(pack, ring, false);
        if (!opened) give_up(opened.error());
      });
  fs::remove_all(folder);
  return 0;
}
