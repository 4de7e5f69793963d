// RGL material files: their warp, their values at points computed by hand, and files that are broken.
#include "packs/tools/rgl_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "core/environment.hpp"
#include "packs/tools/brdf_import.hpp"
#include "packs/tools/rgl_tensors.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;
using Bytes = std::vector<std::uint8_t>;

// ---- small files made by hand

struct Field {
  std::string name;
  std::uint8_t type = 10;
  std::vector<std::uint64_t> shape;
  std::vector<float> floats;
  Bytes bytes;
};

template <class T>
void put(Bytes& out, const T& value) {
  const auto* at = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), at, at + sizeof value);
}
void put_text(Bytes& out, const std::string& text) { out.insert(out.end(), text.begin(), text.end()); }

Field numbers(const std::string& name, std::vector<std::uint64_t> shape, std::vector<float> values) {
  Field out;
  out.name = name;
  out.shape = std::move(shape);
  out.floats = std::move(values);
  return out;
}
Field text(const std::string& name, const std::string& value) {
  Field out;
  out.name = name;
  out.type = 1;
  out.shape = {value.size()};
  out.bytes.assign(value.begin(), value.end());
  return out;
}

/// Two angles, constant in everything but the colour: rgb = (0.5, 0.25, 0.125) * (1 + slice).
std::vector<Field> small_fields() {
  std::vector<Field> out;
  std::vector<float> rgb;
  for (int slice = 0; slice < 2; ++slice) {
    for (const float colour : {0.5f, 0.25f, 0.125f}) rgb.insert(rgb.end(), 4, colour * static_cast<float>(1 + slice));
  }
  out.push_back(text("description", "A test film"));
  out.push_back(numbers("phi_i", {1}, {0.0f}));
  out.push_back(numbers("theta_i", {2}, {0.0f, 1.5707963f}));
  out.push_back(numbers("sigma", {2, 2}, std::vector<float>(4, 0.5f)));
  out.push_back(numbers("ndf", {2, 2}, std::vector<float>(4, 2.0f)));
  out.push_back(numbers("vndf", {1, 2, 3, 3}, std::vector<float>(18, 1.0f)));
  out.push_back(numbers("luminance", {1, 2, 2, 2}, std::vector<float>(8, 0.3f)));
  out.push_back(numbers("rgb", {1, 2, 3, 2, 2}, std::move(rgb)));
  out.push_back(text("jacobian", "\x01"));
  return out;
}

Bytes file_of(const std::vector<Field>& fields) {
  Bytes out;
  put_text(out, std::string("tensor_file\0\x01\0", 14));
  put(out, static_cast<std::uint32_t>(fields.size()));
  std::size_t offset = out.size();
  for (const Field& field : fields) offset += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  for (const Field& field : fields) {
    put(out, static_cast<std::uint16_t>(field.name.size()));
    put_text(out, field.name);
    put(out, static_cast<std::uint16_t>(field.shape.size()));
    put(out, field.type);
    put(out, static_cast<std::uint64_t>(offset));
    for (const std::uint64_t extent : field.shape) put(out, extent);
    offset += field.floats.size() * sizeof(float) + field.bytes.size();
  }
  for (const Field& field : fields) {
    for (const float value : field.floats) put(out, value);
    out.insert(out.end(), field.bytes.begin(), field.bytes.end());
  }
  return out;
}

Field& named(std::vector<Field>& fields, const std::string& name) {
  return *std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
}

dvec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// ---- the warp

