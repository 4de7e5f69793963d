#include "tests/render/golden_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/colour.hpp"
#include "packs/tools/difference_picture.hpp"

namespace lackwerk::test {
namespace {

bool updating() {
  const char* mode = std::getenv("LACKWERK_GOLDEN");
  return mode != nullptr && std::string_view(mode) == "update";
}

packs::LinearImage linear_of(const gles::Image& image) {
  packs::LinearImage out{image.width, image.height, {}};
  for (std::size_t k = 0; k < image.rgb.size(); k += 3) {
    glm::vec3 pixel;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(core::srgb_decode(image.rgb[k + static_cast<std::size_t>(c)] / 255.0));
    out.pixels.push_back(pixel);
  }
  return out;
}

std::string failure_path(const std::string& name) {
  const std::filesystem::path folder = source_folder() / "build" / "golden-failures";
  std::error_code code;
  std::filesystem::create_directories(folder, code);  // if that fails, writing says so
  return (folder / (name + ".png")).string();
}

double outlier_share(const gles::Image& a, const gles::Image& b) {
  std::size_t outliers = 0;
  for (std::size_t k = 0; k < a.rgb.size(); k += 3) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a.rgb[k + c] - b.rgb[k + c]));
    outliers += largest > golden_channel_steps ? 1 : 0;
  }
  return static_cast<double>(outliers) / (static_cast<double>(a.rgb.size()) / 3.0);
}

}  // namespace

std::filesystem::path source_folder() { return LACKWERK_SOURCE_DIR; }

std::string write_failure(const gles::Image& golden, const gles::Image& image, const std::string& name) {
  const std::string path = failure_path(name);
  const packs::LinearImage a = linear_of(golden), b = linear_of(image);
  std::vector<float> map;
  const auto difference = packs::compare_images(a, b, &map);
  if (!difference) return difference.error().line();
  const std::string note = "mean " + std::to_string(difference->mean) + ", p95 " + std::to_string(difference->p95) +
                           ", max " + std::to_string(difference->max);
  const auto written = packs::write_difference_picture(path, a, b, map, note);
  return written ? path : written.error().line();
}

void expect_golden(const gles::Image& image, const std::string& name, bool may_write) {
  const std::string path = (source_folder() / "tests" / "golden" / (name + ".png")).string();
  if (updating()) {
    if (may_write) {
      const auto written = gles::write_png(image, path);
      ASSERT_TRUE(written) << written.error().line();
    }
    GTEST_SKIP() << (may_write ? "written: " : "left to the other backend: ") << path;
  }
  const auto golden = gles::read_png(path);
  if (!golden) {
    const auto written = gles::write_png(image, failure_path(name));
    FAIL() << golden.error().line() << "\nthe picture is " << (written ? failure_path(name) : written.error().line())
           << "\nif it is right, scripts/golden --update takes it over";
  }
  if (golden->width != image.width || golden->height != image.height)
    FAIL() << path << " is " << golden->width << "x" << golden->height << ", the picture " << image.width << "x"
           << image.height;
  if (*golden == image) return;
  const auto difference = packs::compare_images(linear_of(*golden), linear_of(image));
  const double outliers = outlier_share(*golden, image);
  ASSERT_TRUE(difference) << difference.error().line();
  std::printf("  %s: CIEDE2000 mean %.4f, p95 %.3f, max %.2f; %.3f %% of pixels beyond %d/255\n", name.c_str(),
              difference->mean, difference->p95, difference->max, 100.0 * outliers, golden_channel_steps);
  if (outliers <= golden_outlier_share && difference->mean <= golden_mean_limit) return;
  ADD_FAILURE() << name << ": CIEDE2000 mean " << difference->mean << " (limit " << golden_mean_limit << "), "
                << 100.0 * outliers << " % of pixels beyond " << golden_channel_steps << "/255 (limit "
                << 100.0 * golden_outlier_share << " %): see " << write_failure(*golden, image, name);
}

}  // namespace lackwerk::test
