// Display profiles: published matrices, lcms2 as a second opinion, and files that mean harm.
#include "kiosk/display/display_profile.hpp"

#include <gtest/gtest.h>
#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/colour.hpp"

namespace lackwerk::test {
namespace {

using kiosk::Chromaticity;
using kiosk::DisplayProfile;

constexpr Chromaticity d65{0.3127, 0.3290};
constexpr Chromaticity d50{0.3457, 0.3585};

DisplayProfile display_p3() {
  DisplayProfile p;
  p.red = {0.680, 0.320};
  p.green = {0.265, 0.690};
  p.blue = {0.150, 0.060};
  return p;
}

/// rows[3 * row + column]
glm::dmat3 matrix(const std::array<double, 9>& rows) {
  glm::dmat3 m;
  for (int k = 0; k < 9; ++k) m[k % 3][k / 3] = rows[static_cast<std::size_t>(k)];
  return m;
}

void expect_near(const glm::dmat3& a, const glm::dmat3& b, double tolerance) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(a[column][row], b[column][row], tolerance) << "row " << row << ", column " << column;
}

// W3C, CSS Color Module Level 4, sample code for colour conversions: linear display-p3 to XYZ, and linear sRGB to XYZ,
// both under D65 (0.3127, 0.3290).
const glm::dmat3 css_xyz_from_p3 =
    matrix({0.4865709486482162, 0.26566769316909306, 0.1982172852343625, 0.2289745640697488, 0.6917385218365064,
            0.079286914093745, 0.0, 0.04511338185890264, 1.043944368900976});
// There as well: Bradford from D65 to D50 (0.3457, 0.3585).
const glm::dmat3 css_d50_from_d65 =
    matrix({1.0479297925449969, 0.022946870601609652, -0.05019226628920524, 0.02962780877005599, 0.9904344267538799,
            -0.017073799063418826, -0.009243040646204504, 0.015055191490298152, 0.7518742814281371});

glm::dmat3 xyz_from_srgb() {
  glm::dmat3 m;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) m[column][row] = core::rgb_to_xyz[row][column];
  return m;
}

TEST(DisplayProfile, SrgbIsItself) {
  const DisplayProfile srgb;
  EXPECT_TRUE(srgb.is_srgb());
  EXPECT_TRUE(kiosk::check_profile(srgb, "here"));
  expect_near(matrix(kiosk::panel_from_srgb(srgb)), glm::dmat3(1.0), 1e-14);
  EXPECT_FALSE(display_p3().is_srgb());
}

TEST(DisplayProfile, SrgbIsKnownByItsCurveToo) {
  DisplayProfile p;
  for (auto& curve : p.curves)
    for (int k = 0; k < 256; ++k) curve.push_back(core::srgb_decode(k / 255.0));
  EXPECT_TRUE(p.is_srgb());
  for (auto& curve : p.curves) curve = kiosk::power_curve(2.2);
  EXPECT_FALSE(p.is_srgb());  // 2.2 is not the sRGB curve
}

TEST(DisplayProfile, DisplayP3IsThePublishedMatrix) {
  const glm::dmat3 wanted = glm::inverse(css_xyz_from_p3) * xyz_from_srgb();
  expect_near(matrix(kiosk::panel_from_srgb(display_p3())), wanted, 1e-12);
  // In the digits one finds printed.
  expect_near(matrix(kiosk::panel_from_srgb(display_p3())),
              matrix({0.8225, 0.1775, 0.0, 0.0332, 0.9668, 0.0, 0.0171, 0.0724, 0.9105}), 5e-5);
}

TEST(DisplayProfile, OtherWhitesAreBradford) {
  // Panel to XYZ, times sRGB to panel, times XYZ to sRGB, is the adaptation alone.
  DisplayProfile p = display_p3();
  p.white = d50;
  const auto xyz = [](Chromaticity c) { return glm::dvec3(c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y); };
  const glm::dmat3 primaries(xyz(p.red), xyz(p.green), xyz(p.blue));
  const glm::dvec3 weights = glm::inverse(primaries) * xyz(p.white);
  const glm::dmat3 xyz_from_panel(primaries[0] * weights.x, primaries[1] * weights.y, primaries[2] * weights.z);
  expect_near(xyz_from_panel * matrix(kiosk::panel_from_srgb(p)) * glm::inverse(xyz_from_srgb()), css_d50_from_d65,
              1e-9);
}

TEST(DisplayProfile, GreyStaysGreyOnAnyWhite) {
  for (const Chromaticity white : {d65, d50, Chromaticity{0.28, 0.29}, Chromaticity{0.40, 0.39}}) {
    DisplayProfile p = display_p3();
    p.white = white;
    ASSERT_TRUE(kiosk::check_profile(p, "here"));
    const auto m = kiosk::panel_from_srgb(p);
    for (std::size_t row = 0; row < 9; row += 3) EXPECT_NEAR(m[row] + m[row + 1] + m[row + 2], 1.0, 1e-13);
  }
}