TEST(RglWarp, OfALinearDensityByHand) {
  // Density 1 + 2 x, the same in every row: the integral up to x is (x + x^2) / 2, its inverse (sqrt(1 + 8 u) - 1) / 2.
  const RglWarp warp({1.0f, 3.0f, 1.0f, 3.0f}, 2, 2, {});
  EXPECT_NEAR(warp.invert({0.5, 0.25}, {}).x, 0.375, 1e-12);
  EXPECT_NEAR(warp.invert({0.5, 0.25}, {}).y, 0.25, 1e-12);
  EXPECT_NEAR(warp.sample({0.375, 0.25}, {}).x, 0.5, 1e-12);
  // Density 1 + 2 y: rows by their marginal.
  const RglWarp upright({1.0f, 1.0f, 3.0f, 3.0f}, 2, 2, {});
  EXPECT_NEAR(upright.invert({0.3, 0.5}, {}).y, 0.375, 1e-12);
  EXPECT_NEAR(upright.invert({0.3, 0.5}, {}).x, 0.3, 1e-12);
}

TEST(RglWarp, InvertsItself) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> even(0.05f, 1.0f);
  std::vector<float> nodes(4 * 7 * 9);
  for (float& node : nodes) node = even(random);
  const RglWarp warp(nodes, 9, 7, {{0.0f, 1.0f}, {0.0f, 0.5f}});
  for (int k = 0; k < 2000; ++k) {
    const dvec2 at(even(random), even(random));
    const double parameters[]{static_cast<double>(even(random)), static_cast<double>(even(random)) * 0.5};
    const dvec2 uniform = warp.invert(at, parameters);
    const dvec2 back = warp.sample(uniform, parameters);
    EXPECT_NEAR(back.x, at.x, 1e-7);
    EXPECT_NEAR(back.y, at.y, 1e-7);
  }
}

TEST(RglWarp, TheLastRowOfTheLastSliceHasNoneBehindIt) {
  // Found by fuzzing: the total of the last row was read as a blend with the next one, which the last slice does not
  // have (sanitizers tell). Rows 1, 2, 3 of two slices; the marginal of 1 + 2 y up to y = 0.75 is (y + y^2) / 2.
  const std::vector<float> rows{1.0f, 1.0f, 2.0f, 2.0f, 3.0f, 3.0f};
  std::vector<float> nodes = rows;
  nodes.insert(nodes.end(), rows.begin(), rows.end());
  const RglWarp warp(nodes, 2, 3, {{0.0f, 1.0f}});
  for (const double parameter : {0.0, 0.5, 1.0, 2.0}) {
    const double at[]{parameter};
    EXPECT_NEAR(warp.invert({0.25, 0.75}, at).y, 0.65625, 1e-7);
    EXPECT_NEAR(warp.invert({0.25, 1.0}, at).y, 1.0, 1e-7);
    EXPECT_NEAR(warp.sample({0.25, 0.65625}, at).y, 0.75, 1e-6);
  }
}

TEST(RglWarp, SendsUniformPointsWhereTheDensityIs) {
  std::vector<float> nodes(16, 0.0f);
  nodes[5] = 1.0f;  // a tent over the node (1, 1) of 4 x 4
  const RglWarp warp(nodes, 4, 4, {});
  EXPECT_FALSE(warp.has_empty_slice());
  std::mt19937 random(2);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  dvec2 mean(0.0);
  for (int k = 0; k < 4000; ++k) {
    const dvec2 at = warp.sample({even(random), even(random)}, {});
    EXPECT_LT(at.x, 2.0 / 3.0 + 1e-9);
    EXPECT_LT(at.y, 2.0 / 3.0 + 1e-9);
    mean += at / 4000.0;
  }
  EXPECT_NEAR(mean.x, 1.0 / 3.0, 0.01);
  EXPECT_NEAR(mean.y, 1.0 / 3.0, 0.01);
  EXPECT_TRUE(RglWarp(std::vector<float>(4, 0.0f), 2, 2, {}).has_empty_slice());
}

// ---- values

