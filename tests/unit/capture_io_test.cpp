// Capture folders: what is written comes back, and damage is named.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "packs/tools/capture.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

class CaptureIo : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / (std::string("lackwerk_capture_") + info->name());
    fs::remove_all(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  /// A small capture whose numbers all fit a half float.
  static Capture sample(std::uint32_t edge = 5) {
    Capture capture;
    capture.identity = {"Blue \"\\ pearl\n\x01", "made up", core::Provenance::measured, core::Provenance::simulated,
                        core::Provenance::published_fit};
    capture.analytic.diffuse = {0.1, 1.0 / 3.0, 0.0};
    capture.analytic.lobes = {core::Lobe{{0.1, 0.2, 0.3}, 0.4, 1.0}, core::Lobe{{0.5, 0.0, 1.0 / 7.0}, 0.1, 0.05},
                              core::Lobe{{0.0, 0.0, 0.0}, 0.1, 0.05}};
    capture.analytic.coat_ior = 1.5;
    capture.analytic.refraction_ior = 1.4;
    capture.analytic.table = core::ColourTable{3, std::vector<glm::vec3>(9, glm::vec3(0.25f, 1.0f, 2.5f))};
    capture.layout = {12, {0, 2, 3}};
    capture.edge_texels = edge;
    capture.texel_mm = 0.05f;
    capture.slices.resize(3);
    for (std::size_t slice = 0; slice < 3; ++slice) {
      for (std::uint32_t k = 0; k < edge * edge; ++k) {
        capture.slices[slice].texels.emplace_back(static_cast<float>(k), 0.125f * static_cast<float>(slice), 60000.0f);
      }
    }
    return capture;
  }
  Error read_error() const {
    const auto result = read_capture(folder);
    EXPECT_FALSE(result);
    return result ? Error{} : result.error();
  }
  void write_sample() const {
    const auto ok = write_capture(sample(), folder);
    ASSERT_TRUE(ok) << ok.error().line();
  }
  std::string paint_text() const {
    std::ifstream stream(folder / "paint.toml");
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  /// Replaces a piece of paint.toml and returns what reading says.
  Error error_after(const std::string& from, const std::string& to) const {
    write_sample();
    std::string text = paint_text();
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(folder / "paint.toml") << text.replace(at, from.size(), to);
    return read_error();
  }
  /// Puts another picture in place of slice 1.
  Error error_with_slice(OIIO::ImageSpec spec, std::vector<float> values) const {
    write_sample();
    const std::string file = (folder / "flakes" / "slice_01.exr").string();
    auto image = OIIO::ImageOutput::create(file);
    EXPECT_TRUE(image && image->open(file, spec));
    values.resize(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels), 0.5f);
    EXPECT_TRUE(image->write_image(OIIO::TypeDesc::FLOAT, values.data()) && image->close());
    const Error error = read_error();
    EXPECT_NE(error.file.find("slice_01.exr"), std::string::npos) << error.line();
    EXPECT_FALSE(error.remedy.empty());
    return error;
  }
  static OIIO::ImageSpec picture(int width, int height, int channels) {
    return {width, height, channels, OIIO::TypeDesc::HALF};
  }

  fs::path folder;
};

TEST_F(CaptureIo, ComesBackAsItWas) {
  const Capture before = sample();
  ASSERT_TRUE(write_capture(before, folder));
  const auto after = read_capture(folder);
  ASSERT_TRUE(after) << after.error().line();
  EXPECT_EQ(after->identity, before.identity);
  EXPECT_EQ(after->analytic, before.analytic);
  EXPECT_EQ(after->layout, before.layout);
  EXPECT_EQ(after->edge_texels, before.edge_texels);
  EXPECT_EQ(after->texel_mm, before.texel_mm);
  ASSERT_EQ(after->slices.size(), before.slices.size());
  for (std::size_t k = 0; k < before.slices.size(); ++k) EXPECT_EQ(after->slices[k].texels, before.slices[k].texels);
}

TEST_F(CaptureIo, ReplacesALongerCaptureAndLeavesStrangersAlone) {
  write_sample();
  std::ofstream(folder / "notes.txt") << "mine";
  Capture plain = sample();
  plain.analytic.table.reset();
  plain.analytic.refraction_ior = 1.0;
  plain.layout = {};
  plain.slices.clear();
  ASSERT_TRUE(write_capture(plain, folder));
  EXPECT_FALSE(fs::exists(folder / "colour.exr"));
  EXPECT_FALSE(fs::exists(folder / "flakes" / "slice_00.exr"));
  EXPECT_TRUE(fs::exists(folder / "notes.txt"));
  const auto after = read_capture(folder);
  ASSERT_TRUE(after) << after.error().line();
  EXPECT_EQ(after->analytic, plain.analytic);
  EXPECT_TRUE(after->slices.empty());
}

