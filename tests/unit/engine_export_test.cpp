// Captures as engine materials: energy, colours and flakes of the fit, and the glTF files read back byte by byte.
#include "packs/tools/engine_export.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "core/analysis/reference_numbers.hpp"
#include "core/analysis/reference_sampling.hpp"
#include "core/colour.hpp"
#include "packs/tools/capture_brdf.hpp"
#include "packs/tools/engine_fit.hpp"
#include "packs/tools/image_compare.hpp"
#include "packs/tools/model_reader.hpp"
#include "packs/tools/picture_file.hpp"
#include "packs/tools/recipe.hpp"
#include "packs/tools/virtual_goniometer.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using glm::dvec3;
using nlohmann::json;
using testing::read_bytes;
using testing::TemporaryFolder;

Capture captured(const std::string& recipe, std::uint32_t edge = 96) {
  const auto read = read_recipe(std::filesystem::path(LACKWERK_SOURCE_DIR) / "packs/recipes" / (recipe + ".toml"));
  GoniometerSettings settings;
  settings.edge_texels = edge;
  return *measure(*read, settings);
}

Capture plain(const core::AnalyticPaint& paint) {
  Capture capture;
  capture.identity.name = "plain";
  capture.analytic = paint;
  return capture;
}

/// A paint's reflectance of light from everywhere, seen along the normal: cosine samples.
dvec3 albedo_at_normal(const core::Brdf& brdf) {
  const dvec3 n(0.0, 0.0, 1.0);
  const core::ReferenceFrame frame(n);
  dvec3 sum(0.0);
  constexpr std::uint64_t batches = 256;
  for (std::uint64_t batch = 0; batch < batches; ++batch)
    for (std::uint32_t k = 0; k < core::reference_batch; ++k) {
      core::ReferenceNumbers numbers(5, 0, batch, k);
      sum += brdf(core::sample_cosine(frame, numbers.next()), n) * std::numbers::pi;
    }
  return sum / static_cast<double>(batches * core::reference_batch);
}

/// Mean s over the texture as an engine decodes it, and mean w.
struct Decoded {
  dvec3 specular{0.0};
  double weight = 0.0, brightest = 0.0;
  dvec3 far_away{0.0};  ///< mean colour times mean weight: what the last mip level shows
};
Decoded decoded(const EngineMaterial& material) {
  Decoded out;
  dvec3 colour(0.0);
  const std::size_t count = material.flakes.rgba.size() / 4;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint8_t* rgba = &material.flakes.rgba[4 * k];
    const double w = rgba[3] / 255.0 * material.specular_weight;
    for (int c = 0; c < 3; ++c) {
      const double linear = core::srgb_decode(rgba[c] / 255.0);
      out.specular[c] += w * linear / static_cast<double>(count);
      colour[c] += linear / static_cast<double>(count);
      out.brightest = std::max(out.brightest, w * linear);
    }
    out.weight += w / static_cast<double>(count);
  }
  out.far_away = colour * out.weight;
  return out;
}

TEST(EngineFit, AUnitOfLightComesOutAsOfThePaint) {
  // Wide lobes, so that plain cosine samples see them; a table, a coat, flakes.
  for (const char* name : {"gu_bmw_339_coated", "gu_ford_f8_coated", "gu_white_coated"}) {
    const Capture capture = captured(name);
    const auto fit = fit_engine_material(capture);
    ASSERT_TRUE(fit) << fit.error().line();
    ASSERT_EQ(fit->gltf.outcome, core::GgxOutcome::fitted);
    const dvec3 truth = albedo_at_normal(capture_brdf(capture)), engine = albedo_at_normal(engine_brdf(fit->material));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(engine[c], truth[c], 0.03 * truth[c]) << name << " channel " << c;
  }
}

TEST(EngineFit, TheCoatsPeakBecomesTheCoat) {
  const auto fit = fit_engine_material(captured("gu_blue"));
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->peak_is_coat);
  EXPECT_NEAR(fit->material.clearcoat_alpha, core::narrow_lobe_ratio * 0.02, 1e-4);
  EXPECT_EQ(fit->material.clearcoat, 1.0) << "4 s f0 is 0.049 in Table 1, a glTF coat mirrors 0.04";
  EXPECT_NEAR(fit->material.alpha, core::narrow_lobe_ratio * 0.043, 0.02) << "the two lobes below";
  // A paint under a coat has that coat, whatever its lobes.
  const auto coated = fit_engine_material(captured("gu_blue_coated"));
  ASSERT_TRUE(coated);
  EXPECT_FALSE(coated->peak_is_coat);
  EXPECT_NEAR(coated->material.clearcoat, 1.0, 1e-12);
  EXPECT_EQ(coated->material.clearcoat_alpha, 0.0);
}

