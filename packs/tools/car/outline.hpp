// Closed and open curves in a drawing plane, with distances to them.
//
// Why it exists: windows, lamps, shut lines and intakes are drawn as a stylist draws them, as rounded polygons in a
// side, front or top view; the mesh is then cut where the distance is zero. Immutable values, any thread.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

namespace lackwerk::packs::car {

using Vec2 = glm::dvec2;

struct Corner {
  Vec2 at;
  double radius_mm = 0.0;
};

/// A polygon with rounded corners.
class Outline {
 public:
  explicit Outline(const std::vector<Corner>& corners);

  /// Negative inside, in millimetres.
  [[nodiscard]] double distance(const Vec2& p) const;

  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }

 private:
  std::vector<Vec2> points_;
  Vec2 low_, high_;
};

/// An open polyline with rounded corners, used for strokes of a constant width.
class Stroke {
 public:
  explicit Stroke(const std::vector<Corner>& corners);

  /// Which side of the line p is on, in millimetres: positive to the left of its direction. Beyond the ends the first
  /// and last pieces are continued straight.
  [[nodiscard]] double side(const Vec2& p) const;

 private:
  std::vector<Vec2> points_;
};

}  // namespace lackwerk::packs::car
