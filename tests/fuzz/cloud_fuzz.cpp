// Fuzz target: any bytes as a scan.
//
// Input: a byte that says whether the rest is a PLY file (even) or text. Whatever comes: no sanitizer finding, every
// refusal on one line with its remedy, and what is taken is points within bounds, no more of them than the file has
// room for, with a label each or with none.
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "packs/tools/cloud_file.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace lackwerk;
using fuzz::require;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string file = data[0] % 2 == 0 ? "fuzz.ply" : "fuzz.xyz";
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  const auto cloud = packs::parse_cloud(bytes, file);
  if (!cloud) {
    const Error& error = cloud.error();
    require(error.file == file && !error.what.empty() && !error.remedy.empty());
    require(error.line().find('\n') == std::string::npos);
    return 0;
  }
  constexpr std::size_t least_point_bytes = 3;  // x, y and z as bytes; a capacity beyond is memory for nothing
  require(!cloud->points.empty() && cloud->points.size() <= bytes.size() / least_point_bytes);
  require(cloud->points.capacity() <= bytes.size());
  require(cloud->labels.empty() || cloud->labels.size() == cloud->points.size());
  constexpr double farthest = 1e9;  // docs of cloud_file.hpp
  for (const glm::dvec3& point : cloud->points)
    for (int axis = 0; axis < 3; ++axis) require(std::abs(point[axis]) <= farthest);
  return 0;
}