TEST(EngineFit, TheTableIsFilteredIntoTwoColours) {
  // Red where the half vector leans less than 45 degrees, blue beyond: the lobe is red, the diffuse part both.
  core::AnalyticPaint paint;
  paint.diffuse = dvec3(0.3);
  paint.lobes[0] = {dvec3(0.1), 0.2, 1.0};
  core::ColourTable table{91, std::vector<glm::vec3>(91 * 91)};
  for (std::size_t k = 0; k < table.linear.size(); ++k)
    table.linear[k] = k % 91 < 45 ? glm::vec3(1.5f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.5f);
  paint.table = table;
  const auto fit = fit_engine_material(plain(paint));
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->specular_chi.x, 1.48) << "values above 1 are legal";
  EXPECT_LT(fit->specular_chi.z, 0.03);
  EXPECT_GT(fit->diffuse_chi.x, 0.5);
  EXPECT_GT(fit->diffuse_chi.z, 0.1);
  EXPECT_NEAR(fit->diffuse_chi.x + fit->diffuse_chi.z, 1.5, 1e-6);
  EXPECT_EQ(fit->specular_chi.y, 0.0);
  EXPECT_NEAR(fit->material.diffuse.x, 0.3 * fit->diffuse_chi.x, 1e-9) << "no coat, nothing lost";
}

TEST(EngineFit, TheTextureKeepsTheMeanAndSparkles) {
  const auto fit = fit_engine_material(captured("gu_bmw_339_coated"));
  ASSERT_TRUE(fit);
  const EngineMaterial& material = fit->material;
  ASSERT_EQ(material.flakes.rgba.size(), 4u * 96 * 96);
  const Decoded texture = decoded(material);
  const dvec3 wanted = fit->specular_chi * fit->gltf.lobes + fit->gltf.flakes;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(texture.specular[c], wanted[c], 0.01 * wanted[c]);
    EXPECT_NEAR(texture.specular[c], material.specular[c], 1e-9);
    EXPECT_NEAR(texture.far_away[c], wanted[c], 0.03 * wanted[c]) << "from afar, filtered by the engine";
  }
  EXPECT_NEAR(texture.weight, material.mean_weight, 1e-9);
  EXPECT_GT(texture.brightest, 1.2 * wanted.z);
  EXPECT_LE(texture.brightest, 1.0);
  EXPECT_LE(std::max({material.diffuse.x, material.diffuse.y, material.diffuse.z}), 1.0 - material.mean_weight);
}

TEST(EngineFit, ExtremesAreNumbersWithANote) {
  const auto finite = [](const dvec3& v) {
    for (int c = 0; c < 3; ++c)
      if (!(v[c] >= 0.0 && v[c] <= 1.0)) return false;
    return true;
  };
  const auto check = [&](const core::AnalyticPaint& paint, const char* note) {
    const auto fit = fit_engine_material(plain(paint));
    ASSERT_TRUE(fit);
    const EngineMaterial& m = fit->material;
    EXPECT_TRUE(finite(m.diffuse) && finite(m.specular)) << note;
    EXPECT_TRUE(m.alpha >= core::least_engine_alpha && m.alpha <= 1.0) << note;
    EXPECT_TRUE(m.clearcoat >= 0.0 && m.clearcoat <= 1.0) << note;
    EXPECT_LE(m.mean_weight, 1.0) << note;
    const dvec3 seen = engine_brdf(m)(glm::normalize(dvec3(0.5, 0.0, 1.0)), dvec3(0.0, 0.0, 1.0));
    EXPECT_TRUE(std::isfinite(seen.x + seen.y + seen.z)) << note;
    const bool said = std::any_of(fit->notes.begin(), fit->notes.end(),
                                  [&](const std::string& text) { return text.find(note) != std::string::npos; });
    EXPECT_EQ(said, *note != '\0') << note << (fit->notes.empty() ? "" : ": " + fit->notes.front());
  };
  core::AnalyticPaint paint;
  check(paint, "");  // black, no lobe
  paint.diffuse = dvec3(0.8);
  check(paint, "");
  paint.diffuse = dvec3(7.0);
  check(paint, "more light than there is");
  paint.diffuse = dvec3(0.0);
  paint.lobes[0] = {dvec3(0.1), 1e-3, 1.0};
  check(paint, "no roughness is given");
  paint.lobes[0].m = 1.0;
  check(paint, "wider than roughness 1");
  paint.lobes[0] = {dvec3(5.0), 0.3, 1.0};
  check(paint, "cut at 1");
  paint.lobes[0] = {dvec3(0.1), 0.3, 0.0};
  paint.coat_ior = paint.refraction_ior = 2.5;
  check(paint, "drawn as 1.5");
  paint.coat_ior = 1.0;
  core::ColourTable bright{2, std::vector<glm::vec3>(4, glm::vec3(50.0f))};
  paint.lobes[0] = {dvec3(0.1), 0.3, 0.5};
  paint.diffuse = dvec3(0.2);
  paint.table = bright;
  check(paint, "cut at 1");
}

