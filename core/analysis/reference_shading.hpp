// Light along one ray, by one random path: what the reference averages.
//
// Why it exists: apart from pixels, threads and error bars this is the whole integrator. Directions of incoming light
// come from a mixture of densities (environment, each lobe, cosine) and are weighted by the balance heuristic, that is,
// divided by the mixture's density (Veach 1997, 9.2). Holds paint models, which are cheap and not shared: one per
// thread; what it points to is read-only and outlives it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/analysis/reference.hpp"
#include "core/analysis/reference_geometry.hpp"
#include "core/analysis/reference_numbers.hpp"
#include "core/analysis/reference_room.hpp"
#include "core/analysis/reference_sampling.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::core {

class ReferenceShader {
 public:
  struct World {
    const ReferenceScene* scene;
    const ReferenceGeometry* geometry;
    const RoomSampler* room;
    const ReferenceLighting* lighting;
    ReferenceVisibility visibility;
    int bounces;
    double pixel_per_mm;  ///< edge of a pixel in mm per mm of distance
  };
  explicit ReferenceShader(const World& world);

  /// Scene-linear radiance that arrives from `direction` at the eye: one sample of it.
  [[nodiscard]] glm::dvec3 camera_ray(const glm::dvec3& eye, const glm::dvec3& direction, ReferenceNumbers& numbers) {
    return along(eye, direction, 0.0, 0, numbers);
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  using Model = PaintModel<double>;
  /// The lobes and the flakes' mean, each with a Beckmann roughness to draw by.
  static constexpr std::size_t glossy_parts = max_lobes + 1;

  struct Material {
    Model all;          ///< as the renderer binds it
    Model matt, gloss;  ///< its diffuse part alone, its lobes alone: the floor's are lit in different ways
    glm::dvec3 emission;
    double coverage;
    bool floor, paint;
    double matt_albedo;                            ///< luminance of the diffuse part
    std::array<double, glossy_parts> part_albedo;  ///< at normal view, before Fresnel
    std::array<double, glossy_parts> part_m;
  };
  /// A hit, ready to be shaded. All directions are unit and point away from the surface.
  struct Surface {
    glm::dvec3 p, n, o;
    VisibilityQuadratic open;
    glm::dvec2 texel;
    double lod;
    Material* material;
  };
  struct Mixture {
    double environment = 0.0, cosine = 0.0;
    std::array<double, glossy_parts> part{};
  };

  [[nodiscard]] Material bind(const ReferenceMaterial& material) const;
  [[nodiscard]] Surface surface_at(const ReferenceHit& hit, const glm::dvec3& direction, double travelled);
  [[nodiscard]] glm::dvec3 along(const glm::dvec3& origin, const glm::dvec3& direction, double travelled, int depth,
                                 ReferenceNumbers& numbers);
  [[nodiscard]] glm::dvec3 through_glass(const glm::dvec3& origin, const glm::dvec3& direction, double travelled,
                                         double end, const glm::dvec3& behind, int depth, ReferenceNumbers& numbers);
  [[nodiscard]] glm::dvec3 shade(const ReferenceHit& hit, const glm::dvec3& direction, double travelled, int depth,
                                 ReferenceNumbers& numbers);
  [[nodiscard]] glm::dvec3 radiance(const Surface& s, double travelled, int depth, ReferenceNumbers& numbers);
  [[nodiscard]] glm::dvec3 one_light(const Surface& s, double u);
  [[nodiscard]] std::optional<glm::dvec3> draw(const Surface& s, const Mixture& mix, const LobeSampler& lobes,
                                               const glm::dvec2& u) const;
  [[nodiscard]] glm::dvec3 one_direction(const Surface& s, double travelled, int depth, ReferenceNumbers& numbers);
  [[nodiscard]] Mixture mixture_at(const Surface& s);
  [[nodiscard]] glm::dvec3 traced(const Surface& s, const glm::dvec3& d, double travelled, int depth,
                                  ReferenceNumbers& numbers);
  [[nodiscard]] double open_part(const Surface& s, const glm::dvec3& d) {
    return room_.visible_part(s.open.v0, s.open.v1, s.open.v2, d);
  }
  [[nodiscard]] glm::dvec3 room_radiance(const glm::dvec3& p, const glm::dvec3& d) {
    return room_.environment_sharp(room_.room_direction(p, d));
  }
  [[nodiscard]] bool is_traced() const { return world_.visibility == ReferenceVisibility::traced; }

  World world_;
  Model room_;  ///< any model: for the functions of environment.glsl
  std::vector<Material> materials_;
  double texels_per_mm_ = 0.0;
  std::uint64_t rays_ = 0;
};

}  // namespace lackwerk::core
