#include "packs/minisign.hpp"

#include <gtest/gtest.h>
#include <sodium.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "packs/keyring.hpp"
#include "packs/small_file.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

/// Debian's minisign, a folder for its files, and a key pair without a password made by it.
class RealMinisign : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("minisign -v >/dev/null 2>&1") != 0) GTEST_SKIP() << "no minisign; install the package minisign";
    ASSERT_GE(sodium_init(), 0);
    folder_ = fs::temp_directory_path() / ("lackwerk-minisign-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream file(folder_ / "file", std::ios::binary);
    for (int k = 0; k < 100'000; ++k) file << k;
    file.close();
    ASSERT_TRUE(shell("minisign -G -W -p key.pub -s key.key"));
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  [[nodiscard]] bool shell(const std::string& command) const {
    return std::system(("cd '" + folder_.string() + "' && " + command + " >out.txt 2>&1").c_str()) == 0;
  }
  [[nodiscard]] std::string read(const char* name) const { return read_small_file(folder_ / name, 1u << 20u).value(); }
  [[nodiscard]] std::array<std::uint8_t, 64> hash() const {
    const std::string text = read("file");
    FileHash hash;
    // In two parts, as a copy would.
    hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), 1000});
    hash.add({reinterpret_cast<const std::uint8_t*>(text.data()) + 1000, text.size() - 1000});
    return hash.finish();
  }
  [[nodiscard]] PublicKey key() const { return parse_public_key(read("key.pub"), "key.pub").value(); }
  fs::path folder_;
};

TEST_F(RealMinisign, WhatItSignsVerifiesHere) {
  ASSERT_TRUE(shell("minisign -S -s key.key -m file -t 'id=summer serial=12'"));
  const auto signature = parse_signature(read("file.minisig"), "file.minisig");
  ASSERT_TRUE(signature) << signature.error().line();
  EXPECT_TRUE(check_signature(*signature, key(), hash(), "file.minisig"));
  const auto as = Keyring({key()}, {}).check(read("file.minisig"), hash(), "file.minisig");
  ASSERT_TRUE(as) << as.error().line();
  EXPECT_EQ(*as, (SignedAs{"summer", 12, key().id}));
  // The key alone, as minisign -P takes it.
  std::string line = read("key.pub");
  line = line.substr(line.find('\n') + 1);
  EXPECT_EQ(parse_public_key(line, "line").value(), key());
}

TEST_F(RealMinisign, WhatIsSignedHereVerifiesThere) {
  EXPECT_FALSE(SecretKey::is_locked(read("key.key")));
  const auto secret = SecretKey::parse(read("key.key"), "", "key.key");
  ASSERT_TRUE(secret) << secret.error().line();
  EXPECT_EQ(secret->public_key(), key());
  std::ofstream(folder_ / "file.minisig") << signature_text(secret->sign(hash(), "id=summer serial=12"));
  EXPECT_TRUE(shell("minisign -V -p key.pub -m file")) << read("out.txt");
  EXPECT_NE(read("out.txt").find("id=summer serial=12"), std::string::npos);
  EXPECT_NE(read("key.pub").find(" " + key_id_text(secret->id()) + "\n"), std::string::npos) << read("key.pub");
  std::ofstream(folder_ / "file", std::ios::app) << "x";
  EXPECT_FALSE(shell("minisign -V -p key.pub -m file"));
}

TEST_F(RealMinisign, LegacySignaturesAreRefused) {
  ASSERT_TRUE(shell("minisign -S -l -s key.key -m file -t 'id=summer serial=12'"));
  const auto signature = parse_signature(read("file.minisig"), "file.minisig");
  ASSERT_FALSE(signature);
  EXPECT_NE(signature.error().line().find("legacy"), std::string::npos);
}

TEST_F(RealMinisign, ALockedKeyOpensWithItsPasswordOnly) {
  ASSERT_TRUE(shell("printf 'car paint\\ncar paint\\n' | minisign -G -p locked.pub -s locked.key"));
  const std::string text = read("locked.key");
  EXPECT_TRUE(SecretKey::is_locked(text));
  const auto wrong = SecretKey::parse(text, "car pain", "locked.key");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().line().find("password"), std::string::npos);
  const auto secret = SecretKey::parse(text, "car paint", "locked.key");
  ASSERT_TRUE(secret) << secret.error().line();
  std::ofstream(folder_ / "file.minisig") << signature_text(secret->sign(hash(), "id=summer serial=12"));
  EXPECT_TRUE(shell("minisign -V -p locked.pub -m file")) << read("out.txt");
}

