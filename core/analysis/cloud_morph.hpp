// From one scan to the next: straight paths of points, segment by segment.
//
// Why it exists: this is what a scan pack holds and the kiosk plays (Golla 2021, chapter 4). Values; pure, any thread;
// same bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/cloud_match.hpp"
#include "core/analysis/cloud_segments.hpp"
#include "core/analysis/cloud_transport.hpp"
#include "core/error.hpp"

namespace lackwerk::core {

/// One point's straight way from time 0 to time 1.
struct CloudPath {
  static constexpr std::uint32_t none = 0xffffffffu;
  glm::dvec3 from{0.0}, to{0.0};
  std::uint32_t match = 0;        ///< into `matches`: its kind says whether the point grows, moves or decays
  std::uint32_t from_point = 0;   ///< index in its scan
  std::uint32_t to_point = none;  ///< index in its scan; none where the point decays
};

struct CloudMorph {
  std::vector<SegmentMatch> matches;
  std::vector<CloudPath> paths;  ///< match by match; every point of both scans ends one path at least
  int unsettled = 0;             ///< matches whose transport met its iteration limit
  double worst_violation = 0.0;  ///< of marginals, over all matches
};

/// The ways of one match's points.
struct MatchPaths {
  std::vector<CloudPath> paths;
  SinkhornState state = SinkhornState::converged;
  double violation = 0.0;  ///< of marginals
};

/// Paths of match number `number`: straight down (or nowhere) where it decays, else along the chosen pairs.
[[nodiscard]] Result<MatchPaths> match_paths(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                                             const SegmentMatch& match, std::uint32_t number,
                                             const CloudTransportOptions& transport);

/// Puts a match's paths behind those before it.
void add_match_paths(MatchPaths paths, CloudMorph& morph);

/// Paths between segmented scans. Errors: a scan has no points (field: from or to).
[[nodiscard]] Result<CloudMorph> morph_scans(std::span<const glm::dvec3> from, const CloudSegments& from_tree,
                                             std::span<const glm::dvec3> to, const CloudSegments& to_tree,
                                             const MatchOptions& match, const CloudTransportOptions& transport);

/// Where the points are at time t in [0, 1].
[[nodiscard]] std::vector<glm::dvec3> places_at(std::span<const CloudPath> paths, double t);

/// How far each of `points` lies from the nearest of `others`, after both are scaled to the unit cube by `extent`.
struct CloudDistance {
  double mean = 0.0, deviation = 0.0, most = 0.0;
};
[[nodiscard]] CloudDistance distance_to(std::span<const glm::dvec3> points, std::span<const glm::dvec3> others,
                                        double extent);

}  // namespace lackwerk::core
