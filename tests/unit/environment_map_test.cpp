#include "packs/tools/environment_map.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "core/analysis/environment_lights.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::TemporaryFolder;

constexpr double pi = 3.14159265358979323846;

void write_picture(const std::filesystem::path& path, const OIIO::ImageSpec& spec, const std::vector<float>& values) {
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output);
  ASSERT_TRUE(output->open(path.string(), spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
}

OIIO::ImageSpec float_spec(int width, int height, int channels) {
  return {width, height, channels, OIIO::TypeDesc::FLOAT};
}

TEST(EnvironmentMap, ReadsColourGreyAndAlpha) {
  const TemporaryFolder folder;
  for (const int channels : {1, 2, 3, 4}) {
    std::vector<float> values;
    for (int k = 0; k < 32; ++k) {
      for (int c = 0; c < channels; ++c) values.push_back(static_cast<float>(k) + 0.25f * static_cast<float>(c));
    }
    const auto path = folder.path() / ("room" + std::to_string(channels) + ".exr");
    OIIO::ImageSpec spec = float_spec(8, 4, channels);
    if (channels == 2) spec.channelnames = {"Y", "A"};
    write_picture(path, spec, values);
    const auto read = read_environment_map(path);
    ASSERT_TRUE(read) << read.error().line();
    EXPECT_EQ(read->map.name, "room" + std::to_string(channels));
    EXPECT_EQ(read->map.width, 8);
    EXPECT_TRUE(read->repairs.empty());
    EXPECT_EQ(read->map.pixels[9], channels < 3 ? glm::vec3(9.0f) : glm::vec3(9.0f, 9.25f, 9.5f)) << channels;
  }
}

TEST(EnvironmentMap, SaysWhatItMended) {
  const TemporaryFolder folder;
  std::vector<float> values(64 * 32 * 3, 0.5f);
  values[300] = std::numeric_limits<float>::quiet_NaN();
  values[900] = -2.0f;
  values[1203] = std::numeric_limits<float>::infinity();
  const auto path = folder.path() / "dusty.exr";
  write_picture(path, float_spec(64, 32, 3), values);
  const auto read = read_environment_map(path);
  ASSERT_TRUE(read) << read.error().line();
  ASSERT_EQ(read->repairs.size(), 2u);
  EXPECT_EQ(read->repairs[0], "1 negative pixels were set to 0");
  EXPECT_EQ(read->repairs[1], "2 infinite or undefined pixels were filled from their neighbours");
  EXPECT_EQ(read->map.pixels[100], glm::vec3(0.5f));
}

TEST(EnvironmentMap, RefusesWithFileFieldAndRemedy) {
  const TemporaryFolder folder;
  const auto refused = [](const std::filesystem::path& path, const std::string& field) {
    const auto read = read_environment_map(path);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().file, path.string());
    EXPECT_EQ(read.error().field, field) << read.error().line();
    EXPECT_FALSE(read.error().remedy.empty());
  };
  refused(folder.path() / "missing.hdr", "");
  refused(folder.path() / "picture.png", "format");
  std::ofstream(folder.path() / "text.hdr") << "no picture at all";
  refused(folder.path() / "text.hdr", "");
  write_picture(folder.path() / "wide.exr", float_spec(16386, 1, 1), std::vector<float>(16386, 1.0f));
  refused(folder.path() / "wide.exr", "size");
  write_picture(folder.path() / "square.exr", float_spec(8, 8, 3), std::vector<float>(192, 1.0f));
  refused(folder.path() / "square.exr", "size");
  write_picture(folder.path() / "many.exr", float_spec(8, 4, 6), std::vector<float>(192, 1.0f));
  refused(folder.path() / "many.exr", "channels");
  write_picture(folder.path() / "black.hdr", float_spec(8, 4, 3), std::vector<float>(96, 0.0f));
  refused(folder.path() / "black.hdr", "pixels");
  write_picture(folder.path() / "nan.exr", float_spec(8, 4, 3),
                std::vector<float>(96, std::numeric_limits<float>::quiet_NaN()));
  refused(folder.path() / "nan.exr", "pixels");
  OIIO::ImageSpec cropped = float_spec(8, 4, 3);
  cropped.full_width = 16;
  cropped.full_height = 8;
  write_picture(folder.path() / "cropped.exr", cropped, std::vector<float>(96, 1.0f));
  refused(folder.path() / "cropped.exr", "data window");
}

