#include "packs/store.hpp"

#include <gtest/gtest.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>

#include "packs/memory_storage.hpp"
#include "packs/minisign.hpp"
#include "packs/store_state.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

/// A pack as these tests have it: "ID SERIAL" and some ballast.
Bytes pack_of(const std::string& id, std::uint64_t serial, std::size_t ballast = 300'000) {
  const std::string head = id + " " + std::to_string(serial) + "\n";
  Bytes bytes(head.begin(), head.end());
  for (std::size_t k = 0; k < ballast; ++k) bytes.push_back(static_cast<std::uint8_t>(k * 31 + serial));
  return bytes;
}

Result<PackSelf> check_pack(const Bytes& bytes, const std::string& file) {
  const std::string text(bytes.begin(), std::find(bytes.begin(), bytes.end(), std::uint8_t{'\n'}));
  const std::size_t space = text.find(' ');
  if (space == std::string::npos) return fail(file, "magic", "not a pack", "");
  return PackSelf{text.substr(0, space), std::stoull(text.substr(space + 1))};
}

/// A key pair as a key file without a password holds it.
class Maker {
 public:
  Maker() {
    std::array<std::uint8_t, 32> pk{};
    std::array<std::uint8_t, 64> sk{};
    crypto_sign_keypair(pk.data(), sk.data());
    Bytes bytes{'E', 'd', 0, 0, 'B', '2'};
    bytes.resize(54);
    std::array<std::uint8_t, 8> id{};
    randombytes_buf(id.data(), id.size());
    bytes.insert(bytes.end(), id.begin(), id.end());
    bytes.insert(bytes.end(), sk.begin(), sk.end());
    bytes.resize(bytes.size() + 32);
    std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
    sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
    text.pop_back();  // sodium ends it with a zero
    text_ = "untrusted comment: a test\n" + text + "\n";
  }
  [[nodiscard]] SecretKey key() const { return std::move(SecretKey::parse(text_, "", "test.key").value()); }
  [[nodiscard]] Keyring ring() const { return Keyring({key().public_key()}, {}); }
  [[nodiscard]] std::string sign(const Bytes& pack, const std::string& comment) const {
    FileHash hash;
    hash.add(pack);
    return signature_text(key().sign(hash.finish(), comment));
  }
  [[nodiscard]] std::string sign(const Bytes& pack, const std::string& id, std::uint64_t serial) const {
    return sign(pack, trusted_comment(id, serial));
  }

 private:
  std::string text_;
};

Result<Store::AddResult> add(Store& store, const Maker& maker, const std::string& id, std::uint64_t serial) {
  const Bytes pack = pack_of(id, serial);
  const std::string text = maker.sign(pack, id, serial);
  const auto from = MemoryStorage::source(pack);
  const auto signature = MemoryStorage::source({text.begin(), text.end()});
  return store.add(id + ".lwp", *from, signature.get(), maker.ring());
}

/// Everything in the store belongs to what its state names, whole and byte for byte.
void expect_sound(MemoryStorage& storage, const StoreState& state) {
  std::map<std::string, std::vector<std::uint8_t>> files = storage.files();
  files.erase("state");
  for (const StoredPack& pack : state.packs) {
    std::vector<StoredVersion> versions{pack.current};
    if (pack.previous) versions.push_back(*pack.previous);
    for (const StoredVersion& version : versions) {
      const std::string folder = Store::folder_of(pack.id, version) + "/";
      EXPECT_EQ(files[folder + stored_pack_file], pack_of(pack.id, version.serial)) << folder;
      EXPECT_EQ(files.count(folder + stored_signature_file), 1u) << folder;
      files.erase(folder + stored_pack_file);
      files.erase(folder + stored_signature_file);
    }
  }
  for (const auto& [path, bytes] : files) ADD_FAILURE() << "left behind: " << path;
}

class StoreTest : public ::testing::Test {
 protected:
  StoreTest() { EXPECT_GE(sodium_init(), 0); }
  MemoryStorage storage_;
  Maker maker_;
  Store store_{storage_, {}, check_pack};
};

TEST_F(StoreTest, KeepsTheOneInUseAndTheOneBefore) {
  EXPECT_EQ(store_.state().value(), StoreState{});
  for (const std::uint64_t serial : {1u, 4u, 9u}) ASSERT_TRUE(add(store_, maker_, "summer", serial));
  ASSERT_TRUE(add(store_, maker_, "winter", 2));
  const StoreState state = store_.state().value();
  ASSERT_EQ(state.packs.size(), 2u);
  EXPECT_EQ(state.shown, "winter");
  EXPECT_EQ(state.find("summer")->current.serial, 9u);
  EXPECT_EQ(state.find("summer")->previous->serial, 4u);
  EXPECT_FALSE(state.find("winter")->previous);
  expect_sound(storage_, state);
}

