// Which flake slices a coat's refraction leaves to be seen.
#include "core/slice_layout.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

namespace lackwerk::core {
namespace {

int reachable_nodes(const SliceLayout& layout, double index) {
  int count = 0;
  for (int slice = 0; slice < layout.slice_count(); ++slice) {
    const auto node = layout.node_of(slice);
    const double width = layout.bin_width_rad();
    count += reachable_below_coat(node.bin_h * width, node.bin_i * width, index) ? 1 : 0;
  }
  return count;
}

TEST(SliceLayout, IndexOfGlassLeavesAThirdOut) {
  const SliceLayout all = axf_layout();
  EXPECT_EQ(reachable_nodes(all, 1.5), 31);
  const SliceLayout kept = reachable_layout(all, 1.5);
  EXPECT_EQ(kept.slice_count(), 44);
  EXPECT_EQ(reachable_layout(all, 1.0), all) << "nothing bends, nothing is lost";
  EXPECT_LT(reachable_layout(all, 2.0).slice_count(), kept.slice_count());
}

// Random pairs of directions, refracted into the coat: every node that a bilinear tap would read is there.
TEST(SliceLayout, NoDirectionReadsALeftOutSlice) {
  const SliceLayout all = axf_layout();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const double index : {1.05, 1.3, 1.5, 1.8}) {
    const SliceLayout kept = reachable_layout(all, index);
    const auto inside = [&] {
      const double z = unit(random), phi = 6.283185307179586 * unit(random);
      const double r = std::sqrt(1.0 - z * z) / index;
      return glm::dvec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r * r));
    };
    for (int k = 0; k < 20000; ++k) {
      const glm::dvec3 i = inside(), o = inside(), h = glm::normalize(i + o);
      const double fh = std::acos(std::min(h.z, 1.0)) / all.bin_width_rad();
      const double fi = std::acos(std::min(glm::dot(h, i), 1.0)) / all.bin_width_rad();
      for (int dh = 0; dh < 2; ++dh)
        for (int di = 0; di < 2; ++di) {
          const int bin_h = static_cast<int>(fh) + dh, bin_i = static_cast<int>(fi) + di;
          ASSERT_EQ(kept.slice_at(bin_h, bin_i).has_value(), all.slice_at(bin_h, bin_i).has_value())
              << "index " << index << ", bins " << bin_h << ", " << bin_i;
        }
    }
  }
}

}  // namespace
}  // namespace lackwerk::core
