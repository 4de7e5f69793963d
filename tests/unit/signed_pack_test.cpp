#include "packs/signed_pack.hpp"

#include <gtest/gtest.h>
#include <sodium.h>

#include <algorithm>
#include <cstdio>

#include "tests/unit/pack_samples.hpp"
#include "tests/unit/scan_samples.hpp"

namespace lackwerk::packs {
namespace {

/// A key pair as a key file without a password holds it.
SecretKey make_key() {
  EXPECT_GE(sodium_init(), 0);
  std::array<std::uint8_t, 32> open{};
  std::array<std::uint8_t, 64> secret{};
  crypto_sign_keypair(open.data(), secret.data());
  std::vector<std::uint8_t> bytes{'E', 'd', 0, 0, 'B', '2'};
  bytes.resize(54 + 8);
  bytes.insert(bytes.end(), secret.begin(), secret.end());
  bytes.resize(bytes.size() + 32);
  std::string text(sodium_base64_encoded_len(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  return std::move(SecretKey::parse(text.c_str(), "", "test.key").value());
}

class SignedPack : public ::testing::Test {
 protected:
  SignedPack() {
    testing::SamplePack sample;
    sample.contents.info.id = "summer";
    sample.contents.info.serial = 3;
    EXPECT_TRUE(write_paint_pack(path_, sample.contents));
    const std::vector<char> bytes = testing::read_bytes(path_);
    FileHash hash;
    hash.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    const std::string text = signature_text(key_.sign(hash.finish(), trusted_comment("summer", 3)));
    testing::write_bytes(signature_path(path_), text.data(), text.size());
  }
  [[nodiscard]] Result<OpenedPack> open() const { return open_signed_pack(path_, ring_, true); }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "p.lwp";
  SecretKey key_ = make_key();
  Keyring ring_{{key_.public_key()}, {}};
};

TEST_F(SignedPack, EveryFlippedBitOfThePackIsRefusedByItsSignature) {
  ASSERT_TRUE(open());
  testing::BitFlipper file(path_);
  for (std::size_t bit = 0; bit < file.size_bits(); ++bit) {
    file.flip(bit);
    const auto pack = open();
    ASSERT_FALSE(pack) << "bit " << bit;
    // The signature is looked at first: the pack's own digest is not needed.
    ASSERT_EQ(pack.error().file, signature_path(path_).string()) << pack.error().line();
    file.flip(bit);
  }
  ASSERT_TRUE(open());
  std::printf("%zu single-bit flips of a signed pack of %zu bytes, all refused by the signature\n", file.size_bits(),
              file.size_bits() / 8);
}

TEST_F(SignedPack, EveryFlippedBitOfTheSignatureIsRefused) {
  const std::vector<char> text = testing::read_bytes(signature_path(path_));
  // Line 1 is anybody's to write, but for how it begins.
  const auto first_line_end = std::find(text.begin(), text.end(), '\n') - text.begin();
  const std::string_view fixed = "untrusted comment:";
  testing::BitFlipper file(signature_path(path_));
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < file.size_bits(); ++bit) {
    const std::size_t byte = bit / 8;
    if (byte >= fixed.size() && byte < static_cast<std::size_t>(first_line_end)) continue;
    file.flip(bit);
    const auto pack = open();
    ASSERT_FALSE(pack) << "bit " << bit << ", byte " << byte << " of " << text.size();
    ++refused;
    file.flip(bit);
  }
  ASSERT_TRUE(open());
  std::printf("%zu single-bit flips of a signature of %zu bytes, all refused\n", refused, text.size());
}

// ---- scans come by the same way

TEST_F(SignedPack, ScansAreSignedAndRefusedAsPaintsAre) {
  const testing::SampleScans sample("growth", 7, 60);
  const std::filesystem::path path = folder_ / "scans.lwp";
  ASSERT_TRUE(write_scan_pack(path, sample.contents));
  EXPECT_FALSE(open_signed_pack(path, ring_, false)) << "not signed";
  const std::vector<char> bytes = testing::read_bytes(path);
  const auto sign_as = [&](const char* id, std::uint64_t serial) {
    FileHash hash;
    hash.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    const std::string text = signature_text(key_.sign(hash.finish(), trusted_comment(id, serial)));
    testing::write_bytes(signature_path(path), text.data(), text.size());
  };
  sign_as("growth", 8);
  const auto other = open_signed_pack(path, ring_, false);
  ASSERT_FALSE(other) << "signed as another serial than it has";
  EXPECT_EQ(other.error().file, signature_path(path).string());
  sign_as("growth", 7);
  const auto opened = open_signed_pack(path, ring_, false);
  ASSERT_TRUE(opened) << opened.error().line();
  EXPECT_EQ(opened->pack.paints(), nullptr);
  ASSERT_NE(opened->pack.scans(), nullptr);
  EXPECT_EQ(opened->pack.scans()->info().states.size(), 3u);
  EXPECT_EQ(opened->pack.id(), "growth");
  EXPECT_EQ(opened->pack.serial(), 7u);
  EXPECT_STREQ(opened->pack.kind_name(), "scan pack");
  testing::BitFlipper file(path);
  for (std::size_t bit = 0; bit < file.size_bits(); bit += 7) {
    file.flip(bit);
    ASSERT_FALSE(open_signed_pack(path, ring_, false)) << "bit " << bit;
    file.flip(bit);
  }
}

TEST_F(SignedPack, TheStoreTakesBothKinds) {
  const testing::SampleScans sample("growth", 7, 60);
  ASSERT_TRUE(write_scan_pack(folder_ / "scans.lwp", sample.contents));
  for (const char* name : {"p.lwp", "scans.lwp"}) {
    const std::vector<char> text = testing::read_bytes(folder_ / name);
    std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const auto self = check_pack(bytes, name);
    ASSERT_TRUE(self) << self.error().line();
    EXPECT_EQ(self->id, std::string(name) == "p.lwp" ? "summer" : "growth");
    bytes[bytes.size() / 2] ^= 1;
    EXPECT_FALSE(check_pack(bytes, name));
  }
  EXPECT_FALSE(check_pack({1, 2, 3}, "nothing"));
}

}  // namespace
}  // namespace lackwerk::packs
