#include "packs/scene_pack.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>
#include <unordered_map>

#include "packs/paint_pack.hpp"
#include "packs/scene_pack_checks.hpp"
#include "packs/scene_pack_generated.h"

namespace lackwerk::packs {
namespace {

static_assert(sizeof(fb::Point) == sizeof(glm::vec3) &&
              std::alignment_of_v<fb::Point> == std::alignment_of_v<glm::vec3>);
static_assert(sizeof(fb::UnitVector) == 6);

static_assert(sizeof(fb::Light) == sizeof(core::EnvironmentLight));

constexpr flatbuffers::uoffset_t max_depth = 4, max_tables = max_scene_parts + max_scene_cameras + 2;
constexpr float snorm_scale = 32767.0f;

glm::vec3 point_of(const fb::Point& p) { return {p.x(), p.y(), p.z()}; }
fb::Point fb_point(const glm::vec3& p) { return {p.x, p.y, p.z}; }

fb::UnitVector quantise(const glm::vec3& normal) {
  // Normalised first: what a reader restores is then within half a step of the direction.
  const glm::vec3 n = glm::normalize(normal) * snorm_scale;
  const auto round = [](float v) { return static_cast<std::int16_t>(std::lround(std::clamp(v, -32767.0f, 32767.0f))); };
  return {round(n.x), round(n.y), round(n.z)};
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
    piece.detail = part.detail;
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
        if (!part.visibility.empty()) piece.visibility.push_back(part.visibility[vertex]);
        if (!part.irradiance.empty()) piece.irradiance.push_back(part.irradiance[vertex]);
      }
      piece.indices.push_back(found->second);
    }
  }
  finish();
}

template <class Group>
void copy_groups(const flatbuffers::Vector<typename Group::value_type>& flat, std::vector<Group>& out) {
  constexpr std::size_t size = std::tuple_size_v<Group>;
  out.resize(flat.size() / size);
  for (std::size_t k = 0; k < out.size() * size; ++k)
    out[k / size][k % size] = flat.Get(static_cast<flatbuffers::uoffset_t>(k));
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
    out.normals.push_back(std::abs(length - 1.0f) <= max_unit_error ? v / length : v);
  }
  out.indices.assign(part.indices()->begin(), part.indices()->end());
  if (part.visibility() != nullptr) copy_groups<Visibility>(*part.visibility(), out.visibility);
  if (part.irradiance() != nullptr) copy_groups<Irradiance>(*part.irradiance(), out.irradiance);
  out.detail = part.detail();
  return out;
}

/// Checked before: the atlas has its one size and there are environment_light_count lights.
core::Environment decode_environment(const fb::Environment& environment) {
  core::Environment out;
  out.name = environment.name()->str();
  out.centre_mm = point_of(*environment.centre());
  out.room_radius_mm = environment.room_radius();
  out.range = environment.range();
  const std::uint8_t* atlas = environment.atlas()->data();
  out.atlas.assign(atlas, atlas + environment.atlas()->size());
  for (const fb::Light* light : *environment.lights())
    out.lights.push_back({point_of(light->direction()), point_of(light->radiance())});
  return out;
}

flatbuffers::Offset<fb::Environment> encode_environment(flatbuffers::FlatBufferBuilder& out,
                                                        const core::Environment& environment) {
  const auto name = out.CreateString(environment.name);
  const auto atlas = out.CreateVector(environment.atlas);
  std::vector<fb::Light> lights;
  for (const core::EnvironmentLight& light : environment.lights)
    lights.emplace_back(fb_point(light.direction), fb_point(light.radiance));
  const auto light_vector = out.CreateVectorOfStructs(lights);
  const fb::Point centre = fb_point(environment.centre_mm);
  return fb::CreateEnvironment(out, name, &centre, environment.room_radius_mm, environment.range, atlas, light_vector);
}

/// Arrays of arrays are stored flat.
template <class T, class Group>
flatbuffers::Offset<flatbuffers::Vector<T>> encode_groups(flatbuffers::FlatBufferBuilder& out,
                                                          const std::vector<Group>& groups) {
  std::vector<T> flat;
  flat.reserve(groups.size() * std::tuple_size_v<Group>);
  for (const Group& group : groups) flat.insert(flat.end(), group.begin(), group.end());
  return out.CreateVector(flat);
}

template <class Group>
Result<void> check_groups(const flatbuffers::Vector<typename Group::value_type>* flat, std::size_t vertices,
                          const std::string& field, const std::string& file) {
  if (flat == nullptr || flat->size() == 0 || flat->size() == vertices * std::tuple_size_v<Group>) return {};
  return fail(file, field, "must be " + std::to_string(std::tuple_size_v<Group>) + " numbers per vertex or none",
              "build the scene again");
}

