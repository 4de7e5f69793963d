#include "packs/tools/car/builtin_car.hpp"

#include <map>
#include <string>
#include <utility>

#include "packs/tools/car/body_parts.hpp"
#include "packs/tools/car/cameras.hpp"
#include "packs/tools/car/face_details.hpp"
#include "packs/tools/car/floor.hpp"
#include "packs/tools/car/interior.hpp"
#include "packs/tools/car/mirror.hpp"
#include "packs/tools/car/wheels.hpp"
#include "packs/tools/scene_detail.hpp"

namespace lackwerk::packs {

namespace {

using namespace car;

/// The body is meshed twice, once for each level: leaving vertices out of the fine mesh would make mirror images
/// wobble. 0.8 degrees of the normal move a mirror image by 1.6 degrees, three widths of the moon.
constexpr BodyFineness fine_body{};
constexpr BodyFineness coarse_body{2.5, 20.0, 0.8, 1.5, 11.0};

/// How far vertices may be left out elsewhere: 1.5 mm is a third of a pixel in a picture of the whole car; what stands
/// behind dark glass may move more, strips of chrome less.
CoarseLimits coarse_limits(SurfaceKind kind) {
  constexpr CoarseLimits silhouette{0, 1.5f}, behind_glass{0, 6.0f}, bright{0, 0.3f};
  if (kind == SurfaceKind::interior) return behind_glass;
  return kind == SurfaceKind::chrome ? bright : silhouette;
}

/// Their coarse mesh keeps all its vertices.
bool mirrors_or_lies_flat(SurfaceKind kind) {
  return kind == SurfaceKind::paint || kind == SurfaceKind::glass || kind == SurfaceKind::floor;
}

/// `left` and its mirror image; `middle` is what was built for both sides already.
Patch both_sides(const Patch& left, const Patch& middle = {}) {
  Patch both = left;
  append(both, mirrored_y(left));
  append(both, middle);
  return both;
}

/// Collects parts of one level.
struct Level {
  std::vector<MeshPart>& parts;
  std::uint8_t detail;

  void add(const Patch& patch, const std::string& name, SurfaceKind kind) const {
    const std::size_t first = parts.size();
    add_parts(parts, patch, name, kind);
    for (std::size_t k = first; k < parts.size(); ++k) {
      if (detail == detail_coarse && !mirrors_or_lies_flat(kind)) parts[k] = coarser(parts[k], coarse_limits(kind));
      parts[k].detail = detail;
    }
  }
};

void add_body(const Level& level, BodyParts parts, const FacePatches& face, const MirrorPatches& mirror) {
  std::map<Region, Patch>& regions = parts.regions;
  Patch paint = regions[Region::paint];
  append(paint, parts.lip);
  append(paint, mirror.cap);
  level.add(both_sides(paint, face.paint), "body", SurfaceKind::paint);
  level.add(both_sides(parts.dark), "gaps", SurfaceKind::rubber);
  Patch bright = regions[Region::window_bright];
  append(bright, mirror.glass);
  append(bright, regions[Region::grille_frame]);
  append(bright, regions[Region::badge]);
  level.add(both_sides(bright, face.bright), "bright_trim", SurfaceKind::chrome);
  level.add(both_sides(regions[Region::head_light]), "head_lights", SurfaceKind::lamp_clear);
  level.add(both_sides(regions[Region::tail_light]), "tail_light", SurfaceKind::lamp_red);
  Patch trim = mirror.base;
  for (const Region region :
       {Region::window_frame, Region::cowl, Region::tail_frame, Region::lower_trim, Region::underbody})
    append(trim, regions[region]);
  level.add(both_sides(trim, face.trim), "trim", SurfaceKind::trim);
  level.add(both_sides(parts.lining), "lining", SurfaceKind::interior);
  level.add(both_sides(regions[Region::side_glass]), "side_windows", SurfaceKind::glass);
  level.add(both_sides(regions[Region::front_glass]), "windscreen", SurfaceKind::glass);
  level.add(both_sides(regions[Region::rear_glass]), "rear_window", SurfaceKind::glass);
  level.add(both_sides(regions[Region::head_lamp]), "head_lamps", SurfaceKind::glass);
}

/// Parts that are built once; the coarse level leaves vertices out.
void add_with_twins(Scene& scene, const Patch& patch, const std::string& name, SurfaceKind kind) {
  std::vector<MeshPart> parts;
  add_parts(parts, patch, name, kind);
  for (MeshPart& part : parts) add_with_twin(scene.parts, std::move(part), coarse_limits(kind));
}

void add_wheels(Scene& scene, const WheelLayout& layout) {
  const WheelPatches wheel = build_wheel(layout, {});
  const auto all_four = [&](const Patch& one, const std::string& name, SurfaceKind kind) {
    Patch left;
    for (const double x : {layout.front_axle_x_mm, layout.rear_axle_x_mm}) {
      append(left, transformed(one, [&](const Vec3& p) {
               return p + Vec3{x, layout.outer_face_y_mm, layout.centre_z_mm};
             }));
    }
    add_with_twins(scene, both_sides(left), name, kind);
  };
  all_four(wheel.tyre, "tyres", SurfaceKind::rubber);
  all_four(wheel.rim, "rims", SurfaceKind::rim);
  all_four(wheel.caliper, "calipers", SurfaceKind::trim);
  all_four(wheel.cap, "wheel_caps", SurfaceKind::chrome);
}

void add_floor(Scene& scene) {
  FloorShape coarse;
  coarse.cell_mm *= 2.0;
  coarse.rings = 8;
  const Level full{scene.parts, detail_full}, twin{scene.parts, detail_coarse};
  full.add(build_floor({}), "floor", SurfaceKind::floor);
  twin.add(build_floor(coarse), "floor", SurfaceKind::floor);
}

}  // namespace

Scene build_builtin_car() {
  Scene scene;
  scene.name = "car";
  const BodyShape shape;
  const BodyField body(shape);
  const GraphicsShape drawing;
  const BodyGraphics graphics(body, shape.wheels, drawing);
  const FacePatches face = build_face_details(body, drawing);
  const MirrorPatches mirror = build_mirror();
  const Level full{scene.parts, detail_full}, coarse{scene.parts, detail_coarse};
  add_body(full, build_body(body, graphics, shape, fine_body), face, mirror);
  add_body(coarse, build_body(body, graphics, shape, coarse_body), face, mirror);
  add_wheels(scene, shape.wheels);
  add_with_twins(scene, build_interior(), "interior", SurfaceKind::interior);
  add_floor(scene);
  scene.cameras = car_cameras(body);
  return scene;
}

}  // namespace lackwerk::packs
