// Folders of flake pictures named by their angles.
#include "packs/tools/btf_folder.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/colour.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

class BtfFolder : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("lackwerk_btf_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "btf");
  }
  void TearDown() override { fs::remove_all(folder); }

  static std::string toml(const std::string& flakes = "unit = \"radiance_factor\"\n", const std::string& ior = "1.5") {
    return "format = 1\nname = \"Blue\"\nsource = \"AxF\"\nIOR = " + ior +
           "\nCT_diffuse = [0.1, 0.2, 0.3]\nCT_coeffs = [[0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]\nCT_F0s = [0.9, 0.5]\n"
           "CT_spreads = [0.2, 0.5]\n[provenance]\nlobes = \"measured\"\nflakes = \"measured\"\ncoat = \"measured\"\n"
           "[flakes]\nBTFflakes = \"btf\"\ntexel_mm = 0.04\nnum_thetaF = 12\nnum_thetaI = 12\nmax_thetaI = 2\n"
           "thetaFI_sliceLUT = [0, 2, 3]\n" +
           flakes;
  }
  void describe(const std::string& text) const { std::ofstream(folder / "paint.toml") << text; }
  /// Every texel holds `level`.
  void picture(const std::string& name, float level, int width = 4, int height = 4, int channels = 3) const {
    const auto image = OIIO::ImageOutput::create((folder / name).string());
    const bool whole = name.ends_with(".png");
    const OIIO::ImageSpec spec(width, height, channels, whole ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    const std::vector<float> values(static_cast<std::size_t>(width * height * channels), level);
    ASSERT_TRUE(image && image->open((folder / name).string(), spec) &&
                image->write_image(OIIO::TypeDesc::FLOAT, values.data()) && image->close())
        << name;
  }
  void three(const std::string& ext = "exr") const {
    picture("btf/th00.0_ti00.0." + ext, 0.25f);
    picture("btf/th07.5_ti00.0." + ext, 0.5f);
    picture("btf/th0_ti7.5." + ext, 0.75f);
  }
  Error error() const {
    const auto result = import_btf_folder(folder);
    EXPECT_FALSE(result);
    if (result) return {};
    EXPECT_EQ(result.error().line().find('\n'), std::string::npos);
    return result.error();
  }

  fs::path folder;
};

TEST_F(BtfFolder, NamesAreAngles) {
  const auto good = angles_of_name("th07.5_ti15.0");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->theta_h, 7.5);
  EXPECT_EQ(good->theta_i, 15.0);
  for (const char* bad : {"", "th_ti", "th1_ti", "ti1_th2", "th1_ti2_", "th-1_ti2", "th1e1_ti2", "th1.2.3_ti2",
                          "thnan_ti0", "th1 _ti2", "th99999999999999999999_ti0"})
    EXPECT_FALSE(angles_of_name(bad)) << bad;
}

TEST_F(BtfFolder, ComesInOneToOne) {
  describe(toml());
  three();
  std::ofstream(folder / "btf" / "notes.txt") << "mine";
  ImportNotes notes;
  const auto capture = import_btf_folder(folder, &notes);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_EQ(capture->edge_texels, 4u);
  ASSERT_EQ(capture->slices.size(), 3u);
  EXPECT_EQ(capture->slices[0].texels[5], glm::vec3(0.25f));
  EXPECT_EQ(capture->slices[1].texels[5], glm::vec3(0.5f));
  EXPECT_EQ(capture->slices[2].texels[5], glm::vec3(0.75f));
  EXPECT_EQ(capture->analytic.lobes[0].m, 0.5);  // sorted
  EXPECT_EQ(capture->analytic.refraction_ior, 1.5);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("notes.txt"), std::string::npos);
  // A capture of it comes back.
  ASSERT_TRUE(write_capture(*capture, folder / "out"));
  const auto again = read_capture(folder / "out");
  ASSERT_TRUE(again) << again.error().line();
  EXPECT_EQ(again->layout, capture->layout);
  EXPECT_EQ(again->slices[2].texels, capture->slices[2].texels);
}

