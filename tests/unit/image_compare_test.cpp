#include "packs/tools/difference_picture.hpp"

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

TEST(ImageCompare, OnlyWhiteOfTheMaskCounts) {
  LinearImage white_right = grey_image(4, 1, 0.1f);
  white_right.pixels[2] = white_right.pixels[3] = glm::vec3(0.9f);
  const PixelMask mask = mask_of(white_right);
  EXPECT_EQ(mask, (PixelMask{0, 0, 1, 1}));
  const LinearImage a = grey_image(4, 1, 0.25f);
  LinearImage b = a;
  b.pixels[0] = b.pixels[3] = glm::vec3(0.5f);
  std::vector<float> map;
  const auto masked = compare_images(a, b, &map, mask), whole = compare_images(a, b);
  ASSERT_TRUE(masked && whole);
  EXPECT_EQ(masked->pixels, 2u);
  EXPECT_NEAR(masked->mean, whole->max / 2.0, 1e-5);
  EXPECT_EQ(map[0], -1.0f);
  EXPECT_EQ(map[2], 0.0f);
  EXPECT_NEAR(map[3], whole->max, 1e-5);
  EXPECT_EQ(compare_images(a, b, nullptr, PixelMask(3, 1)).error().field, "mask");
  EXPECT_EQ(compare_images(a, b, nullptr, PixelMask(4, 0)).error().field, "mask");
}

TEST(ImageCompare, PictureShowsBothAndTheMap) {
  const TemporaryFolder folder;
  const LinearImage a = grey_image(64, 32, 0.25f), b = grey_image(64, 32, 0.5f);
  const std::vector<float> map(64 * 32, 2.0f);
  const auto written = write_difference_picture(folder / "map.png", a, b, map, "note");
  ASSERT_TRUE(written) << written.error().line();
  const auto image = read_image(folder / "map.png");
  ASSERT_TRUE(image) << image.error().line();
  const auto pixel = [&](int x, int y) {
    return image
        ->pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image->width) + static_cast<std::size_t>(x)];
  };
  EXPECT_NEAR(pixel(8 + 32, 8 + 16).y, 0.25f, 3e-3);
  EXPECT_NEAR(pixel(2 * 8 + 64 + 32, 8 + 16).y, 0.5f, 3e-3);
  const glm::vec3 seen = pixel(3 * 8 + 2 * 64 + 32, 8 + 16), meant = map_colour(2.0f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(core::srgb_encode(static_cast<double>(seen[c])), meant[c], 3e-3);
}

TEST(ImageCompare, ScaleRisesFromBlackToWhite) {
  EXPECT_EQ(map_colour(0.0f), glm::vec3(0.0f));
  EXPECT_EQ(map_colour(map_scale_end), glm::vec3(1.0f));
  EXPECT_EQ(map_colour(1000.0f), glm::vec3(1.0f));
  double last = -1.0;
  for (int k = 0; k <= 100; ++k) {
    const glm::vec3 colour = map_colour(static_cast<float>(k) * 0.1f);
    const double lightness = core::lab_from_linear(glm::dvec3(core::srgb_decode(colour.x), core::srgb_decode(colour.y),
                                                              core::srgb_decode(colour.z)))
                                 .x;
    EXPECT_GT(lightness, last) << k;
    last = lightness;
  }
}

TEST(ImageCompare, BadFilesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_image(folder / "missing.png"));
  testing::write_bytes(folder / "text.png", "no picture", 10);
  EXPECT_FALSE(read_image(folder / "text.png"));
  const LinearImage grey = grey_image(64, 64, 0.3f);
  const std::vector<float> map(64 * 64, 3.0f);
  ASSERT_TRUE(write_difference_picture(folder / "map.png", grey, grey, map, ""));
  const auto bytes = testing::read_bytes(folder / "map.png");
  testing::write_bytes(folder / "cut.png", bytes.data(), bytes.size() / 2);
  const auto cut = read_image(folder / "cut.png");
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().file.find("cut.png"), std::string::npos);
  EXPECT_FALSE(write_difference_picture(folder / "map.unknown", grey, grey, map, ""));
  EXPECT_FALSE(write_difference_picture(folder / "no" / "map.png", grey, grey, map, ""));
}

}  // namespace
}  // namespace lackwerk::packs
