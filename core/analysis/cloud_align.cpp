#include "core/analysis/cloud_align.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/point_cloud.hpp"

namespace lackwerk::core {

namespace {

struct Pair {
  glm::dvec3 from, to;
  double distance = 0.0;
};

glm::dvec3 mean_of(std::span<const glm::dvec3> points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

glm::dmat3 turn_about(int up, double angle) {
  const int first = (up + 1) % 3;
  const int second = (up + 2) % 3;
  glm::dmat3 turn(1.0);
  turn[first][first] = turn[second][second] = std::cos(angle);
  turn[first][second] = std::sin(angle);
  turn[second][first] = -std::sin(angle);
  return turn;
}

/// The turn with the least sum of squares; `spread` is the sum of from * to^T (Kabsch 1976).
glm::dmat3 best_turn(const Eigen::Matrix3d& spread) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  sign.z() = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;  // no mirror
  const Eigen::Matrix3d turn = svd.matrixV() * sign.asDiagonal() * svd.matrixU().transpose();
  glm::dmat3 out;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out[column][row] = turn(row, column);
  return out;
}

/// The same about the vertical axis: sums of sines and cosines give the angle.
glm::dmat3 best_standing_turn(const Eigen::Matrix3d& spread, int up) {
  const int first = (up + 1) % 3;
  const int second = (up + 2) % 3;
  const double cosines = spread(first, first) + spread(second, second);
  const double sines = spread(first, second) - spread(second, first);
  return turn_about(up, std::atan2(sines, cosines));
}

/// What a motion may do: `feet` stay together where both scans have one.
struct Freedom {
  bool stands = true;
  int up = 2;
  std::optional<Pair> feet;
};

/// The motion with the least sum of squares over the pairs.
RigidMotion best_motion(std::span<const Pair> pairs, const Freedom& freedom) {
  glm::dvec3 from(0.0);
  glm::dvec3 to(0.0);
  for (const Pair& pair : pairs) {
    from += pair.from;
    to += pair.to;
  }
  from /= static_cast<double>(pairs.size());
  to /= static_cast<double>(pairs.size());
  if (freedom.feet) {
    from = freedom.feet->from;
    to = freedom.feet->to;
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Pair& pair : pairs) {
    const glm::dvec3 a = pair.from - from;
    const glm::dvec3 b = pair.to - to;
    spread += Eigen::Vector3d(a.x, a.y, a.z) * Eigen::RowVector3d(b.x, b.y, b.z);
  }
  RigidMotion motion;
  motion.rotation = freedom.stands ? best_standing_turn(spread, freedom.up) : best_turn(spread);
  motion.shift = to - motion.rotation * from;
  return motion;
}

Alignment descend(std::span<const glm::dvec3> moving, const CloudTree& fixed, RigidMotion motion,
                  const AlignOptions& options, const Freedom& freedom) {
  Alignment out;
  out.motion = motion;
  std::vector<Pair> pairs(moving.size());
  std::vector<CloudNeighbour> near;
  double last = HUGE_VAL;
  while (true) {
    for (std::size_t i = 0; i < moving.size(); ++i) {
      pairs[i].from = moving[i];
      const glm::dvec3 place = out.motion(moving[i]);
      fixed.nearest(place, 1, near);
      pairs[i].to = fixed.point(near[0].index);
      pairs[i].distance = near[0].distance;
    }
    const auto believed = std::clamp(static_cast<std::size_t>(options.overlap * static_cast<double>(pairs.size())),
                                     std::size_t{3}, pairs.size());
    std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(believed - 1), pairs.end(),
                     [](const Pair& one, const Pair& two) { return one.distance < two.distance; });
    double squares = 0.0;
    for (std::size_t i = 0; i < believed; ++i) squares += pairs[i].distance * pairs[i].distance;
    out.rms = std::sqrt(squares / static_cast<double>(believed));
    constexpr double settled = 1e-4;  // of the rms: coarse is what is asked for
    if (out.iterations >= options.most_iterations || !(out.rms < last * (1.0 - settled))) return out;
    last = out.rms;
    out.motion = best_motion(std::span(pairs).first(believed), freedom);
    ++out.iterations;
  }
}

}  // namespace

std::optional<glm::dvec3> foot_of(std::span<const glm::dvec3> points, int up) {
  constexpr double share = 0.1;
  constexpr double widest = 0.25;
  const CloudBox box = box_of(points);
  const double top = box.low[up] + share * (box.high[up] - box.low[up]);
  std::vector<glm::dvec3> low;
  std::copy_if(points.begin(), points.end(), std::back_inserter(low),
               [&](const glm::dvec3& p) { return p[up] <= top; });
  if (low.empty() || extent_of(box_of(low)) > widest * extent_of(box)) return std::nullopt;
  return mean_of(low);
}

Alignment align(std::span<const glm::dvec3> moving, std::span<const glm::dvec3> fixed, const AlignOptions& options) {
  if (moving.size() < 3 || fixed.size() < 3) return {};
  const CloudTree tree(fixed);
  std::vector<glm::dvec3> sample;
  const std::size_t step = std::max<std::size_t>(1, moving.size() / std::max<std::size_t>(options.sample, 3));
  for (std::size_t i = 0; i < moving.size(); i += step) sample.push_back(moving[i]);
  Freedom freedom{options.stands, options.up, {}};
  const auto foot_from = foot_of(moving, options.up);
  const auto foot_to = foot_of(fixed, options.up);
  if (options.stands && foot_from && foot_to) freedom.feet = Pair{*foot_from, *foot_to};
  const glm::dvec3 from = freedom.feet ? *foot_from : mean_of(moving);
  const glm::dvec3 to = freedom.feet ? *foot_to : mean_of(fixed);
  RigidMotion as_it_is;
  if (freedom.feet) as_it_is.shift = to - from;
  Alignment best = descend(sample, tree, as_it_is, options, freedom);
  for (int start = 0; start < options.starts; ++start) {
    constexpr double full_turn = 6.283185307179586;
    RigidMotion motion;
    motion.rotation = turn_about(options.up, full_turn * start / options.starts);
    motion.shift = to - motion.rotation * from;
    Alignment found = descend(sample, tree, motion, options, freedom);
    found.start = start + 1;
    if (found.rms < best.rms) best = found;
  }
  return best;
}

}  // namespace lackwerk::core
