// Where rays of the reference integrator meet the scene.
//
// Why it exists: the one place that knows Embree. Owns Embree's copies of the meshes; immutable after creation, any
// number of threads. Rays are single precision (a tenth of a micrometre at a car's size matters to nobody); everything
// that is shaded from a hit is double.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/analysis/reference.hpp"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace lackwerk::core {

struct ReferenceHit {
  std::uint32_t mesh = 0;  ///< index into ReferenceScene::meshes
  std::uint32_t triangle = 0;
  double u = 0.0, v = 0.0;  ///< weights of its second and third corner
  double distance_mm = 0.0;
};

/// The clamped quadratic of visibility, as visible_part of environment.glsl takes it.
struct VisibilityQuadratic {
  glm::dvec3 v0{1.0, 0.0, 0.0}, v1{0.0}, v2{0.0};
};

class ReferenceGeometry {
 public:
  /// `scene` must outlive it. Errors: no device, an index beyond its array, arrays of unequal length.
  [[nodiscard]] static Result<ReferenceGeometry> create(const ReferenceScene& scene);

  /// The first front face along the ray beyond `from_mm` and before `to_mm`. `glass`: among blended meshes, otherwise
  /// among the opaque ones. `direction` is unit.
  [[nodiscard]] std::optional<ReferenceHit> first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                                                      double from_mm, double to_mm, bool glass) const;
  [[nodiscard]] bool has_glass() const { return has_glass_; }
  /// Whether anything opaque stands in the way.
  [[nodiscard]] bool blocked(const glm::dvec3& origin, const glm::dvec3& direction) const;

  [[nodiscard]] glm::dvec3 position(const ReferenceHit& hit) const;
  [[nodiscard]] glm::dvec3 normal(const ReferenceHit& hit) const;  ///< interpolated, unit
  [[nodiscard]] VisibilityQuadratic visibility(const ReferenceHit& hit) const;

 private:
  struct ReleaseDevice {
    void operator()(RTCDeviceTy* device) const;
  };
  struct ReleaseScene {
    void operator()(RTCSceneTy* scene) const;
  };
  ReferenceGeometry() = default;
  void attach(RTCSceneTy* target, std::uint32_t number);

  std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
  std::unique_ptr<RTCSceneTy, ReleaseScene> opaque_, glass_;
  const ReferenceScene* scene_ = nullptr;
  bool has_glass_ = false;
};

}  // namespace lackwerk::core
