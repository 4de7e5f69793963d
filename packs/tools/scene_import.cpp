#include "packs/tools/scene_import.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <sstream>

#include "packs/scene_pack.hpp"
#include "packs/tools/car/floor.hpp"
#include "packs/tools/car/patch.hpp"
#include "packs/tools/import_materials.hpp"
#include "packs/tools/model_reader.hpp"
#include "packs/tools/model_reduce.hpp"
#include "packs/tools/scene_detail.hpp"

namespace lackwerk::packs {
namespace {

using car::Patch;
using car::Triangle;
using car::Vec3;

// Above this a weak machine gets a coarser twin; below, one mesh serves both levels.
constexpr std::size_t twin_above_triangles = 80'000, twin_triangles = 60'000;
constexpr float twin_error_mm = 4.0f;
// Room in the pack for twins and floor.
constexpr std::size_t budget_vertices = max_scene_vertices * 4 / 5, budget_triangles = max_scene_indices / 3 * 4 / 5;
constexpr double least_area_mm2 = 1e-5;

/// What was mended, over all meshes.
struct Mended {
  std::size_t empty_faces = 0, turned_faces = 0, meshes_without_normals = 0;
};

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

bool has_usable_normals(const ModelMesh& mesh) {
  return mesh.normals.size() == mesh.positions.size() &&
         std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const glm::vec3& n) {
           const float length = glm::length(n);
           return length > 0.1f && length < 10.0f;  // false for NaN
         });
}

/// In our axes, without faces that have no area; winding and normals agree.
Patch placed(const ModelMesh& mesh, const Placement& placement, double crease_deg, Mended& mended) {
  Patch patch;
  const glm::dmat3 for_normals = glm::transpose(glm::inverse(placement.turn));
  const bool has_normals = has_usable_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    patch.positions.push_back(placement.turn * Vec3(mesh.positions[v]) + placement.shift_mm);
    if (has_normals) patch.normals.push_back(glm::normalize(for_normals * Vec3(mesh.normals[v])));
  }
  for (std::size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
    Triangle t{mesh.indices[k], mesh.indices[k + 1], mesh.indices[k + 2]};
    const Vec3 doubled_area =
        glm::cross(patch.positions[t[1]] - patch.positions[t[0]], patch.positions[t[2]] - patch.positions[t[0]]);
    if (!(glm::length(doubled_area) >= least_area_mm2)) {
      ++mended.empty_faces;
      continue;
    }
    if (has_normals && glm::dot(doubled_area, patch.normals[t[0]] + patch.normals[t[1]] + patch.normals[t[2]]) < 0.0) {
      std::swap(t[1], t[2]);
      ++mended.turned_faces;
    }
    patch.triangles.push_back(t);
  }
  if (patch.triangles.empty()) return {};
  if (has_normals) return patch;
  ++mended.meshes_without_normals;
  return car::with_normals(patch, crease_deg);
}

/// Triangles that share vertices follow each other: a GPU shades fewer vertices, and the writer, which splits parts
/// for 16-bit indices in the order of their triangles, has fewer to repeat.
MeshPart with_near_order(MeshPart part) {
  const std::vector<std::uint32_t> before = part.indices;
  meshopt_optimizeVertexCache(part.indices.data(), before.data(), before.size(), part.positions_mm.size());
  return part;
}

/// One part, however large: splitting for 16-bit indices is the pack writer's work.
MeshPart part_of(const Patch& patch, const std::string& name, SurfaceKind kind) {
  MeshPart part;
  part.name = name;
  part.kind = kind;
  std::vector<std::uint32_t> place(patch.positions.size(), car::no_vertex);
  for (const Triangle& t : patch.triangles) {
    for (const std::uint32_t v : t) {
      if (place[v] == car::no_vertex) {
        place[v] = static_cast<std::uint32_t>(part.positions_mm.size());
        part.positions_mm.emplace_back(patch.positions[v]);
        part.normals.emplace_back(patch.normals[v]);
      }
      part.indices.push_back(place[v]);
    }
  }
  return part;
}

std::size_t triangles_of(const MeshPart& part) { return part.indices.size() / 3; }

std::size_t count_triangles(const std::vector<MeshPart>& parts) {
  std::size_t count = 0;
  for (const MeshPart& part : parts) count += triangles_of(part);
  return count;
}
std::size_t count_vertices(const std::vector<MeshPart>& parts) {
  std::size_t count = 0;
  for (const MeshPart& part : parts) count += part.positions_mm.size();
  return count;
}