TEST(RglFile, SmallFileByHand) {
  const Bytes bytes = file_of(small_fields());
  const auto material = read_rgl(bytes, "small");
  ASSERT_TRUE(material) << material.error().line();
  EXPECT_EQ(material->description(), "A test film");
  EXPECT_EQ(material->negative_share(), 0.0);
  // 0.5 * 2 / (4 * 0.5) / cos: a quarter of the way from the first angle to the second at 22.5 degrees.
  for (const double theta_out : {0.0, 0.7, 1.2}) {
    const dvec3 value = (*material)(direction(pi / 8.0, 1.0), direction(theta_out, 2.5));
    EXPECT_NEAR(value.x, 0.5 * 1.25 / std::cos(theta_out), 1e-6);
    EXPECT_NEAR(value.z, 0.125 * 1.25 / std::cos(theta_out), 1e-6);
  }
  EXPECT_EQ((*material)({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}), dvec3(0.0));
  EXPECT_EQ((*material)({0.6, 0.0, -0.8}, {0.0, 0.0, 1.0}), dvec3(0.0));
}

TEST(RglFile, WithoutJacobianTheColoursAreWhole) {
  auto fields = small_fields();
  named(fields, "jacobian").bytes = {0};
  const auto material = read_rgl(file_of(fields), "small");
  ASSERT_TRUE(material);
  EXPECT_NEAR((*material)({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}).y, 0.25, 1e-6);
}

std::filesystem::path real_file(const std::string& name) {
  return std::filesystem::path(LACKWERK_SOURCE_DIR "/../shared/data/rgl") / (name + "_rgb.bsdf");
}

/// Value at a node: entry `theta` of theta_i, and the half vector at a node of ndf and vndf, where interpolation is the
/// identity. Computed from the raw arrays by another program, with plain sums.
struct HandPoint {
  const char* file;
  std::size_t theta;
  int column, row;
  dvec3 value;
};

const HandPoint hand_points[]{
    {"irid_flake_paint1", 1, 4, 20, {16.862796932861205, 16.506990261789294, 16.689940800061997}},
    {"irid_flake_paint1", 3, 20, 90, {0.8059826251381641, 0.7402524874540078, 0.677919407251416}},
    {"irid_flake_paint1", 5, 12, 64, {141.57282322995593, 144.61351494706034, 150.74052962479195}},
    {"irid_flake_paint1", 6, 30, 100, {4.4199809660275555, 4.697599111828493, 4.9719598285122135}},
    {"satin_rosaline", 1, 4, 20, {2.7348067963833604, 1.607628997826724, 2.0535283131664612}},
    {"satin_rosaline", 3, 20, 90, {2.7310008805620596, 2.0087935588233417, 2.058670803948352}},
    {"satin_rosaline", 5, 12, 64, {25.683741974932985, 24.06632304106586, 22.977364015361054}},
    {"satin_rosaline", 6, 30, 100, {66.84594294431939, 67.8046061515963, 68.53304106671669}},
};

TEST(RglFile, RealFilesAtPointsComputedByHand) {
  for (const HandPoint& point : hand_points) {
    if (!std::filesystem::exists(real_file(point.file))) GTEST_SKIP() << "needs ../shared/data/rgl";
    const auto material = read_rgl(real_file(point.file));
    ASSERT_TRUE(material) << material.error().line();
    const dvec3 in = direction(static_cast<double>(material->theta_in()[point.theta]), 0.0);
    const double x = point.column / 127.0;
    const dvec3 half = direction(x * x * pi / 2.0, (2.0 * point.row / 127.0 - 1.0) * pi);
    const dvec3 out = 2.0 * glm::dot(in, half) * half - in;
    // Turned about the normal it is the same: isotropic.
    const auto turned = [](const dvec3& v) { return dvec3(0.6 * v.x - 0.8 * v.y, 0.8 * v.x + 0.6 * v.y, v.z); };
    for (const dvec3& found : {(*material)(in, out), (*material)(turned(in), turned(out))}) {
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(found[channel], point.value[channel], 2e-5 * point.value[channel])
            << point.file << " " << point.theta << " " << point.column << " " << point.row;
    }
  }
}

