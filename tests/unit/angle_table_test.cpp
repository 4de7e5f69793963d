// Tables of spectrophotometers: dialects, angle names, spectra, and what is refused.
#include "packs/tools/angle_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "core/analysis/standard_angles.hpp"
#include "core/colour.hpp"
#include "packs/tools/angle_names.hpp"
#include "packs/tools/cie_observer.hpp"

namespace lackwerk::packs {
namespace {

namespace fs = std::filesystem;

class AngleTable : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = info->name();
    std::replace(name.begin(), name.end(), '/', '_');
    file = fs::path(testing::TempDir()) / ("lackwerk_angles_" + name + ".csv");
  }
  void TearDown() override { fs::remove(file); }

  Result<Capture> read(const std::string& text) const {
    std::ofstream(file, std::ios::binary) << text;
    return read_angle_table(file);
  }
  Capture good(const std::string& text) const {
    auto result = read(text);
    EXPECT_TRUE(result) << (result ? "" : result.error().line());
    return result ? *result : Capture{};
  }
  static std::vector<std::string> names(const Capture& capture) {
    std::vector<std::string> out;
    for (const AngleReading& r : capture.angles) out.push_back(core::angle_name({r.light_deg, r.aspecular_deg}));
    return out;
  }
  /// A flat spectrum of 400 to 700 nm by 10 as one row.
  static std::string flat(const std::string& heading, const std::string& value, const std::string& suffix = "") {
    std::string head = "angle", row = heading;
    for (int nm = 400; nm <= 700; nm += 10) {
      head += "," + std::to_string(nm) + suffix;
      row += "," + value;
    }
    return head + "\n" + row + "\n";
  }

  fs::path file;
};

using Names = std::vector<std::string>;

TEST_F(AngleTable, LabOfSixAngles) {
  const Capture capture = good(
      "# name = Blue metallic\n# source = BYK of shop 7\n# measured in May\nangle,L,a,b\n-15as45,110.5,-2,-20\n"
      "15as45,92.1,-1.5,-18\n25as45,70,-1,-17\n45as45,40,0,-15\n75as45,25,1,-12\n110as45,20,1.5,-11\n");
  EXPECT_EQ(capture.identity.name, "Blue metallic");
  EXPECT_EQ(capture.identity.source, "BYK of shop 7");
  EXPECT_EQ(capture.identity.lobes, core::Provenance::measured);
  EXPECT_FALSE(capture.is_fitted);
  EXPECT_EQ(names(capture), (Names{"-15as45", "15as45", "25as45", "45as45", "75as45", "110as45"}));
  EXPECT_EQ(capture.angles[0].lab, glm::dvec3(110.5, -2.0, -20.0));
}

TEST_F(AngleTable, DialectsSayTheSame) {
  const Capture comma = good("angle,L,a,b\n15as45,92.1,-1.5,-18\n110as45,20,1.5,-11\n");
  const std::vector<std::string> others = {
      std::string("\xef\xbb\xbf") + "angle;L*;a*;b*\r\n15as45;92,1;-1,5;-18\r\n110as45;20;1,5;-11\r\n",
      "b\tangle\tL\tdate\ta\n-18\t15as45\t92.1\tMay 3\t-1.5\n-11\t110as45\t20\tMay 3\t1,5\n",
      "\"angle\",\"L\",\"a\",\"b\",,\n\"15as45\",\"92.1\",-1.5,-18,,\n\n\"110as45\",20,+1.5,-11,,\n",
      "light_deg,aspecular_deg,L,a,b\n45,15,92.1,-1.5,-18\n45,110,20,1.5,-11\n",
      "value,15as45,110as45\nL,92.1,20\na,-1.5,1.5\nb,-18,-11\n",
      "angle,L,a,b\n45:as15,92.1,-1.5,-18\n45:as110,20,1.5,-11\n",
      "angle,L,a,b\nas15,92.1,-1.5,-18\nas110,20,1.5,-11\n",
      "angle,L,a,b\n15 as 45\xc2\xb0,92.1,-1.5,-18\n110as45,20,1.5,-11\n",
  };
  for (const std::string& text : others) {
    const Capture other = good(text);
    EXPECT_EQ(names(other), names(comma)) << text;
    for (std::size_t k = 0; k < comma.angles.size() && k < other.angles.size(); ++k)
      EXPECT_EQ(other.angles[k].lab, comma.angles[k].lab) << text;
  }
}

