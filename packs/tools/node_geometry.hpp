// The geometry in which flake slices are taken, and the smooth paint seen in it.
//
// Why it exists: a slice belongs to angles (theta_h, theta_i) and says nothing about phi_d. The virtual goniometer, its
// tests and the film table all choose phi_d = 90 degrees: light and eye lie symmetrically on both sides of the plane
// that holds the normal and h, so that n.i = n.o = cos(theta_h) cos(theta_i) is positive at every node, and no other
// phi_d lets the two angles come as close to 90 degrees. Directions are those inside the coat. Pure; any thread.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/paint.hpp"
#include "core/paint_model.hpp"

namespace lackwerk::packs {

/// The surface normal is +z, h lies in the x-z plane at azimuth 0. All are unit vectors.
struct NodeGeometry {
  glm::dvec3 half, light, eye;
};
[[nodiscard]] inline NodeGeometry node_geometry(double theta_h, double theta_i) {
  const glm::dvec3 half(std::sin(theta_h), 0.0, std::cos(theta_h));
  const glm::dvec3 across(0.0, std::sin(theta_i), 0.0);
  return {half, half * std::cos(theta_i) + across, half * std::cos(theta_i) - across};
}

/// The model with a paint's diffuse part and lobes (no table, no flakes, no coat).
inline void bind_lobes(const core::AnalyticPaint& paint, core::PaintModel<double>& model) {
  model.u_diffuse = paint.diffuse;
  for (std::size_t k = 0; k < core::max_lobes; ++k) {
    model.u_lobe[k] = glm::dvec4(paint.lobes[k].s, paint.lobes[k].f0);
  }
  model.u_inv_m = {1.0 / paint.lobes[0].m, 1.0 / paint.lobes[1].m, 1.0 / paint.lobes[2].m};
}

/// Radiance factor of diffuse part and lobes at a node, without chi.
[[nodiscard]] inline glm::dvec3 node_factor(const core::AnalyticPaint& paint, double theta_h, double theta_i) {
  core::PaintModel<double> model;
  bind_lobes(paint, model);
  const NodeGeometry g = node_geometry(theta_h, theta_i);
  return model.lobes_factor(model.paint_geometry({0.0, 0.0, 1.0}, g.light, g.eye), 1.0);
}

}  // namespace lackwerk::packs