TEST(DisplayProfile, PixelUndoesTheCurve) {
  DisplayProfile p;
  p.curves[1] = kiosk::power_curve(2.4, 1024);
  EXPECT_DOUBLE_EQ(kiosk::pixel_of_light(p, 0, 0.5), core::srgb_encode(0.5));
  for (int k = 0; k <= 255; ++k) {
    const double pixel = k / 255.0;
    EXPECT_NEAR(kiosk::pixel_of_light(p, 0, core::srgb_decode(pixel)), pixel, 1e-9);
    EXPECT_NEAR(kiosk::pixel_of_light(p, 1, std::pow(pixel, 2.4)), pixel, k > 10 ? 1e-5 : 1.0 / 1023.0);
  }
  for (const int channel : {0, 1}) {
    EXPECT_EQ(kiosk::pixel_of_light(p, channel, -0.1), 0.0);
    EXPECT_EQ(kiosk::pixel_of_light(p, channel, 1.1), 1.0);
  }
  // A panel whose black glows, and whose curve has a level stretch: the lower end of it.
  p.curves[2] = {0.01, 0.2, 0.2, 1.0};
  EXPECT_EQ(kiosk::pixel_of_light(p, 2, 0.005), 0.0);
  EXPECT_DOUBLE_EQ(kiosk::pixel_of_light(p, 2, 0.2), 1.0 / 3.0);
}

TEST(DisplayProfile, NonsenseIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* field;
    DisplayProfile profile;
  };
  std::vector<Case> cases;
  const auto add = [&](const char* field, auto change) {
    cases.push_back({field, DisplayProfile()});
    change(cases.back().profile);
  };
  add("red", [](DisplayProfile& p) { p.red = {0.8, 0.3}; });
  add("green", [&](DisplayProfile& p) { p.green = {nan, 0.6}; });
  add("blue", [](DisplayProfile& p) { p.blue = {0.15, 0.0}; });
  add("white", [](DisplayProfile& p) { p.white = {-0.1, 0.3}; });
  add("primaries", [](DisplayProfile& p) { p.green = {0.395, 0.195}; });  // half way between red and blue
  add("primaries", [](DisplayProfile& p) { std::swap(p.red, p.green); });
  add("white", [](DisplayProfile& p) { p.white = {0.60, 0.39}; });
  add("red curve", [](DisplayProfile& p) { p.curves[0] = {0.0}; });
  add("green curve", [](DisplayProfile& p) { p.curves[1].assign(4097, 0.5); });
  add("blue curve", [&](DisplayProfile& p) { p.curves[2] = {0.0, nan, 1.0}; });
  add("red curve", [](DisplayProfile& p) { p.curves[0] = {0.0, 0.6, 0.5, 1.0}; });
  add("red curve", [](DisplayProfile& p) { p.curves[0] = {0.0, 1.5}; });
  add("green curve", [](DisplayProfile& p) { p.curves[1] = {0.5, 0.6}; });
  for (const Case& c : cases) {
    const auto checked = kiosk::check_profile(c.profile, "kiosk.toml");
    ASSERT_FALSE(checked) << c.field;
    EXPECT_EQ(checked.error().file, "kiosk.toml");
    EXPECT_EQ(checked.error().field, c.field) << checked.error().line();
    EXPECT_FALSE(checked.error().remedy.empty());
  }
}

TEST(DisplayProfile, GamutLossCountsAndMeasures) {
  const std::vector<std::array<double, 3>> colours = {{0, 1, 0}, {0.5, 0.5, 0.5}, {1, 1, 1}, {0, 0, 0}};
  EXPECT_EQ(kiosk::gamut_loss(DisplayProfile(), colours).share, 0.0);
  EXPECT_EQ(kiosk::gamut_loss(display_p3(), colours).share, 0.0);  // P3 holds all of sRGB
  DisplayProfile small;
  small.green = {0.32, 0.55};
  const auto loss = kiosk::gamut_loss(small, colours);
  EXPECT_EQ(loss.share, 0.25);
  const auto m = kiosk::panel_from_srgb(small);
  EXPECT_DOUBLE_EQ(loss.worst, std::max({-m[1], m[4] - 1.0, -m[7]}));
  EXPECT_EQ(kiosk::gamut_loss(small, colours, 10.0).share, 0.0);
  EXPECT_EQ(kiosk::gamut_loss(small, {}).share, 0.0);
}

// ---- ICC files, made by lcms2 here and now