/// What decides how much memory is taken, before any is: a small file can name the same vector a thousand times.
Result<void> check_sizes(const fb::ScenePack& root, const std::string& file) {
  const char* remedy = "build the scene again";
  std::size_t vertices = 0, indices = 0;
  for (flatbuffers::uoffset_t k = 0; k < root.parts()->size(); ++k) {
    const fb::Part& part = *root.parts()->Get(k);
    const std::string field = item_name("parts", k);
    if (part.name()->size() > max_scene_name_bytes)
      return fail(file, "parts", "a name is longer than 200 bytes", remedy);
    const std::size_t own = part.positions()->size();
    if (auto ok = check_groups<Visibility>(part.visibility(), own, field + ".visibility", file); !ok) return ok;
    if (auto ok = check_groups<Irradiance>(part.irradiance(), own, field + ".irradiance", file); !ok) return ok;
    vertices += std::max(part.positions()->size(), part.normals()->size());
    indices += part.indices()->size();
  }
  for (const fb::View* view : *root.views())
    if (view->name()->size() > max_scene_name_bytes)
      return fail(file, "views", "a name is longer than 200 bytes", remedy);
  if (root.name()->size() > max_scene_name_bytes) return fail(file, "name", "must have at most 200 bytes", remedy);
  if (root.environment() == nullptr) return fail(file, "environment", "is missing", remedy);
  if (root.environment()->name()->size() > max_scene_name_bytes)
    return fail(file, "environment.name", "must have at most 200 bytes", remedy);
  if (auto ok =
          check_environment_counts(root.environment()->atlas()->size(), root.environment()->lights()->size(), file);
      !ok)
    return ok;
  return check_scene_counts(root.parts()->size(), root.views()->size(), vertices, indices, file);
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
    const auto indices = out.CreateVector(std::vector<std::uint16_t>(part.indices.begin(), part.indices.end()));
    const auto visibility = encode_groups<std::uint8_t>(out, part.visibility);
    const auto irradiance = encode_groups<std::uint16_t>(out, part.irradiance);
    parts.push_back(fb::CreatePart(out, name, static_cast<std::uint8_t>(part.kind), positions, normals, indices,
                                   visibility, irradiance, part.detail));
  }
  std::vector<flatbuffers::Offset<fb::View>> views;
  for (const Camera& camera : scene.cameras) {
    const fb::Point eye = fb_point(camera.eye_mm), target = fb_point(camera.target_mm);
    views.push_back(fb::CreateView(out, out.CreateString(camera.name), &eye, &target, camera.vertical_fov_deg));
  }
  const auto tool = out.CreateString(pack_tool_version.data(), pack_tool_version.size());
  const auto name = out.CreateString(scene.name);
  const auto part_vector = out.CreateVector(parts);
  const auto view_vector = out.CreateVector(views);
  const auto environment = encode_environment(out, scene.environment);
  fb::FinishScenePackBuffer(out, fb::CreateScenePack(out, scene_schema_version, scene_schema_version, tool, name,
                                                     part_vector, view_vector, environment, scene.irradiance_range));
  return {out.GetBufferPointer(), out.GetBufferPointer() + out.GetSize()};
}

Result<Scene> decode_scene_pack(std::span<const std::uint8_t> payload, const std::string& file) {
  flatbuffers::Verifier verifier(payload.data(), payload.size(), max_depth, max_tables);
  if (!fb::VerifyScenePackBuffer(verifier))
    return fail(file, "payload", "not a well-formed scene pack", "build the scene again");
  const fb::ScenePack& root = *fb::GetScenePack(payload.data());
  if (root.schema_version() < oldest_scene_schema_version)
    return fail(file, "schema_version", std::to_string(root.schema_version()) + " holds no light",
                "build the scene again");
  if (root.minimum_reader() > scene_schema_version || root.minimum_reader() < 1)
    return fail(file, "minimum_reader", "needs schema version " + std::to_string(root.minimum_reader()),
                "update this program");
  if (auto ok = check_sizes(root, file); !ok) return tl::unexpected(ok.error());
  // All in one: an environment of its own, which a Scene otherwise begins with, takes longer than the rest.
  Scene out{root.name()->str(), {}, {}, decode_environment(*root.environment()), root.irradiance_range()};
  for (const fb::Part* part : *root.parts()) {
    if (part->positions()->size() > max_part_vertices)
      return fail(file, item_name("parts", out.parts.size()), "has more than 65535 vertices", "build the scene again");
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
  Scene split{scene.name, {}, scene.cameras, scene.environment, scene.irradiance_range};
  for (const MeshPart& part : scene.parts) split_part(part, split.parts);
  // Splitting repeats vertices and makes parts: what would not be read back is not written.
  if (auto counted = check_counts_of(split, path.string()); !counted) return counted;
  return write_sealed_file(path, SealedKind::scene, encode_scene_pack(split));
}

}  // namespace lackwerk::packs
