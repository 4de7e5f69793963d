#include "packs/tools/model_reader.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <map>

namespace lackwerk::packs {
namespace {

constexpr unsigned max_materials = 2000;
constexpr const char* simplify_remedy = "simplify the model in its editor before exporting it";

bool is_finite(const aiVector3D& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Result<void> check_file(const std::filesystem::path& path, const ModelLimits& limits) {
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (problem || !std::filesystem::exists(status))
    return fail(path.string(), "", "no such file", "give a model file: .gltf, .glb, .obj, ...");
  if (!std::filesystem::is_regular_file(status))
    return fail(path.string(), "", "not a regular file", "give a model file: .gltf, .glb, .obj, ...");
  const auto bytes = std::filesystem::file_size(path, problem);
  if (!problem && bytes > limits.bytes)
    return fail(path.string(), "size", std::to_string(bytes) + " bytes of at most " + std::to_string(limits.bytes),
                simplify_remedy);
  return {};
}

struct Counts {
  std::size_t triangles = 0, vertices = 0;
};

Counts counts_of(const aiMesh& mesh) {
  Counts out{0, mesh.mNumVertices};
  for (unsigned f = 0; f < mesh.mNumFaces; ++f)
    out.triangles += mesh.mFaces[f].mNumIndices >= 3 ? mesh.mFaces[f].mNumIndices - 2 : 0;
  return out;
}

/// With every node's copy: a small file can show one large mesh a thousand times. Ends early beyond the limits.
Counts shown_counts(const aiScene& scene, const ModelLimits& limits) {
  std::vector<Counts> of_mesh;
  of_mesh.reserve(scene.mNumMeshes);
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) of_mesh.push_back(counts_of(*scene.mMeshes[m]));
  Counts sum;
  std::vector<const aiNode*> nodes{scene.mRootNode};
  while (!nodes.empty() && sum.triangles <= limits.triangles && sum.vertices <= 3 * limits.triangles) {
    const aiNode* node = nodes.back();
    nodes.pop_back();
    if (node == nullptr) continue;
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      if (node->mMeshes[k] >= scene.mNumMeshes) continue;
      sum.triangles += of_mesh[node->mMeshes[k]].triangles;
      sum.vertices += of_mesh[node->mMeshes[k]].vertices;
    }
    nodes.insert(nodes.end(), node->mChildren, node->mChildren + node->mNumChildren);
  }
  return sum;
}

/// What the file itself says, before anything multiplies it.
Result<void> check_counts(const aiScene& scene, const ModelLimits& limits, const std::string& file) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      if (!is_finite(mesh.mVertices[v]))
        return fail(file, "mesh '" + std::string(mesh.mName.C_Str()) + "': vertex " + std::to_string(v),
                    "is not finite", "repair the model in its editor");
  }
  const Counts shown = shown_counts(scene, limits);
  if (shown.triangles == 0) return fail(file, "faces", "the model has none", "export it with its meshes");
  if (shown.triangles > limits.triangles)
    return fail(file, "faces",
                std::to_string(shown.triangles) + " triangles or more, of at most " + std::to_string(limits.triangles),
                simplify_remedy);
  if (shown.vertices > 3 * limits.triangles)  // more than so many triangles can use
    return fail(file, "vertices",
                std::to_string(shown.vertices) + " or more, of at most " + std::to_string(3 * limits.triangles),
                simplify_remedy);
  if (scene.mNumMaterials > max_materials)
    return fail(file, "materials", std::to_string(scene.mNumMaterials) + " of at most " + std::to_string(max_materials),
                "merge materials in the model's editor");
  return {};
}

std::string material_name(const aiScene& scene, unsigned index) {
  if (index >= scene.mNumMaterials) return "unnamed";
  aiString name;
  if (scene.mMaterials[index]->Get(AI_MATKEY_NAME, name) != AI_SUCCESS || name.length == 0) return "unnamed";
  std::string out(name.C_Str());
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  constexpr std::size_t longest = 200;  // what a pack takes as a part's name
  if (out.size() > longest) out.resize(longest);
  return out;
}

Result<ModelMesh> take(const aiMesh& mesh, const std::string& file) {
  ModelMesh out;
  out.positions.reserve(mesh.mNumVertices);
  if (mesh.HasNormals()) out.normals.reserve(mesh.mNumVertices);
  out.indices.reserve(std::size_t{3} * mesh.mNumFaces);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    if (!is_finite(p))  // a node's matrix can do that
      return fail(file, "mesh '" + std::string(mesh.mName.C_Str()) + "'", "its node moves it out of all bounds",
                  "repair the model in its editor");
    out.positions.emplace_back(p.x, p.y, p.z);
    if (!mesh.HasNormals()) continue;
    const aiVector3D& n = mesh.mNormals[v];
    out.normals.emplace_back(n.x, n.y, n.z);
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        return fail(file, "mesh '" + std::string(mesh.mName.C_Str()) + "'", "a face names a vertex that is not there",
                    "export the model again");
      out.indices.push_back(face.mIndices[k]);
    }
  }
  return out;
}

}  // namespace

Result<Model> read_model(const std::filesystem::path& path, const ModelLimits& limits) {
  if (auto ok = check_file(path, limits); !ok) return tl::unexpected(ok.error());
  const std::string file = path.string();
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                                          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS |
                                                          aiComponent_ANIMATIONS | aiComponent_TEXTURES |
                                                          aiComponent_LIGHTS | aiComponent_CAMERAS);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const auto reason = [&importer] {
    const std::string text = importer.GetErrorString();
    return "cannot be read as a model" + (text.empty() ? "" : ": " + text);
  };
  const char* remedy = "export it again, as .glb or .obj";
  const aiScene* scene = importer.ReadFile(file, 0);  // as it is: counted before anything is derived from it
  if (scene == nullptr) return fail(file, "", reason(), remedy);
  if (auto ok = check_counts(*scene, limits, file); !ok) return tl::unexpected(ok.error());
  scene = importer.ApplyPostProcessing(aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType |
                                       aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
  if (scene == nullptr || scene->mNumMeshes == 0) return fail(file, "", reason(), remedy);
  Model model;
  const std::string extension = path.extension().string();
  model.is_gltf = extension == ".gltf" || extension == ".glb" || extension == ".GLTF" || extension == ".GLB";
  std::map<std::string, std::size_t> known;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    auto mesh = take(*scene->mMeshes[m], file);
    if (!mesh) return tl::unexpected(mesh.error());
    if (mesh->indices.empty()) continue;
    const std::string name = material_name(*scene, scene->mMeshes[m]->mMaterialIndex);
    const auto [at, is_new] = known.try_emplace(name, model.materials.size());
    if (is_new) model.materials.push_back(name);
    mesh->material = at->second;
    model.meshes.push_back(std::move(*mesh));
  }
  if (model.meshes.empty()) return fail(file, "faces", "the model has none", "export it with its meshes");
  return model;
}

}  // namespace lackwerk::packs
