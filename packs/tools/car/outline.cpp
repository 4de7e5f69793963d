#include "packs/tools/car/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace lackwerk::packs::car {

namespace {

constexpr double chord_step_deg = 4.0;

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Appends the corner at `b` between `a` and `c` as a circle arc (or as the bare point where it is sharp).
void append_corner(std::vector<Vec2>& out, const Vec2& a, const Corner& b, const Vec2& c) {
  const Vec2 in = glm::normalize(b.at - a);
  const Vec2 leave = glm::normalize(c - b.at);
  const double turn = std::atan2(cross(in, leave), glm::dot(in, leave));
  if (b.radius_mm <= 0.0 || std::abs(turn) < 1e-6) {
    out.push_back(b.at);
    return;
  }
  // Never eat more than half of either leg, so that neighbouring corners cannot overlap.
  const double half_turn = std::tan(0.5 * std::abs(turn));
  const double room = 0.5 * std::min(glm::distance(a, b.at), glm::distance(b.at, c));
  const double radius = std::min(b.radius_mm, room / half_turn);
  const Vec2 start = b.at - in * (radius * half_turn);
  const double sign = turn > 0.0 ? 1.0 : -1.0;
  const Vec2 centre = start + Vec2{-in.y, in.x} * (sign * radius);
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(turn) * 57.29578 / chord_step_deg)));
  for (int i = 0; i <= steps; ++i) {
    const double angle = turn * i / steps;
    const Vec2 arm = start - centre;
    out.push_back(centre + Vec2{arm.x * std::cos(angle) - arm.y * std::sin(angle),
                                arm.x * std::sin(angle) + arm.y * std::cos(angle)});
  }
}

struct Nearest {
  double squared = std::numeric_limits<double>::max();
  double side = 0.0;
};

}  // namespace

Outline::Outline(const std::vector<Corner>& corners)
    : low_(std::numeric_limits<double>::max()), high_(std::numeric_limits<double>::lowest()) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    append_corner(points_, corners[(i + n - 1) % n].at, corners[i], corners[(i + 1) % n].at);
  }
  for (const Vec2& p : points_) {
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
  }
}

double Outline::distance(const Vec2& p) const {
  // Far away the box distance is enough: callers only look for the sign there.
  constexpr double exact_within_mm = 60.0;
  const Vec2 away = glm::max(glm::max(low_ - p, p - high_), Vec2(0.0));
  if (const double far = glm::length(away); far > exact_within_mm) return far;
  double best = std::numeric_limits<double>::max();
  bool inside = false;
  for (std::size_t i = 0, j = points_.size() - 1; i < points_.size(); j = i++) {
    const Vec2& a = points_[j];
    const Vec2& b = points_[i];
    const Vec2 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
    const Vec2 d = p - (a + ab * t);
    best = std::min(best, glm::dot(d, d));
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * ab.x) inside = !inside;
  }
  return inside ? -std::sqrt(best) : std::sqrt(best);
}

Stroke::Stroke(const std::vector<Corner>& corners) {
  points_.push_back(corners.front().at);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    append_corner(points_, corners[i - 1].at, corners[i], corners[i + 1].at);
  }
  points_.push_back(corners.back().at);
}

double Stroke::side(const Vec2& p) const {
  Nearest nearest;
  const std::size_t last = points_.size() - 2;
  for (std::size_t i = 0; i <= last; ++i) {
    const Vec2 a = points_[i];
    const Vec2 ab = points_[i + 1] - a;
    const double from = i == 0 ? -std::numeric_limits<double>::max() : 0.0;
    const double to = i == last ? std::numeric_limits<double>::max() : 1.0;
    const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), from, to);
    const Vec2 d = p - (a + ab * t);
    const double squared = glm::dot(d, d);
    if (squared < nearest.squared) nearest = {squared, cross(ab, p - a) > 0.0 ? 1.0 : -1.0};
  }
  return nearest.side * std::sqrt(nearest.squared);
}

}  // namespace lackwerk::packs::car