using Icc = std::unique_ptr<void, decltype(&cmsCloseProfile)>;

class IccFile : public testing::Test {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "lackwerk_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".icc";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  static Icc rgb(const DisplayProfile& p, double gamma) {
    const cmsCIExyY white{p.white.x, p.white.y, 1.0};
    const cmsCIExyYTRIPLE primaries{{p.red.x, p.red.y, 1.0}, {p.green.x, p.green.y, 1.0}, {p.blue.x, p.blue.y, 1.0}};
    cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
    std::array<cmsToneCurve*, 3> curves = {curve, curve, curve};
    Icc made(cmsCreateRGBProfile(&white, &primaries, curves.data()), &cmsCloseProfile);
    cmsFreeToneCurve(curve);
    return made;
  }
  void save(const Icc& icc) const { ASSERT_TRUE(cmsSaveProfileToFile(icc.get(), path_.c_str())); }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  void expect_error(const char* what) const {
    const auto read = kiosk::read_icc(path_);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().file, path_);
    EXPECT_NE(read.error().line().find(what), std::string::npos) << read.error().line();
    EXPECT_FALSE(read.error().remedy.empty());
  }
  std::string path_;
};

void expect_near(Chromaticity a, Chromaticity b) {
  // The file's numbers are steps of 1/65536 of X, Y and Z; blue's Y is the smallest, 0.06.
  EXPECT_NEAR(a.x, b.x, 2e-4);
  EXPECT_NEAR(a.y, b.y, 2e-4);
}

TEST_F(IccFile, GivesBackWhatWentIn) {
  for (const Chromaticity white : {d65, d50, Chromaticity{0.29, 0.30}}) {
    DisplayProfile p = display_p3();
    p.white = white;
    save(rgb(p, 2.2));
    const auto read = kiosk::read_icc(path_);
    ASSERT_TRUE(read) << read.error().line();
    expect_near(read->red, p.red);
    expect_near(read->green, p.green);
    expect_near(read->blue, p.blue);
    expect_near(read->white, white);
    EXPECT_EQ(read->source.rfind(path_, 0), 0u);
    ASSERT_EQ(read->curves[0].size(), 1024u);
    EXPECT_NEAR(read->curves[0][512], std::pow(512.0 / 1023.0, 2.2), 1e-4);
    const auto a = kiosk::panel_from_srgb(*read), b = kiosk::panel_from_srgb(p);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(a[k], b[k], 1e-3);
  }
}

TEST_F(IccFile, Version2WithoutAdaptationUsesItsWhite) {
  DisplayProfile p = display_p3();
  p.white = {0.29, 0.30};
  const Icc icc = rgb(p, 2.2);
  cmsSetProfileVersion(icc.get(), 2.1);
  ASSERT_TRUE(cmsWriteTag(icc.get(), cmsSigChromaticAdaptationTag, nullptr));
  const cmsCIEXYZ white{0.29 / 0.30, 1.0, 0.41 / 0.30};
  ASSERT_TRUE(cmsWriteTag(icc.get(), cmsSigMediaWhitePointTag, &white));
  save(icc);
  const auto read = kiosk::read_icc(path_);
  ASSERT_TRUE(read) << read.error().line();
  expect_near(read->white, p.white);
  expect_near(read->green, p.green);
}

