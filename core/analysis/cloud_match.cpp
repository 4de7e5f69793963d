#include "core/analysis/cloud_match.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/cloud_wasserstein.hpp"

namespace lackwerk::core {

namespace {

using Numbers = std::vector<std::uint32_t>;

std::vector<glm::dvec3> places(std::span<const glm::dvec3> points, const Numbers& indices) {
  std::vector<glm::dvec3> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) out.push_back(points[i]);
  return out;
}

/// One scan and its tree.
struct Side {
  std::span<const glm::dvec3> points;
  const CloudSegments& tree;
  std::size_t clusters;

  [[nodiscard]] const CloudSegment& at(std::uint32_t s) const { return tree.segments[s]; }

  [[nodiscard]] Numbers points_of(const Numbers& segments) const {
    Numbers out;
    for (const std::uint32_t s : segments) out.insert(out.end(), at(s).points.begin(), at(s).points.end());
    std::sort(out.begin(), out.end());
    return out;
  }
  /// Children of any of `segments` that are none of them.
  [[nodiscard]] Numbers children_of(const Numbers& segments) const {
    Numbers out;
    for (const std::uint32_t s : segments)
      for (const std::uint32_t c : at(s).children)
        if (std::find(segments.begin(), segments.end(), c) == segments.end()) out.push_back(c);
    return out;
  }
  [[nodiscard]] Numbers with_descendants(std::uint32_t segment) const {
    Numbers out{segment};
    for (std::size_t k = 0; k < out.size(); ++k)
      out.insert(out.end(), at(out[k]).children.begin(), at(out[k]).children.end());
    return out;
  }
  [[nodiscard]] CloudClusters reduced(const Numbers& segments) const {
    return clusters_of(places(points, points_of(segments)), clusters);
  }
};

/// Where matching goes on: children of a match, how far their parents lie apart, and what new parts come out of.
struct Open {
  Numbers from, to;
  double moved = 0.0;
  Numbers base;
};

class Matcher {
 public:
  Matcher(Side from, Side to, const MatchOptions& options) : from_(from), to_(to), options_(options) {
    for (const glm::dvec3& p : to.points) floor_ = std::min(floor_, p[options.up]);
  }

  std::vector<SegmentMatch> by_distance() {
    const bool from_virtual = from_.at(0).points.empty();
    const bool to_virtual = to_.at(0).points.empty();
    if (!from_virtual && !to_virtual) {
      accept({0}, {0});
    } else {
      SegmentMatch roots;  // an empty root stands for nothing; the other scan's root is one part among others
      Open open{
          from_virtual ? from_.at(0).children : Numbers{0}, to_virtual ? to_.at(0).children : Numbers{0}, 0.0, {}};
      if (from_virtual) roots.from_segments = {0};
      if (to_virtual) roots.to_segments = {0};
      matches_.push_back(std::move(roots));
      open_.push_back(std::move(open));
    }
    for (; !open_.empty(); open_.pop_front()) match_children(open_.front());
    return std::move(matches_);
  }

  std::vector<SegmentMatch> by_label() {
    // An empty root stands for nothing: its label, which parts may bear too, makes no pair.
    SegmentMatch roots;
    if (from_.at(0).points.empty()) roots.from_segments = {0};
    if (to_.at(0).points.empty()) roots.to_segments = {0};
    if (!roots.from_segments.empty() || !roots.to_segments.empty()) matches_.push_back(std::move(roots));
    std::map<std::int32_t, std::uint32_t> to_of;
    for (std::uint32_t s = 0; s < to_.tree.segments.size(); ++s)
      if (!to_.at(s).points.empty()) to_of[to_.at(s).label] = s;
    std::vector<std::uint32_t> partner(to_.tree.segments.size(), CloudSegment::none);
    for (std::uint32_t s = 0; s < from_.tree.segments.size(); ++s) {
      if (from_.at(s).points.empty()) continue;
      const auto found = to_of.find(from_.at(s).label);
      if (found == to_of.end()) {
        decay({s});
        continue;
      }
      partner[found->second] = s;
      add_match({s}, {found->second}, distance({s}, {found->second}));
    }
    for (std::uint32_t s = 0; s < to_.tree.segments.size(); ++s) {
      if (partner[s] != CloudSegment::none || to_.at(s).points.empty()) continue;
      std::uint32_t above = to_.at(s).parent;
      while (above != CloudSegment::none && partner[above] == CloudSegment::none) above = to_.at(above).parent;
      grow({s}, above == CloudSegment::none ? Numbers{} : from_.at(partner[above]).points);
    }
    return std::move(matches_);
  }

