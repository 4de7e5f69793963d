#include "packs/tools/car/builtin_car.hpp"

#include <map>
#include <string>

#include "packs/tools/car/body_parts.hpp"
#include "packs/tools/car/cameras.hpp"
#include "packs/tools/car/face_details.hpp"
#include "packs/tools/car/floor.hpp"
#include "packs/tools/car/interior.hpp"
#include "packs/tools/car/mirror.hpp"
#include "packs/tools/car/wheels.hpp"
#include "packs/tools/scene_occlusion.hpp"

namespace lackwerk::packs {

namespace {

using namespace car;

/// `middle` is what was built for both sides already.
void add_both_sides(Scene& scene, const Patch& left, const std::string& name, SurfaceKind kind,
                    const Patch& middle = {}) {
  Patch both = left;
  append(both, mirrored_y(left));
  append(both, middle);
  add_parts(scene.parts, both, name, kind);
}

void add_body(Scene& scene, BodyParts parts, const FacePatches& face) {
  const MirrorPatches mirror = build_mirror();
  std::map<Region, Patch>& regions = parts.regions;
  Patch paint = regions[Region::paint];
  append(paint, parts.lip);
  append(paint, mirror.cap);
  add_both_sides(scene, paint, "body", SurfaceKind::paint, face.paint);
  add_both_sides(scene, parts.dark, "gaps", SurfaceKind::rubber);
  Patch bright = regions[Region::window_bright];
  append(bright, mirror.glass);
  append(bright, regions[Region::grille_frame]);
  append(bright, regions[Region::badge]);
  add_both_sides(scene, bright, "bright_trim", SurfaceKind::chrome, face.bright);
  add_both_sides(scene, regions[Region::head_light], "head_lights", SurfaceKind::lamp_clear);
  add_both_sides(scene, regions[Region::tail_light], "tail_light", SurfaceKind::lamp_red);
  Patch trim = mirror.base;

  for (const Region region :
       {Region::window_frame, Region::cowl, Region::tail_frame, Region::lower_trim, Region::underbody}) {
    append(trim, regions[region]);
  }

  add_both_sides(scene, trim, "trim", SurfaceKind::trim, face.trim);

  add_both_sides(scene, parts.lining, "lining", SurfaceKind::interior);
  add_both_sides(scene, regions[Region::side_glass], "side_windows", SurfaceKind::glass);
  add_both_sides(scene, regions[Region::front_glass], "windscreen", SurfaceKind::glass);
  add_both_sides(scene, regions[Region::rear_glass], "rear_window", SurfaceKind::glass);
  add_both_sides(scene, regions[Region::head_lamp], "head_lamps", SurfaceKind::glass);
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
    add_both_sides(scene, left, name, kind);
  };
  all_four(wheel.tyre, "tyres", SurfaceKind::rubber);
  all_four(wheel.rim, "rims", SurfaceKind::rim);
  all_four(wheel.caliper, "calipers", SurfaceKind::trim);
  all_four(wheel.cap, "wheel_caps", SurfaceKind::chrome);
}

}  // namespace

Scene build_builtin_car() {
  Scene scene;
  scene.name = "car";
  const BodyShape shape;
  const BodyField body(shape);
  const GraphicsShape drawing;
  const BodyGraphics graphics(body, shape.wheels, drawing);
  add_body(scene, build_body(body, graphics, shape), build_face_details(body, drawing));
  add_wheels(scene, shape.wheels);
  add_parts(scene.parts, build_interior(), "interior", SurfaceKind::interior);
  add_parts(scene.parts, build_floor({}), "floor", SurfaceKind::floor);
  scene.cameras = car_cameras(body);
  constexpr int rays_per_vertex = 128;
  bake_ambient_occlusion(scene, rays_per_vertex);
  return scene;
}

}  // namespace lackwerk::packs
