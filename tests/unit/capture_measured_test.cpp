// A capture's measurement: what is written comes back, old captures stay readable, and damage is named.
#include "packs/tools/capture_measured.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "packs/tools/capture.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::TemporaryFolder;

constexpr core::BrdfTableSize small{4, 5, 6};

Capture sample() {
  Capture capture;
  capture.identity = {"A film", "measured somewhere", core::Provenance::measured, core::Provenance::measured,
                      core::Provenance::measured};
  capture.is_fitted = false;
  core::BrdfTable table(small);
  for (std::size_t cell = 0; cell < small.cells(); ++cell) {
    if (cell % 7 != 3) table.set(cell, {0.1f + static_cast<float>(cell), 1.0f / 3.0f, 1e5f});
  }
  capture.measured = table;
  capture.angles = {{45.0, 15.0, {51.25, -3.5, 1.0 / 3.0}}, {45.0, -15.0, {130.0, 0.0, 2.0}}};
  return capture;
}

std::string text_of(const std::filesystem::path& file) {
  const auto bytes = testing::read_bytes(file);
  return {bytes.begin(), bytes.end()};
}

TEST(CaptureMeasured, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const Capture before = sample();
  const auto written = write_capture(before, folder.path());
  ASSERT_TRUE(written) << written.error().line();
  const auto after = read_capture(folder.path());
  ASSERT_TRUE(after) << after.error().line();
  EXPECT_FALSE(after->is_fitted);
  ASSERT_TRUE(after->measured);
  EXPECT_EQ(after->measured->size(), small);
  for (std::size_t cell = 0; cell < small.cells(); ++cell)
    EXPECT_EQ(after->measured->value(cell), before.measured->value(cell)) << cell;
  ASSERT_EQ(after->angles.size(), 2u);
  EXPECT_EQ(after->angles[0].lab, before.angles[0].lab);
  EXPECT_EQ(after->angles[1].aspecular_deg, -15.0);
}

TEST(CaptureMeasured, WritingAnotherCaptureLeavesNothingBehind) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_capture(sample(), folder.path()));
  Capture plain = sample();
  plain.measured.reset();
  plain.angles.clear();
  plain.is_fitted = true;
  ASSERT_TRUE(write_capture(plain, folder.path()));
  EXPECT_FALSE(std::filesystem::exists(folder / "brdf.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder / "angles.csv"));
  // Without a measurement the text is that of captures before there were any: old ones read as fitted.
  const std::string text = text_of(folder / "paint.toml");
  EXPECT_EQ(text.find("fitted"), std::string::npos);
  EXPECT_EQ(text.find("measured]"), std::string::npos);
  const auto read = read_capture(folder.path());
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->is_fitted);
  EXPECT_FALSE(read->measured);
}

struct BadKey {
  const char* from;
  const char* to;
  const char* field;  ///< that the error's field ends in
};

TEST(CaptureMeasured, WrongKeysAreNamed) {
  const BadKey cases[]{{"fitted = false", "fitted = 0", "fitted"},
                       {"\"brdf.exr\"", "\"../brdf.exr\"", "measured.BRDF"},
                       {"num_theta_h = 4", "num_theta_h = 1", "measured.num_theta_h"},
                       {"num_theta_h = 4", "num_theta_h = 4.5", "measured.num_theta_h"},
                       {"num_phi_d = 6", "num_phi_d = 1000000000", "measured.num_phi_d"},
                       {"num_theta_d = 5\n", "", "measured.num_theta_d"},
                       {"\"angles.csv\"", "\"other.csv\"", "measured.angles"},
                       {"num_phi_d", "num_phi", "measured.num_phi"}};
  for (const BadKey& bad : cases) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_capture(sample(), folder.path()));
    std::string text = text_of(folder / "paint.toml");
    const auto at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.from;
    std::ofstream(folder / "paint.toml") << text.replace(at, std::string(bad.from).size(), bad.to);
    const auto read = read_capture(folder.path());
    ASSERT_FALSE(read) << bad.to;
    EXPECT_TRUE(read.error().field.ends_with(bad.field)) << read.error().line();
  }
}

/// Puts another picture in place of brdf.exr.
Error error_with_picture(int width, int height, int channels, float value) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_capture(sample(), folder.path()));
  const std::string file = (folder / "brdf.exr").string();
  const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  std::vector<float> values(static_cast<std::size_t>(width * height * channels), 0.5f);
  values[4] = value;
  auto image = OIIO::ImageOutput::create(file);
  EXPECT_TRUE(image && image->open(file, spec) && image->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  EXPECT_TRUE(image->close());
  const auto read = read_capture(folder.path());
  EXPECT_FALSE(read);
  if (read) return {};
  EXPECT_EQ(read.error().file, file);
  return read.error();
}

TEST(CaptureMeasured, WrongPicturesAreNamed) {
  EXPECT_EQ(error_with_picture(6, 19, 3, 0.5f).field, "size");
  EXPECT_EQ(error_with_picture(5, 20, 3, 0.5f).field, "size");
  EXPECT_EQ(error_with_picture(6, 20, 4, 0.5f).field, "channels");
  EXPECT_EQ(error_with_picture(6, 20, 3, -0.5f).field, "pixel 1,0 channel 1");
  EXPECT_NE(error_with_picture(6, 20, 3, std::numeric_limits<float>::quiet_NaN()).what.find("finite"),
            std::string::npos);
  EXPECT_NE(error_with_picture(6, 20, 3, 2e9f).what.find("1e9"), std::string::npos);
  // -1 in one channel alone is no hole.
  EXPECT_NE(error_with_picture(6, 20, 3, -1.0f).what.find("negative"), std::string::npos);
}

TEST(CaptureMeasured, CutMissingAndEmptyPicturesAreNamed) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_capture(sample(), folder.path()));
  const auto size = std::filesystem::file_size(folder / "brdf.exr");
  for (const std::uintmax_t left : {size * 3 / 4, size / 4, std::uintmax_t{0}}) {
    std::filesystem::resize_file(folder / "brdf.exr", left);
    const auto read = read_capture(folder.path());
    ASSERT_FALSE(read) << left;
    EXPECT_EQ(read.error().file, (folder / "brdf.exr").string());
  }
  std::filesystem::remove(folder / "brdf.exr");
  const auto read = read_capture(folder.path());
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().what.find("missing"), std::string::npos);
}

TEST(CaptureMeasured, WrongTablesAreNamed) {
  struct BadTable {
    const char* text;
    const char* field;
  };
  const BadTable cases[]{{"light_deg,aspecular_deg,L,a\n45,15,50,0\n", "line 1"},
                         {"light_deg,aspecular_deg,L,a,b\n", ""},
                         {"light_deg,aspecular_deg,L,a,b\n45,15,50,0,0\n45,x,50,0,0\n", "line 3, aspecular_deg"},
                         {"light_deg,aspecular_deg,L,a,b\n95,15,50,0,0\n", "line 2, light_deg"},
                         {"light_deg,aspecular_deg,L,a,b\n45,15,-1,0,0\n", "line 2, L"},
                         {"light_deg,aspecular_deg,L,a,b\n45,15,nan,0,0\n", "line 2, L"}};
  const TemporaryFolder folder;
  for (const BadTable& bad : cases) {
    std::ofstream(folder / "angles.csv") << bad.text;
    const auto read = read_readings(folder / "angles.csv");
    ASSERT_FALSE(read) << bad.text;
    EXPECT_EQ(read.error().field, bad.field) << read.error().line();
  }
}

}  // namespace
}  // namespace lackwerk::packs
