// The scene as something rays hit.
//
// Why it exists: baking asks one question many million times, "does the car block this ray?"; Embree answers it. Holds
// its own copy of the triangles; read-only after it was made, so any number of threads may ask at once.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "packs/scene.hpp"

namespace lackwerk::packs {

class Blockers {
 public:
  /// Everything drawn at full detail blocks, but glass (it lets light through) and the floor (its light is part of the
  /// environment). Throws std::bad_alloc where Embree runs out of memory.
  explicit Blockers(const Scene& scene);
  ~Blockers();
  Blockers(const Blockers&) = delete;
  Blockers& operator=(const Blockers&) = delete;

  /// From a point in millimetres along a unit direction, without end.
  [[nodiscard]] bool blocked(const glm::vec3& from, const glm::vec3& direction) const;

  /// Corners of the box around what blocks; both zero when nothing does.
  [[nodiscard]] const glm::vec3& low_mm() const { return low_; }
  [[nodiscard]] const glm::vec3& high_mm() const { return high_; }

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  glm::vec3 low_{0.0f}, high_{0.0f};
};

/// The share of the sky above (cosine-weighted) that each place of the floor sees past the car, [0, 1].
class FloorOpenness {
 public:
  FloorOpenness(const Blockers& blockers, int threads);
  /// Linear between grid points; 1 further than 1.5 m outside the car's box.
  [[nodiscard]] float at(float x_mm, float y_mm) const;

 private:
  glm::vec3 low_{0.0f}, high_{0.0f};
  std::vector<float> share_;
};

}  // namespace lackwerk::packs