 private:
  [[nodiscard]] double distance(const Numbers& from, const Numbers& to) const {
    const CloudClusters one = from_.reduced(from);
    const CloudClusters two = to_.reduced(to);
    return one.points == 0 || two.points == 0 ? 0.0 : wasserstein(one, two);
  }

  void add_match(Numbers from, Numbers to, double distance) {
    SegmentMatch match;
    match.from_points = from_.points_of(from);
    match.to_points = to_.points_of(to);
    match.from_segments = std::move(from);
    match.to_segments = std::move(to);
    match.distance = distance;
    matches_.push_back(std::move(match));
  }

  /// Merges what splits on one side only, then goes on with the children.
  void accept(Numbers from, Numbers to) {
    // A merge must bring the parts nearer by a tenth: less than that, the groups' own grain could.
    constexpr double gain = 0.9;
    double now = distance(from, to);
    while (options_.merges && now > 0.0) {
      double best = gain * now;
      Numbers* side = nullptr;
      std::uint32_t child = 0;
      const auto try_child = [&](Numbers& set, std::uint32_t c) {
        set.push_back(c);
        const double then = distance(from, to);
        set.pop_back();
        if (then >= best) return;
        best = then;
        side = &set;
        child = c;
      };
      for (const std::uint32_t c : to_.children_of(to)) try_child(to, c);
      for (const std::uint32_t c : from_.children_of(from)) try_child(from, c);
      if (side == nullptr) break;
      side->push_back(child);
      now = best;
    }
    open_.push_back({from_.children_of(from), to_.children_of(to), now, from_.points_of(from)});
    add_match(std::move(from), std::move(to), now);
  }

  void match_children(const Open& open) {
    std::vector<CloudClusters> sources, targets;
    std::vector<double> source_extent, target_extent;
    for (const std::uint32_t c : open.from) {
      sources.push_back(from_.reduced({c}));
      source_extent.push_back(extent_of(box_of(places(from_.points, from_.at(c).points))));
    }
    for (const std::uint32_t c : open.to) {
      targets.push_back(to_.reduced({c}));
      target_extent.push_back(extent_of(box_of(places(to_.points, to_.at(c).points))));
    }
    // A pair that is none costs as much as its limit: the assignment then prefers the pairs that are some.
    std::vector<double> cost, limit;
    for (std::size_t p = 0; p < sources.size(); ++p) {
      for (std::size_t q = 0; q < targets.size(); ++q) {
        limit.push_back(open.moved + options_.most_distance * std::max(source_extent[p], target_extent[q]));
        const bool both = sources[p].points > 0 && targets[q].points > 0;
        cost.push_back(both ? std::min(limit.back(), wasserstein(sources[p], targets[q])) : limit.back());
      }
    }
    const Numbers partner = least_assignment(cost, sources.size(), targets.size());
    std::vector<bool> taken(targets.size(), false);
    for (std::size_t p = 0; p < partner.size(); ++p) {
      const std::size_t pair = p * targets.size() + partner[p];
      const bool far = partner[p] != CloudSegment::none && cost[pair] >= limit[pair] && limit[pair] > 0.0;
      if (partner[p] == CloudSegment::none || far) {
        decay(from_.with_descendants(open.from[p]));
        continue;
      }
      taken[partner[p]] = true;
      accept({open.from[p]}, {open.to[partner[p]]});
    }
    for (std::size_t q = 0; q < targets.size(); ++q)
      if (!taken[q]) grow(to_.with_descendants(open.to[q]), open.base);
  }