TEST(EngineFit, WhatIsNotFittedYetIsAnError) {
  Capture capture = plain({});
  capture.is_fitted = false;
  const auto fit = fit_engine_material(capture);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().remedy.find("lackwerk fit"), std::string::npos);
  Capture torn = captured("gu_bmw_339_coated", 16);
  torn.slices[5].texels.pop_back();
  EXPECT_FALSE(fit_engine_material(torn));
}

/// What the specification asks of a document and its binary: all references in range, views inside the buffer, aligned,
/// the bounds of positions exact, extensions declared.
void expect_valid(const json& gltf, const std::vector<char>& binary) {
  EXPECT_EQ(gltf.at("asset").at("version"), "2.0");
  ASSERT_EQ(gltf.at("buffers").size(), 1u);
  const std::size_t size = gltf["buffers"][0].at("byteLength");
  EXPECT_GE(binary.size(), size);
  EXPECT_LE(binary.size(), size + 3);
  for (const json& view : gltf.at("bufferViews")) {
    EXPECT_EQ(view.at("buffer"), 0);
    EXPECT_EQ(view.at("byteOffset").get<std::size_t>() % 4, 0u);
    EXPECT_GT(view.at("byteLength").get<std::size_t>(), 0u);
    EXPECT_LE(view.at("byteOffset").get<std::size_t>() + view.at("byteLength").get<std::size_t>(), size);
  }
  const auto data = [&](const json& accessor) {
    return binary.data() +
           gltf["bufferViews"].at(accessor.at("bufferView").get<std::size_t>())["byteOffset"].get<std::size_t>();
  };
  for (const json& accessor : gltf.at("accessors")) {
    const std::string type = accessor.at("type");
    const std::size_t components = type == "VEC3" ? 3 : type == "VEC2" ? 2 : 1;
    const std::size_t bytes = accessor.at("componentType") == 5126 ? 4 : 2;
    EXPECT_EQ(accessor.at("count").get<std::size_t>() * components * bytes,
              gltf["bufferViews"].at(accessor.at("bufferView").get<std::size_t>())["byteLength"].get<std::size_t>());
  }
  const json& primitive = gltf.at("meshes").at(0).at("primitives").at(0);
  const json& positions = gltf["accessors"].at(primitive.at("attributes").at("POSITION").get<std::size_t>());
  const json& indices = gltf["accessors"].at(primitive.at("indices").get<std::size_t>());
  const std::size_t count = positions.at("count");
  std::vector<glm::vec3> points(count);
  std::memcpy(points.data(), data(positions), count * sizeof(glm::vec3));
  glm::vec3 lo = points[0], hi = points[0];
  for (const glm::vec3& p : points) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
    EXPECT_NEAR(glm::length(p), engine_sphere_radius_m, 1e-7);
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(positions.at("min").at(static_cast<std::size_t>(c)).get<float>(), lo[c]);
    EXPECT_EQ(positions.at("max").at(static_cast<std::size_t>(c)).get<float>(), hi[c]);
  }
  std::vector<std::uint16_t> corners(indices.at("count").get<std::size_t>());
  std::memcpy(corners.data(), data(indices), corners.size() * 2);
  ASSERT_EQ(corners.size() % 3, 0u);
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    ASSERT_LT(std::max({corners[k], corners[k + 1], corners[k + 2]}), count);
    const glm::vec3 a = points[corners[k]], b = points[corners[k + 1]], c = points[corners[k + 2]];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0f) << "counter-clockwise from outside";
  }
  const json& material = gltf.at("materials").at(primitive.at("material").get<std::size_t>());
  std::vector<std::string> used = gltf.at("extensionsUsed");
  std::vector<std::string> found;
  for (const auto& [name, value] : material.at("extensions").items()) found.push_back(name);
  std::sort(used.begin(), used.end());
  EXPECT_EQ(used, found);  // items() comes sorted
  for (const json& value : material.at("pbrMetallicRoughness").at("baseColorFactor")) {
    EXPECT_GE(value.get<double>(), 0.0);
    EXPECT_LE(value.get<double>(), 1.0);
  }
  const json& specular = material["extensions"].at("KHR_materials_specular");
  EXPECT_LE(specular.at("specularFactor").get<double>(), 1.0);
  EXPECT_EQ(specular.contains("specularTexture"), gltf.contains("images"));
  if (gltf.contains("images")) {
    EXPECT_EQ(gltf.at("textures").at(specular.at("specularColorTexture").at("index").get<std::size_t>()).at("source"),
              0);
    EXPECT_TRUE(primitive.at("attributes").contains("TEXCOORD_0"));
  }
}