/// Reciprocity is what tells that the cosine is in the file: satin is broad and well measured.
TEST(RglFile, SatinIsReciprocalOnceItsCosineIsDividedOut) {
  if (!std::filesystem::exists(real_file("satin_rosaline"))) GTEST_SKIP() << "needs ../shared/data/rgl";
  const auto material = read_rgl(real_file("satin_rosaline"));
  ASSERT_TRUE(material);
  const core::BrdfHealth whole = core::health(std::cref(*material));
  EXPECT_LT(whole.mean_reciprocity, 0.04);
  const core::BrdfHealth with_cosine =
      core::health([&](const dvec3& in, const dvec3& out) { return (*material)(in, out) * out.z; });
  EXPECT_GT(with_cosine.mean_reciprocity, 0.25);
}

TEST(RglFile, EveryRealFileKeepsItsEnergyAndItsTable) {
  struct Expected {
    const char* file;
    const char* name;
    double albedo;      ///< highest, at most
    double resampling;  ///< CIEDE2000, mean, at most
  };
  // satin_rosaline gives out more than it gets beyond 70 degrees of incidence: the file does, its table may not be
  // worse.
  const Expected files[]{{"irid_flake_paint1", "Dupli-color flip flop ultra", 1.0, 0.5},
                         {"cc_nothern_aurora", "Nothern Aurora RD05, vinyl film", 1.0, 0.3},
                         {"chm_mint", "Mint CHM16E, vinyl film", 1.0, 1.0},
                         {"chm_orange", "Orange CHM11E, vinyl film", 1.0, 1.0},
                         {"satin_rosaline", "Rosaline Satin CK904, vinyl film", 1.17, 0.1},
                         {"vch_silk_blue", "Silk Blue VCH502N, vinyl film", 1.0, 0.1}};
  // Each takes two seconds; the paint and the worst two stand for all.
  for (const Expected& expected : {files[0], files[2], files[4]}) {
    if (!std::filesystem::exists(real_file(expected.file))) GTEST_SKIP() << "needs ../shared/data/rgl";
    BrdfImportReport report;
    const auto capture = import_rgl(real_file(expected.file), {}, report);
    ASSERT_TRUE(capture) << capture.error().line();
    EXPECT_EQ(capture->identity.name, expected.name);
    EXPECT_EQ(capture->identity.lobes, core::Provenance::measured);
    EXPECT_NE(capture->identity.source.find("Dupuy & Jakob 2018"), std::string::npos);
    EXPECT_FALSE(capture->is_fitted);
    EXPECT_EQ(report.holes, 0u);
    EXPECT_LE(report.highest_albedo, expected.albedo);
    EXPECT_GT(report.highest_albedo, 0.2);
    ASSERT_TRUE(report.resampling);
    EXPECT_EQ(report.resampling->directions, 4096u);
    EXPECT_LT(report.resampling->mean, expected.resampling) << expected.file;
    RecordProperty(expected.file, std::to_string(report.resampling->mean));
  }
}

TEST(RglFile, NamesSayWhatIsAFilm) {
  EXPECT_EQ(rgl_name("TeckWrap vinyl wrapping film (Mint CHM16E)", "chm_mint_rgb"), "Mint CHM16E, vinyl film");
  EXPECT_EQ(rgl_name("Car paint (\"Deep\") on aluminium", "x_rgb"), "Deep");
  EXPECT_EQ(rgl_name("Plain", "x_rgb"), "Plain");
  EXPECT_EQ(rgl_name("", "some_film_rgb"), "some_film");
}

// ---- broken files

Error refusal(const Bytes& bytes) {
  const auto material = read_rgl(bytes, "bad.bsdf");
  EXPECT_FALSE(material);
  return material ? Error{} : material.error();
}

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

struct BadField {
  const char* what;
  const char* field;  ///< that the error names
  const char* says;   ///< part of what it says
  std::function<void(std::vector<Field>&)> spoil;
};

