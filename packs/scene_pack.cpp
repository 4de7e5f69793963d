#include "packs/scene_pack.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>
#include <unordered_map>

#include "packs/paint_pack.hpp"
#include "packs/scene_pack_generated.h"

namespace lackwerk::packs {
namespace {

static_assert(sizeof(fb::Point) == sizeof(glm::vec3) &&
              std::alignment_of_v<fb::Point> == std::alignment_of_v<glm::vec3>);
static_assert(sizeof(fb::UnitVector) == 6);

constexpr flatbuffers::uoffset_t max_depth = 4, max_tables = max_scene_parts + max_scene_cameras + 1;
constexpr float max_coordinate_mm = 1e6f, max_normal_error = 1e-2f;
constexpr float snorm_scale = 32767.0f;

std::string at(const char* name, std::size_t index) { return std::string(name) + "[" + std::to_string(index) + "]"; }

bool in_bounds(const glm::vec3& p) {
  return std::abs(p.x) <= max_coordinate_mm && std::abs(p.y) <= max_coordinate_mm &&
         std::abs(p.z) <= max_coordinate_mm;  // false for NaN
}

glm::vec3 point_of(const fb::Point& p) { return {p.x(), p.y(), p.z()}; }

fb::UnitVector quantise(const glm::vec3& normal) {
  // Normalised first: what a reader restores is then within half a step of the direction.
  const glm::vec3 n = glm::normalize(normal) * snorm_scale;
  const auto round = [](float v) { return static_cast<std::int16_t>(std::lround(std::clamp(v, -32767.0f, 32767.0f))); };
  return {round(n.x), round(n.y), round(n.z)};
}

Result<void> check_camera(const Camera& camera, const std::string& name, const std::string& file) {
  const char* remedy = "build the scene again";
  if (camera.name.empty() || camera.name.size() > 200)
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
  if (part.name.size() > 200) return fail(file, name + ".name", "must have at most 200 bytes", remedy);
  if (static_cast<std::uint8_t>(part.kind) >= surface_kind_count)
    return fail(file, name + ".kind", "is not known", remedy);
  if (vertices == 0 || part.indices.empty()) return fail(file, name, "has no triangles", remedy);
  if (part.normals.size() != vertices) return fail(file, name + ".normals", "must be one per vertex", remedy);
  if (!part.ambient_occlusion.empty() && part.ambient_occlusion.size() != vertices)
    return fail(file, name + ".ambient_occlusion", "must be one per vertex or none", remedy);
  if (part.indices.size() % 3 != 0) return fail(file, name + ".indices", "must come in threes", remedy);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!in_bounds(part.positions_mm[v]))
      return fail(file, name + "." + at("positions", v), "must be within 1e6 mm", remedy);
    if (!(std::abs(glm::length(part.normals[v]) - 1.0f) <= max_normal_error))
      return fail(file, name + "." + at("normals", v), "must have unit length", remedy);
  }
  for (std::size_t k = 0; k < part.indices.size(); ++k)
    if (part.indices[k] >= vertices)
      return fail(file, name + "." + at("indices", k),
                  std::to_string(part.indices[k]) + " of " + std::to_string(vertices) + " vertices", remedy);
  return {};
}

Result<void> check_totals(std::size_t parts, std::size_t cameras, std::size_t vertices, std::size_t indices,
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

Result<void> check_scene(const Scene& scene, const std::string& file) {
  std::size_t vertices = 0, indices = 0;
  for (const MeshPart& part : scene.parts) {
    vertices += part.positions_mm.size();
    indices += part.indices.size();
  }
  if (auto ok = check_totals(scene.parts.size(), scene.cameras.size(), vertices, indices, file); !ok) return ok;
  if (scene.name.size() > 200) return fail(file, "name", "must have at most 200 bytes", "shorten it");
  for (std::size_t k = 0; k < scene.parts.size(); ++k)
    if (auto ok = check_part(scene.parts[k], at("parts", k), file); !ok) return ok;
  for (std::size_t k = 0; k < scene.cameras.size(); ++k)
    if (auto ok = check_camera(scene.cameras[k], at("views", k), file); !ok) return ok;
  return {};
}

/// Appends `part` in pieces of at most max_part_vertices, triangles in their order.
void split_part(const MeshPart& part, std::vector<MeshPart>& out) {
  if (part.positions_mm.size() <= max_part_vertices) {
    out.push_back(part);
    return;
  }
  MeshPart piece;
  std::unordered_map<std::uint32_t, std::uint32_t> local;  // vertex of `part` -> vertex of `piece`
  const auto finish = [&] {
    piece.name = part.name;
    piece.kind = part.kind;
    out.push_back(std::move(piece));
    piece = {};
    local.clear();
  };
  for (std::size_t k = 0; k < part.indices.size(); k += 3) {
    if (piece.positions_mm.size() + 3 > max_part_vertices) finish();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = part.indices[k + corner];
      const auto [found, is_new] = local.try_emplace(vertex, static_cast<std::uint32_t>(piece.positions_mm.size()));
      if (is_new) {
        piece.positions_mm.push_back(part.positions_mm[vertex]);
        piece.normals.push_back(part.normals[vertex]);
        if (!part.ambient_occlusion.empty()) piece.ambient_occlusion.push_back(part.ambient_occlusion[vertex]);
      }
      piece.indices.push_back(found->second);
    }
  }
  finish();
}