TEST_F(AngleTable, LightFirstIsTold) {
  const std::string rows = ",1,2,3\n";
  const auto table = [&](const std::vector<std::string>& angles, const std::string& head = "") {
    std::string text = head + "angle,L,a,b\n";
    for (const std::string& angle : angles) text += angle + rows;
    return text;
  };
  // 110 degrees can be no light, so 45as15 names the light first too.
  EXPECT_EQ(names(good(table({"45as15", "45as110", "45as-15"}))), (Names{"15as45", "110as45", "-15as45"}));
  EXPECT_EQ(names(good(table({"45as15", "80as15", "-45as15"}))), (Names{"45as15", "80as15", "-45as15"}));
  // The twelve angles with the light first.
  EXPECT_EQ(names(good(table({"45as-15", "45as15", "45as25", "45as45", "45as75", "45as110", "15as-45", "15as-30",
                              "15as-15", "15as15", "15as45", "15as80"}))),
            (Names{"-15as45", "15as45", "25as45", "45as45", "75as45", "110as45", "-45as15", "-30as15", "-15as15",
                   "15as15", "45as15", "80as15"}));
  // Nothing tells: degrees from the mirror direction first.
  EXPECT_EQ(names(good(table({"15as45"}))), Names{"15as45"});
  EXPECT_EQ(names(good(table({"15as45"}, "# order = light-first\n"))), Names{"45as15"});
  // Names that disagree settle nothing, and do no harm where nothing is open.
  EXPECT_EQ(names(good(table({"25as45", "45as-15"}))), (Names{"25as45", "-15as45"}));
  const auto open = read(table({"25as45", "45as-15", "15as45"}));
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().field, "line 4, column angle");
  EXPECT_NE(open.error().remedy.find("order"), std::string::npos);
}

TEST_F(AngleTable, APerfectWhiteIsWhite) {
  for (const auto& [value, suffix] : {std::pair{"1", ""}, {"100", ""}, {"100", " %"}, {"1.0", "nm"}}) {
    const Capture capture = good(flat("45as45", value, suffix));
    ASSERT_EQ(capture.angles.size(), 1u);
    EXPECT_NEAR(capture.angles[0].lab.x, 100.0, 1e-9) << value << suffix;
    EXPECT_NEAR(capture.angles[0].lab.y, 0.0, 1e-9);
    EXPECT_NEAR(capture.angles[0].lab.z, 0.0, 1e-9);
  }
  // 0.6 % is 0.6 % where the file says so.
  EXPECT_NEAR(good("# reflectance = percent\n" + flat("45as45", "0.6")).angles[0].lab.x, 903.2963 * 0.006, 1e-3);
}

TEST(CieObserver, SumsAndWhiteAreTheCies) {
  // Each function integrates to 106.86 nm (equal energy is white: CIE 15:2004); D65 is at 0.9504, 1.0888 of Y.
  glm::dvec3 sum(0.0), white(0.0);
  for (const ObserverRow& row : observer_rows()) {
    sum += glm::dvec3(row.x, row.y, row.z) * observer_step_nm;
    white += glm::dvec3(row.x, row.y, row.z) * row.d65;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], 106.86, 0.1);
  EXPECT_NEAR(white.x / white.y, core::white_xyz[0], 5e-4);
  EXPECT_NEAR(white.z / white.y, core::white_xyz[2], 2e-3);
}

TEST(CieObserver, StepsAndCutsOfASpectrumMatterLittle) {
  // A smooth blue. ASTM E308 allows 20 nm and spectra from 400 to 700.
  const auto blue = [](double nm) { return 0.04 + 0.5 * std::exp(-0.5 * std::pow((nm - 460.0) / 35.0, 2.0)); };
  const auto lab_of = [&](double from, double to, double step) {
    std::vector<double> nm, value;
    for (double at = from; at <= to; at += step) nm.push_back(at), value.push_back(blue(at));
    return lab_from_reflectance(nm, value);
  };
  const glm::dvec3 fine = lab_of(380.0, 780.0, 1.0);
  EXPECT_LT(core::ciede2000(fine, lab_of(400.0, 700.0, 10.0)), 0.05);
  EXPECT_LT(core::ciede2000(fine, lab_of(400.0, 700.0, 20.0)), 1.0);  // 0.63
  EXPECT_LT(fine.z, -30.0);
}

TEST_F(AngleTable, ReadingsAreComparedByAKnownPair) {
  // Sharma, Wu & Dalal 2005, table 1, pair 1.
  const Capture a = good("angle,L,a,b\n15as45,50,2.6772,-79.7751\n");
  const Capture b = good("angle,L,a,b\n15as45,50,0,-82.7485\n");
  EXPECT_NEAR(core::ciede2000(a.angles[0].lab, b.angles[0].lab), 2.0425, 1e-4);
}

struct BadTable {
  const char* name;
  std::string text;
  std::string field, what;  ///< parts of the answer
};
void PrintTo(const BadTable& bad, std::ostream* out) { *out << bad.name; }
class BadAngleTable : public AngleTable, public testing::WithParamInterface<BadTable> {};

TEST_P(BadAngleTable, IsNamed) {
  const auto result = read(GetParam().text);
  ASSERT_FALSE(result);
  const Error& error = result.error();
  EXPECT_NE(error.field.find(GetParam().field), std::string::npos) << error.line();
  EXPECT_NE(error.what.find(GetParam().what), std::string::npos) << error.line();
  EXPECT_EQ(error.file, file.string());
  EXPECT_EQ(error.line().find('\n'), std::string::npos);
}

