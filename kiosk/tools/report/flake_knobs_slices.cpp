#include "kiosk/tools/report/flake_knobs_slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/analysis/mip_chain.hpp"
#include "core/colour.hpp"

namespace lackwerk::report {

namespace {

struct Place {
  int bin_h, bin_i;
};
/// The last one is left out by quick reports. All can be reached below a coat of index 1.5.
constexpr std::array<Place, 4> places = {{{0, 0}, {2, 2}, {1, 5}, {4, 1}}};

FlakeSample sample_of(const packs::Capture& capture, int slice, const std::string& name) {
  FlakeSample out;
  out.name = name;
  const auto& texels = capture.slices[static_cast<std::size_t>(slice)].texels;
  for (core::MipLevel& level : core::mip_chain(texels, capture.edge_texels)) {
    FlakeLevel one;
    one.edge = level.edge;
    one.linear = std::move(level.texels);
    one.lab.resize(one.linear.size());
    std::transform(one.linear.begin(), one.linear.end(), one.lab.begin(),
                   [](const glm::vec3& rgb) { return core::lab_from_linear(rgb); });
    out.levels.push_back(std::move(one));
  }
  return out;
}

}  // namespace

Result<std::vector<FlakeSample>> flake_samples(Workbench& bench) {
  const auto captures = bench.captures();
  if (!captures) return tl::unexpected(captures.error());
  std::vector<FlakeSample> out;
  const std::size_t count = bench.choose(places.size(), places.size() - 1);
  for (const packs::Capture& capture : **captures) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto slice = capture.layout.slice_at(places[k].bin_h, places[k].bin_i);
      if (!slice) continue;
      out.push_back(sample_of(capture, *slice,
                              capture.identity.name + ", theta_h bin " + std::to_string(places[k].bin_h) +
                                  ", theta_i bin " + std::to_string(places[k].bin_i)));
    }
  }
  return out;
}

std::vector<std::size_t> judged_levels(const Workbench& bench) {
  if (bench.quick()) return {0, 3};
  return {0, 2, 4};
}

}  // namespace lackwerk::report