TEST_F(BtfFolder, UnitsAndFormats) {
  describe(toml("unit = \"brdf\"\nscale = 2.0\n"));
  three("tif");
  auto capture = import_btf_folder(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_NEAR(capture->slices[1].texels[0].x, std::numbers::pi, 1e-6);
  fs::remove_all(folder / "btf");
  fs::create_directories(folder / "btf");
  three("png");
  EXPECT_EQ(error().field, "encoding");
  describe(toml("unit = \"radiance_factor\"\nscale = 50\nencoding = \"srgb\"\n"));
  capture = import_btf_folder(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_NEAR(static_cast<double>(capture->slices[1].texels[0].x), 50.0 * core::srgb_decode(128.0 / 255.0), 1e-4);
}

TEST_F(BtfFolder, RadiansAndAnglesOutsideTheCoat) {
  describe(toml("unit = \"radiance_factor\"\nangle_unit = \"rad\"\n"));
  picture("btf/th0.0000_ti0.0000.exr", 0.25f);
  picture("btf/th0.1309_ti0.0000.exr", 0.5f);
  picture("btf/th0.0000_ti0.1309.exr", 0.75f);
  auto capture = import_btf_folder(folder);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_EQ(capture->slices[2].texels[0].x, 0.75f);
  // Below an index of 1.5, 7.5 degrees inside are 11.29 outside, near the normal.
  fs::remove_all(folder / "btf");
  fs::create_directories(folder / "btf");
  describe(toml("unit = \"radiance_factor\"\nangles = \"outside\"\n"));
  picture("btf/th0_ti0.exr", 0.25f);
  picture("btf/th11.3_ti0.exr", 0.5f);
  picture("btf/th0_ti11.3.exr", 0.75f);
  picture("btf/th60_ti0.exr", 0.9f);
  ImportNotes notes;
  capture = import_btf_folder(folder, &notes);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_EQ(capture->slices[1].texels[0].x, 0.5f);
  EXPECT_EQ(capture->slices[2].texels[0].x, 0.75f);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("up to 0.0 degrees"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("1 pictures"), std::string::npos) << notes[1];
}

TEST_F(BtfFolder, MissingAndExtraPicturesAreNamed) {
  describe(toml());
  three();
  fs::remove(folder / "btf" / "th0_ti7.5.exr");
  EXPECT_EQ(error().field, "th00.0_ti07.5");
  picture("btf/th0_ti7.8.exr", 0.75f);  // 0.3 degrees beside the node
  EXPECT_EQ(error().field, "th00.0_ti07.5");
  three();
  EXPECT_NE(error().file.find("th0_ti7.8.exr"), std::string::npos);
  fs::remove(folder / "btf" / "th0_ti7.8.exr");
  picture("btf/th15_ti0.exr", 0.1f);
  EXPECT_NE(error().file.find("th15_ti0.exr"), std::string::npos);
  fs::remove(folder / "btf" / "th15_ti0.exr");
  picture("btf/th7.5_ti0.exr", 0.1f);  // the same angles twice
  EXPECT_NE(error().what.find("twice"), std::string::npos);
}

TEST_F(BtfFolder, BadPicturesAreNamed) {
  const std::string odd = "btf/th0_ti7.5.exr";
  const auto error_with = [&](float level, int width, int height, int channels) {
    describe(toml());
    three();
    picture(odd, level, width, height, channels);
    const Error e = error();
    EXPECT_NE(e.file.find("th0_ti7.5.exr"), std::string::npos) << e.line();
    return e;
  };
  EXPECT_EQ(error_with(-0.5f, 4, 4, 3).what, "is negative");
  EXPECT_EQ(error_with(std::numeric_limits<float>::quiet_NaN(), 4, 4, 3).what, "is not a finite number");
  EXPECT_EQ(error_with(std::numeric_limits<float>::infinity(), 4, 4, 3).what, "is not a finite number");
  EXPECT_EQ(error_with(70000.0f, 4, 4, 3).what, "is too bright");
  EXPECT_EQ(error_with(0.5f, 5, 5, 3).field, "size");
  EXPECT_EQ(error_with(0.5f, 3, 4, 3).field, "size");
  EXPECT_EQ(error_with(0.5f, 4, 4, 1).field, "channels");
  EXPECT_EQ(error_with(0.5f, 4, 4, 4).field, "channels");
  three();
  const auto bytes = fs::file_size(folder / odd);
  for (const auto part : {bytes / 2, bytes - 1, std::uintmax_t{0}}) {
    fs::resize_file(folder / odd, part);
    EXPECT_NE(error().file.find("th0_ti7.5.exr"), std::string::npos) << part;
  }
}

TEST_F(BtfFolder, BadKeysAreNamed) {
  three();
  const auto error_after = [&](const std::string& from, const std::string& to) {
    std::string text = toml();
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    describe(text.replace(at, from.size(), to));
    return error().field;
  };
  EXPECT_NE(error_after("unit = \"radiance_factor\"", "").find("flakes.unit"), std::string::npos);
  EXPECT_NE(error_after("\"radiance_factor\"", "\"nits\"").find("flakes.unit"), std::string::npos);
  EXPECT_NE(error_after("[0, 2, 3]", "[0, 2, 300]").find("thetaFI_sliceLUT"), std::string::npos);
  EXPECT_NE(error_after("[0, 2, 3]", "[0, 3, 2]").find("thetaFI_sliceLUT"), std::string::npos);
  EXPECT_NE(error_after("max_thetaI = 2", "max_thetaI = 3").find("max_thetaI"), std::string::npos);
  EXPECT_NE(error_after("\"btf\"", "\"../btf\"").find("BTFflakes"), std::string::npos);
  EXPECT_NE(error_after("texel_mm = 0.04", "texel_mm = -1").find("texel_mm"), std::string::npos);
  EXPECT_NE(error_after("texel_mm", "edge_texels = 4000000000\ntexel_mm").find("edge_texels"), std::string::npos);
  EXPECT_NE(error_after("CT_diffuse = [0.1", "CT_diffuse = [nan").find("CT_diffuse"), std::string::npos);
  EXPECT_NE(error_after("lobes = \"measured\"", "lobes = \"seen\"").find("provenance.lobes"), std::string::npos);
  EXPECT_NE(error_after("[flakes]\n", "BRDFcolors = \"none.exr\"\n[flakes]\n").find("provenance"), std::string::npos);
  fs::remove(folder / "paint.toml");
  EXPECT_NE(error().file.find("paint.toml"), std::string::npos);
}

}  // namespace
}  // namespace lackwerk::packs