TEST_F(IccFile, LcmsAgreesPixelByPixel) {
  DisplayProfile p = display_p3();
  p.white = {0.305, 0.315};
  const Icc panel = rgb(p, 2.4);
  save(panel);
  const auto read = kiosk::read_icc(path_);
  ASSERT_TRUE(read);
  const Icc srgb(cmsCreate_sRGBProfile(), &cmsCloseProfile);
  cmsHTRANSFORM transform = cmsCreateTransform(srgb.get(), TYPE_RGB_DBL, panel.get(), TYPE_RGB_DBL,
                                               INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
  ASSERT_NE(transform, nullptr);
  const auto m = kiosk::panel_from_srgb(*read);
  double worst = 0.0;
  for (int r = 0; r <= 255; r += 51)
    for (int g = 0; g <= 255; g += 51)
      for (int b = 0; b <= 255; b += 51) {
        const std::array<double, 3> in = {r / 255.0, g / 255.0, b / 255.0};
        std::array<double, 3> out{};
        cmsDoTransform(transform, in.data(), out.data(), 1);
        for (std::size_t row = 0; row < 3; ++row) {
          double light = 0.0;
          for (std::size_t k = 0; k < 3; ++k) light += m[3 * row + k] * core::srgb_decode(in[k]);
          if (light < 0.002 || light > 1.0) continue;  // the two clip in their own ways
          worst = std::max(worst, std::abs(kiosk::pixel_of_light(*read, static_cast<int>(row), light) - out[row]));
        }
      }
  cmsDeleteTransform(transform);
  std::printf("  at most %.4f of an 8-bit step from lcms2\n", worst * 255.0);
  EXPECT_LT(worst * 255.0, 0.25);
}

TEST_F(IccFile, SrgbsOwnProfileIsACopy) {
  const Icc srgb(cmsCreate_sRGBProfile(), &cmsCloseProfile);
  save(srgb);
  const auto read = kiosk::read_icc(path_);
  ASSERT_TRUE(read) << read.error().line();
  EXPECT_TRUE(read->is_srgb());
}

TEST_F(IccFile, VideoCardTableIsLeftOutAndSaid) {
  const Icc icc = rgb(display_p3(), 2.2);
  cmsToneCurve* curve = cmsBuildGamma(nullptr, 1.1);
  std::array<cmsToneCurve*, 3> table = {curve, curve, curve};
  ASSERT_TRUE(cmsWriteTag(icc.get(), cmsSigVcgtTag, table.data()));
  save(icc);
  cmsFreeToneCurve(curve);
  const auto read = kiosk::read_icc(path_);
  ASSERT_TRUE(read) << read.error().line();
  EXPECT_NE(read->source.find("vcgt"), std::string::npos);
  EXPECT_NEAR(read->curves[0][512], std::pow(512.0 / 1023.0, 2.2), 1e-4);
}

TEST_F(IccFile, TablesOnlyAreRefused) {
  const Icc icc(cmsCreateProfilePlaceholder(nullptr), &cmsCloseProfile);
  cmsSetProfileVersion(icc.get(), 2.1);
  cmsSetDeviceClass(icc.get(), cmsSigDisplayClass);
  cmsSetColorSpace(icc.get(), cmsSigRgbData);
  cmsSetPCS(icc.get(), cmsSigLabData);
  cmsPipeline* pipeline = cmsPipelineAlloc(nullptr, 3, 3);
  cmsPipelineInsertStage(pipeline, cmsAT_BEGIN, cmsStageAllocCLut16bit(nullptr, 2, 3, 3, nullptr));
  ASSERT_TRUE(cmsWriteTag(icc.get(), cmsSigAToB0Tag, pipeline));
  save(icc);
  cmsPipelineFree(pipeline);
  expect_error("tables only");
}

TEST_F(IccFile, PrintersAndScannersAreRefused) {
  const Icc icc(cmsCreateProfilePlaceholder(nullptr), &cmsCloseProfile);
  cmsSetDeviceClass(icc.get(), cmsSigOutputClass);
  cmsSetColorSpace(icc.get(), cmsSigCmykData);
  cmsSetPCS(icc.get(), cmsSigLabData);
  save(icc);
  expect_error("not RGB");
  const Icc scanner = rgb(display_p3(), 2.2);
  cmsSetDeviceClass(scanner.get(), cmsSigInputClass);
  save(scanner);
  expect_error("not a display profile");
}

TEST_F(IccFile, MissingEmptyAndHugeFilesAreRefused) {
  expect_error("cannot be opened");
  write("");
  expect_error("not an ICC profile");
  write(std::string(1000, 'x'));
  expect_error("not an ICC profile");
  std::filesystem::resize_file(path_, std::uintmax_t{17} << 20);
  expect_error("larger than 16 MiB");
}

TEST_F(IccFile, CutShortAtAnyByte) {
  save(rgb(display_p3(), 2.2));
  const std::string whole = bytes();
  ASSERT_TRUE(kiosk::read_icc(path_));
  std::size_t refused = 0;
  for (std::size_t length = 0; length + 1 < whole.size(); length += 3) {
    write(whole.substr(0, length));
    if (!kiosk::read_icc(path_)) ++refused;
  }
  std::printf("  %zu of %zu cut files refused\n", refused, whole.size() / 3);
  EXPECT_GT(refused, whole.size() / 6);
}

TEST_F(IccFile, AnyDamagedByteIsAnErrorOrASoundProfile) {
  save(rgb(display_p3(), 2.2));
  const std::string whole = bytes();
  std::size_t taken = 0;
  for (std::size_t at = 0; at < whole.size(); at += 2)
    for (const char value : {'\0', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = value;
      write(damaged);
      const auto read = kiosk::read_icc(path_);
      if (!read) {
        EXPECT_FALSE(read.error().line().empty());
        continue;
      }
      ++taken;
      EXPECT_TRUE(kiosk::check_profile(*read, path_)) << at;
      for (const double v : kiosk::panel_from_srgb(*read)) EXPECT_TRUE(std::isfinite(v)) << at;
    }
  std::printf("  %zu of %zu damaged files still make sense\n", taken, whole.size());
}

}  // namespace
}  // namespace lackwerk::test
