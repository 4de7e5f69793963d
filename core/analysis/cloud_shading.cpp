#include "core/analysis/cloud_shading.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <unordered_set>

#include "core/analysis/cloud_neighbours.hpp"
#include "core/analysis/point_cloud.hpp"

namespace lackwerk::core {

namespace {

glm::dvec3 normal_of(std::span<const glm::dvec3> points, std::span<const CloudNeighbour> near, const glm::dvec3& up) {
  glm::dvec3 mean(0.0);
  for (const CloudNeighbour& n : near) mean += points[n.index];
  mean /= static_cast<double>(near.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const CloudNeighbour& n : near) {
    const glm::dvec3 d = points[n.index] - mean;
    const Eigen::Vector3d v(d.x, d.y, d.z);
    spread += v * v.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector3d values = solver.eigenvalues();
  // A line (or one place) has no normal of its own: the one that looks up most.
  constexpr double line = 1e-6;
  if (!(values[1] > line * values[2])) {
    const Eigen::Vector3d along = solver.eigenvectors().col(2);
    const glm::dvec3 axis(along.x(), along.y(), along.z());
    const glm::dvec3 upright = values[2] > 0.0 ? up - axis * glm::dot(axis, up) : up;
    const double length = glm::length(upright);
    return length > 1e-9 ? upright / length : glm::dvec3(up.y, up.z, up.x);
  }
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(least.x(), least.y(), least.z()));
  return glm::dot(normal, up) < 0.0 ? -normal : normal;
}

/// Cubes that hold points, by their three numbers.
class Cubes {
 public:
  Cubes(std::span<const glm::dvec3> points, double edge) : low_(box_of(points).low), edge_(edge) {
    held_.reserve(points.size());
    for (const glm::dvec3& p : points) held_.insert(key(place(p)));
  }
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& p) const { return (p - low_) / edge_; }
  [[nodiscard]] bool holds(const glm::dvec3& place) const { return held_.count(key(place)) > 0; }

 private:
  static std::uint64_t key(const glm::dvec3& place) {
    std::uint64_t out = 0;
    for (int c = 0; c < 3; ++c)  // one cube of margin below; 21 bits each
      out = out << 21 | static_cast<std::uint64_t>(std::clamp(std::floor(place[c]) + 1.0, 0.0, 2097151.0));
    return out;
  }
  glm::dvec3 low_;
  double edge_;
  std::unordered_set<std::uint64_t> held_;
};

constexpr int ray_count = 24;

/// Rays spread evenly over the cosine of their angle to the vertical (Fibonacci's spiral), upper half only.
std::array<glm::dvec3, ray_count> sky_rays(int up) {
  std::array<glm::dvec3, ray_count> rays;
  for (int k = 0; k < ray_count; ++k) {
    const double height = std::sqrt((k + 0.5) / ray_count);  // cosine-weighted
    const double turn = 2.0 * std::numbers::pi * k * 0.6180339887498949;
    const double flat = std::sqrt(1.0 - height * height);
    glm::dvec3& ray = rays[static_cast<std::size_t>(k)];
    ray[up] = height;
    ray[(up + 1) % 3] = flat * std::cos(turn);
    ray[(up + 2) % 3] = flat * std::sin(turn);
  }
  return rays;
}

}  // namespace

std::vector<glm::vec3> normals_of(std::span<const glm::dvec3> points, std::size_t neighbours, int up) {
  std::vector<glm::vec3> out;
  out.reserve(points.size());
  glm::dvec3 upwards(0.0);
  upwards[up] = 1.0;
  const CloudTree tree(points);
  std::vector<CloudNeighbour> near;
  for (const glm::dvec3& p : points) {
    tree.nearest(p, neighbours + 1, near);
    out.emplace_back(normal_of(points, near, upwards));
  }
  return out;
}

std::vector<float> sky_of(std::span<const glm::dvec3> points, double cube, int reach, int up) {
  std::vector<float> out;
  out.reserve(points.size());
  const Cubes cubes(points, cube);
  const auto rays = sky_rays(up);
  // A leaf one cube thick must not shade itself: rays begin two cubes away.
  constexpr int first = 2;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 at = cubes.place(p);
    int seen = 0;
    for (const glm::dvec3& ray : rays) {
      bool free = true;
      for (int k = first; free && k < reach; ++k) free = !cubes.holds(at + ray * static_cast<double>(k));
      seen += free ? 1 : 0;
    }
    out.push_back(static_cast<float>(seen) / static_cast<float>(ray_count));
  }
  return out;
}

}  // namespace lackwerk::core
