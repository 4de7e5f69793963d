#include "kiosk/display/import.hpp"

#include <gtest/gtest.h>
#include <sodium.h>
#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "packs/memory_storage.hpp"
#include "packs/signed_pack.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::kiosk {
namespace {

namespace fs = std::filesystem;
using Outcome = ImportedFile::Outcome;
using Bytes = std::vector<std::uint8_t>;

/// A key pair as a key file without a password holds it.
packs::SecretKey make_key() {
  EXPECT_GE(sodium_init(), 0);
  std::array<std::uint8_t, 32> open{};
  std::array<std::uint8_t, 64> secret{};
  crypto_sign_keypair(open.data(), secret.data());
  Bytes bytes{'E', 'd', 0, 0, 'B', '2'};
  bytes.resize(54 + 8);
  randombytes_buf(bytes.data() + 54, 8);
  bytes.insert(bytes.end(), secret.begin(), secret.end());
  bytes.resize(bytes.size() + 32);
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  return std::move(packs::SecretKey::parse(text.c_str(), "", "test.key").value());
}

class Import : public ::testing::Test {
 protected:
  Import() { fs::create_directories(folder()); }
  [[nodiscard]] fs::path folder() const { return stick_ / stick_folder; }
  [[nodiscard]] static Bytes pack_of(const std::string& id, std::uint64_t serial) {
    const testing::TemporaryFolder temporary;
    testing::SamplePack sample(1);
    sample.contents.info.id = id;
    sample.contents.info.serial = serial;
    EXPECT_TRUE(packs::write_paint_pack(temporary / "p.lwp", sample.contents));
    const std::vector<char> bytes = testing::read_bytes(temporary / "p.lwp");
    return {bytes.begin(), bytes.end()};
  }
  static void put(const fs::path& path, std::string_view text) { testing::write_bytes(path, text.data(), text.size()); }
  /// Pack and signature, as a dealer's stick has them.
  void put_pack(const std::string& name, const std::string& id, std::uint64_t serial) {
    const Bytes pack = pack_of(id, serial);
    put(folder() / name, {reinterpret_cast<const char*>(pack.data()), pack.size()});
    packs::FileHash hash;
    hash.add(pack);
    put(packs::signature_path(folder() / name),
        packs::signature_text(key_.sign(hash.finish(), packs::trusted_comment(id, serial))));
  }
  ImportReport take(const ImportLimits& limits = {}) {
    return import_folder(stick_.path(), store_, packs::Keyring({key_.public_key()}, {}), limits);
  }
  /// The one file's refusal.
  std::string refusal(const ImportLimits& limits = {}) {
    const ImportReport report = take(limits);
    EXPECT_EQ(report.files.size(), 1u) << report.error;
    EXPECT_FALSE(report.is_good());
    EXPECT_EQ(store_.state().value(), packs::StoreState{});
    return report.files.empty() ? "" : report.files[0].error;
  }