  void decay(Numbers segments) {
    SegmentMatch match;
    match.kind = MatchKind::decayed;
    match.from_points = from_.points_of(segments);
    match.from_segments = std::move(segments);
    match.to_places = places(from_.points, match.from_points);
    if (!options_.fades && !to_.points.empty())
      for (glm::dvec3& place : match.to_places) place[options_.up] = floor_;
    matches_.push_back(std::move(match));
  }

  /// Comes out of the points of `base` (of the whole scan where that is empty) that lie nearest.
  void grow(Numbers segments, Numbers base) {
    SegmentMatch match;
    match.kind = MatchKind::grown;
    match.to_points = to_.points_of(segments);
    match.to_segments = std::move(segments);
    if (base.empty())
      for (std::uint32_t i = 0; i < from_.points.size(); ++i) base.push_back(i);
    const std::vector<glm::dvec3> part = places(to_.points, match.to_points);
    if (!part.empty()) {
      const CloudTree tree(part);
      std::vector<std::pair<double, std::uint32_t>> order;
      std::vector<CloudNeighbour> near;
      for (const std::uint32_t i : base) {
        tree.nearest(from_.points[i], 1, near);
        order.emplace_back(near[0].distance, i);
      }
      std::sort(order.begin(), order.end());
      order.resize(std::min({order.size(), options_.bud_points, part.size()}));
      for (const auto& [far, i] : order) match.from_points.push_back(i);
      std::sort(match.from_points.begin(), match.from_points.end());
    }
    matches_.push_back(std::move(match));
  }

  Side from_, to_;
  MatchOptions options_;
  double floor_ = HUGE_VAL;
  std::deque<Open> open_;
  std::vector<SegmentMatch> matches_;
};

}  // namespace

std::vector<std::uint32_t> least_assignment(std::span<const double> cost, std::size_t rows, std::size_t columns) {
  std::vector<std::uint32_t> partner(rows, CloudSegment::none);
  const bool turned = rows > columns;
  const std::size_t few = std::min(rows, columns);
  const std::size_t many = std::max(rows, columns);
  const auto at = [&](std::size_t i, std::size_t j) { return turned ? cost[j * columns + i] : cost[i * columns + j]; };
  // Place 0 of either side is the free end of the path being grown.
  std::vector<double> price_few(few + 1, 0.0), price_many(many + 1, 0.0);
  std::vector<std::size_t> owner(many + 1, 0);
  for (std::size_t i = 1; i <= few; ++i) {
    std::vector<double> slack(many + 1, HUGE_VAL);
    std::vector<std::size_t> way(many + 1, 0);
    std::vector<bool> done(many + 1, false);
    owner[0] = i;
    std::size_t end = 0;
    do {
      done[end] = true;
      double step = HUGE_VAL;
      std::size_t next = 0;
      for (std::size_t j = 1; j <= many; ++j) {
        if (done[j]) continue;
        const double reduced = at(owner[end] - 1, j - 1) - price_few[owner[end]] - price_many[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          way[j] = end;
        }
        if (slack[j] < step) {
          step = slack[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= many; ++j) {
        if (done[j]) {
          price_few[owner[j]] += step;
          price_many[j] -= step;
        } else {
          slack[j] -= step;
        }
      }
      end = next;
    } while (owner[end] != 0);
    for (; end != 0; end = way[end]) owner[end] = owner[way[end]];
  }
  for (std::size_t j = 1; j <= many; ++j) {
    if (owner[j] == 0) continue;
    const std::size_t row = turned ? j - 1 : owner[j] - 1;
    partner[row] = static_cast<std::uint32_t>(turned ? owner[j] - 1 : j - 1);
  }
  return partner;
}

std::vector<SegmentMatch> match_segments(std::span<const glm::dvec3> from, const CloudSegments& from_tree,
                                         std::span<const glm::dvec3> to, const CloudSegments& to_tree,
                                         const MatchOptions& options) {
  Matcher matcher({from, from_tree, options.clusters}, {to, to_tree, options.clusters}, options);
  return options.by_label ? matcher.by_label() : matcher.by_distance();
}

}  // namespace lackwerk::core
