#include "packs/materials.hpp"

#include "core/check.hpp"

namespace lackwerk::packs {
namespace {

/// A lobe that mirrors the share `albedo` of light from everywhere at normal view where f0 = 1, and albedo * f0 of it
/// for a dielectric: 4 s F is that share (docs/decisions.md, the lobe weights).
core::Lobe lobe(glm::dvec3 albedo, double m, double f0) { return {albedo * 0.25, m, f0}; }

Material make(glm::dvec3 diffuse, const core::Lobe& shine, double coat_ior = 1.0) {
  Material out;
  out.surface.diffuse = diffuse;
  out.surface.lobes[0] = shine;
  out.surface.coat_ior = coat_ior;
  return out;
}

Material glass() {
  Material out = make({0.010, 0.012, 0.013}, {}, 1.52);
  out.coverage = 0.80;
  return out;
}

/// A bright inside behind a smooth lens.
Material lamp(glm::dvec3 inside, glm::vec3 emission) {
  Material out = make(glm::dvec3(0.0), lobe(inside, 0.13, 1.0), 1.5);
  out.emission = emission;
  return out;
}

}  // namespace

const Material& material_of(SurfaceKind kind) {
  // Reflectances as seen on cars of today: bright chrome 0.63, satin aluminium 0.35, tyres 2 %, polished concrete 12 %.
  static const Material glass_material = glass();
  static const Material chrome = make(glm::dvec3(0.0), lobe({0.62, 0.63, 0.65}, 0.02, 1.0));
  static const Material rubber = make(glm::dvec3(0.018), lobe(glm::dvec3(0.35), 0.35, 0.04));
  static const Material trim = make(glm::dvec3(0.012), lobe(glm::dvec3(0.8), 0.09, 0.04));
  static const Material rim = make(glm::dvec3(0.05), lobe({0.34, 0.345, 0.355}, 0.11, 1.0));
  static const Material lamp_clear = lamp(glm::dvec3(0.16), {0.92f, 0.97f, 1.05f});
  static const Material lamp_red = lamp({0.10, 0.004, 0.004}, {0.75f, 0.012f, 0.010f});
  static const Material interior = make(glm::dvec3(0.02), {});
  static const Material floor = make({0.115, 0.114, 0.112}, lobe(glm::dvec3(0.55), 0.08, 0.04));
  switch (kind) {
    case SurfaceKind::glass:
      return glass_material;
    case SurfaceKind::chrome:
      return chrome;
    case SurfaceKind::rubber:
      return rubber;
    case SurfaceKind::trim:
      return trim;
    case SurfaceKind::rim:
      return rim;
    case SurfaceKind::lamp_clear:
      return lamp_clear;
    case SurfaceKind::lamp_red:
      return lamp_red;
    case SurfaceKind::interior:
      return interior;
    case SurfaceKind::floor:
      return floor;
    case SurfaceKind::paint:
      break;
  }
  check_equal(kind != SurfaceKind::paint, true, "the paint's material is the pack's");
  return floor;
}

}  // namespace lackwerk::packs