TEST_F(StoreTest, ALowerSerialIsRefusedUnlessRolledBackOnPurpose) {
  ASSERT_TRUE(add(store_, maker_, "summer", 4));
  ASSERT_TRUE(add(store_, maker_, "summer", 5));
  EXPECT_FALSE(add(store_, maker_, "summer", 4));
  EXPECT_FALSE(add(store_, maker_, "summer", 3));
  EXPECT_EQ(add(store_, maker_, "summer", 5)->what, Store::Added::already_there);
  EXPECT_EQ(store_.rollback("summer")->current.serial, 4u);
  EXPECT_FALSE(store_.rollback("summer"));
  expect_sound(storage_, store_.state().value());
  EXPECT_TRUE(add(store_, maker_, "summer", 5));
  expect_sound(storage_, store_.state().value());
}

TEST_F(StoreTest, RemoveLeavesNothing) {
  ASSERT_TRUE(add(store_, maker_, "summer", 4));
  ASSERT_TRUE(add(store_, maker_, "winter", 4));
  ASSERT_TRUE(store_.remove("winter"));
  EXPECT_EQ(store_.state()->shown, "summer");
  EXPECT_FALSE(store_.remove("winter"));
  ASSERT_TRUE(store_.remove("summer"));
  EXPECT_EQ(store_.state().value(), StoreState{});
  expect_sound(storage_, store_.state().value());
}

TEST_F(StoreTest, RefusesWhatIsNotSignedForIt) {
  const Bytes pack = pack_of("summer", 3), other = pack_of("summer", 4);
  const auto refused = [&](const Bytes& bytes, const std::optional<std::string>& text, const Keyring& ring) {
    const auto from = MemoryStorage::source(bytes);
    const auto signature = text ? MemoryStorage::source({text->begin(), text->end()}) : nullptr;
    const auto added = store_.add("summer.lwp", *from, signature.get(), ring);
    EXPECT_EQ(store_.state().value(), StoreState{});
    expect_sound(storage_, StoreState{});
    return added ? std::string() : added.error().line();
  };
  const std::string good = maker_.sign(pack, "summer", 3);
  EXPECT_NE(refused(pack, std::nullopt, maker_.ring()).find("not signed"), std::string::npos);
  EXPECT_NE(refused(other, good, maker_.ring()).find("not of this file"), std::string::npos);
  EXPECT_NE(refused(pack, good, Keyring{}).find("not in the keyring"), std::string::npos);
  EXPECT_NE(refused(pack, good, Keyring({maker_.key().public_key()}, {maker_.key().id()})).find("revoked"),
            std::string::npos);
  EXPECT_NE(refused(pack, maker_.sign(pack, "winter", 3), maker_.ring()).find("is for winter 3"), std::string::npos);
  EXPECT_NE(refused(pack, maker_.sign(pack, "summer", 4), maker_.ring()).find("is for summer 4"), std::string::npos);
  EXPECT_NE(refused(pack, maker_.sign(pack, "hello"), maker_.ring()).find("trusted comment"), std::string::npos);
  std::string changed = good;
  changed.replace(changed.find("serial=3"), 8, "serial=9");
  EXPECT_NE(refused(pack, changed, maker_.ring()).find("was changed"), std::string::npos);
}

TEST_F(StoreTest, AnUnsignedPackIsTakenOnlyWhereThatIsAllowedABadSignatureNever) {
  Store store(storage_, {.allow_unsigned = true}, check_pack);
  const Bytes pack = pack_of("summer", 3);
  const auto from = MemoryStorage::source(pack);
  const auto nonsense = MemoryStorage::source({'x'});
  EXPECT_FALSE(store.add("summer.lwp", *from, nonsense.get(), maker_.ring()));
  const auto again = MemoryStorage::source(pack);
  const auto added = store.add("summer.lwp", *again, nullptr, Keyring{});
  ASSERT_TRUE(added);
  EXPECT_FALSE(added->signed_by);
}

TEST_F(StoreTest, TheQuotaHolds) {
  const Bytes pack = pack_of("summer", 1);
  Store store(storage_, {.quota_bytes = 2 * pack.size() + 4096}, check_pack);
  ASSERT_TRUE(add(store, maker_, "summer", 1));
  ASSERT_TRUE(add(store, maker_, "winter", 1));
  const auto refused = add(store, maker_, "spring", 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().line().find("do not fit"), std::string::npos);
  Store small(storage_, {.most_pack_bytes = 1000}, check_pack);
  EXPECT_FALSE(add(small, maker_, "winter", 2));
  expect_sound(storage_, store_.state().value());
}

