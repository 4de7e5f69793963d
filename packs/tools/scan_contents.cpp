#include "packs/tools/scan_contents.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "core/analysis/cloud_shading.hpp"
#include "packs/tools/parallel.hpp"

namespace lackwerk::packs {
namespace {

constexpr std::size_t normal_neighbours = 12;  // about two rings on an even surface
constexpr double sky_cube_spacings = 3.0;      // no ray slips between the points of a leaf
constexpr int sky_reach = 16;
constexpr double place_steps = 65535.0;

/// How the points of one scan are lit.
struct Looks {
  std::vector<glm::vec3> normals;
  std::vector<float> sky;
};

std::array<std::uint16_t, 4> quantised(const glm::dvec3& place, const ScanInfo& info, bool there) {
  std::array<std::uint16_t, 4> out{};
  for (int c = 0; c < 3; ++c)
    out[static_cast<std::size_t>(c)] = static_cast<std::uint16_t>(
        std::lround(std::clamp((place[c] - info.low[c]) / info.edge, 0.0, 1.0) * place_steps));
  out[3] = there ? 65535 : 0;
  return out;
}

std::array<std::int8_t, 4> quantised(const glm::vec3& normal, float sky) {
  const auto round = [](float v) { return static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0f, 1.0f) * 127.0f)); };
  return {round(normal.x), round(normal.y), round(normal.z), round(sky)};
}

/// The cube around all places.
void frame(const ScanSeries& series, ScanInfo& info) {
  core::CloudBox box;
  for (const core::CloudMorph& step : series.steps)
    for (const core::CloudPath& path : step.paths)
      for (const glm::dvec3& place : {path.from, path.to}) {
        box.low = glm::min(box.low, place);
        box.high = glm::max(box.high, place);
      }
  info.low = box.low;
  info.edge = core::extent_of(box);
  if (!(info.edge > 0.0)) info.edge = 1.0;  // a single place
}

/// Shuffled the same way everywhere: the library's own shuffle may differ from one to the next.
void shuffle(std::vector<ScanPath>& paths) {
  std::mt19937 random(1);
  for (std::size_t k = paths.size(); k > 1; --k)
    std::swap(paths[k - 1], paths[static_cast<std::size_t>((std::uint64_t{random()} * k) >> 32)]);
}

std::vector<ScanPath> packed(const core::CloudMorph& step, const ScanInfo& info, const Looks& from, const Looks& to,
                             bool fades) {
  std::vector<ScanPath> out;
  out.reserve(step.paths.size());
  for (const core::CloudPath& path : step.paths) {
    const bool decays = path.to_point == core::CloudPath::none;
    const glm::vec3 normal = from.normals[path.from_point];
    const float sky = from.sky[path.from_point];
    // Both ends on one side, so that the normal between them never vanishes.
    glm::vec3 end = decays ? normal : to.normals[path.to_point];
    if (glm::dot(end, normal) < 0.0f) end = -end;
    out.push_back({quantised(path.from, info, true), quantised(path.to, info, !(decays && fades)),
                   quantised(normal, sky), quantised(end, decays ? sky : to.sky[path.to_point])});
  }
  shuffle(out);
  return out;
}

}  // namespace

ScanContents BuiltScan::contents() const {
  ScanContents out{info, {}};
  for (std::size_t k = 0; k < paths.size(); ++k) out.steps.push_back({paths[k], kinds[k][0], kinds[k][1], kinds[k][2]});
  return out;
}

BuiltScan scan_contents(const ScanSeries& series, const ScanNaming& naming, int up, bool fades, int threads) {
  BuiltScan out;
  out.info.id = naming.id;
  out.info.serial = naming.serial;
  out.info.name = naming.name;
  out.info.time_unit = naming.time_unit;
  out.info.up = up;
  frame(series, out.info);
  double spacing = series.spacing;
  if (!(spacing > 0.0)) spacing = core::spacing_of(series.scans.front().cloud.points);
  out.info.spacing = std::min(spacing, out.info.edge);
  for (const PreparedScan& scan : series.scans)
    out.info.states.push_back({scan.name, scan.time, static_cast<std::uint32_t>(scan.cloud.points.size())});

  const int workers = thread_count(threads);
  const double cube = sky_cube_spacings * (spacing > 0.0 ? spacing : out.info.edge);
  std::vector<Looks> looks(series.scans.size());
  for_each_index(looks.size(), workers, [&](std::size_t k) {
    const auto& points = series.scans[k].cloud.points;
    looks[k] = {core::normals_of(points, normal_neighbours, up), core::sky_of(points, cube, sky_reach, up)};
  });
  out.paths.resize(series.steps.size());
  for_each_index(out.paths.size(), workers, [&](std::size_t k) {
    out.paths[k] = packed(series.steps[k], out.info, looks[k], looks[k + 1], fades);
  });
  for (const core::CloudMorph& step : series.steps) {
    std::array<std::uint32_t, 3> kinds{};
    for (const core::SegmentMatch& match : step.matches) ++kinds[static_cast<std::size_t>(match.kind)];
    out.kinds.push_back(kinds);
  }
  return out;
}

}  // namespace lackwerk::packs