struct Glb {
  json document;
  std::vector<char> binary;
};
Glb split(const std::vector<char>& file) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  EXPECT_EQ(std::string(file.data(), 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), file.size());
  const std::size_t text = word(12);
  EXPECT_EQ(text % 4, 0u);
  EXPECT_EQ(std::string(file.data() + 16, 4), "JSON");
  const std::size_t binary = word(20 + text);
  EXPECT_EQ(std::string(file.data() + 24 + text, 3), "BIN");
  EXPECT_EQ(28 + text + binary, file.size());
  const auto begin = file.begin();
  return {json::parse(begin + 20, begin + 20 + static_cast<std::ptrdiff_t>(text)),
          {begin + 28 + static_cast<std::ptrdiff_t>(text), file.end()}};
}

TEST(EngineExport, BothFormsAreValidAndHoldTheMaterial) {
  Capture capture = captured("gu_bmw_339");
  capture.identity.name = "BMW \"339\"\n\xff";  // names are strangers' bytes
  const auto fit = fit_engine_material(capture);
  ASSERT_TRUE(fit);
  const TemporaryFolder folder;
  const auto out = folder.path() / "new" / "folder";
  const auto written = write_engine_material(fit->material, capture.identity, out);
  ASSERT_TRUE(written) << written.error().line();

  const std::vector<char> text = read_bytes(out / "paint.gltf");
  const json apart = json::parse(text.begin(), text.end());
  expect_valid(apart, read_bytes(out / "paint.bin"));
  const Glb glb = split(read_bytes(out / "paint.glb"));
  expect_valid(glb.document, glb.binary);
  EXPECT_EQ(glb.document.at("materials"), apart.at("materials"));

  const json& material = apart["materials"][0];
  EXPECT_NEAR(material["pbrMetallicRoughness"]["roughnessFactor"], std::sqrt(fit->material.alpha), 1e-12);
  EXPECT_EQ(material["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"], fit->material.clearcoat);
  EXPECT_NEAR(material["extensions"]["KHR_materials_clearcoat"]["clearcoatRoughnessFactor"].get<double>(),
              std::sqrt(fit->material.clearcoat_alpha), 1e-12);
  EXPECT_EQ(material["extras"]["provenance_lobes"], "published-fit");
  EXPECT_EQ(material["extras"]["provenance_flakes"], "simulated");
  EXPECT_NEAR(material["extras"]["flake_tile_m"], 96 * 0.05e-3, 1e-9);
  // What is left of the diffuse colour below the specular weight is the fit's.
  const double base = material["pbrMetallicRoughness"]["baseColorFactor"][1];
  EXPECT_NEAR(base * (1.0 - fit->material.mean_weight), fit->material.diffuse.y, 1e-9);

  // The picture on disk, the one inside the .glb and the fit's bytes are the same.
  const std::vector<char> png = read_bytes(out / "flakes.png");
  const json& view = glb.document["bufferViews"].at(glb.document["images"][0].at("bufferView").get<std::size_t>());
  ASSERT_EQ(view["byteLength"], png.size());
  EXPECT_EQ(std::memcmp(glb.binary.data() + view["byteOffset"].get<std::size_t>(), png.data(), png.size()), 0);
  const auto picture = read_picture(out / "flakes.png", {4096, 4096, 1u << 24, 4, "", ""}, true);
  ASSERT_TRUE(picture) << picture.error().line();
  ASSERT_EQ(picture->channels, 4);
  ASSERT_EQ(picture->values.size(), fit->material.flakes.rgba.size());
  for (std::size_t k = 0; k < picture->values.size(); ++k)
    ASSERT_EQ(std::lround(picture->values[k] * 255.0f), fit->material.flakes.rgba[k]) << k;

  // The same input gives the same bytes.
  const auto again = folder.path() / "again";
  ASSERT_TRUE(write_engine_material(fit->material, capture.identity, again));
  EXPECT_EQ(read_bytes(again / "paint.glb"), read_bytes(out / "paint.glb"));
}

