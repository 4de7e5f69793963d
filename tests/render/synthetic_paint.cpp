#include "tests/render/synthetic_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "core/colour.hpp"

namespace lackwerk::test {
namespace {

constexpr int level0_edge = 64;
constexpr int level_count = 7;  // 64, 32, ..., 1
constexpr std::uint32_t row_mass = 1u << 12;

/// Counter-based noise in [0, 1).
double noise(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/// One slice of one paint: dark binder, one texel in twelve a flake whose brightness is exponentially distributed.
std::vector<glm::dvec3> slice_texels(int paint, int slice, const core::SliceLayout::Node& node) {
  std::vector<glm::dvec3> texels;
  const double strength =
      (paint == 0 ? 0.9 : 1.6) * std::exp(-0.12 * node.bin_h * node.bin_h) / (1.0 + 0.06 * node.bin_i);
  const glm::dvec3 tint = paint == 0 ? glm::dvec3(1.0, 0.97, 0.92) : glm::dvec3(0.55, 0.75, 1.0);
  for (int k = 0; k < level0_edge * level0_edge; ++k) {
    const auto seed = static_cast<std::uint64_t>((paint * 1000 + slice) * 100000 + k) * 2654435761u + 12345u;
    const double brightness = noise(seed) < 1.0 / 12.0 ? -std::log(1.0 - noise(seed + 7)) : 0.02 * noise(seed + 7);
    const glm::dvec3 hue = tint * (0.9 + 0.2 * noise(seed + 13));
    texels.push_back(hue * (strength * brightness + 0.002));
  }
  return texels;
}

std::vector<glm::dvec3> half_size(const std::vector<glm::dvec3>& texels) {
  std::vector<glm::dvec3> out;
  const auto edge = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(texels.size()))));
  for (std::size_t y = 0; y + 1 < edge; y += 2)
    for (std::size_t x = 0; x + 1 < edge; x += 2)
      out.push_back(0.25 * (texels[y * edge + x] + texels[y * edge + x + 1] + texels[(y + 1) * edge + x] +
                            texels[(y + 1) * edge + x + 1]));
  return out;
}

struct LabCluster {
  glm::dvec3 lo, hi;
  std::uint32_t mass;
};

/// Texels sorted by L and cut where the rare bright ones get their own clusters.
std::vector<LabCluster> clusters_of(const std::vector<glm::dvec3>& texels) {
  std::vector<glm::dvec3> lab;
  for (const glm::dvec3& t : texels) lab.push_back(core::lab_from_linear(t));
  std::sort(lab.begin(), lab.end(), [](const glm::dvec3& a, const glm::dvec3& b) { return a.x < b.x; });
  constexpr std::array<double, 13> cuts = {0.25,  0.5,  0.7,  0.85,  0.91,   0.93, 0.95,
                                           0.965, 0.98, 0.99, 0.995, 0.9985, 1.0};
  std::vector<LabCluster> out;
  std::size_t begin = 0;
  for (const double cut : cuts) {
    const auto end = static_cast<std::size_t>(std::lround(cut * static_cast<double>(lab.size())));
    if (end <= begin) continue;
    LabCluster cluster{glm::dvec3(1e9), glm::dvec3(-1e9), 0};
    for (std::size_t k = begin; k < end; ++k) {
      cluster.lo = glm::min(cluster.lo, lab[k]);
      cluster.hi = glm::max(cluster.hi, lab[k]);
    }
    cluster.mass = static_cast<std::uint32_t>((end - begin) * (row_mass / lab.size()));
    out.push_back(cluster);
    begin = end;
  }
  return out;
}

core::QuantisedCuboid quantise(const LabCluster& cluster, const core::LabRange& range) {
  core::QuantisedCuboid out;
  for (int axis = 0; axis < 3; ++axis) {
    const double span = range.hi[axis] - range.lo[axis];
    const auto q = [&](double v) {
      return static_cast<std::uint16_t>(std::lround(std::clamp((v - range.lo[axis]) / span, 0.0, 1.0) * 65535.0));
    };
    out.q[static_cast<std::size_t>(2 * axis)] = q(cluster.lo[axis]);
    out.q[static_cast<std::size_t>(2 * axis + 1)] = q(cluster.hi[axis]);
  }
  return out;
}

core::ColourTable colour_table(const glm::vec3& face, const glm::vec3& flop) {
  core::ColourTable table;
  table.num_theta = 19;
  for (int i = 0; i < 19; ++i)
    for (int h = 0; h < 19; ++h) {
      const float t = std::min(1.0f, static_cast<float>(h) / 9.0f + 0.02f * static_cast<float>(i));
      table.linear.push_back(face * (1.0f - t) + flop * t);
    }
  return table;
}

}  // namespace