TEST(RglFile, RefusesWrongFieldsByName) {
  const auto edit = [](const char* name, auto change) {
    return [name, change](std::vector<Field>& fields) { change(named(fields, name)); };
  };
  const BadField cases[]{
      {"no rgb", "rgb", "is missing", [](auto& f) { named(f, "rgb").name = "rgbx"; }},
      {"spectral", "spectra", "spectral", [](auto& f) { named(f, "rgb").name = "spectra"; }},
      {"twice", "ndf", "twice", [](auto& f) { named(f, "sigma").name = "ndf"; }},
      {"NaN", "ndf", "finite", edit("ndf", [](Field& f) { f.floats[2] = nan_value; })},
      {"infinite", "rgb", "finite",
       edit("rgb", [](Field& f) { f.floats[3] = std::numeric_limits<float>::infinity(); })},
      {"huge", "rgb", "1e30", edit("rgb", [](Field& f) { f.floats[3] = 1e31f; })},
      {"negative ndf", "ndf", "negative", edit("ndf", [](Field& f) { f.floats[1] = -1.0f; })},
      {"negative vndf", "vndf", "negative", edit("vndf", [](Field& f) { f.floats[1] = -1e-9f; })},
      {"negative luminance", "luminance", "negative", edit("luminance", [](Field& f) { f.floats[7] = -0.1f; })},
      {"negative light", "rgb", "negative luminance", edit("rgb", [](Field& f) { f.floats[4] = -3.0f; })},
      {"black", "rgb", "no light", edit("rgb", [](Field& f) { std::fill(f.floats.begin(), f.floats.end(), 0.0f); })},
      {"zero sigma", "sigma", "zero", edit("sigma", [](Field& f) { f.floats[0] = 0.0f; })},
      {"empty warp", "vndf", "zeros", edit("vndf", [](Field& f) { std::fill_n(f.floats.begin(), 9, 0.0f); })},
      {"anisotropic", "phi_i", "anisotropic",
       [](auto& f) {
         named(f, "phi_i") = numbers("phi_i", {3}, {0.0f, 1.0f, 2.0f});
       }},
      {"falling angles", "theta_i", "rise", edit("theta_i", [](Field& f) { std::swap(f.floats[0], f.floats[1]); })},
      {"angle below", "theta_i", "range", edit("theta_i", [](Field& f) { f.floats[1] = 1.7f; })},
      {"angle NaN", "theta_i", "range", edit("theta_i", [](Field& f) { f.floats[0] = nan_value; })},
      {"angles differ", "vndf", "dimension 1", [](auto& f) { named(f, "theta_i") = numbers("theta_i", {1}, {0.0f}); }},
      {"dimensions", "rgb", "dimensions",
       edit("rgb",
            [](Field& f) {
              f.shape = {2, 3, 2, 2};
            })},
      {"channels", "rgb", "dimension 2",
       edit("rgb",
            [](Field& f) {
              f.shape = {1, 2, 2, 2, 3};
            })},
      {"one node", "ndf", "1 x 4",
       edit("ndf",
            [](Field& f) {
              f.shape = {4, 1};
            })},
      {"type", "sigma", "type 5", edit("sigma", [](Field& f) { f.type = 5; })},
      {"unknown type", "sigma", "unknown type", edit("sigma", [](Field& f) { f.type = 12; })},
      {"no jacobian", "jacobian", "missing", [](auto& f) { named(f, "jacobian").name = "j"; }},
      {"huge extent", "vndf", "declares", edit("vndf", [](Field& f) { f.shape[3] = 1ull << 62; })},
      {"product runs over", "vndf", "declares",
       edit("vndf",
            [](Field& f) {
              f.shape = {1ull << 8, 1ull << 8, 1ull << 24, 1ull << 24};
            })},
      {"no extent", "vndf", "declares 0", edit("vndf", [](Field& f) { f.shape[0] = 0; })},
      {"nine dimensions", "phi_i", "9 dimensions",
       edit("phi_i", [](Field& f) { f.shape = std::vector<std::uint64_t>(9, 1); })},
      {"no dimension", "phi_i", "0 dimensions", edit("phi_i", [](Field& f) { f.shape.clear(); })},
      {"longer than it is", "jacobian", "lies at", edit("jacobian", [](Field& f) { f.shape = {2}; })},
      {"into the next", "sigma", "overlaps", edit("phi_i", [](Field& f) { f.shape = {4}; })},
  };
  for (const BadField& bad : cases) {
    auto fields = small_fields();
    bad.spoil(fields);
    const Error error = refusal(file_of(fields));
    EXPECT_EQ(error.file, "bad.bsdf") << bad.what;
    if (std::string(bad.what) == "into the next") {
      EXPECT_NE(error.what.find("overlaps"), std::string::npos) << error.line();
      continue;
    }
    EXPECT_EQ(error.field, bad.field) << bad.what << ": " << error.line();
    EXPECT_NE(error.what.find(bad.says), std::string::npos) << bad.what << ": " << error.line();
    EXPECT_FALSE(error.remedy.empty()) << bad.what;
  }
}