TEST(EngineExport, AssimpReadsIt) {
  const auto fit = fit_engine_material(captured("gu_bmw_339"));
  ASSERT_TRUE(fit);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_engine_material(fit->material, {}, folder.path()));
  for (const char* name : {"paint.glb", "paint.gltf"}) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((folder / name).string(), 0);
    ASSERT_NE(scene, nullptr) << name << ": " << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, 1u);
    EXPECT_EQ(scene->mMeshes[0]->mNumVertices, 6u * 25 * 25);
    EXPECT_EQ(scene->mMeshes[0]->mNumFaces, 6u * 24 * 24 * 2);
    EXPECT_TRUE(scene->mMeshes[0]->HasNormals());
    EXPECT_TRUE(scene->mMeshes[0]->HasTextureCoords(0));
    const aiMaterial* material = scene->mMaterials[scene->mMeshes[0]->mMaterialIndex];
    float coat = 0.0f, coat_roughness = 0.0f, roughness = 0.0f;
    EXPECT_EQ(material->Get(AI_MATKEY_CLEARCOAT_FACTOR, coat), AI_SUCCESS);
    EXPECT_EQ(material->Get(AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, coat_roughness), AI_SUCCESS);
    EXPECT_EQ(material->Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness), AI_SUCCESS);
    EXPECT_NEAR(coat, fit->material.clearcoat, 1e-6);
    EXPECT_NEAR(coat_roughness, std::sqrt(fit->material.clearcoat_alpha), 1e-6);
    EXPECT_NEAR(roughness, std::sqrt(fit->material.alpha), 1e-6);
    const auto model = read_model(folder / name);  // and our own importer, which takes models from strangers
    ASSERT_TRUE(model) << model.error().line();
    EXPECT_TRUE(model->is_gltf);
  }
}

TEST(EngineExport, APlainPaintHasNoImage) {
  const auto flaky = fit_engine_material(captured("gu_bmw_339", 16));
  const auto fit = fit_engine_material(captured("gu_white"));
  ASSERT_TRUE(flaky && fit);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_engine_material(flaky->material, {}, folder.path()));
  ASSERT_TRUE(std::filesystem::exists(folder / "flakes.png"));
  ASSERT_TRUE(write_engine_material(fit->material, {}, folder.path()));
  EXPECT_FALSE(std::filesystem::exists(folder / "flakes.png")) << "an older export's image would mislead";
  const Glb glb = split(read_bytes(folder / "paint.glb"));
  expect_valid(glb.document, glb.binary);
  EXPECT_FALSE(glb.document.contains("images"));
  const json& specular = glb.document["materials"][0]["extensions"]["KHR_materials_specular"];
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(specular["specularColorFactor"][static_cast<std::size_t>(c)].get<double>() *
                    specular["specularFactor"].get<double>(),
                fit->material.specular[c], 1e-12);
  // No lobe and no coat: neither weight nor extension.
  ASSERT_TRUE(write_engine_material(fit_engine_material(plain({}))->material, {}, folder.path()));
  const Glb black = split(read_bytes(folder / "paint.glb"));
  expect_valid(black.document, black.binary);
  EXPECT_FALSE(black.document["materials"][0]["extensions"].contains("KHR_materials_clearcoat"));
}

TEST(EngineExport, SaysWhatCannotBeWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const auto written = write_engine_material({}, {}, folder / "file");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().file.find("file"), std::string::npos);
}

}  // namespace
}  // namespace lackwerk::packs
