// MERL binaries: layout, scale and holes by hand; files made from published fits of real paints; broken files.
#include "packs/tools/merl_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "packs/tools/brdf_import.hpp"
#include "packs/tools/neural_brdf.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using glm::dvec3;
using std::numbers::pi;
using Bytes = std::vector<std::uint8_t>;

constexpr core::BrdfTableSize small{10, 8, 12};

/// A file with the same three numbers at every node.
Bytes constant_file(const core::BrdfTableSize& size, const dvec3& stored) {
  Bytes out(12 + 24 * size.cells());
  const std::int32_t header[]{static_cast<std::int32_t>(size.theta_h), static_cast<std::int32_t>(size.theta_d),
                              static_cast<std::int32_t>(size.phi_d)};
  std::memcpy(out.data(), header, sizeof header);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t node = 0; node < size.cells(); ++node)
      std::memcpy(&out[12 + 8 * (channel * size.cells() + node)], &stored[static_cast<int>(channel)], 8);
  }
  return out;
}

void set_value(Bytes& bytes, const core::BrdfTableSize& size, std::size_t channel, std::size_t node, double value) {
  std::memcpy(&bytes[12 + 8 * (channel * size.cells() + node)], &value, sizeof value);
}

TEST(MerlFile, PlanesHaveTheirScales) {
  const auto material = read_merl(constant_file(small, dvec3(1500.0, 1500.0, 1500.0)), "white", small);
  ASSERT_TRUE(material) << material.error().line();
  EXPECT_EQ(material->holes, 0u);
  EXPECT_EQ(material->table.holes(), 0u);
  const auto value = material->table.at({0.0, 0.0, 1.0}, {0.6, 0.0, 0.8});
  ASSERT_TRUE(value);
  EXPECT_NEAR(value->x, 1.0, 1e-6);
  EXPECT_NEAR(value->y, 1.15, 1e-6);
  EXPECT_NEAR(value->z, 1.66, 1e-6);
}

