// Which segment of one scan becomes which of the next, what grows anew and what falls.
//
// Why it exists: scans are segmented one by one, so segments bear no common names, and a new leaf splits a stem in two
// (Golla 2021, 4.3.3). Values; pure, any thread; same bytes for the same input.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/analysis/cloud_segments.hpp"

namespace lackwerk::core {

enum class MatchKind {
  matched,
  grown,    ///< nothing stood for it: it comes out of `from_points`, a few points near its base
  decayed,  ///< nothing is left of it: it falls to (or fades at) `to_places`
};

struct SegmentMatch {
  MatchKind kind = MatchKind::matched;
  std::vector<std::uint32_t> from_segments, to_segments;  ///< one each, more after merges; empty on the virtual side
  std::vector<std::uint32_t> from_points;                 ///< ascending; duplicates of its base where grown
  std::vector<std::uint32_t> to_points;                   ///< ascending; empty where decayed
  std::vector<glm::dvec3> to_places;                      ///< where decayed: one per from_points
  double distance = 0.0;                                  ///< Wasserstein, of real segments only
};

struct MatchOptions {
  int up = 2;
  std::size_t clusters = 32;    ///< of each segment, for its distance to others
  std::size_t bud_points = 30;  ///< l of GT 4.3.3: how many points a new part comes out of (10 to 100 there)
  /// Children are no pair when they lie further apart than this part of the longer one's extent, beside what their
  /// parents moved: the one has gone, the other is new. A branch that grows threefold moves by a third of its length;
  /// one on the other side of the stem lies about one length away.
  double most_distance = 0.5;
  bool fades = false;     ///< decayed parts stay where they are (and fade) instead of falling
  bool merges = true;     ///< by distance: what is split in one scan only comes together again
  bool by_label = false;  ///< segments of equal label are pairs (GT's cases 1 and 2)
};

/// Every segment of both scans is in exactly one match, and every point on its own side in exactly one (points that new
/// parts come out of are there twice). Matches come parents first. `from` and `to` may be empty; an empty scan against
/// points: all grows from the root (of nothing) or decays.
[[nodiscard]] std::vector<SegmentMatch> match_segments(std::span<const glm::dvec3> from, const CloudSegments& from_tree,
                                                       std::span<const glm::dvec3> to, const CloudSegments& to_tree,
                                                       const MatchOptions& options);

/// The assignment of rows to columns with the least total cost (Kuhn 1955, by shortest augmenting paths); the smaller
/// side is assigned wholly. For each row its column, or CloudSegment::none. `cost` row by row, finite.
[[nodiscard]] std::vector<std::uint32_t> least_assignment(std::span<const double> cost, std::size_t rows,
                                                          std::size_t columns);

}  // namespace lackwerk::core