  testing::TemporaryFolder stick_;
  packs::SecretKey key_ = make_key();
  packs::MemoryStorage storage_;
  packs::Store store_{storage_, {}, packs::check_pack};
};

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST_F(Import, TakesSignedPacksByName) {
  put_pack("b summer.lwp", "summer", 5);
  put_pack("a.lwp", "winter", 7);
  put(folder() / "readme.txt", "not looked at");
  put(folder() / "._a.lwp", "a Mac was here");
  const ImportReport report = take();
  ASSERT_EQ(report.files.size(), 2u) << report.error;
  EXPECT_TRUE(report.is_good() && report.has_news());
  EXPECT_EQ(report.files[0].file, "a.lwp");
  EXPECT_EQ(report.files[1].id, "summer");
  EXPECT_EQ(report.files[1].serial, 5u);
  EXPECT_EQ(report.files[1].key, packs::key_id_text(key_.id()));
  EXPECT_EQ(store_.state()->shown, "summer");
  // The same stick again changes nothing, and is no fault.
  const ImportReport again = take();
  EXPECT_TRUE(again.is_good() && !again.has_news());
  EXPECT_EQ(again.files[0].outcome, Outcome::already_there);
}

TEST_F(Import, CapitalsAreTheSameName) {
  put_pack("SUMMER.LWP", "summer", 5);
  put_pack(".lwp", "winter", 1);
  for (const char* spelled : {"LACKWERK", "Lackwerk"}) {
    fs::rename(folder(), stick_ / spelled);
    const ImportReport report = take();
    ASSERT_EQ(report.files.size(), 1u) << spelled << ": " << report.error;
    EXPECT_TRUE(report.is_good());
    EXPECT_EQ(report.files[0].id, "summer");
    fs::rename(stick_ / spelled, folder());
  }
  // Not another name, nor a link in capitals.
  fs::rename(folder(), stick_ / "lackwerk2");
  EXPECT_TRUE(has(take().error, "no such folder"));
  fs::create_directory_symlink("lackwerk2", stick_ / "LACKWERK");
  EXPECT_TRUE(has(take().error, "make it a folder of its own"));
}

TEST_F(Import, RefusesWhatIsNoPairOfRegularFiles) {
  put_pack("p.lwp", "summer", 5);
  const fs::path pack = folder() / "p.lwp", signature = packs::signature_path(pack), aside = stick_ / "aside";
  fs::rename(signature, aside);
  EXPECT_TRUE(has(refusal(), "p.lwp.minisig: is not there"));
  fs::create_symlink(aside, signature);
  EXPECT_TRUE(has(refusal(), "p.lwp.minisig: is a symbolic link"));
  fs::remove(signature);
  ASSERT_EQ(::mkfifo(signature.c_str(), 0600), 0);
  EXPECT_TRUE(has(refusal(), "p.lwp.minisig: is not a regular file"));
  fs::remove(signature);
  put(signature, std::string(packs::max_minisig_bytes + 1, 'x'));
  EXPECT_TRUE(has(refusal(), "4097 bytes"));
  fs::rename(aside, signature);

  fs::rename(pack, aside);
  fs::create_symlink(aside, pack);
  EXPECT_TRUE(has(refusal(), "p.lwp: is a symbolic link"));
  fs::remove(pack);
  ASSERT_EQ(::mkfifo(pack.c_str(), 0600), 0);
  EXPECT_TRUE(has(refusal(), "p.lwp: is not a regular file"));
  fs::remove(pack);
  fs::create_directory(pack);
  EXPECT_TRUE(has(refusal(), "p.lwp: is not a regular file"));
  fs::remove(pack);
  fs::rename(aside, pack);
  EXPECT_TRUE(take().is_good());
}

TEST_F(Import, SizesAreKnownBeforeAnythingIsRead) {
  put_pack("p.lwp", "summer", 5);
  EXPECT_TRUE(has(refusal({.most_pack_bytes = 100}), "at most 100 are allowed"));
  // A hole of a terabyte takes no room on the stick and would take a day to read.
  fs::resize_file(folder() / "p.lwp", 1ull << 40);
  const std::uint64_t calls = storage_.calls();
  EXPECT_TRUE(has(refusal(), "1099511627776 bytes"));
  // refusal() asks the store for its state; the importer has not touched it.
  EXPECT_LE(storage_.calls() - calls, 2u);
}

TEST_F(Import, TheStoresVerdictIsTheFilesOwn) {
  put_pack("a.lwp", "summer", 5);
  put_pack("b.lwp", "summer", 4);
  put_pack("c.lwp", "winter", 1);
  put(folder() / "c.lwp", "no pack");
  put_pack("d.lwp", "winter", 2);
  const ImportReport report = take();
  ASSERT_EQ(report.files.size(), 4u);
  EXPECT_EQ(report.files[0].outcome, Outcome::stored);
  EXPECT_TRUE(has(report.files[1].error, "serial: 4 is not above 5"));
  EXPECT_TRUE(has(report.files[2].error, "not of this file"));
  EXPECT_EQ(report.files[3].outcome, Outcome::stored);
  EXPECT_FALSE(report.is_good());
  EXPECT_TRUE(report.has_news());
}

TEST_F(Import, OnlyOneFolderAndSixteenPacks) {
  put_pack("p.lwp", "summer", 1);
  fs::rename(folder() / "p.lwp", stick_ / "p.lwp");
  EXPECT_TRUE(has(take().error, "no packs"));
  fs::remove_all(folder());
  EXPECT_TRUE(has(take().error, "no such folder"));
  fs::create_directory(stick_ / "elsewhere");
  fs::create_directory_symlink("elsewhere", folder());
  EXPECT_FALSE(take().error.empty());
  fs::remove(folder());
  fs::create_directory(folder());
  for (std::uint64_t k = 0; k < 17; ++k) put_pack(std::string(1, static_cast<char>('a' + k)) + ".lwp", "summer", k);
  const ImportReport report = take();
  EXPECT_EQ(report.files.size(), 16u);
  EXPECT_TRUE(has(report.error, "17 packs"));
  EXPECT_EQ(store_.state()->find("summer")->current.serial, 15u);
}

TEST_F(Import, StrangeNamesStayOnOneLineAndInJson) {
  const std::string name = "\x1B[2J\n\xFF.lwp";
  put(folder() / name, "x");
  const ImportReport report = take();
  const std::string lines = import_lines(report);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
  EXPECT_EQ(lines.find('\x1B'), std::string::npos);
  EXPECT_TRUE(nlohmann::json::accept(import_json(report)));
}

TEST_F(Import, TheReportIsReplacedWhole) {
  put_pack("p.lwp", "summer", 3);
  const testing::TemporaryFolder run;
  put(run / import_file_name, "old");
  ASSERT_TRUE(write_import(run.path(), take()));
  const std::vector<char> text = testing::read_bytes(run / import_file_name);
  const auto json = nlohmann::json::parse(text.begin(), text.end());
  EXPECT_TRUE(json["good"]);
  EXPECT_EQ(json["files"][0]["result"], "stored");
  EXPECT_EQ(json["files"][0]["serial"], 3);
  EXPECT_GT(json["time_s"], 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(run.path()), fs::directory_iterator()), 1);
  EXPECT_FALSE(write_import(run / "nowhere", take()));
}

TEST_F(Import, AllOfItOnADisk) {
  const testing::TemporaryFolder disk;
  put_pack("p.lwp", "summer", 3);
  fs::create_directories(disk / "run");
  const ImportPlaces places{stick_.path(), disk / "store", disk / "keys", disk / "run"};
  auto done = import_stick(places);
  ASSERT_TRUE(done);
  EXPECT_FALSE(*done) << "there is no keyring";
  fs::create_directories(disk / "keys");
  const packs::PublicKey key = key_.public_key();
  Bytes bytes{'E', 'd'};
  bytes.insert(bytes.end(), key.id.begin(), key.id.end());
  bytes.insert(bytes.end(), key.key.begin(), key.key.end());
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // sodium ends it with a zero
  put(disk / "keys/maker.pub", "untrusted comment: a maker\n" + text + "\n");
  done = import_stick(places);
  ASSERT_TRUE(done);
  EXPECT_TRUE(*done);
  const auto storage = packs::open_disk(disk / "store");
  packs::Store store(*storage, {}, packs::check_pack);
  EXPECT_EQ(store.state()->shown, "summer");
}

}  // namespace
}  // namespace lackwerk::kiosk
