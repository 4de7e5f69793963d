#include "core/analysis/cloud_wasserstein.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/analysis/point_cloud.hpp"
#include "core/check.hpp"

namespace lackwerk::core {

namespace {

using Members = std::vector<std::uint32_t>;

/// Halves at the median of the longest edge; ties by index, so that duplicates split too.
std::pair<Members, Members> halves(std::span<const glm::dvec3> points, Members members) {
  CloudBox box;
  for (const std::uint32_t m : members) {
    const CloudBox one = box_of(points.subspan(m, 1));
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], one.low[axis]);
      box.high[axis] = std::max(box.high[axis], one.high[axis]);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (box.high[axis] - box.low[axis] > box.high[longest] - box.low[longest]) longest = axis;
  const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
  std::nth_element(members.begin(), middle, members.end(), [&](std::uint32_t one, std::uint32_t two) {
    const double a = points[one][longest];
    const double b = points[two][longest];
    return a != b ? a < b : one < two;
  });
  std::pair<Members, Members> out{Members(members.begin(), middle), Members(middle, members.end())};
  std::sort(out.first.begin(), out.first.end());
  std::sort(out.second.begin(), out.second.end());
  return out;
}

}  // namespace

CloudClusters clusters_of(std::span<const glm::dvec3> points, std::size_t most) {
  CloudClusters out;
  out.points = points.size();
  if (points.empty()) return out;
  out.members.emplace_back(points.size());
  std::iota(out.members[0].begin(), out.members[0].end(), 0u);
  while (out.members.size() * 2 <= most && out.members.size() * 2 <= points.size()) {
    std::vector<Members> finer;
    for (Members& members : out.members) {
      auto [low, high] = halves(points, std::move(members));
      finer.push_back(std::move(low));
      finer.push_back(std::move(high));
    }
    out.members = std::move(finer);
  }
  for (const Members& members : out.members) {
    const glm::dvec3 base = points[members[0]];
    glm::dvec3 sum(0.0);
    for (const std::uint32_t m : members) sum += points[m] - base;
    out.centres.push_back(base + sum / static_cast<double>(members.size()));
  }
  return out;
}

TransportPlan plan_between(const CloudClusters& from, const CloudClusters& to) {
  const auto masses = [](const CloudClusters& one, const CloudClusters& other) {
    std::vector<std::int64_t> out;
    for (const Members& members : one.members) out.push_back(static_cast<std::int64_t>(members.size() * other.points));
    return out;
  };
  auto plan = solve_transport(from.centres, masses(from, to), to.centres, masses(to, from));
  check_equal(plan.has_value(), true, "a plan between clusters of equal mass exists");
  return std::move(*plan);
}

double wasserstein(const CloudClusters& from, const CloudClusters& to) {
  return plan_between(from, to).cost / (static_cast<double>(from.points) * static_cast<double>(to.points));
}

}  // namespace lackwerk::core
