// A model file as lists of triangles by material.
//
// Why it exists: the one place that knows Assimp. What comes out is finite and has its indices in range; it may still
// lack normals and have faces without area. Free function; one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

struct ModelMesh {
  std::size_t material = 0;                   ///< index into Model::materials
  std::vector<glm::vec3> positions, normals;  ///< in the file's axes and unit; normals: one per position or none
  std::vector<std::uint32_t> indices;         ///< three a triangle
};
struct Model {
  std::vector<std::string> materials;  ///< those that triangles use
  std::vector<ModelMesh> meshes;
  bool is_gltf = false;  ///< metres, y up
};

/// What is read at all. Reading takes up to 100 bytes of memory a triangle before it can be counted, and up to 300
/// where it is few enough to go on.
struct ModelLimits {
  std::uintmax_t bytes = std::uintmax_t{1} << 30;  ///< of the file, without others that it names
  std::size_t triangles = 10'000'000;              ///< with every node's copy
};

/// Nodes are applied, polygons triangulated, equal vertices joined; points, lines, textures and everything else that is
/// no surface is left out.
[[nodiscard]] Result<Model> read_model(const std::filesystem::path& path, const ModelLimits& limits = {});

}  // namespace lackwerk::packs
