// Scans from files, and files that are none.
#include "packs/tools/cloud_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace lackwerk::packs {
namespace {

class CloudFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("lackwerk_cloud_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Result<core::PointCloud> read(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return read_cloud(folder_ / name);
  }
  /// The place and fault that an unreadable file is refused with.
  std::string fault(const std::string& name, const std::string& text) {
    const auto cloud = read(name, text);
    return cloud ? "read" : cloud.error().field + ": " + cloud.error().what;
  }
  std::filesystem::path folder_;
};

template <class T>
std::string bytes_of(T value, bool big) {
  std::string out(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big) std::reverse(out.begin(), out.end());
  return out;
}

std::string header(const std::string& format, const std::string& count, const std::string& label = "") {
  return "ply\nformat " + format + " 1.0\ncomment none\nelement vertex " + count +
         "\nproperty float x\nproperty double y\nproperty short z\n" + label + "end_header\n";
}

TEST_F(CloudFile, XyzWithAndWithoutLabels) {
  const auto plain = read("a.xyz", "# a scan\r\n1 2 3\r\n\r\n-4.5,5e1;+6\n");
  ASSERT_TRUE(plain) << plain.error().line();
  ASSERT_EQ(plain->points.size(), 2u);
  EXPECT_EQ(plain->points[1], glm::dvec3(-4.5, 50.0, 6.0));
  EXPECT_TRUE(plain->labels.empty());
  const auto labelled = read("b.txt", "1 2 3 7\n1 2 4 -1\n");
  ASSERT_TRUE(labelled);
  EXPECT_EQ(labelled->labels, (std::vector<std::int32_t>{7, -1}));
  const auto other = read("c.xyz", "1 2 3 7\n1 2 4 0.5\n");  // a fourth column that is no label
  ASSERT_TRUE(other);
  EXPECT_TRUE(other->labels.empty());
}

TEST_F(CloudFile, PlyOfEitherByteOrderAndAsText) {
  for (const bool big : {false, true}) {
    std::string text =
        header(big ? "binary_big_endian" : "binary_little_endian", "2", "property uchar red\nproperty int label\n");
    for (const int k : {1, 2})
      text += bytes_of(0.5f * static_cast<float>(k), big) + bytes_of(-2.0 * k, big) +
              bytes_of(static_cast<std::int16_t>(-3 * k), big) + "r" + bytes_of(static_cast<std::int32_t>(k), big);
    const auto cloud = read("a.ply", text);
    ASSERT_TRUE(cloud) << cloud.error().line();
    ASSERT_EQ(cloud->points.size(), 2u);
    EXPECT_EQ(cloud->points[1], glm::dvec3(1.0, -4.0, -6.0));
    EXPECT_EQ(cloud->labels, (std::vector<std::int32_t>{1, 2}));
  }
  const auto text = read("b.ply", header("ascii", "2") + "1 2 3\n4 5 6");
  ASSERT_TRUE(text) << text.error().line();
  EXPECT_EQ(text->points[1], glm::dvec3(4.0, 5.0, 6.0));
}

TEST_F(CloudFile, BadFilesAreOneLine) {
  EXPECT_EQ(fault("a.xyz", "1 2 3\n1 2\n"), "line 2: has fewer than three numbers");
  EXPECT_EQ(fault("a.xyz", "1 nan 3\n"), "line 1: column y is not finite");
  EXPECT_EQ(fault("a.xyz", "1 2 3\n1 2 inf\n"), "line 2: column z is not finite");
  EXPECT_EQ(fault("a.xyz", "1 2 1e10\n"), "line 1: column z is larger than 1e9");
  EXPECT_EQ(fault("a.xyz", "1 2 +-3\n"), "line 1: column z is no number");
  EXPECT_EQ(fault("a.xyz", "x y z\n"), "line 1: column x is no number");
  EXPECT_EQ(fault("a.xyz", "# nothing\n"), ": has no points");
  EXPECT_EQ(fault("a.obj", "v 1 2 3\n"), ": is neither .ply nor .xyz");
  EXPECT_EQ(fault("a.ply", "plx\n"), "line 1: is not \"ply\"");
  EXPECT_EQ(fault("a.ply", "ply\nformat ascii 1.0\n"), "end_header: is missing");
  EXPECT_EQ(fault("a.ply", header("ascii", "0")), "line 4: has no number of vertices");
  EXPECT_EQ(fault("a.ply", header("ascii", "99999999999")), "line 4: names more than 8 million vertices");
  EXPECT_EQ(fault("a.ply", header("middle_endian", "1")), "line 2: names an unknown format");
  EXPECT_EQ(fault("a.ply", header("ascii", "5000000") + "1 2 3\n"),
            "vertex: the file ends before its 5000000 vertices do");
  EXPECT_EQ(fault("a.ply", header("binary_little_endian", "2") + std::string(20, '\0')),
            "vertex: the file ends before its 2 vertices do");
  EXPECT_EQ(fault("a.ply", header("ascii", "2") + "1 2 3\n12 34567\n"), "line 10: has fewer numbers than properties");
  EXPECT_EQ(fault("a.ply", header("ascii", "1") + "1 nan 3\n"), "vertex 0, y: is not finite");
  EXPECT_EQ(fault("a.ply", header("ascii", "1", "property list uchar int many\n") + "1 2 3\n"),
            "line 8: has a property of a type that is not read");
  EXPECT_EQ(fault("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
            "property y: is missing");
}

TEST_F(CloudFile, TomatoSeriesIsRead) {
  const std::filesystem::path folder = LACKWERK_SOURCE_DIR "/../shared/data/scans/tomato";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared/data/scans/tomato is not there";
  const std::pair<const char*, std::size_t> scans[] = {
      {"03-05.xyz", 24795}, {"03-06.xyz", 50000}, {"03-08.ply", 179757}};
  for (const auto& [name, count] : scans) {
    const auto cloud = read_cloud(folder / name);
    ASSERT_TRUE(cloud) << cloud.error().line();
    EXPECT_EQ(cloud->points.size(), count);
    const double extent = core::extent_of(core::box_of(cloud->points));
    EXPECT_GT(extent, 20.0) << name;
    EXPECT_LT(extent, 100.0) << name;
  }
}

}  // namespace
}  // namespace lackwerk::packs
