#include "packs/tools/car/body_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace lackwerk::packs::car {

namespace {

/// Encloses the left half; its spine runs where every part of the body can be seen from.
constexpr WrapBox body_box{{-2420, 0, 60}, {2420, 1050, 1560}, -1650, 1500, 620, 0, 90};

SurfaceMesh mesh_body(const BodyField& body, const BodyGraphics& graphics, const BodyFineness& fineness) {
  SurfaceMesh mesh = wrap_field(body, body_box);
  MeshQuality quality;
  quality.tolerance = [&graphics, &fineness](const Vec3& p) {
    constexpr double dull_error_deg = 15.0;
    const double limit = graphics.edge_limit(p) * fineness.edge_scale;
    if (graphics.is_dull(p)) return Tolerance{limit, 45.0, dull_error_deg};
    return Tolerance{limit, fineness.bend_deg,
                     graphics.is_window(p) ? fineness.glass_error_deg : fineness.glossy_error_deg};
  };
  quality.shortest_edge_mm = fineness.shortest_edge_mm;
  refine(mesh, body, quality);
  MeshCutter cutter(mesh, body);
  for (const Cut& cut : graphics.cuts()) cutter.cut(cut);
  return mesh;
}

void add_hole(const Patch& rim, const std::function<Vec3(const Vec3&)>& depth, Patch& into) {
  append(into, displaced(rim, depth));
  append(into, hole_walls(rim, depth));
}

/// Inside of roof and pillars: keeps daylight out and is what one sees through the glass on the far side.
Patch build_lining(const BodyField& body, const BodyGraphics& graphics) {
  constexpr double lining_depth_mm = 26.0;
  constexpr double lining_from_z_mm = 900.0;
  constexpr double lining_edge_mm = 85.0;
  SurfaceMesh mesh = wrap_field(body, body_box);
  refine(mesh, body, {[](const Vec3&) { return Tolerance{lining_edge_mm, 12.0}; }, 20.0});
  MeshCutter cutter(mesh, body);
  for (const Cut& cut : graphics.glass_cuts()) cutter.cut(cut);
  const Patch roof = extract(mesh, body, [&](const Triangle& t) {
    const Vec3 middle = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0;
    if (middle.z < lining_from_z_mm || body.cabin_over_body(middle) > 0.0) return false;
    const Region region = graphics.region(middle);
    return region != Region::side_glass && region != Region::front_glass && region != Region::rear_glass;
  });
  return reversed(displaced(roof, [&body](const Vec3& p) { return unit_normal(body, p) * -lining_depth_mm; }));
}

/// The returned edge of the wheel openings: a small painted radius, then a dark inner fender.
void add_wheel_returns(BodyParts& parts, const Patch& opening, const BodyGraphics& graphics,
                       const WheelLayout& wheels) {
  const auto outward_part = [&](double toward_axle_mm, double inward_mm) {
    return [=, &wheels](const Vec3& p) {
      const double axle_x = p.x > 0.0 ? wheels.front_axle_x_mm : wheels.rear_axle_x_mm;
      const Vec3 radial = glm::normalize(Vec3{p.x - axle_x, 0.0, p.z - wheels.centre_z_mm});
      return Vec3{0.0, -inward_mm, 0.0} - radial * toward_axle_mm;
    };
  };
  // Only the arch itself, not the straight cut under the floor.

  const std::vector<BorderEdge> edges = border(opening);
  struct Step {
    double toward_axle_mm, inward_mm;
  };
  const std::vector<Step> steps{{0.0, 0.0}, {1.2, 1.2}, {2.0, 4.0}, {2.0, 18.0}};
  Patch lip;
  Patch black_lip;
  Patch well;
  for (const BorderEdge& e : edges) {
    const Vec3& a = opening.positions[e.from];
    const Vec3& b = opening.positions[e.to];
    const auto on_arch = [&wheels](const Vec3& p) {
      const double axle_x = p.x > 0.0 ? wheels.front_axle_x_mm : wheels.rear_axle_x_mm;
      return std::abs(std::hypot(p.x - axle_x, p.z - wheels.centre_z_mm) - wheels.arch_radius_mm) < 1.0;
    };
    if (!on_arch(a) || !on_arch(b) || a.y < 700.0) continue;
    const bool painted = graphics.lower_edge(0.5 * (a + b)) > 0.0;
    Patch& edge = painted ? lip : black_lip;
    for (std::size_t s = 0; s + 1 < steps.size(); ++s) {
      const auto near = outward_part(steps[s].toward_axle_mm, steps[s].inward_mm);
      const auto far = outward_part(steps[s + 1].toward_axle_mm, steps[s + 1].inward_mm);
      const auto base = static_cast<std::uint32_t>(edge.positions.size());
      edge.positions.insert(edge.positions.end(), {a + near(a), b + near(b), b + far(b), a + far(a)});
      edge.triangles.push_back({base, base + 1, base + 2});
      edge.triangles.push_back({base, base + 2, base + 3});
    }
    const auto last = outward_part(steps.back().toward_axle_mm, steps.back().inward_mm);
    const auto base = static_cast<std::uint32_t>(well.positions.size());
    const auto inside = [&wheels](Vec3 p) {
      p.y = wheels.well_inner_y_mm;
      return p;
    };
    constexpr std::uint32_t strips = 5;  // so that occlusion can fade towards the inside
    for (std::uint32_t s = 0; s <= strips; ++s) {
      const double t = static_cast<double>(s) / strips;
      const Vec3 from = a + last(a);
      const Vec3 to = b + last(b);
      well.positions.push_back(from + (inside(from) - from) * t);
      well.positions.push_back(to + (inside(to) - to) * t);
      if (s == strips) break;
      const std::uint32_t row = base + 2 * s;
      well.triangles.push_back({row, row + 1, row + 3});
      well.triangles.push_back({row, row + 3, row + 2});
    }
  }
  constexpr double lip_crease_deg = 80.0;
  append(parts.lip, with_normals(lip, lip_crease_deg));
  append(parts.dark, with_normals(black_lip, lip_crease_deg));
  append(parts.dark, with_normals(well, lip_crease_deg));
  // The inner wall, so that nobody sees through the car between tyre and arch.
  constexpr int wall_segments = 40;
  const Patch wall =
      with_normals(revolve({{0.0, 0.0}, {200.0, 0.0}, {wheels.arch_radius_mm, 0.0}}, wall_segments), 30.0);
  for (const double x : {wheels.front_axle_x_mm, wheels.rear_axle_x_mm}) {
    append(parts.dark, transformed(wall, [&wheels, x](const Vec3& p) {
             constexpr double lowest_z_mm = 158.0;  // cut off flat at the car's floor
             const double z = std::fmax(p.z + wheels.centre_z_mm, lowest_z_mm);
             return Vec3{p.x + x, wheels.well_inner_y_mm, z};
           }));
  }
}

}  // namespace

