#include "tests/render/golden_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/analysis/environment_lights.hpp"
#include "core/check.hpp"
#include "packs/tools/car/builtin_car.hpp"
#include "render_gles/governor.hpp"
#include "tests/render/support.hpp"

namespace lackwerk::test {
namespace {

struct Lamp {
  glm::dvec3 towards;
  glm::dvec3 radiance;
  double kappa;  ///< of a von Mises-Fisher distribution: 1 / variance
};

/// The room as a rough mirror of Beckmann roughness m sees it: mirrored directions vary by 2 m^2 around the sharp one.
glm::dvec3 room_light(const glm::dvec3& d, double m, double sun) {
  const std::array<Lamp, 5> lamps = {{{{-0.5, -0.6, 0.62}, {14.0, 13.0, 12.0}, 60.0},
                                      {{0.8, -0.2, 0.5}, {4.0, 5.0, 7.0}, 25.0},
                                      {{0.1, 0.7, 0.7}, {5.0, 5.0, 4.0}, 12.0},
                                      {{0.25, -0.8, 0.55}, {60.0, 58.0, 50.0}, 900.0},
                                      {{-0.6, -0.5, 0.7}, {sun, sun, sun}, 900.0}}};
  const double up = 0.5 + 0.5 * d.z / std::sqrt(d.z * d.z + 0.02 + m * m);
  glm::dvec3 sum = glm::mix(glm::dvec3(0.12, 0.11, 0.10), glm::dvec3(0.42, 0.46, 0.52), up);
  for (const Lamp& lamp : lamps) {
    const double kappa = 1.0 / (1.0 / lamp.kappa + 2.0 * m * m);
    sum += lamp.radiance * (kappa / lamp.kappa * std::exp(kappa * (glm::dot(d, glm::normalize(lamp.towards)) - 1.0)));
  }
  return sum;
}

core::OctahedralImage level_image(int edge, double m, double sun) {
  core::OctahedralImage image(edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x)
      image.at(x, y) =
          glm::vec3(room_light(core::direction_from_octahedral({(x + 0.5) / edge, (y + 0.5) / edge}), m, sun));
  image.wrap_border();
  return image;
}

packs::MeshPart moved_sphere(float radius_mm, const glm::vec3& centre_mm, packs::SurfaceKind kind) {
  packs::MeshPart part = sphere(radius_mm, 64, kind);
  for (glm::vec3& p : part.positions_mm) p += centre_mm;
  return part;
}

packs::MeshPart floor_square(float half_mm) {
  packs::MeshPart part;
  part.name = "floor";
  part.kind = packs::SurfaceKind::floor;
  part.positions_mm = {
      {-half_mm, -half_mm, 0.0f}, {half_mm, -half_mm, 0.0f}, {half_mm, half_mm, 0.0f}, {-half_mm, half_mm, 0.0f}};
  part.normals.assign(4, {0.0f, 0.0f, 1.0f});
  part.indices = {0, 1, 2, 0, 2, 3};
  return part;
}

/// Invented, smooth and strong enough to be seen: dark towards the floor and towards -x.
void add_baked_light(packs::MeshPart& part) {
  for (const glm::vec3& n : part.normals) {
    packs::Visibility seen = packs::open_visibility;
    seen[1] = 144;  // + 0.25 x
    seen[3] = 152;  // + 0.375 z
    part.visibility.push_back(seen);
    const float light = glm::clamp(0.35f + 0.3f * n.z + 0.1f * n.x, 0.0f, 1.0f);
    const auto coded = static_cast<std::uint16_t>(std::lround(std::sqrt(light) * 65535.0f));
    part.irradiance.push_back({coded, coded, static_cast<std::uint16_t>(coded / 2 + 30000)});
  }
}

/// A body of the table seen from in front and above.
const gles::View table_view{{60.0f, -620.0f, 260.0f}, {0.0f, 0.0f, 65.0f}, 30.0f, {}};
constexpr glm::vec3 sphere_centre_mm(0.0f, 0.0f, 180.0f);
const gles::View sphere_view{sphere_centre_mm + glm::vec3(0.0f, -400.0f, 60.0f), sphere_centre_mm, 32.0f, {}};
/// Texels of 0.6 mm are two pixels wide.
const gles::View macro_view{sphere_centre_mm + glm::vec3(-30.0f, -165.0f, 50.0f),
                            sphere_centre_mm + glm::vec3(-18.0f, -60.0f, 40.0f),
                            24.0f,
                            {}};

gles::Lighting room_lighting() {
  gles::Lighting lighting;
  lighting.exposure = 0.7f;
  lighting.lamp_glow = 0.9f;
  lighting.dither = false;  // half a step of noise makes the files four times larger and is tested elsewhere
  lighting.quality.flake_lights = 1;
  return lighting;
}

}  // namespace

core::Environment golden_environment(double sun) {
  core::Environment room;
  room.name = "golden";
  room.centre_mm = {0.0f, 0.0f, 400.0f};
  room.room_radius_mm = 3000.0f;
  room.atlas.resize(std::size_t{4} * core::environment_width * core::environment_height);
  const core::OctahedralImage sharp = level_image(core::environment_levels[0].edge, 0.0, sun);
  room.range = 0.0f;
  for (const glm::vec3& t : sharp.texels) room.range = std::max({room.range, t.x, t.y, t.z});
  for (const core::EnvironmentLevel& level : core::environment_levels) {
    const core::OctahedralImage image = level.m > 0.0 ? level_image(level.edge, level.m, sun) : sharp;
    for (int y = -1; y <= level.edge; ++y)
      for (int x = -1; x <= level.edge; ++x) {
        const auto texel = std::size_t{core::environment_width} * static_cast<unsigned>(level.y + y) +
                           static_cast<unsigned>(level.x + x);
        core::encode_radiance(glm::dvec3(image.at(x, y)), static_cast<double>(room.range), &room.atlas[4 * texel]);
      }
  }
  room.lights = core::median_cut(level_image(128, 0.0, sun));
  return room;
}

packs::Scene golden_scene(GoldenSubject subject) {
  using packs::SurfaceKind;
  packs::Scene scene;
  scene.name = "golden";
  scene.environment = golden_environment();
  if (subject == GoldenSubject::sphere) {
    scene.parts = {moved_sphere(100.0f, sphere_centre_mm, SurfaceKind::paint)};
    return scene;
  }
  for (packs::MeshPart& part : packs::build_capsule(70.0f, 200.0f).parts) {
    if (part.kind != SurfaceKind::paint) continue;
    part.visibility.clear();
    part.irradiance.clear();
    // Laid down along x: it is built standing.
    for (glm::vec3& n : part.normals) n = {n.z, n.y, -n.x};
    float low = 1e6f, left = 1e6f, right = -1e6f;
    for (glm::vec3& p : part.positions_mm) {
      p = {p.z, p.y, -p.x};
      low = std::min(low, p.z);
      left = std::min(left, p.x);
      right = std::max(right, p.x);
    }
    for (glm::vec3& p : part.positions_mm) p -= glm::vec3(0.5f * (left + right), 0.0f, low);
    add_baked_light(part);
    scene.parts.push_back(std::move(part));
  }
  scene.parts.push_back(floor_square(900.0f));
  scene.parts.push_back(moved_sphere(40.0f, {-225.0f, -80.0f, 40.0f}, SurfaceKind::chrome));
  scene.parts.push_back(moved_sphere(40.0f, {235.0f, 20.0f, 40.0f}, SurfaceKind::rubber));
  scene.parts.push_back(moved_sphere(25.0f, {140.0f, -130.0f, 25.0f}, SurfaceKind::lamp_red));
  scene.parts.push_back(moved_sphere(30.0f, {-60.0f, -170.0f, 30.0f}, SurfaceKind::glass));
  return scene;
}

std::vector<GoldenShot> golden_shots() {
  std::vector<GoldenShot> shots;
  const auto add = [&](std::string name, GoldenSubject subject, const gles::View& view) -> GoldenShot& {
    shots.push_back({std::move(name), subject, view, room_lighting(), 1, 0.4});
    return shots.back();
  };
  add("sphere_moving", GoldenSubject::sphere, sphere_view);
  add("sphere_still", GoldenSubject::sphere, sphere_view).samples = 64;
  add("sphere_no_environment", GoldenSubject::sphere, sphere_view);
  shots.back().lighting.quality.path = gles::LightPath::none;
  shots.back().lighting.lights = {{glm::normalize(glm::vec3(-0.4f, -0.8f, 0.6f)), glm::vec3(0.9f)},
                                  {glm::normalize(glm::vec3(0.8f, -0.3f, 0.3f)), glm::vec3(0.1f, 0.2f, 0.4f)}};
  add("macro_moving", GoldenSubject::sphere, macro_view).lighting.quality.sparkle_lights = 4;
  add("macro_still", GoldenSubject::sphere, macro_view).samples = 64;
  for (const gles::Rung& rung : gles::quality_ladder())
    add("table_" + std::string(rung.name), GoldenSubject::table, table_view).lighting.quality = rung.quality;
  add("table_smoothed", GoldenSubject::table, table_view).samples = 16;
  add("table_still", GoldenSubject::table, table_view).samples = 64;
  add("table_sun", GoldenSubject::table, table_view);
  shots.back().lighting.lights = {{glm::normalize(glm::vec3(-0.45f, -0.55f, 0.90f)), {0.95f, 0.92f, 0.86f}}};
  shots.back().lighting.environment_gain = 0.25f;
  add("table_lights_16", GoldenSubject::table, table_view);
  shots.back().lighting.quality.path = gles::LightPath::lights;
  shots.back().lighting.quality.cut_lights = 16;
  add("table_stripes", GoldenSubject::table, table_view).lighting.stripes = true;
  add("table_blue", GoldenSubject::table, table_view).mix = 1.0;
  return shots;
}

GoldenShot golden_shot(const std::string& name) {
  const auto shots = golden_shots();
  const auto found =
      std::find_if(shots.begin(), shots.end(), [&](const GoldenShot& shot) { return shot.name == name; });
  check_equal(found != shots.end(), true, "a golden shot of this name");
  return *found;
}

}  // namespace lackwerk::test
