#include "core/analysis/cloud_align.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/analysis/cloud_neighbours.hpp"

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

/// The motion with the least sum of squares over the pairs (Kabsch 1976).
RigidMotion best_motion(std::span<const Pair> pairs) {
  glm::dvec3 from(0.0);
  glm::dvec3 to(0.0);
  for (const Pair& pair : pairs) {
    from += pair.from;
    to += pair.to;
  }
  from /= static_cast<double>(pairs.size());
  to /= static_cast<double>(pairs.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Pair& pair : pairs) {
    const glm::dvec3 a = pair.from - from;
    const glm::dvec3 b = pair.to - to;
    spread += Eigen::Vector3d(a.x, a.y, a.z) * Eigen::RowVector3d(b.x, b.y, b.z);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  sign.z() = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;  // no mirror
  const Eigen::Matrix3d turn = svd.matrixV() * sign.asDiagonal() * svd.matrixU().transpose();
  RigidMotion motion;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) motion.rotation[column][row] = turn(row, column);
  motion.shift = to - motion.rotation * from;
  return motion;
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

Alignment descend(std::span<const glm::dvec3> moving, const CloudTree& fixed, RigidMotion motion,
                  const AlignOptions& options) {
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
    out.motion = best_motion(std::span(pairs).first(believed));
    ++out.iterations;
  }
}

}  // namespace

Alignment align(std::span<const glm::dvec3> moving, std::span<const glm::dvec3> fixed, const AlignOptions& options) {
  if (moving.size() < 3 || fixed.size() < 3) return {};
  const CloudTree tree(fixed);
  std::vector<glm::dvec3> sample;
  const std::size_t step = std::max<std::size_t>(1, moving.size() / std::max<std::size_t>(options.sample, 3));
  for (std::size_t i = 0; i < moving.size(); i += step) sample.push_back(moving[i]);
  const glm::dvec3 from = mean_of(moving);
  const glm::dvec3 to = mean_of(fixed);
  Alignment best = descend(sample, tree, {}, options);
  for (int start = 0; start < options.starts; ++start) {
    constexpr double full_turn = 6.283185307179586;
    RigidMotion motion;
    motion.rotation = turn_about(options.up, full_turn * start / options.starts);
    motion.shift = to - motion.rotation * from;
    Alignment found = descend(sample, tree, motion, options);
    found.start = start + 1;
    if (found.rms < best.rms) best = found;
  }
  return best;
}

}  // namespace lackwerk::core