TEST_F(CaptureIo, SameCaptureSameBytes) {
  const auto bytes = [&] {
    write_sample();
    std::ifstream stream(folder / "flakes" / "slice_02.exr", std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST_F(CaptureIo, MissingFilesAreNamed) {
  EXPECT_NE(read_error().file.find("paint.toml"), std::string::npos);
  write_sample();
  fs::remove(folder / "flakes" / "slice_01.exr");
  EXPECT_NE(read_error().file.find("slice_01.exr"), std::string::npos);
  write_sample();
  fs::remove(folder / "colour.exr");
  EXPECT_NE(read_error().file.find("colour.exr"), std::string::npos);
}

TEST_F(CaptureIo, TruncatedImagesAreErrors) {
  for (const double part : {0.0, 0.02, 0.5, 0.9, 0.99}) {
    write_sample();
    const fs::path file = folder / "flakes" / "slice_01.exr";
    fs::resize_file(file, static_cast<std::uintmax_t>(part * static_cast<double>(fs::file_size(file))));
    const Error error = read_error();
    EXPECT_NE(error.file.find("slice_01.exr"), std::string::npos) << part << " " << error.line();
  }
}

TEST_F(CaptureIo, WrongPicturesAreErrors) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_with_slice(picture(5, 5, 3), {0.0f, nan}).what, "is not a finite number");
  EXPECT_EQ(error_with_slice(picture(5, 5, 3), {0.0f, std::numeric_limits<float>::infinity()}).what,
            "is not a finite number");
  const Error negative = error_with_slice(picture(5, 5, 3), {0.0f, 0.0f, 0.0f, 0.0f, -0.001f});
  EXPECT_EQ(negative.what, "is negative");
  EXPECT_EQ(negative.field, "texel 1,0 channel 1");
  EXPECT_EQ(error_with_slice(picture(5, 5, 4), {}).field, "channels");
  EXPECT_EQ(error_with_slice(picture(5, 5, 1), {}).field, "channels");
  EXPECT_EQ(error_with_slice(picture(5, 4, 3), {}).field, "size");
  EXPECT_EQ(error_with_slice(picture(6, 6, 3), {}).field, "size");
  OIIO::ImageSpec cropped = picture(5, 5, 3);
  cropped.full_width = 7;
  cropped.full_height = 7;
  EXPECT_EQ(error_with_slice(cropped, {}).field, "dataWindow");
  OIIO::ImageSpec renamed = picture(5, 5, 3);
  renamed.channelnames = {"X", "Y", "Z"};
  EXPECT_EQ(error_with_slice(renamed, {}).field, "channels");
}

TEST_F(CaptureIo, NoPictureAtAll) {
  write_sample();
  std::ofstream(folder / "flakes" / "slice_00.exr") << "this is no picture";
  EXPECT_NE(read_error().file.find("slice_00.exr"), std::string::npos);
}

TEST_F(CaptureIo, BrokenTextIsAnsweredWithItsLine) {
  Error error = error_after("name = ", "name == ");
  EXPECT_EQ(error.field, "line 3");
  error = error_after("CT_spreads", "CT_spread");
  EXPECT_EQ(error.remedy, "did you mean CT_spreads?");
  EXPECT_NE(error_after("format = 1", "format = 2").field.find("format"), std::string::npos);
  EXPECT_NE(error_after("\"measured\"", "\"hearsay\"").field.find("provenance.lobes"), std::string::npos);
}

TEST_F(CaptureIo, NumbersOutOfRangeAreErrors) {
  EXPECT_NE(error_after("CT_spreads = [0.4", "CT_spreads = [1.4").field.find("CT_spreads"), std::string::npos);
  EXPECT_NE(error_after("CT_F0s = [1", "CT_F0s = [-1").field.find("CT_F0s"), std::string::npos);
  EXPECT_NE(error_after("CT_coeffs = [[0.1", "CT_coeffs = [[nan").field.find("CT_coeffs"), std::string::npos);
  EXPECT_NE(error_after("CT_F0s = [1, ", "CT_F0s = [").field.find("CT_coeffs"), std::string::npos);
  EXPECT_NE(error_after("edge_texels = 5", "edge_texels = 50000").field.find("edge_texels"), std::string::npos);
  EXPECT_NE(error_after("[0, 2, 3]", "[0, 2, 300]").field.find("thetaFI_sliceLUT"), std::string::npos);
  EXPECT_NE(error_after("[0, 2, 3]", "[0, 3, 2]").field.find("thetaFI_sliceLUT"), std::string::npos);
  EXPECT_NE(error_after("[0, 2, 3]", "[]").field.find("max_thetaI"), std::string::npos);
  EXPECT_NE(error_after("num_thetaI = 12", "num_thetaI = 11").field.find("num_thetaI"), std::string::npos);
  EXPECT_NE(error_after("IOR = 1.5", "IOR = 0.5").field.find("IOR"), std::string::npos);
}

TEST_F(CaptureIo, WritingRefusesWhatReadingWould) {
  Capture bad = sample();
  bad.slices[1].texels[3].y = -1.0f;
  auto result = write_capture(bad, folder);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().file.find("slice_01.exr"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "paint.toml"));  // nothing that looks complete is left behind
  bad = sample();
  bad.slices[1].texels[3].y = 70000.0f;  // no half float
  EXPECT_FALSE(write_capture(bad, folder));
  bad = sample();
  bad.slices.pop_back();
  EXPECT_FALSE(write_capture(bad, folder));
  bad = sample();
  bad.analytic.lobes[0].m = 0.05;  // finer than the next
  EXPECT_FALSE(write_capture(bad, folder));
  EXPECT_FALSE(write_capture(sample(), "/proc/no/such/folder"));
}

}  // namespace
}  // namespace lackwerk::packs