MeshPart decode_part(const fb::Part& part) {
  MeshPart out;
  out.name = part.name()->str();
  out.kind = static_cast<SurfaceKind>(part.kind());
  out.positions_mm.reserve(part.positions()->size());
  for (const fb::Point* p : *part.positions()) out.positions_mm.push_back(point_of(*p));
  out.normals.reserve(part.normals()->size());
  for (const fb::UnitVector* n : *part.normals()) {
    const glm::vec3 v = glm::vec3(n->x(), n->y(), n->z()) / snorm_scale;
    // Restored to unit length only where it nearly has it: check_part must still see what is wrong.
    const float length = glm::length(v);
    out.normals.push_back(std::abs(length - 1.0f) <= max_normal_error ? v / length : v);
  }
  out.ambient_occlusion.assign(part.ambient_occlusion()->begin(), part.ambient_occlusion()->end());
  out.indices.assign(part.indices()->begin(), part.indices()->end());
  return out;
}

}  // namespace

std::vector<std::uint8_t> encode_scene_pack(const Scene& scene) {
  flatbuffers::FlatBufferBuilder out(1 << 20);
  std::vector<flatbuffers::Offset<fb::Part>> parts;
  for (const MeshPart& part : scene.parts) {
    const auto name = out.CreateString(part.name);
    const auto positions = out.CreateVectorOfStructs(reinterpret_cast<const fb::Point*>(part.positions_mm.data()),
                                                     part.positions_mm.size());
    std::vector<fb::UnitVector> unit;
    unit.reserve(part.normals.size());
    for (const glm::vec3& normal : part.normals) unit.push_back(quantise(normal));
    const auto normals = out.CreateVectorOfStructs(unit);
    const auto occlusion = out.CreateVector(part.ambient_occlusion);
    const auto indices = out.CreateVector(std::vector<std::uint16_t>(part.indices.begin(), part.indices.end()));
    parts.push_back(
        fb::CreatePart(out, name, static_cast<std::uint8_t>(part.kind), positions, normals, occlusion, indices));
  }
  std::vector<flatbuffers::Offset<fb::View>> views;
  for (const Camera& camera : scene.cameras) {
    const fb::Point eye(camera.eye_mm.x, camera.eye_mm.y, camera.eye_mm.z);
    const fb::Point target(camera.target_mm.x, camera.target_mm.y, camera.target_mm.z);
    views.push_back(fb::CreateView(out, out.CreateString(camera.name), &eye, &target, camera.vertical_fov_deg));
  }
  const auto tool = out.CreateString(pack_tool_version.data(), pack_tool_version.size());
  const auto name = out.CreateString(scene.name);
  const auto part_vector = out.CreateVector(parts);
  const auto view_vector = out.CreateVector(views);
  fb::FinishScenePackBuffer(
      out, fb::CreateScenePack(out, scene_schema_version, scene_schema_version, tool, name, part_vector, view_vector));
  return {out.GetBufferPointer(), out.GetBufferPointer() + out.GetSize()};
}

Result<Scene> decode_scene_pack(std::span<const std::uint8_t> payload, const std::string& file) {
  flatbuffers::Verifier verifier(payload.data(), payload.size(), max_depth, max_tables);
  if (!fb::VerifyScenePackBuffer(verifier))
    return fail(file, "payload", "not a well-formed scene pack", "build the scene again");
  const fb::ScenePack& root = *fb::GetScenePack(payload.data());
  if (root.minimum_reader() < 1 || root.minimum_reader() > scene_schema_version)
    return fail(file, "minimum_reader", "needs schema version " + std::to_string(root.minimum_reader()),
                "update this program");
  // Counted before anything is copied: a small file can name the same vector a thousand times.
  std::size_t vertices = 0, indices = 0;
  for (const fb::Part* part : *root.parts()) {
    if (part->name()->size() > 200) return fail(file, "parts", "a name is longer than 200 bytes", "build it again");
    vertices += std::max({part->positions()->size(), part->normals()->size(), part->ambient_occlusion()->size()});
    indices += part->indices()->size();
  }
  for (const fb::View* view : *root.views())
    if (view->name()->size() > 200) return fail(file, "views", "a name is longer than 200 bytes", "build it again");
  if (root.name()->size() > 200) return fail(file, "name", "must have at most 200 bytes", "build it again");
  if (auto ok = check_totals(root.parts()->size(), root.views()->size(), vertices, indices, file); !ok)
    return tl::unexpected(ok.error());
  Scene out;
  out.name = root.name()->str();
  for (const fb::Part* part : *root.parts()) {
    if (part->positions()->size() > max_part_vertices)
      return fail(file, at("parts", out.parts.size()), "has more than 65535 vertices", "build the scene again");
    out.parts.push_back(decode_part(*part));
  }
  for (const fb::View* view : *root.views())
    out.cameras.push_back(
        {view->name()->str(), point_of(*view->eye()), point_of(*view->target()), view->vertical_fov_deg()});
  if (auto ok = check_scene(out, file); !ok) return tl::unexpected(ok.error());
  return out;
}

Result<Scene> read_scene_pack(const std::filesystem::path& path, Backing backing) {
  const auto file = SealedFile::open(path, SealedKind::scene, backing);
  if (!file) return tl::unexpected(file.error());
  return decode_scene_pack(file->payload(), path.string());
}

Result<void> write_scene_pack(const std::filesystem::path& path, const Scene& scene) {
  if (auto checked = check_scene(scene, path.string()); !checked) return checked;
  Scene split{scene.name, {}, scene.cameras};
  for (const MeshPart& part : scene.parts) split_part(part, split.parts);
  if (split.parts.size() > max_scene_parts)
    return fail(path.string(), "parts", "too many after splitting", "build a smaller scene");
  return write_sealed_file(path, SealedKind::scene, encode_scene_pack(split));
}

}  // namespace lackwerk::packs
