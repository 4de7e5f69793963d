// Small packs and scenes for the tests, with the memory they need.
//
// Why it exists: several tests start from something valid and break one thing. Values; one thread.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "packs/paint_pack.hpp"
#include "packs/scene.hpp"

namespace lackwerk::testing {

/// A folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "lackwerk-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::vector<char> read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void write_bytes(const std::filesystem::path& path, const char* bytes, std::size_t size) {
  std::ofstream(path, std::ios::binary).write(bytes, static_cast<std::streamsize>(size));
}

/// Flips one bit of a file at a time: writing it anew for each of ten thousand flips would take most of the time.
class BitFlipper {
 public:
  explicit BitFlipper(const std::filesystem::path& path)
      : bytes_(read_bytes(path)), file_(path, std::ios::binary | std::ios::in | std::ios::out) {}
  [[nodiscard]] std::size_t size_bits() const { return bytes_.size() * 8; }
  /// Flips one bit in the file; the second time it is as before.
  void flip(std::size_t bit) {
    char& byte = bytes_[bit / 8];
    byte = static_cast<char>(byte ^ (1 << (bit % 8)));
    file_.seekp(static_cast<std::streamoff>(bit / 8)).put(byte).flush();
  }

 private:
  std::vector<char> bytes_;
  std::fstream file_;
};

/// Two paints, two slices, two levels: four rows of two tuples, two clusters per paint and row.
struct SamplePack {
  std::vector<std::vector<std::uint32_t>> cluster_begin{{0, 2, 4, 6, 8}, {0, 2, 4, 6, 8}};
  std::vector<std::vector<core::QuantisedCuboid>> clusters;
  std::vector<std::vector<std::uint8_t>> tuple_cluster{{0, 1, 0, 1, 0, 1, 0, 1}, {1, 0, 1, 0, 0, 1, 0, 1}};
  std::vector<std::uint32_t> tuple_begin{0, 2, 4, 6, 8};
  std::vector<std::uint32_t> mass{3, 1, 2, 2, 1, 3, 2, 2};
  packs::PackContents contents;

  explicit SamplePack(std::size_t paint_count = 2) {
    cluster_begin.resize(paint_count, cluster_begin[0]);
    tuple_cluster.resize(paint_count, tuple_cluster[0]);
    core::InterpolatablePaint& paint = contents.paint;
    for (std::size_t k = 0; k < paint_count; ++k) {
      clusters.emplace_back();
      for (std::uint16_t c = 0; c < 8; ++c) {
        const auto low = static_cast<std::uint16_t>(100 * c + k);
        const auto high = static_cast<std::uint16_t>(low + 7);
        clusters.back().push_back({{low, high, low, low, 0, 65535}});
      }
      core::InterpolatablePaint::PaintPart part;
      part.identity = {"Paint " + std::to_string(k), "made up", core::Provenance::published_fit,
                       core::Provenance::simulated, core::Provenance::measured};
      part.analytic.diffuse = {0.1, 0.2, 0.3};
      part.analytic.lobes[0] = {{0.5, 0.4, 0.3}, 0.4, 0.5};
      part.analytic.lobes[1] = {{0.1, 0.2, 0.3}, 0.1 + 1.0 / 3.0 * 0.1, 0.9};
      part.analytic.coat_ior = 1.5;
      if (k == 0) part.analytic.table = core::ColourTable{2, {{1, 1, 1}, {1.5f, 0, 0}, {0, 1, 0}, {0.1f, 0, 1}}};
      part.life = {6.25f, 30.0f, core::LifeOrigin::fine};
      paint.paints.push_back(std::move(part));
      contents.info.errors.push_back({0.5f, 0.75f, {0.25f, 0.75f}, {}});
    }
    paint.layout = {12, {0, 1, 2}};
    paint.level_count = 2;
    paint.texel_mm = 0.05f;
    paint.level0_texels = 2;
    paint.range = {{-1.0f, -2.0f, -3.0f}, {400.0f, 50.0f, 60.0f}};
    paint.row_mass = 4;
    paint.random_seed = 0x123456789ABCDEF0ull;
    contents.info.id = "sample";
    contents.info.serial = 42;
    contents.info.transport_cost = 1.25;
    link();
  }
  SamplePack(const SamplePack&) = delete;
  SamplePack& operator=(const SamplePack&) = delete;

  /// Points the spans at the vectors again, after these were changed.
  void link() {
    core::InterpolatablePaint& paint = contents.paint;
    paint.tuple_begin = tuple_begin;
    paint.mass = mass;
    for (std::size_t k = 0; k < paint.paints.size(); ++k) {
      paint.paints[k].cluster_begin = cluster_begin[k];
      paint.paints[k].clusters = clusters[k];
      paint.paints[k].tuple_cluster = tuple_cluster[k];
    }
  }
};

/// Two parts: a quad and a triangle.
inline packs::Scene sample_scene() {
  packs::Scene scene;
  scene.name = "sample";
  packs::MeshPart quad;
  quad.name = "quad";
  quad.positions_mm = {{0, 0, 0}, {100.125f, 0, 0}, {100, 100, 0}, {0, 100, -1e-3f}};
  quad.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.6f, 0.8f}, {0.48f, 0.6f, 0.64f}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  packs::MeshPart triangle;
  triangle.name = "glass";
  triangle.kind = packs::SurfaceKind::glass;
  triangle.positions_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  triangle.indices = {0, 1, 2};
  scene.parts = {quad, triangle};
  scene.cameras = {{"front", {5000, 0, 1200}, {0, 0, 600}, 30.0f}, {"side", {0, -5000, 1200}, {0, 0, 600}, 25.5f}};
  return scene;
}

}  // namespace lackwerk::testing