BodyParts build_body(const BodyField& body, const BodyGraphics& graphics, const BodyShape& shape,
                     const BodyFineness& fineness) {
  const SurfaceMesh mesh = mesh_body(body, graphics, fineness);
  std::vector<Region> region_of;
  region_of.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 middle = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0;
    region_of.push_back(graphics.region(middle));
  }
  BodyParts parts;
  for (int r = 0; r <= static_cast<int>(Region::underbody); ++r) {
    const auto region = static_cast<Region>(r);
    parts.regions[region] = extract(mesh, body, [&](const Triangle& t) {
      return region_of[static_cast<std::size_t>(&t - mesh.triangles.data())] == region;
    });
  }
  constexpr double grille_depth_mm = 45.0;
  constexpr double intake_depth_mm = 70.0;
  constexpr double lamp_depth_mm = 42.0;
  const auto backward = [](double depth_mm) { return [depth_mm](const Vec3&) { return Vec3{-depth_mm, 0.0, 0.0}; }; };
  constexpr double plate_recess_mm = 12.0;
  const auto forward = [](const Vec3&) { return Vec3{plate_recess_mm, 0.0, 0.0}; };
  add_hole(parts.regions[Region::plate_recess], forward, parts.lip);

  add_hole(parts.regions[Region::grille], backward(grille_depth_mm), parts.dark);
  add_hole(parts.regions[Region::intake], backward(intake_depth_mm), parts.dark);
  add_hole(parts.regions[Region::head_lamp], backward(lamp_depth_mm), parts.dark);
  append(parts.dark, parts.regions[Region::shut_line]);
  add_wheel_returns(parts, parts.regions[Region::opening], graphics, shape.wheels);
  parts.lining = build_lining(body, graphics);
  return parts;
}

}  // namespace lackwerk::packs::car
