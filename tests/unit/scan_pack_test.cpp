// Scan packs: written and read back, and refused where anything is wrong.
#include "packs/scan_pack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

namespace lackwerk::packs {
namespace {

/// Two steps of a few paths; the vectors own what the contents point into.
struct Sample {
  std::vector<ScanPath> one, two;
  ScanContents contents;

  Sample() {
    for (std::uint16_t k = 0; k < 50; ++k) {
      const auto step = static_cast<std::uint16_t>(1000 * k);
      one.push_back({{step, 7, 65535, 65535}, {7, step, 0, 0}, {127, 0, 0, 127}, {0, -127, 0, 3}});
      two.push_back({{7, step, 0, 65535}, {step, step, step, 65535}, {0, 0, 127, 0}, {0, 90, 90, 64}});
    }
    ScanInfo& info = contents.info;
    info.id = "tomato";
    info.serial = 3;
    info.name = "Tomate";
    info.time_unit = "days";
    info.low = {-10.5, 2.0, 1e-3};
    info.edge = 310.25;
    info.spacing = 1.5;
    info.up = 2;
    info.states = {{"a.xyz", 5.0, 40}, {"b.xyz", 6.0, 45}, {"c.ply", 8.5, 50}};
    contents.steps = {{one, 4, 1, 0}, {two, 5, 0, 2}};
  }
};

class ScanPackTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("scan_pack_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::filesystem::path file(const char* name) const { return folder_ / name; }
  std::filesystem::path folder_;
};

TEST_F(ScanPackTest, ComesBackAsItWas) {
  const Sample sample;
  const auto path = file("tomato.lwp");
  const auto written = write_scan_pack(path, sample.contents);
  ASSERT_TRUE(written) << written.error().line();
  EXPECT_EQ(sealed_kind_of(path), SealedKind::scan);
  for (const Backing backing : {Backing::map, Backing::copy}) {
    auto opened = ScanPack::open(path, backing);
    ASSERT_TRUE(opened) << opened.error().line();
    const ScanPack pack = std::move(*opened);
    ScanInfo expected = sample.contents.info;
    expected.tool_version = pack.info().tool_version;
    EXPECT_FALSE(expected.tool_version.empty());
    EXPECT_EQ(pack.info(), expected);
    ASSERT_EQ(pack.steps().size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const ScanStep &is = pack.steps()[k], &was = sample.contents.steps[k];
      EXPECT_TRUE(std::equal(is.paths.begin(), is.paths.end(), was.paths.begin(), was.paths.end()));
      EXPECT_EQ(is.matched, was.matched);
      EXPECT_EQ(is.grown, was.grown);
      EXPECT_EQ(is.decayed, was.decayed);
    }
    EXPECT_EQ(pack.file_bytes(), std::filesystem::file_size(path));
  }
}

TEST_F(ScanPackTest, WrongMeaningsAreRefusedByWriterAndReader) {
  const std::map<std::string, std::function<void(Sample&)>> wrong = {
      {"id", [](Sample& s) { s.contents.info.id = "a/b"; }},
      {"name", [](Sample& s) { s.contents.info.name = ""; }},
      {"time_unit", [](Sample& s) { s.contents.info.time_unit = "\n"; }},
      {"low", [](Sample& s) { s.contents.info.low.y = std::nan(""); }},
      {"edge", [](Sample& s) { s.contents.info.edge = 0.0; }},
      {"spacing", [](Sample& s) { s.contents.info.spacing = 1e4; }},
      {"up", [](Sample& s) { s.contents.info.up = 3; }},
      {"states", [](Sample& s) { s.contents.info.states.resize(1); }},
      {"states[1].name", [](Sample& s) { s.contents.info.states[1].name = std::string(201, 'x'); }},
      {"states[2].time", [](Sample& s) { s.contents.info.states[2].time = 6.0; }},
      {"steps", [](Sample& s) { s.contents.steps.pop_back(); }},
      {"steps[1].paths", [](Sample& s) { s.contents.steps[1].paths = {}; }},
      {"steps[0].paths[9]", [](Sample& s) { s.one[9].to_normal[3] = -1; }},
  };
  for (const auto& [field, spoil] : wrong) {
    Sample sample;
    spoil(sample);
    const auto refused = write_scan_pack(file("bad.lwp"), sample.contents);
    ASSERT_FALSE(refused) << field;
    EXPECT_EQ(refused.error().field, field);
    EXPECT_FALSE(std::filesystem::exists(file("bad.lwp")));
    // Somebody else's writer may not have looked.
    const auto payload = encode_scan_pack(sample.contents);
    ASSERT_TRUE(write_sealed_file(file("bad.lwp"), SealedKind::scan, payload));
    EXPECT_FALSE(ScanPack::open(file("bad.lwp"), Backing::copy)) << field;
    std::filesystem::remove(file("bad.lwp"));
  }
}

TEST_F(ScanPackTest, AnyCutAndAnyFlippedBitOfTheStructureIsRefusedOrSound) {
  const Sample sample;
  const std::vector<std::uint8_t> payload = encode_scan_pack(sample.contents);
  ASSERT_TRUE(write_scan_pack(file("good.lwp"), sample.contents));
  std::ifstream in(file("good.lwp"), std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_FALSE(ScanPack::from_bytes({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}, "cut"));
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::vector<std::uint8_t> flipped = bytes;
    flipped[k] ^= static_cast<std::uint8_t>(1u << (k % 8));
    EXPECT_FALSE(ScanPack::from_bytes(std::move(flipped), "flipped")) << k;
  }
  // With a digest that fits, only structure and meaning stand between a flipped bit and the renderer.
  int sound = 0;
  for (std::size_t k = 0; k < payload.size(); k += 5) {
    std::vector<std::uint8_t> flipped = payload;
    flipped[k] ^= static_cast<std::uint8_t>(1u << (k % 8));
    ASSERT_TRUE(write_sealed_file(file("flipped.lwp"), SealedKind::scan, flipped));
    const auto opened = ScanPack::open(file("flipped.lwp"), Backing::copy);
    if (!opened) continue;
    ++sound;
    EXPECT_TRUE(check_scan({opened->info(), opened->steps()}, ""));
  }
  EXPECT_GT(sound, 0) << "places may be anything";
}

TEST_F(ScanPackTest, OtherKindsAreRefusedByName) {
  const Sample sample;
  ASSERT_TRUE(write_sealed_file(file("scene.lws"), SealedKind::scene, encode_scan_pack(sample.contents)));
  const auto refused = ScanPack::open(file("scene.lws"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "kind");
  EXPECT_EQ(sealed_kind_of(file("scene.lws")), SealedKind::scene);
  std::ofstream(file("text.lwp"))
      << "no pack, but longer than sixty-four bytes, which is what a header takes of a file";
  EXPECT_EQ(sealed_kind_of(file("text.lwp")), std::nullopt);
  EXPECT_EQ(sealed_kind_of(file("nothing.lwp")), std::nullopt);
}

}  // namespace
}  // namespace lackwerk::packs
