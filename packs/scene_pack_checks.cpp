#include "packs/scene_pack_checks.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace lackwerk::packs {
namespace {

constexpr float max_coordinate_mm = 1e6f, max_light_unit_error = 1e-3f;

bool in_bounds(const glm::vec3& p) {
  return std::abs(p.x) <= max_coordinate_mm && std::abs(p.y) <= max_coordinate_mm &&
         std::abs(p.z) <= max_coordinate_mm;  // false for NaN
}

Result<void> check_camera(const Camera& camera, const std::string& name, const std::string& file) {
  const char* remedy = "build the scene again";
  if (camera.name.empty() || camera.name.size() > max_scene_name_bytes)
    return fail(file, name + ".name", "must have 1 to 200 bytes", remedy);
  if (!in_bounds(camera.eye_mm) || !in_bounds(camera.target_mm))
    return fail(file, name, "coordinates must be within 1e6 mm", remedy);
  if (glm::distance(camera.eye_mm, camera.target_mm) < 1e-3f)
    return fail(file, name, "looks at the point it stands on", remedy);
  if (!(camera.vertical_fov_deg > 0.0f && camera.vertical_fov_deg < 120.0f))
    return fail(file, name + ".vertical_fov_deg", "must be above 0 and below 120", remedy);
  return {};
}

Result<void> check_part(const MeshPart& part, const std::string& name, const std::string& file) {
  const char* remedy = "build the scene again";
  const std::size_t vertices = part.positions_mm.size();
  if (part.name.size() > max_scene_name_bytes) return fail(file, name + ".name", "must have at most 200 bytes", remedy);
  if (static_cast<std::uint8_t>(part.kind) >= surface_kind_count)
    return fail(file, name + ".kind", "is not known", remedy);
  if (vertices == 0 || part.indices.empty()) return fail(file, name, "has no triangles", remedy);
  if (part.normals.size() != vertices) return fail(file, name + ".normals", "must be one per vertex", remedy);
  if (!part.visibility.empty() && part.visibility.size() != vertices)
    return fail(file, name + ".visibility", "must be one per vertex or none", remedy);
  if (!part.irradiance.empty() && part.irradiance.size() != vertices)
    return fail(file, name + ".irradiance", "must be one per vertex or none", remedy);
  if (part.detail < detail_full || part.detail > (detail_full | detail_coarse))
    return fail(file, name + ".detail", "must be 1, 2 or 3", remedy);
  if (part.indices.size() % 3 != 0) return fail(file, name + ".indices", "must come in threes", remedy);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!in_bounds(part.positions_mm[v]))
      return fail(file, name + "." + item_name("positions", v), "must be within 1e6 mm", remedy);
    if (!(std::abs(glm::length(part.normals[v]) - 1.0f) <= max_unit_error))
      return fail(file, name + "." + item_name("normals", v), "must have unit length", remedy);
  }
  for (std::size_t k = 0; k < part.indices.size(); ++k)
    if (part.indices[k] >= vertices)
      return fail(file, name + "." + item_name("indices", k),
                  std::to_string(part.indices[k]) + " of " + std::to_string(vertices) + " vertices", remedy);
  return {};
}

bool is_radiance(const glm::vec3& c) {
  return c.x >= 0.0f && c.x <= max_radiance && c.y >= 0.0f && c.y <= max_radiance && c.z >= 0.0f && c.z <= max_radiance;
}

Result<void> check_range(float range, const std::string& field, const std::string& file) {
  if (range > 0.0f && range <= max_radiance) return {};  // false for NaN
  return fail(file, field, "must be above 0 and at most 1e6", "build the scene again");
}

Result<void> check_environment(const core::Environment& environment, const std::string& file) {
  const char* remedy = "build the scene again";
  if (environment.name.size() > max_scene_name_bytes)
    return fail(file, "environment.name", "must have at most 200 bytes", remedy);
  if (auto ok = check_environment_counts(environment.atlas.size(), environment.lights.size(), file); !ok) return ok;
  if (!in_bounds(environment.centre_mm)) return fail(file, "environment.centre", "must be within 1e6 mm", remedy);
  const float radius = environment.room_radius_mm;
  if (radius != 0.0f && !(radius >= min_room_radius_mm && radius <= max_room_radius_mm))
    return fail(file, "environment.room_radius", "must be 0 or 100 to 1e6 mm", remedy);
  if (auto ok = check_range(environment.range, "environment.range", file); !ok) return ok;
  for (std::size_t k = 0; k < environment.lights.size(); ++k) {
    const std::string field = "environment." + item_name("lights", k);
    if (!(std::abs(glm::length(environment.lights[k].direction) - 1.0f) <= max_light_unit_error))
      return fail(file, field + ".direction", "must have unit length", remedy);
    if (!is_radiance(environment.lights[k].radiance))
      return fail(file, field + ".radiance", "must be 0 to 1e6", remedy);
  }
  return {};
}

}  // namespace

std::string item_name(const char* name, std::size_t index) {
  return std::string(name) + "[" + std::to_string(index) + "]";
}

Result<void> check_scene_counts(std::size_t parts, std::size_t cameras, std::size_t vertices, std::size_t indices,
                                const std::string& file) {
  const auto limit = [&](const char* field, std::size_t count, std::size_t most) -> Result<void> {
    if (count <= most) return {};
    return fail(file, field, std::to_string(count) + " of at most " + std::to_string(most), "build a smaller scene");
  };
  if (parts == 0) return fail(file, "parts", "a scene needs at least one", "build the scene again");
  if (auto ok = limit("parts", parts, max_scene_parts); !ok) return ok;
  if (auto ok = limit("views", cameras, max_scene_cameras); !ok) return ok;
  if (auto ok = limit("positions", vertices, max_scene_vertices); !ok) return ok;
  return limit("indices", indices, max_scene_indices);
}

Result<void> check_environment_counts(std::size_t atlas_bytes, std::size_t lights, const std::string& file) {
  constexpr std::size_t bytes = std::size_t{core::environment_width} * core::environment_height * 4;
  if (atlas_bytes != bytes)
    return fail(file, "environment.atlas", std::to_string(atlas_bytes) + " bytes instead of " + std::to_string(bytes),
                "build the scene again");
  if (lights != core::environment_light_count)
    return fail(file, "environment.lights",
                std::to_string(lights) + " instead of " + std::to_string(core::environment_light_count),
                "build the scene again");
  return {};
}

Result<void> check_counts_of(const Scene& scene, const std::string& file) {
  std::size_t vertices = 0, indices = 0;
  for (const MeshPart& part : scene.parts) {
    vertices += part.positions_mm.size();
    indices += part.indices.size();
  }
  return check_scene_counts(scene.parts.size(), scene.cameras.size(), vertices, indices, file);
}

Result<void> check_scene(const Scene& scene, const std::string& file) {
  if (auto ok = check_counts_of(scene, file); !ok) return ok;
  if (scene.name.size() > max_scene_name_bytes) return fail(file, "name", "must have at most 200 bytes", "shorten it");
  for (std::size_t k = 0; k < scene.parts.size(); ++k)
    if (auto ok = check_part(scene.parts[k], item_name("parts", k), file); !ok) return ok;
  for (std::size_t k = 0; k < scene.cameras.size(); ++k)
    if (auto ok = check_camera(scene.cameras[k], item_name("views", k), file); !ok) return ok;
  if (auto ok = check_range(scene.irradiance_range, "irradiance_range", file); !ok) return ok;
  return check_environment(scene.environment, file);
}

}  // namespace lackwerk::packs