TEST_F(RealMinisign, EveryChangedByteOfASignatureIsRefused) {
  ASSERT_TRUE(shell("minisign -S -s key.key -m file -t 'id=summer serial=12'"));
  const std::string good = read("file.minisig");
  const Keyring ring({key()}, {});
  const std::size_t first_line = good.find('\n');
  int tried = 0;
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const int bit : {0, 1, 5, 7}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ (1 << bit));
      ++tried;
      const auto checked = ring.check(bad, hash(), "file.minisig");
      // The untrusted comment is nobody's word; what it says does not count.
      if (at >= std::string("untrusted comment:").size() && at < first_line) continue;
      EXPECT_FALSE(checked) << "byte " << at << " bit " << bit;
    }
  for (std::size_t length = 0; length + 1 < good.size(); ++length)
    EXPECT_FALSE(ring.check(good.substr(0, length), hash(), "file.minisig")) << length;
  EXPECT_FALSE(ring.check(good + "x", hash(), "file.minisig"));
  std::printf("  %d changed bits\n", tried);
}

TEST_F(RealMinisign, AKeyringIsReadAnewAndKnowsWhatIsRevoked) {
  ASSERT_TRUE(shell("minisign -G -W -p other.pub -s other.key"));
  ASSERT_TRUE(shell("minisign -S -s other.key -m file -t 'id=summer serial=12'"));
  const std::string text = read("file.minisig");
  const PublicKey other = parse_public_key(read("other.pub"), "other.pub").value();
  const auto check = [&] { return Keyring::open(folder_).value().check(text, hash(), "file.minisig").has_value(); };
  EXPECT_TRUE(check());
  std::ofstream(folder_ / revoked_file) << "# lost in May\n  " << key_id_text(other.id) << "  # by the painter\n\n";
  EXPECT_FALSE(check());
  fs::remove(folder_ / revoked_file);
  EXPECT_TRUE(check());
  fs::remove(folder_ / "other.pub");
  EXPECT_FALSE(check());
  std::ofstream(folder_ / "strange.pub") << "hello";
  EXPECT_FALSE(Keyring::open(folder_));
  EXPECT_FALSE(Keyring::open(folder_ / "nothing"));
}

TEST(Minisign, NonsenseIsRefusedWithoutHarm) {
  ASSERT_GE(sodium_init(), 0);
  std::mt19937 random(7);
  const std::string alphabet = "untrusted comment: \nRWQABCDEFGHIJKLMNOPabcdef0123456789+/=\r\t";
  for (int round = 0; round < 20'000; ++round) {
    std::string text = round % 3 == 0 ? "untrusted comment: x\n" : "";
    const std::size_t length = random() % 300;
    for (std::size_t k = 0; k < length; ++k) text += alphabet[random() % alphabet.size()];
    EXPECT_FALSE(parse_signature(text, "x"));
    EXPECT_FALSE(parse_public_key(text, "x"));
    EXPECT_FALSE(SecretKey::parse(text, "", "x"));
  }
  EXPECT_FALSE(parse_signature(std::string(max_minisig_bytes + 1, 'x'), "x"));
}

TEST(KeyIds, AreWrittenAsMinisignPrintsThem) {
  const KeyId id{0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0xf1};
  EXPECT_EQ(key_id_text(id), "F123456789ABCDEF");
  EXPECT_EQ(parse_key_id("F123456789ABCDEF", "f", "line 1").value(), id);
  // One id in sixteen begins with a zero, which minisign leaves out.
  const KeyId small{0xaf, 0x65, 0x37, 0x1f, 0xc2, 0xd5, 0x27, 0x0c};
  EXPECT_EQ(key_id_text(small), "C27D5C21F3765AF");
  EXPECT_EQ(parse_key_id("C27D5C21F3765AF", "f", "line 1").value(), small);
  EXPECT_EQ(parse_key_id("0C27D5C21F3765AF", "f", "line 1").value(), small);
  EXPECT_EQ(key_id_text({1}), "00000001");
  EXPECT_EQ(parse_key_id(key_id_text({}), "f", "line 1").value(), KeyId{});
  for (const char* bad : {"", "1234567", "0123456789ABCDEFF", "0x23456789ABCDEF", "0123456789ABCDEG"})
    EXPECT_FALSE(parse_key_id(bad, "f", "line 1")) << bad;
}

}  // namespace
}  // namespace lackwerk::packs