SyntheticPaint::SyntheticPaint(const PaintOptions& options) {
  using core::Lobe;
  paint_.paints.resize(2);
  core::AnalyticPaint& silver = paint_.paints[0].analytic;
  silver.diffuse = {0.06, 0.058, 0.055};
  silver.lobes = {Lobe{{0.16, 0.155, 0.15}, 0.42, 0.35}, Lobe{{0.09, 0.092, 0.095}, 0.21, 0.5},
                  Lobe{{0.012, 0.012, 0.012}, 0.06, 0.4}};
  core::AnalyticPaint& blue = paint_.paints[1].analytic;
  blue.diffuse = {0.01, 0.02, 0.08};
  blue.lobes = {Lobe{{0.04, 0.09, 0.22}, 0.48, 0.2}, Lobe{{0.05, 0.06, 0.11}, 0.18, 0.6},
                Lobe{{0.008, 0.01, 0.013}, 0.05, 0.5}};
  for (int k = 0; k < 2; ++k) {
    core::AnalyticPaint& paint = paint_.paints[static_cast<std::size_t>(k)].analytic;
    for (std::size_t lobe = static_cast<std::size_t>(options.lobes); lobe < core::max_lobes; ++lobe)
      paint.lobes[lobe] = Lobe{};
    if (options.coat) paint.coat_ior = paint.refraction_ior = 1.5;
    if (options.table)
      paint.table = k == 0 ? colour_table({1.1f, 1.05f, 1.0f}, {0.55f, 0.6f, 0.7f})
                           : colour_table({0.9f, 1.0f, 1.3f}, {0.9f, 0.5f, 0.6f});
    paint_.paints[static_cast<std::size_t>(k)].identity.name = k == 0 ? "invented silver" : "invented blue";
  }
  if (options.flakes) add_flakes(options);
}

void SyntheticPaint::add_flakes(const PaintOptions& options) {
  paint_.layout = core::axf_layout();
  paint_.level_count = level_count;
  paint_.texel_mm = options.texel_mm;
  paint_.level0_texels = level0_edge;
  paint_.range = {{-1.0f, -60.0f, -90.0f}, {320.0f, 60.0f, 60.0f}};
  paint_.row_mass = row_mass;
  paint_.random_seed = 20180611;
  std::array<std::vector<std::vector<glm::dvec3>>, 2> texels;  // [paint][slice], of the current level
  const int slices = paint_.layout.slice_count();
  for (int k = 0; k < 2; ++k)
    for (int slice = 0; slice < slices; ++slice)
      texels[static_cast<std::size_t>(k)].push_back(slice_texels(k, slice, paint_.layout.node_of(slice)));

  for (int level = 0; level < level_count; ++level)
    for (int slice = 0; slice < slices; ++slice) {
      std::array<std::vector<LabCluster>, 2> clusters;
      for (std::size_t k = 0; k < 2; ++k) {
        auto& current = texels[k][static_cast<std::size_t>(slice)];
        if (level > 0) current = half_size(current);
        clusters[k] = clusters_of(current);
        for (const LabCluster& cluster : clusters[k]) storage_[k].clusters.push_back(quantise(cluster, paint_.range));
        storage_[k].cluster_begin.push_back(static_cast<std::uint32_t>(storage_[k].clusters.size()));
      }
      // Both are sorted by L: filling up in that order pairs dark with dark and bright with bright.
      std::array<std::size_t, 2> at{};
      while (at[0] < clusters[0].size() && at[1] < clusters[1].size()) {
        const std::uint32_t moved = std::min(clusters[0][at[0]].mass, clusters[1][at[1]].mass);
        mass_.push_back(moved);
        for (std::size_t k = 0; k < 2; ++k) storage_[k].tuple_cluster.push_back(static_cast<std::uint8_t>(at[k]));
        for (std::size_t k = 0; k < 2; ++k)
          if ((clusters[k][at[k]].mass -= moved) == 0) ++at[k];
      }
      tuple_begin_.push_back(static_cast<std::uint32_t>(mass_.size()));
    }
  for (std::size_t k = 0; k < 2; ++k) {
    paint_.paints[k].cluster_begin = storage_[k].cluster_begin;
    paint_.paints[k].clusters = storage_[k].clusters;
    paint_.paints[k].tuple_cluster = storage_[k].tuple_cluster;
  }
  paint_.tuple_begin = tuple_begin_;
  paint_.mass = mass_;
}

}  // namespace lackwerk::test