TEST(EnvironmentMap, CutFileIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "cut.exr";
  std::vector<float> values(256 * 128 * 3);
  std::mt19937 random(3);
  for (float& v : values) v = std::uniform_real_distribution<float>(0.0f, 1.0f)(random);
  write_picture(path, float_spec(256, 128, 3), values);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_FALSE(read_environment_map(path));
}

// The maps that come with the data: light kept at every level, light cuts against the exact cosine integral.
class RealMap : public ::testing::TestWithParam<const char*> {};

TEST_P(RealMap, KeepsItsLightAndItsCutsLightDiffusers) {
  const std::filesystem::path path =
      std::filesystem::path(LACKWERK_SOURCE_DIR "/../shared/data/hdri") / (std::string(GetParam()) + ".hdr");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "shared/data/hdri/" << GetParam() << ".hdr is not there";
  const auto read = read_environment_map(path);
  ASSERT_TRUE(read) << read.error().line();
  glm::dvec3 light(0.0);
  for (int y = 0; y < read->map.height; ++y) {
    for (int x = 0; x < read->map.width; ++x)
      light += glm::dvec3(read->map.pixels[static_cast<std::size_t>(y * read->map.width + x)]) *
               core::pixel_solid_angle(read->map, y);
  }
  const auto loaded = load_environment(path, {5200.0f, {0.0f, 0.0f, 700.0f}});
  ASSERT_TRUE(loaded) << loaded.error().line();
  const core::Environment& e = loaded->environment;
  EXPECT_EQ(e.name, GetParam());
  EXPECT_EQ(e.room_radius_mm, 5200.0f);
  for (int level = 0; level < core::environment_level_count; ++level) {
    const glm::dvec3 shown = core::sphere_integral(core::shown_means(e, level));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c] / light[c], 1.0, 0.002) << level;
  }

  const core::OctahedralImage map = core::shown_means(e, 0);
  std::vector<glm::dvec3> normals;
  std::vector<double> exact;
  double mean = 0.0;
  for (int i = 0; i < 20; ++i) {  // Fibonacci sphere
    const double z = 1.0 - (i + 0.5) / 10.0;
    const double s = std::sqrt(1.0 - z * z);
    normals.emplace_back(s * std::cos(2.39996323 * i), s * std::sin(2.39996323 * i), z);
    exact.push_back(0.0);
  }
  for (int y = 0; y < map.edge; ++y) {
    for (int x = 0; x < map.edge; ++x) {
      const glm::dvec3 d = core::direction_from_octahedral({(x + 0.5) / map.edge, (y + 0.5) / map.edge});
      const double power = core::luminance_of(map.at(x, y)) * core::texel_solid_angle(map.edge, x, y) / pi;
      for (std::size_t i = 0; i < normals.size(); ++i) exact[i] += power * std::max(glm::dot(normals[i], d), 0.0);
    }
  }
  for (const double value : exact) mean += value / static_cast<double>(exact.size());
  double before = 1e9;
  for (const int count : {1, 4, 16, 64}) {
    double error = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      double sum = 0.0;
      for (const core::EnvironmentLight& l : core::lights_of(e, count))
        sum += core::luminance_of(l.radiance) * std::max(glm::dot(normals[i], glm::dvec3(l.direction)), 0.0);
      error += std::abs(sum - exact[i]) / mean / static_cast<double>(normals.size());
    }
    std::printf("%s: %d lights, mean error %.2f %% of the mean irradiance\n", GetParam(), count, 100.0 * error);
    EXPECT_LT(error, before) << count;
    before = error;
  }
  EXPECT_LT(before, 0.02) << "64 lights";
}

INSTANTIATE_TEST_SUITE_P(Data, RealMap, ::testing::Values("pmndrs_studio", "pmndrs_warehouse", "pmndrs_workshop"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace lackwerk::packs