TEST_F(StoreTest, AFaultySourceChangesNothing) {
  ASSERT_TRUE(add(store_, maker_, "summer", 1));
  const Bytes pack = pack_of("summer", 2);
  const std::string text = maker_.sign(pack, "summer", 2);
  const auto from = MemoryStorage::source(pack, 270'000);
  const auto signature = MemoryStorage::source({text.begin(), text.end()});
  EXPECT_FALSE(store_.add("summer.lwp", *from, signature.get(), maker_.ring()));
  EXPECT_EQ(store_.state()->find("summer")->current.serial, 1u);
  expect_sound(storage_, store_.state().value());
}

/// What is done to a store, and with what state before and after.
struct Cut {
  const char* name;
  std::vector<std::uint64_t> before;  ///< serials of "summer" added first
  std::function<bool(Store&, const Maker&)> act;
};

class StoreCut : public ::testing::TestWithParam<Cut> {};

TEST_P(StoreCut, AtEveryCallLeavesOldOrNewAndNothingElse) {
  ASSERT_GE(sodium_init(), 0);
  const Cut& cut = GetParam();
  const Maker maker;
  const auto prepared = [&] {
    auto storage = std::make_unique<MemoryStorage>();
    Store store(*storage, {}, check_pack);
    for (const std::uint64_t serial : cut.before) EXPECT_TRUE(add(store, maker, "summer", serial));
    return storage->after_power_cut(Leftovers::nothing, 0);
  };
  const auto whole = prepared();
  Store untouched(*whole, {}, check_pack);
  const StoreState old_state = untouched.state().value();
  std::uint64_t calls = whole->calls();
  ASSERT_TRUE(cut.act(untouched, maker));
  calls = whole->calls() - calls;
  const StoreState new_state = untouched.state().value();
  ASSERT_NE(old_state, new_state);

  int cases = 0, olds = 0, news = 0;
  for (std::uint64_t call = 1; call <= calls + 1; ++call) {
    const auto storage = prepared();
    Store store(*storage, {}, check_pack);
    storage->plan(DiskFault::power, call);
    const bool said_done = cut.act(store, maker);
    for (int variant = 0; variant < 10; ++variant) {
      const auto leftovers = variant == 0   ? Leftovers::nothing
                             : variant == 1 ? Leftovers::everything
                                            : Leftovers::chance;
      const auto found = storage->after_power_cut(leftovers, call * 100 + static_cast<std::uint64_t>(variant));
      Store after(*found, {}, check_pack);
      const auto state = after.state();
      ASSERT_TRUE(state) << "call " << call << " variant " << variant << ": " << state.error().line();
      ASSERT_TRUE(*state == old_state || *state == new_state) << "call " << call << " variant " << variant;
      if (said_done) {
        ASSERT_EQ(*state, new_state) << "said to be done, but lost: call " << call;
      }
      (*state == new_state ? news : olds) += 1;
      ++cases;
      // The next change sweeps what the cut left.
      ASSERT_TRUE(add(after, maker, "spring", 1)) << "call " << call << " variant " << variant;
      expect_sound(*found, after.state().value());
    }
  }
  EXPECT_GT(olds, 0);
  EXPECT_GT(news, 0);
  std::printf("  %s: %llu calls, %d cuts, %d found old, %d new\n", cut.name, static_cast<unsigned long long>(calls),
              cases, olds, news);
}

TEST_P(StoreCut, DiskFaultsAtEveryCallLeaveOldOrNew) {
  ASSERT_GE(sodium_init(), 0);
  const Cut& cut = GetParam();
  const Maker maker;
  for (const DiskFault fault : {DiskFault::full, DiskFault::io, DiskFault::read_only}) {
    for (std::uint64_t call = 1; call <= 200; ++call) {
      MemoryStorage storage;
      Store store(storage, {}, check_pack);
      for (const std::uint64_t serial : cut.before) ASSERT_TRUE(add(store, maker, "summer", serial));
      const StoreState old_state = store.state().value();
      storage.plan(fault, call);
      const bool done = cut.act(store, maker);
      storage.plan(DiskFault::none, 0);
      const auto state = store.state();
      ASSERT_TRUE(state);
      if (done) {
        ASSERT_NE(*state, old_state);
      }
      ASSERT_TRUE(add(store, maker, "spring", 1)) << "fault " << static_cast<int>(fault) << " at call " << call;
      expect_sound(storage, store.state().value());
      if (done && call > 60) break;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Changes, StoreCut,
    ::testing::Values(
        Cut{"add_the_first", {}, [](Store& s, const Maker& m) { return add(s, m, "summer", 2).has_value(); }},
        Cut{"add_another", {1, 2}, [](Store& s, const Maker& m) { return add(s, m, "summer", 3).has_value(); }},
        Cut{"rollback", {1, 2}, [](Store& s, const Maker&) { return s.rollback("summer").has_value(); }},
        Cut{"remove", {1, 2}, [](Store& s, const Maker&) { return s.remove("summer").has_value(); }}),
    [](const auto& info) { return info.param.name; });

class DiskStore : public ::testing::Test {
 protected:
  DiskStore() {
    EXPECT_GE(sodium_init(), 0);
    root_ = fs::temp_directory_path() / ("lackwerk-store-" + std::to_string(::getpid()));
    fs::remove_all(root_);
  }
  ~DiskStore() override { fs::remove_all(root_); }
  fs::path root_;
  Maker maker_;
};

TEST_F(DiskStore, EightDealersAtOnce) {
  std::vector<std::thread> dealers;
  for (int k = 0; k < 8; ++k)
    dealers.emplace_back([&, k] {
      const auto disk = open_disk(root_);
      Store store(*disk, {}, check_pack);
      for (std::uint64_t serial = 1; serial <= 3; ++serial) {
        // Somebody else's higher serial may be there already: that is a refusal, not a fault.
        const auto added = add(store, maker_, k < 4 ? "summer" : "own" + std::to_string(k), serial * 10 + k);
        if (!added) {
          EXPECT_EQ(added.error().field, "serial") << added.error().line();
        }
      }
    });
  for (std::thread& dealer : dealers) dealer.join();
  const auto disk = open_disk(root_);
  Store store(*disk, {}, check_pack);
  const StoreState state = store.state().value();
  EXPECT_EQ(state.packs.size(), 5u);
  EXPECT_EQ(state.find("summer")->current.serial, 33u);
  for (const StoredPack& pack : state.packs) {
    auto reader = disk->open(Store::folder_of(pack.id, pack.current) + "/" + stored_pack_file);
    ASSERT_TRUE(reader);
    Bytes bytes((*reader)->size());
    ASSERT_EQ((*reader)->read(bytes).value(), bytes.size());
    EXPECT_EQ(bytes, pack_of(pack.id, pack.current.serial));
  }
}

TEST_F(DiskStore, SourcesAreRegularFilesOnly) {
  fs::create_directories(root_);
  std::ofstream(root_ / "file") << "x";
  fs::create_symlink("file", root_ / "link");
  ASSERT_EQ(::mkfifo((root_ / "fifo").c_str(), 0600), 0);
  EXPECT_TRUE(open_source(root_ / "file"));
  EXPECT_FALSE(open_source(root_ / "link"));
  EXPECT_FALSE(open_source(root_ / "fifo"));
  EXPECT_FALSE(open_source(root_));
  EXPECT_FALSE(open_source(root_ / "nothing"));
}

TEST(StoreStateText, ReadsWhatItWrites) {
  StoreState state;
  EXPECT_EQ(parse_store_state(store_state_text(state), "state").value(), state);
  for (const char* id : {"a", "b"}) {
    StoredPack pack;
    pack.id = id;
    pack.current = {12, "12-0123456789abcdef"};
    state.packs.push_back(pack);
  }
  state.packs.back().previous = StoredVersion{3, "3-0123456789abcdef"};
  state.shown = "b";
  EXPECT_EQ(parse_store_state(store_state_text(state), "state").value(), state);
}

TEST(StoreStateText, RefusesWhatNobodyWrote) {
  const std::string good = "lackwerk-store 1\nshown a\npack a 7-0123456789abcdef -\n";
  ASSERT_TRUE(parse_store_state(good, "state"));
  for (std::size_t length = 0; length < good.size(); ++length) {
    const auto cut = parse_store_state(good.substr(0, length), "state");
    // Without its last line it is an empty store that shows something.
    EXPECT_FALSE(cut && length != std::string("lackwerk-store 1\n").size()) << length;
  }
  for (const char* bad : {"lackwerk-store 2\n", "lackwerk-store 1\nshown ../x\npack ../x 7-0123456789abcdef -\n",
                          "lackwerk-store 1\nshown a\npack a 7-0123456789abcde/ -\n",
                          "lackwerk-store 1\nshown a\npack a 7-0123456789abcdef - x\n",
                          "lackwerk-store 1\nshown b\npack b 7-0123456789abcdef -\npack a 7-0123456789abcdef -\n",
                          "lackwerk-store 1\nshown c\npack a 7-0123456789abcdef -\n"})
    EXPECT_FALSE(parse_store_state(bad, "state")) << bad;
}

}  // namespace
}  // namespace lackwerk::packs