TEST(MerlFile, NodesStandWhereTheLayoutSays) {
  const std::size_t node = (std::size_t{45} * 90 + 30) * 180 + 60;
  EXPECT_NEAR(merl_node(node).theta_h, 0.25 * pi / 2.0, 1e-12);
  EXPECT_NEAR(merl_node(node).theta_d, pi / 6.0, 1e-12);
  EXPECT_NEAR(merl_node(node).phi_d, pi / 3.0, 1e-12);
  // What is linear in the grid's coordinates comes back exactly at the middles, half a cell above the nodes.
  const auto linear = [](const core::HalfAngles& angles) {
    return dvec3(1.0 + std::sqrt(angles.theta_h), 1.0 + angles.theta_d, 2.0);
  };
  const Bytes bytes =
      merl_bytes([&](const dvec3& in, const dvec3& out) { return linear(core::half_angles(in, out)); }, small);
  const auto material = read_merl(bytes, "linear", small);
  ASSERT_TRUE(material) << material.error().line();
  std::size_t compared = 0;
  for (std::size_t cell = 0; cell < small.cells(); ++cell) {
    const core::HalfAngles middle = material->table.middle(cell);
    // Away from the border, where nodes below the horizon are left out, and from the last nodes.
    if (middle.theta_h + middle.theta_d > 1.0) continue;
    const auto value = material->table.value(cell);
    ASSERT_TRUE(value);
    EXPECT_NEAR(static_cast<double>(value->x), linear(middle).x, 1e-5);
    EXPECT_NEAR(static_cast<double>(value->y), linear(middle).y, 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

TEST(MerlFile, WritingStoresScaledPlanesAndMarksWhatIsBelow) {
  const Bytes bytes = merl_bytes([](const dvec3&, const dvec3&) { return dvec3(0.5, 0.25, 0.125); }, small);
  const auto stored = [&](std::size_t channel, std::size_t node) {
    double value = 0.0;
    std::memcpy(&value, &bytes[12 + 8 * (channel * small.cells() + node)], sizeof value);
    return value;
  };
  EXPECT_NEAR(stored(0, 0), 0.5 * 1500.0, 1e-9);
  EXPECT_NEAR(stored(1, 0), 0.25 * 1500.0 / 1.15, 1e-9);
  EXPECT_NEAR(stored(2, 0), 0.125 * 1500.0 / 1.66, 1e-9);
  const std::size_t below = (std::size_t{9} * 8 + 7) * 12;  // theta_h 73, theta_d 79 degrees, phi_d 0
  for (std::size_t channel = 0; channel < 3; ++channel) EXPECT_EQ(stored(channel, below), -1.0);
}

TEST(MerlFile, HolesStayOpenUntilTheyAreFilled) {
  Bytes bytes = constant_file(small, dvec3(300.0));
  // One node alone does not make a hole: seven others are around each middle.
  const std::size_t lonely = (std::size_t{3} * 8 + 2) * 12 + 5;
  set_value(bytes, small, 1, lonely, -1.0);  // any channel makes the node a hole
  auto material = read_merl(bytes, "holes", small);
  ASSERT_TRUE(material) << material.error().line();
  EXPECT_EQ(material->holes, 1u);
  EXPECT_EQ(material->table.holes(), 0u);
  // A whole row of theta_h: 4 of 8 around are left, which is enough; two rows: none between them.
  for (std::size_t k = 0; k < 2 * 8 * 12; ++k) set_value(bytes, small, 0, std::size_t{5} * 8 * 12 + k, -0.5);
  material = read_merl(bytes, "holes", small);
  ASSERT_TRUE(material);
  const core::BrdfTable& table = material->table;
  const std::size_t between = (std::size_t{5} * 8 + 1) * 12 + 3;
  EXPECT_FALSE(table.value(between));
  EXPECT_TRUE(table.value(between - std::size_t{8} * 12));
  EXPECT_TRUE(table.value(between + std::size_t{8} * 12));
  const std::size_t holes = table.holes();
  EXPECT_GT(holes, 50u);
  core::BrdfTable filled = table;
  EXPECT_GE(core::fill_holes(filled), holes);
  ASSERT_TRUE(filled.value(between));
  EXPECT_NEAR(static_cast<double>(filled.value(between)->x), 0.2, 1e-6);
}

struct BadFile {
  const char* what;
  const char* field;
  const char* says;
  std::function<void(Bytes&)> spoil;
};

TEST(MerlFile, RefusesBrokenFilesByField) {
  const auto header = [](std::size_t at, std::int32_t value) {
    return [at, value](Bytes& b) { std::memcpy(&b[4 * at], &value, sizeof value); };
  };
  const auto value = [](std::size_t channel, std::size_t node, double stored) {
    return [=](Bytes& b) { set_value(b, small, channel, node, stored); };
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const BadFile cases[]{
      {"zero bytes", "", "empty", [](Bytes& b) { b.clear(); }},
      {"half a header", "dimensions", "header", [](Bytes& b) { b.resize(7); }},
      {"only a header", "values", "12 bytes", [](Bytes& b) { b.resize(12); }},
      {"cut", "values", "bytes, not", [](Bytes& b) { b.pop_back(); }},
      {"too long", "end", "bytes, not", [](Bytes& b) { b.push_back(0); }},
      {"other theta_h", "dimensions", "11 theta_h, not 10", header(0, 11)},
      {"other phi_d", "dimensions", "360 phi_d", header(2, 360)},
      {"huge", "dimensions", "2147483647 theta_d", header(1, 2147483647)},
      {"negative dimension", "dimensions", "-90 theta_h", header(0, -90)},
      {"zero dimension", "dimensions", "0 phi_d", header(2, 0)},
      {"NaN", "blue plane, value 17", "finite", value(2, 17, std::numeric_limits<double>::quiet_NaN())},
      {"infinite", "red plane, value 3", "finite", value(0, 3, infinite)},
      {"minus infinite", "green plane, value 3", "finite", value(1, 3, -infinite)},
      {"beyond", "green plane, value 959", "1e9", value(1, 959, 2e9)},
      {"only holes", "values", "nothing but holes",
       [](Bytes& b) { b = constant_file(small, dvec3(10.0, -1.0, 10.0)); }},
  };
  for (const BadFile& bad : cases) {
    Bytes bytes = constant_file(small, dvec3(10.0));
    bad.spoil(bytes);
    const auto material = read_merl(bytes, "bad.binary", small);
    ASSERT_FALSE(material) << bad.what;
    const Error& error = material.error();
    EXPECT_EQ(error.file, "bad.binary");
    EXPECT_EQ(error.field, bad.field) << bad.what << ": " << error.line();
    EXPECT_NE(error.what.find(bad.says), std::string::npos) << bad.what << ": " << error.line();
    EXPECT_FALSE(error.remedy.empty()) << bad.what;
  }
}

TEST(MerlFile, OnDiskOnlyMerlsOwnSizeIsRead) {
  const testing::TemporaryFolder folder;
  const Bytes bytes = constant_file(small, dvec3(10.0));
  std::ofstream(folder / "small.binary", std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const auto other = read_merl(folder / "small.binary");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().field, "dimensions");
  EXPECT_EQ(other.error().file, (folder / "small.binary").string());
  testing::write_bytes(folder / "huge.binary", "", 0);
  std::filesystem::resize_file(folder / "huge.binary", std::uintmax_t{1} << 36);  // sparse: takes no room
  EXPECT_FALSE(read_merl(folder / "huge.binary"));
  EXPECT_FALSE(read_merl(folder / "none.binary"));
}

const std::filesystem::path fits = LACKWERK_SOURCE_DIR "/../shared/data/merl/neural_fits.json";

TEST(NeuralBrdf, AgreesWithAnotherProgram) {
  if (!std::filesystem::exists(fits)) GTEST_SKIP() << "needs ../shared/data/merl/neural_fits.json";
  const auto blue = read_neural_brdf(fits, "blue-metallic-paint");
  ASSERT_TRUE(blue) << blue.error().line();
  const auto at = [&](double h, double d, double p) {
    const core::DirectionPair pair = core::directions({h, d, p});
    return (*blue)(pair.in, pair.out);
  };
  EXPECT_NEAR(at(0.02, 0.5, 1.0).x, 0.13390837290045932, 1e-7);
  EXPECT_NEAR(at(0.02, 0.5, 1.0).z, 0.3638910708096419, 1e-7);
  EXPECT_NEAR(at(0.4, 0.3, 2.0).y, 0.008553049809168156, 1e-7);
  const auto unknown = read_neural_brdf(fits, "brown-paint");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().remedy.find("pearl-paint"), std::string::npos);
}

TEST(NeuralBrdf, RefusesOtherShapes) {
  const testing::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& field) {
    std::ofstream(folder / "fits.json") << text;
    const auto read = read_neural_brdf(folder / "fits.json", "a");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().field, field) << read.error().line();
  };
  refused("not JSON", "");
  refused("[]", "");
  refused("{\"a\": 3}", "a");
  refused("{\"a\": {}}", "a.W1");
  refused("{\"a\": {\"W1\": [[1, 2], [3, 4]]}}", "a.W1");
  refused("{\"a\": {\"W1\": \"text\"}}", "a.W1");
}

/// A published fit of a real paint, as a MERL file with holes, imported: no measurement, and it says so.
TEST(MerlFile, PublishedFitsComeThrough) {
  if (!std::filesystem::exists(fits)) GTEST_SKIP() << "needs ../shared/data/merl/neural_fits.json";
  const auto fit = read_neural_brdf(fits, "color-changing-paint1");
  ASSERT_TRUE(fit) << fit.error().line();
  const testing::TemporaryFolder folder;
  std::mt19937 random(1);
  const auto written = write_merl(
      [&](const dvec3& in, const dvec3& out) {
        return random() % 10 == 0 ? dvec3(-1.0) : glm::max((*fit)(in, out), dvec3(0.0));
      },
      folder / "colour-change.binary");
  ASSERT_TRUE(written) << written.error().line();
  EXPECT_EQ(std::filesystem::file_size(folder / "colour-change.binary"), 12u + 24u * 1458000u);
  BrdfImportSettings settings;
  settings.provenance = core::Provenance::published_fit;
  settings.note = "Sztrajman et al. 2021";
  BrdfImportReport report;
  const auto capture = import_merl(folder / "colour-change.binary", settings, report);
  ASSERT_TRUE(capture) << capture.error().line();
  EXPECT_EQ(capture->identity.name, "colour-change");
  EXPECT_EQ(capture->identity.lobes, core::Provenance::published_fit);
  EXPECT_NE(capture->identity.source.find("published fit"), std::string::npos);
  EXPECT_NE(capture->identity.source.find("Sztrajman"), std::string::npos);
  EXPECT_FALSE(capture->is_fitted);
  // Less than half of eight nodes are known once in two thousand times at one hole in ten.
  EXPECT_LT(report.holes, report.cells / 500);
  EXPECT_LT(report.highest_albedo, 1.0);
  const BrdfDifference error =
      difference([&](const dvec3& in, const dvec3& out) { return capture->measured->at(in, out).value_or(dvec3(0.0)); },
                 std::cref(*fit), 4096);
  RecordProperty("ciede2000_mean", std::to_string(error.mean));
  EXPECT_LT(error.mean, 0.3);
  EXPECT_LT(error.p95, 1.5);  // one hole in ten makes the means one-sided: without holes it is 0.96
}

}  // namespace
}  // namespace lackwerk::packs