std::vector<BadTable> bad_tables() {
  const std::string head = "angle,L,a,b\n";
  std::string many = head;
  for (int k = 0; k < 70; ++k) many += std::to_string(k) + "as45,1,2,3\n";
  std::string wide = "angle";
  for (int k = 0; k < 2000; ++k) wide += ",x";
  std::vector<BadTable> out;
  const auto add = [&](const char* name, std::string text, std::string field, std::string what) {
    BadTable bad;
    bad.name = name;
    bad.text = std::move(text);
    bad.field = std::move(field);
    bad.what = std::move(what);
    out.push_back(std::move(bad));
  };
  add("Empty", "", "", "is empty");
  add("OnlyComments", "# nothing\n\n", "", "no header");
  add("Binary", std::string("angle\0L", 7), "", "is no text");
  add("Huge", std::string((1u << 20) + 1, 'x'), "", "bytes");
  add("HeaderOnly", head, "line 1", "no readings");
  add("CutRow", head + "15as45,1,2\n", "line 2", "has 3 cells");
  add("DecimalCommas", head + "15as45,1,5,2,3,1\n", "line 2", "has 6 cells");
  add("Word", head + "15as45,1,two,3\n", "line 2, column a", "is not a number");
  add("NotANumber", head + "15as45,nan,2,3\n", "line 2, column L", "is not a number");
  add("Infinite", head + "15as45,1,inf,3\n", "line 2, column a", "is not a number");
  add("NegativeL", head + "15as45,-1,2,3\n", "line 2, column L", "is negative");
  add("FarOff", head + "15as45,1,2000,3\n", "line 2, column a", "out of range");
  add("NoAngles", "L,a,b\n1,2,3\n", "line 1", "has no angles");
  add("NoColours", "angle,sample\n15as45,x\n", "line 1", "neither Lab nor spectra");
  add("NoB", "angle,L,a\n15as45,1,2\n", "line 1", "no column b");
  add("TwiceL", "angle,L,a,b,L\n15as45,1,2,3,4\n", "line 1", "there twice");
  add("UnknownColumn", "angle,L,a,b,gloss\n15as45,1,2,3,4\n", "line 1, column 5", "unknown column");
  add("NoAngle", head + "fifteen,1,2,3\n", "line 2, column angle", "is no angle");
  add("NoLight", head + "20as30,1,2,3\n", "line 2, column angle", "no light");
  add("BelowTheHorizon", head + "140as45,1,2,3\n", "line 2, column angle", "below the horizon");
  // Found by fuzzing: the eye of 100:as60 stands at -40 degrees, where it may, but its light is below the horizon.
  add("LightBelowTheHorizon", head + "100:as60,1,2,3\n", "line 2, column angle", "light below the horizon");
  add("LightBeyondTheNormal", head + "-20:as60,1,2,3\n", "line 2, column angle", "light below the horizon");
  add("TwoSigns", head + "15as45,+-1,2,3\n", "line 2, column L", "is not a number");
  add("SameAngleTwice", head + "15as45,1,2,3\n15as45,1,2,3\n", "line 3, column angle", "there twice");
  add("TwoSamples", "sample,angle,L,a,b\nx,15as45,1,2,3\ny,25as45,1,2,3\n", "line 3, column sample", "another sample");
  add("TooMany", many, "line 1", "more than 64");
  add("TooWide", wide + "\n", "line 1", "more than 1024");
  add("OtherObserver", "# observer = 10\n" + head + "15as45,1,2,3\n", "line 1, observer", "not D65 and 2 degrees");
  add("OtherLight", "# illuminant = A\n" + head + "15as45,1,2,3\n", "line 1, illuminant", "not D65");
  add("OddOrder", "# order = any\n" + head + "15as45,1,2,3\n", "line 1, order", "unknown");
  add("ShortSpectrum", "angle,500,600\n15as45,0.5,0.5\n", "line 1", "do not reach");
  add("Gap", "angle,400,410,700\n15as45,0.5,0.5,0.5\n", "line 1", "gap");
  add("LabAndSpectra", "angle,L,a,b,400,700\n15as45,1,2,3,4,5\n", "line 1", "both");
  return out;
}
INSTANTIATE_TEST_SUITE_P(Tables, BadAngleTable, testing::ValuesIn(bad_tables()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_F(AngleTable, ReflectanceThatMayBePercentIsAsked) {
  const auto result = read(flat("15as45", "3"));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().remedy.find("# reflectance"), std::string::npos);
  EXPECT_FALSE(read(flat("15as45", "-0.1")));
  EXPECT_FALSE(read("# reflectance = factor\n" + flat("15as45", "500")));
  EXPECT_NEAR(good("# reflectance = factor\n" + flat("15as45", "8")).angles[0].lab.x, 216.0, 1e-6);  // 116 * 2 - 16
}

TEST_F(AngleTable, AMissingFileAndAFolderAreErrors) {
  EXPECT_FALSE(read_angle_table("/no/such/table.csv"));
  EXPECT_FALSE(read_angle_table(testing::TempDir()));
}

}  // namespace
}  // namespace lackwerk::packs
