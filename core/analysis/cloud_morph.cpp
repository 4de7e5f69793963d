#include "core/analysis/cloud_morph.hpp"

#include <algorithm>
#include <cmath>

#include "core/analysis/cloud_neighbours.hpp"

namespace lackwerk::core {

Result<MatchPaths> match_paths(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                               const SegmentMatch& match, std::uint32_t number,
                               const CloudTransportOptions& transport) {
  MatchPaths out;
  if (match.kind == MatchKind::decayed) {
    out.paths.reserve(match.from_points.size());
    for (std::size_t i = 0; i < match.from_points.size(); ++i)
      out.paths.push_back(
          {from[match.from_points[i]], match.to_places[i], number, match.from_points[i], CloudPath::none});
    return out;
  }
  std::vector<glm::dvec3> sources, targets;
  sources.reserve(match.from_points.size());
  targets.reserve(match.to_points.size());
  for (const std::uint32_t i : match.from_points) sources.push_back(from[i]);
  for (const std::uint32_t i : match.to_points) targets.push_back(to[i]);
  const auto pairs = pair_points(sources, targets, transport);
  if (!pairs) return tl::unexpected(pairs.error());
  out.paths.reserve(pairs->pairs.size());
  for (const CloudPair& pair : pairs->pairs)
    out.paths.push_back(
        {sources[pair.from], targets[pair.to], number, match.from_points[pair.from], match.to_points[pair.to]});
  out.state = pairs->state;
  out.violation = pairs->marginal_violation;
  return out;
}

void add_match_paths(MatchPaths paths, CloudMorph& morph) {
  morph.paths.insert(morph.paths.end(), paths.paths.begin(), paths.paths.end());
  morph.unsettled += paths.state == SinkhornState::iteration_limit ? 1 : 0;
  morph.worst_violation = std::max(morph.worst_violation, paths.violation);
}

Result<CloudMorph> morph_scans(std::span<const glm::dvec3> from, const CloudSegments& from_tree,
                               std::span<const glm::dvec3> to, const CloudSegments& to_tree, const MatchOptions& match,
                               const CloudTransportOptions& transport) {
  if (from.empty()) return fail({}, "from", "the scan has no points");
  if (to.empty()) return fail({}, "to", "the scan has no points");
  CloudMorph out;
  out.matches = match_segments(from, from_tree, to, to_tree, match);
  for (std::uint32_t m = 0; m < out.matches.size(); ++m) {
    auto paths = match_paths(from, to, out.matches[m], m, transport);
    if (!paths) return tl::unexpected(paths.error());
    add_match_paths(std::move(*paths), out);
  }
  return out;
}

std::vector<glm::dvec3> places_at(std::span<const CloudPath> paths, double t) {
  std::vector<glm::dvec3> out;
  out.reserve(paths.size());
  for (const CloudPath& path : paths) out.push_back(path.from + t * (path.to - path.from));
  return out;
}

CloudDistance distance_to(std::span<const glm::dvec3> points, std::span<const glm::dvec3> others, double extent) {
  CloudDistance out;
  if (points.empty() || others.empty()) return out;
  const CloudTree tree(others);
  std::vector<CloudNeighbour> near;
  double squares = 0.0;
  for (const glm::dvec3& p : points) {
    tree.nearest(p, 1, near);
    const double d = near[0].distance / extent;
    out.mean += d;
    squares += d * d;
    out.most = std::max(out.most, d);
  }
  const auto count = static_cast<double>(points.size());
  out.mean /= count;
  out.deviation = std::sqrt(std::max(0.0, squares / count - out.mean * out.mean));
  return out;
}

}  // namespace lackwerk::core
