// What the parts of the car that are not paint are made of.
//
// Why it exists: renderer and reference must mean the same by "rubber". Every material is a paint without table and
// flakes (core::AnalyticPaint: diffuse part, one lobe, perhaps a coat), so one shading rule and one integrator serve
// them all. Constants; any thread.
#pragma once

#include <glm/vec3.hpp>

#include "core/paint.hpp"
#include "packs/scene.hpp"

namespace lackwerk::packs {

struct Material {
  core::AnalyticPaint surface;
  glm::vec3 emission{0.0f};  ///< radiance per unit of the mood's lamp glow, linear sRGB
  /// Glass: share of what lies behind that is covered at normal view; the coat's Fresnel mirror adds to it. 1 = opaque.
  double coverage = 1.0;
};

/// For all kinds but `paint` (which aborts: its material is the pack's).
[[nodiscard]] const Material& material_of(SurfaceKind kind);

}  // namespace lackwerk::packs