TEST(RglFile, RefusesWrongHeaders) {
  const Bytes good = file_of(small_fields());
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes bytes = good;
    bytes[at] = value;
    return refusal(bytes);
  };
  EXPECT_NE(refusal({}).what.find("empty"), std::string::npos);
  EXPECT_EQ(with(0, 'T').field, "header");
  EXPECT_EQ(with(12, 2).field, "version");
  EXPECT_EQ(with(17, 0xff).field, "header");       // four billion fields
  EXPECT_EQ(with(18 + 1, 0x7f).field, "field 1");  // a name of 32 kB
  EXPECT_EQ(with(20, '\n').field, "field 1");
}

TEST(RglFile, OffsetsMustLieInTheFileAndApart) {
  const Bytes good = file_of(small_fields());
  // description: 18 + 2 + 11 + 2 + 1 is where its offset stands.
  constexpr std::size_t offset_at = 18 + 2 + 11 + 2 + 1;
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{20}, std::uint64_t{good.size()},
                                     std::uint64_t{good.size() - 3}, ~std::uint64_t{0}, ~std::uint64_t{0} - 11}) {
    Bytes bytes = good;
    std::memcpy(&bytes[offset_at], &offset, sizeof offset);
    const Error error = refusal(bytes);
    EXPECT_EQ(error.field, "description") << offset << ": " << error.line();
  }
  std::uint64_t offset = 0;
  Bytes bytes = good;
  std::memcpy(&offset, &bytes[offset_at], sizeof offset);
  offset += 4;  // into phi_i
  std::memcpy(&bytes[offset_at], &offset, sizeof offset);
  EXPECT_NE(refusal(bytes).what.find("overlaps"), std::string::npos);
}

TEST(RglFile, EveryCutIsRefused) {
  const Bytes good = file_of(small_fields());
  for (std::size_t length = 0; length < good.size(); ++length)
    refusal(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)));
}

TEST(RglFile, FlippedBitsGiveAnErrorOrNumbers) {
  const Bytes good = file_of(small_fields());
  const dvec3 in = direction(0.4, 0.0), out = direction(0.6, 2.0);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bytes = good;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << (bit % 8)));
    const auto material = read_rgl(bytes, "flipped");
    if (!material) continue;
    const dvec3 value = (*material)(in, out);
    EXPECT_TRUE(std::isfinite(value.x + value.y + value.z)) << bit;
  }
}

TEST(RglFile, FilesOnDiskAreNamed) {
  const testing::TemporaryFolder folder;
  const auto missing = read_rgl(folder / "none.bsdf");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().file, (folder / "none.bsdf").string());
  testing::write_bytes(folder / "empty.bsdf", "", 0);
  const auto empty = read_rgl(folder / "empty.bsdf");
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().what.find("empty"), std::string::npos);
  EXPECT_FALSE(read_rgl(folder.path()));
  testing::write_bytes(folder / "long.bsdf", "", 0);
  std::filesystem::resize_file(folder / "long.bsdf", (64u << 20) + 1);
  const auto longer = read_rgl(folder / "long.bsdf");
  ASSERT_FALSE(longer);
  EXPECT_NE(longer.error().what.find("at most"), std::string::npos);
}

}  // namespace
}  // namespace lackwerk::packs