/// A floor with cells fine enough for the model's shadow, at both levels.
void add_floor(std::vector<MeshPart>& parts) {
  glm::vec3 reach(0.0f);
  for (const MeshPart& part : parts)
    for (const glm::vec3& p : part.positions_mm) reach = glm::max(reach, glm::abs(p));
  constexpr double margin = 1.08, floor_radius = 3.0, cells_along = 80.0, finest_mm = 60.0;
  constexpr double most_triangles = 12'000.0;
  car::FloorShape shape;
  const double half = static_cast<double>(std::max(reach.x, reach.y));
  shape.half_length_mm = std::max(static_cast<double>(reach.x), 0.1 * half) * margin;
  shape.half_width_mm = std::max(static_cast<double>(reach.y), 0.1 * half) * margin;
  shape.radius_mm = half * floor_radius;
  shape.cell_mm = std::min(finest_mm, 2.0 * half / cells_along);
  const auto triangles = [&shape] {
    const double along = std::ceil(2.0 * shape.half_length_mm / shape.cell_mm);
    const double across = std::ceil(2.0 * shape.half_width_mm / shape.cell_mm);
    return 2.0 * along * across + 4.0 * (along + across) * shape.rings;
  };
  while (triangles() > most_triangles) shape.cell_mm *= 1.05;
  const auto add = [&](std::uint8_t detail) {
    parts.push_back(part_of(car::build_floor(shape), "floor", SurfaceKind::floor));
    parts.back().detail = detail;
  };
  add(detail_full);
  shape.cell_mm *= 2.0;
  shape.rings = shape.rings * 3 / 4;
  add(detail_coarse);
}

void say_what_was_left_out(const ModelReduction& reduction, std::vector<std::string>& repairs) {
  if (reduction.after == reduction.before) return;
  std::ostringstream text;
  text.precision(2);
  text << "simplified from " << reduction.before << " to " << reduction.after << " triangles, at most about "
       << reduction.error_mm << " mm off";
  repairs.push_back(text.str());
}

void say_what_was_mended(const Mended& mended, std::vector<std::string>& repairs) {
  if (mended.empty_faces > 0)
    repairs.push_back(counted(mended.empty_faces, "face", "faces") + " without area left out");
  if (mended.turned_faces > 0)
    repairs.push_back(counted(mended.turned_faces, "face", "faces") + " turned to where the normals point");
  if (mended.meshes_without_normals > 0)
    repairs.push_back("normals made for " + counted(mended.meshes_without_normals, "mesh", "meshes"));
}

}  // namespace

Result<ImportedScene> import_scene(const std::filesystem::path& path, const ImportSettings& settings,
                                   const ImportProgress& progress) {
  const std::string file = path.string();
  const auto tell = [&progress](double done, const std::string& what) {
    if (progress) progress(done, what);
  };
  tell(0.0, "reading the model");
  const auto model = read_model(path, settings.limits);
  if (!model) return tl::unexpected(model.error());
  const auto kinds = assign_kinds(model->materials, settings.paint, settings.kinds, file);
  if (!kinds) return tl::unexpected(kinds.error());
  std::vector<glm::vec3> everything;
  for (const ModelMesh& mesh : model->meshes)
    everything.insert(everything.end(), mesh.positions.begin(), mesh.positions.end());
  PlacementWish wish = settings.placement;
  wish.in_metres = wish.up_is_y = model->is_gltf;
  const auto placement = place_model(everything, wish, file);
  if (!placement) return tl::unexpected(placement.error());
  ImportedScene out;
  out.placement = placement->note;
  Mended mended;
  std::vector<Patch> by_material(model->materials.size());
  for (std::size_t k = 0; k < model->meshes.size(); ++k) {
    tell(0.4 + 0.3 * static_cast<double>(k) / static_cast<double>(model->meshes.size()), "normals");
    const ModelMesh& mesh = model->meshes[k];
    car::append(by_material[mesh.material], placed(mesh, *placement, settings.crease_deg, mended));
  }
  std::vector<MeshPart> parts;
  for (std::size_t k = 0; k < by_material.size(); ++k) {
    out.materials.push_back({model->materials[k], (*kinds)[k]});
    if (!by_material[k].triangles.empty()) parts.push_back(part_of(by_material[k], model->materials[k], (*kinds)[k]));
  }
  say_what_was_mended(mended, out.repairs);
  if (parts.empty()) return fail(file, "faces", "none has any area", "export the model again");
  tell(0.7, "simplifying");
  say_what_was_left_out(reduce_parts(parts, settings.kept_triangles, settings.crease_deg), out.repairs);
  for (MeshPart& part : parts) part = with_near_order(std::move(part));
  const std::size_t vertices = count_vertices(parts), kept = count_triangles(parts);
  if (vertices > budget_vertices || kept > budget_triangles)
    return fail(file, "faces",
                std::to_string(kept) + " triangles with " + std::to_string(vertices) +
                    " vertices are left after simplifying, of at most " + std::to_string(budget_triangles) + " and " +
                    std::to_string(budget_vertices),
                "simplify the model in its editor, with vertices merged");
  tell(0.9, "coarse twins");
  out.scene.name = path.stem().string().substr(0, 200);
  out.scene.cameras = framed_cameras(parts);
  for (MeshPart& part : parts) {
    if (kept <= twin_above_triangles) {
      out.scene.parts.push_back(std::move(part));
      continue;
    }
    const double share = static_cast<double>(twin_triangles) / static_cast<double>(kept);
    const auto target = static_cast<std::size_t>(share * static_cast<double>(triangles_of(part)));
    add_with_twin(out.scene.parts, std::move(part), {target, twin_error_mm});
  }
  if (settings.floor) add_floor(out.scene.parts);
  tell(1.0, "imported");
  return out;
}

}  // namespace lackwerk::packs
