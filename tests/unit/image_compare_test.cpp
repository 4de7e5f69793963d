#include "packs/tools/image_compare.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/colour.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::TemporaryFolder;

LinearImage grey_image(int width, int height, float value) {
  return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), glm::vec3(value))};
}

TEST(ImageCompare, EqualPicturesDifferByNothing) {
  const LinearImage image = grey_image(5, 3, 0.25f);
  std::vector<float> map;
  const auto difference = compare_images(image, image, &map);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->pixels, 15u);
  EXPECT_EQ(difference->mean, 0.0);
  EXPECT_EQ(difference->max, 0.0);
  EXPECT_EQ(map, std::vector<float>(15, 0.0f));
}

TEST(ImageCompare, StatisticsAreNearestRank) {
  // 100 pixels; the last three differ, each by more.
  const LinearImage a = grey_image(10, 10, 0.25f);
  LinearImage b = a;
  std::vector<double> expected;
  for (const std::size_t k : {97u, 98u, 99u}) {
    b.pixels[k] = glm::vec3(0.25f + 0.1f * static_cast<float>(k - 96));
    expected.push_back(core::ciede2000(core::lab_from_linear(glm::dvec3(a.pixels[k])),
                                       core::lab_from_linear(glm::dvec3(b.pixels[k]))));
  }
  const auto difference = compare_images(a, b);
  ASSERT_TRUE(difference);
  EXPECT_NEAR(difference->mean, (expected[0] + expected[1] + expected[2]) / 100.0, 1e-6);
  EXPECT_EQ(difference->p95, 0.0);
  EXPECT_NEAR(difference->p99, expected[1], 1e-5);
  EXPECT_NEAR(difference->max, expected[2], 1e-5);
  EXPECT_GT(expected[0], 5.0);
}

TEST(ImageCompare, SizesMustAgree) {
  const auto difference = compare_images(grey_image(2, 2, 0.0f), grey_image(2, 3, 0.0f));
  ASSERT_FALSE(difference);
  EXPECT_EQ(difference.error().field, "size");
  EXPECT_NE(difference.error().what.find("2x3"), std::string::npos);
}

TEST(ImageCompare, MapsAreWrittenAndReadAsEncodedGrey) {
  const TemporaryFolder folder;
  const std::vector<float> map = {0.0f, 5.0f, 10.0f, 1000.0f};
  const auto written = write_difference_map(folder / "map.png", 2, 2, map);
  ASSERT_TRUE(written) << written.error().line();
  const auto image = read_image(folder / "map.png");
  ASSERT_TRUE(image) << image.error().line();
  ASSERT_EQ(image->width, 2);
  ASSERT_EQ(image->pixels.size(), 4u);
  EXPECT_EQ(image->pixels[0], glm::vec3(0.0f));
  EXPECT_NEAR(image->pixels[1].y, core::srgb_decode(128.0 / 255.0), 1e-6);
  EXPECT_EQ(image->pixels[2], glm::vec3(1.0f));
  EXPECT_EQ(image->pixels[3], glm::vec3(1.0f));
}

TEST(ImageCompare, BadFilesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_image(folder / "missing.png"));
  testing::write_bytes(folder / "text.png", "no picture", 10);
  EXPECT_FALSE(read_image(folder / "text.png"));
  ASSERT_TRUE(write_difference_map(folder / "map.png", 64, 64, std::vector<float>(64 * 64, 3.0f)));
  const auto bytes = testing::read_bytes(folder / "map.png");
  testing::write_bytes(folder / "cut.png", bytes.data(), bytes.size() / 2);
  const auto cut = read_image(folder / "cut.png");
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().file.find("cut.png"), std::string::npos);
  EXPECT_FALSE(write_difference_map(folder / "map.unknown", 2, 2, std::vector<float>(4)));
  EXPECT_FALSE(write_difference_map(folder / "no" / "map.png", 2, 2, std::vector<float>(4)));
}

}  // namespace
}  // namespace lackwerk::packs
