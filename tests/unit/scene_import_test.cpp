#include "packs/tools/scene_import.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>
#include <sstream>

#include "packs/scene_pack.hpp"
#include "packs/tools/import_materials.hpp"
#include "packs/tools/model_reader.hpp"
#include "packs/tools/scene_detail.hpp"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::TemporaryFolder;

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A box of 4.5 x 1.8 x 1.4 with the length along y and z up; the top is glass, the rest paint.
std::string box_obj(const std::string& extra = "", double unit = 1.0) {
  std::ostringstream out;
  out << "mtllib box.mtl\n";
  for (int k = 0; k < 8; ++k)
    out << "v " << unit * ((k & 1) != 0 ? 0.9 : -0.9) << ' ' << unit * ((k & 2) != 0 ? 2.25 : -2.25) << ' '
        << unit * ((k & 4) != 0 ? 1.4 : 0.0) << '\n';
  out << "usemtl Car_Paint\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\nf 1 3 4 2\nusemtl Windshield\nf 5 6 8 7\n";
  return out.str() + extra;
}

void write_box(const TemporaryFolder& folder, const std::string& extra = "", double unit = 1.0) {
  write(folder / "box.mtl", "newmtl Car_Paint\nKd 1 0 0\nnewmtl Windshield\nKd 0 0 0\n");
  write(folder / "box.obj", box_obj(extra, unit));
}

ImportSettings painted(const std::string& material) {
  ImportSettings settings;
  settings.paint = material;
  return settings;
}

glm::vec3 size_of(const Scene& scene) {
  glm::vec3 low(1e9f), high(-1e9f);
  for (const MeshPart& part : scene.parts) {
    if (part.kind == SurfaceKind::floor) continue;
    for (const glm::vec3& p : part.positions_mm) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  EXPECT_NEAR(low.z, 0.0f, 1e-3f);
  EXPECT_NEAR(low.x + high.x, 0.0f, 1e-2f);
  EXPECT_NEAR(low.y + high.y, 0.0f, 1e-2f);
  return high - low;
}

TEST(SceneImport, ABoxBecomesACarOnItsFloor) {
  const TemporaryFolder folder;
  write_box(folder);
  const auto made = import_scene(folder / "box.obj", painted("car_paint"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_LT(glm::distance(size_of(made->scene), glm::vec3(4500, 1800, 1400)), 0.1f);
  ASSERT_EQ(made->scene.parts.size(), 4u);  // paint, glass, floor at two levels
  EXPECT_EQ(made->scene.parts[0].kind, SurfaceKind::paint);
  EXPECT_EQ(made->scene.parts[1].kind, SurfaceKind::glass);
  EXPECT_EQ(made->scene.parts[0].indices.size(), 30u);
  EXPECT_EQ(made->scene.parts[0].detail, detail_full | detail_coarse);
  EXPECT_EQ(made->repairs, std::vector<std::string>{"normals made for 2 meshes"});
  EXPECT_NE(made->placement.find("unit metres (guessed)"), std::string::npos) << made->placement;
  // Normals point outward: a box's own edges are sharper than the crease.
  for (std::size_t v = 0; v < made->scene.parts[0].positions_mm.size(); ++v)
    EXPECT_GT(glm::dot(made->scene.parts[0].normals[v], made->scene.parts[0].positions_mm[v] - glm::vec3(0, 0, 700)),
              0.0f);
  std::vector<std::string> names;
  for (const Camera& camera : made->scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"hero", "side", "rear", "front", "rim", "macro", "stripe"}));
  EXPECT_TRUE(write_scene_pack(folder / "box.lws", made->scene));
  EXPECT_TRUE(read_scene_pack(folder / "box.lws"));
}

TEST(SceneImport, UnitsAxesAndTurnsFollowTheModelOrTheWish) {
  const TemporaryFolder folder;
  for (const double unit : {100.0, 1000.0, 39.37}) {
    write_box(folder, "", unit);
    const auto made = import_scene(folder / "box.obj", painted("Car_Paint"));
    ASSERT_TRUE(made) << made.error().line();
    EXPECT_NEAR(size_of(made->scene).x, 4500.0f, 1.0f) << unit;
  }
  write_box(folder, "", 0.001);
  const auto lost = import_scene(folder / "box.obj", painted("Car_Paint"));
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().field, "unit");
  ImportSettings settings = painted("Car_Paint");
  settings.placement.length_mm = 3000.0;
  settings.placement.rotate_deg = 90.0;
  settings.floor = false;
  const auto made = import_scene(folder / "box.obj", settings);
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_LT(glm::distance(size_of(made->scene), glm::vec3(1200, 3000, 933.333f)), 0.1f);
  EXPECT_EQ(made->scene.parts.size(), 2u);
  settings.placement.up = UpAxis::y;
  settings.placement.rotate_deg = 0.0;
  const auto standing = import_scene(folder / "box.obj", settings);
  ASSERT_TRUE(standing) << standing.error().line();
  EXPECT_NEAR(size_of(standing->scene).x, 3000.0f, 0.1f);
  EXPECT_NEAR(size_of(standing->scene).z, 3000.0f * 4.5f / 1.8f, 0.1f);
}

TEST(SceneImport, WhatCanBeMendedIsMendedAndSaid) {
  const TemporaryFolder folder;
  // Two faces without area, and normals that contradict one face's winding.
  write_box(folder, "vn 0 0 1\nusemtl Car_Paint\nf 1 1 2\nf 1 2 2\n");
  auto made = import_scene(folder / "box.obj", painted("Car_Paint"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_TRUE(std::any_of(made->repairs.begin(), made->repairs.end(), [](const std::string& text) {
    return text == "2 faces without area left out";
  })) << (made->repairs.empty() ? "nothing" : made->repairs[0]);
  write(folder / "turned.obj",
        "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nv 0 0 1\nv 4 0 1\nvn 0 0 1\nusemtl A\nf 1//1 3//1 2//1\nf 1//1 3//1 4//1\n"
        "f 5//1 6//1 3//1\n");
  made = import_scene(folder / "turned.obj", painted("A"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_EQ(made->repairs, std::vector<std::string>{"1 face turned to where the normals point"});
  // Normals without length are none.
  write(folder / "none.obj",
        "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 1\nvn 0 0 0\nusemtl A\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
  made = import_scene(folder / "none.obj", painted("A"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_EQ(made->repairs, std::vector<std::string>{"normals made for 1 mesh"});
}

TEST(SceneImport, WhatCannotBeMendedIsRefusedByName) {
  const TemporaryFolder folder;
  write_box(folder);
  const auto refused = [&](const std::string& name, const ImportSettings& settings) {
    const auto made = import_scene(folder / name, settings);
    EXPECT_FALSE(made) << name;
    return made ? std::string() : made.error().line();
  };
  EXPECT_NE(refused("nowhere.obj", painted("A")).find("no such file"), std::string::npos);
  EXPECT_NE(refused("box.obj", painted("Lack")).find("the model has: Car_Paint, Windshield"), std::string::npos);
  ImportSettings settings = painted("paint");
  settings.kinds = {{"Nothing", SurfaceKind::glass}};
  EXPECT_NE(refused("box.obj", settings).find("no material 'Nothing'"), std::string::npos);
  write(folder / "nan.obj", "v 0 0 0\nv nan 0 0\nv 4 2 0\nv 4 0 1\nusemtl A\nf 1 2 3\nf 1 3 4\n");
  EXPECT_NE(refused("nan.obj", painted("A")).find("not finite"), std::string::npos);
  write(folder / "points.obj", "v 0 0 0\nv 4 0 0\nv 4 2 0\n");
  EXPECT_FALSE(refused("points.obj", painted("A")).empty());
  write(folder / "flat.obj", "v 0 0 0\nv 4 0 0\nv 3 0 0\nusemtl A\nf 1 2 3\n");
  EXPECT_NE(refused("flat.obj", painted("A")).find("none has any area"), std::string::npos);
  write(folder / "empty.glb", "");
  EXPECT_FALSE(refused("empty.glb", painted("A")).empty());
  write(folder / "text.xyzzy", "hello");
  EXPECT_FALSE(refused("text.xyzzy", painted("A")).empty());
  EXPECT_NE(refused("", painted("A")).find("not a regular file"), std::string::npos);
  // Sparse: takes no room on the disk.
  write(folder / "huge.obj", "v 0 0 0\n");
  std::filesystem::resize_file(folder / "huge.obj", ModelLimits{}.bytes + 1);
  EXPECT_NE(refused("huge.obj", painted("A")).find("size"), std::string::npos);
}

/// A glTF of two triangles, Body and Glass, in metres, y up, the nose at +z, without normals; the node stands 1 m up,
/// `copies` times at one place.
void write_gltf(const std::filesystem::path& path, int copies = 1) {
  const float positions[6][3] = {{-0.9f, 0, 2}, {0.9f, 0, 2}, {0, 0.5f, -2.5f},
                                 {-0.9f, 1, 1}, {0.9f, 1, 1}, {0, 1.2f, -2}};
  std::string bytes(sizeof positions, '\0');
  std::memcpy(bytes.data(), positions, sizeof positions);
  const std::filesystem::path buffer = path.parent_path() / "model.bin";
  write(buffer, bytes);
  std::string roots, nodes;
  for (int k = 0; k < copies; ++k) {
    const char* comma = k == 0 ? "" : ",";
    roots += comma + std::to_string(k);
    nodes += std::string(comma) + R"({"mesh":0,"translation":[0,1,0]})";
  }
  write(path, R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],
"nodes":[)" + nodes +
                  R"(],
"buffers":[{"uri":"model.bin","byteLength":72}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36}],
"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-0.9,0,-2.5],"max":[0.9,0.5,2]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[-0.9,1,-2],"max":[0.9,1.2,1]}],
"materials":[{"name":"Body"},{"name":"Glass"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0},{"attributes":{"POSITION":1},"material":1}]}]})");
}

TEST(SceneImport, GltfIsInMetresWithYUpAndItsNoseAhead) {
  const TemporaryFolder folder;
  write_gltf(folder / "model.gltf");
  const auto made = import_scene(folder / "model.gltf", painted("body"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_LT(glm::distance(size_of(made->scene), glm::vec3(4500, 1800, 1200)), 0.1f);
  EXPECT_EQ(made->scene.parts[0].kind, SurfaceKind::paint);
  EXPECT_EQ(made->scene.parts[1].kind, SurfaceKind::glass);
  // The triangle's two corners at z = +2 m are its nose.
  const auto& p = made->scene.parts[0].positions_mm;
  EXPECT_EQ(std::count_if(p.begin(), p.end(), [](const glm::vec3& v) { return v.x > 2200.0f; }), 2);
  EXPECT_NE(made->placement.find("unit metres,"), std::string::npos) << made->placement;
}

/// A wave of 2 (edge - 1)^2 triangles, about 4.3 x 1.9 where edge is 215; `faces` in the order given.
std::string wave_obj(int edge, const std::vector<int>& quads) {
  const double step = 4.3 / edge;
  std::ostringstream out;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x)
      out << "v " << step * x << ' ' << 0.45 * step * y << ' '
          << 0.05 * std::sin(step * x) + 0.02 * std::sin(1.5 * step * y) << '\n';
  out << "usemtl Lack\n";
  for (const int quad : quads) {
    const int corner = quad / (edge - 1) * edge + quad % (edge - 1) + 1;
    out << "f " << corner << ' ' << corner + 1 << ' ' << corner + edge + 1 << ' ' << corner + edge << '\n';
  }
  return out.str();
}

std::vector<int> in_order(int edge) {
  std::vector<int> quads(static_cast<std::size_t>((edge - 1) * (edge - 1)));
  std::iota(quads.begin(), quads.end(), 0);
  return quads;
}

std::size_t painted_triangles(const Scene& scene, std::uint8_t detail) {
  std::size_t count = 0;
  for (const MeshPart& part : scene.parts)
    if (part.kind == SurfaceKind::paint && (part.detail & detail) != 0) count += part.indices.size() / 3;
  return count;
}

TEST(SceneImport, LargeModelsGetACoarseTwin) {
  const TemporaryFolder folder;
  constexpr int edge = 215;  // 91,592 triangles
  write(folder / "wave.obj", wave_obj(edge, in_order(edge)));
  const auto made = import_scene(folder / "wave.obj", painted("Lack"));
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_EQ(painted_triangles(made->scene, detail_full), 2u * (edge - 1) * (edge - 1));
  EXPECT_LE(painted_triangles(made->scene, detail_coarse), 60'000u);
  EXPECT_GT(painted_triangles(made->scene, detail_coarse), 1000u);
}

TEST(SceneImport, MoreThanTheLimitsIsRefusedWithTheLimitAndTheRemedy) {
  const TemporaryFolder folder;
  constexpr int edge = 33;  // 2,048 triangles
  write(folder / "wave.obj", wave_obj(edge, in_order(edge)));
  write_gltf(folder / "model.gltf", 600);  // 1,200 triangles of two that the file has
  const auto refusal = [&](const char* name, const ModelLimits& limits) {
    ImportSettings settings = painted(name[0] == 'w' ? "Lack" : "Body");
    settings.limits = limits;
    const auto made = import_scene(folder / name, settings);
    return made ? std::string("accepted") : made.error().line();
  };
  EXPECT_EQ(refusal("wave.obj", {.triangles = 2048}), "accepted");
  const std::string faces = refusal("wave.obj", {.triangles = 2047});
  EXPECT_NE(faces.find("wave.obj: faces: 2048 triangles or more, of at most 2047"), std::string::npos) << faces;
  EXPECT_NE(faces.find("simplify the model"), std::string::npos) << faces;
  const std::string bytes = refusal("wave.obj", {.bytes = 1000});
  EXPECT_NE(bytes.find("bytes of at most 1000"), std::string::npos) << bytes;
  EXPECT_NE(bytes.find("simplify the model"), std::string::npos) << bytes;
  EXPECT_EQ(refusal("model.gltf", {.triangles = 1200}), "accepted");
  const std::string copies = refusal("model.gltf", {.triangles = 1100});
  EXPECT_NE(copies.find("triangles or more, of at most 1100"), std::string::npos) << copies;
  EXPECT_EQ(refusal("model.gltf", {}), "accepted");
}

TEST(SceneImport, MoreThanAKioskCanUseIsSimplifiedAndSaid) {
  const TemporaryFolder folder;
  constexpr int edge = 65;  // 8,192 triangles
  const std::string joined = wave_obj(edge, in_order(edge));
  write(folder / "joined.obj", joined);
  // The same as a stereolithography file: no triangle shares a vertex with another, and each has its own normal.
  std::ostringstream facets;
  facets << "solid Lack\n";
  for (int quad = 0; quad < (edge - 1) * (edge - 1); ++quad) {
    const auto corner = [&](int dx, int dy) {
      const int row = quad / (edge - 1);
      const double x = 0.0661538 * (quad % (edge - 1) + dx), y = 0.0297692 * (row + dy);
      facets << "vertex " << x << ' ' << y << ' ' << 0.05 * std::sin(x) + 0.02 * std::sin(3.3 * y) << '\n';
    };
    for (const bool upper : {false, true}) {
      facets << "facet normal " << 0.001 * (quad % 9) << " 0 1\nouter loop\n";
      corner(0, 0);
      corner(1, upper ? 1 : 0);
      corner(upper ? 0 : 1, 1);
      facets << "endloop\nendfacet\n";
    }
  }
  facets << "endsolid Lack\n";
  write(folder / "facets.stl", facets.str());
  for (const char* name : {"joined.obj", "facets.stl"}) {
    const auto model = read_model(folder / name);
    ASSERT_TRUE(model) << model.error().line();
    ImportSettings settings = painted(model->materials.at(0));
    settings.kept_triangles = 8192;
    const auto whole = import_scene(folder / name, settings);
    ASSERT_TRUE(whole) << whole.error().line();
    EXPECT_EQ(painted_triangles(whole->scene, detail_full), 8192u) << name;
    settings.kept_triangles = 2000;
    const auto made = import_scene(folder / name, settings);
    ASSERT_TRUE(made) << made.error().line();
    EXPECT_LE(painted_triangles(made->scene, detail_full), 2500u) << name;
    EXPECT_GT(painted_triangles(made->scene, detail_full), 1000u) << name;
    EXPECT_LT(glm::distance(size_of(made->scene), size_of(whole->scene)), 2.0f) << name;
    ASSERT_FALSE(made->repairs.empty()) << name;
    const std::string& said = made->repairs.back();
    EXPECT_EQ(said.rfind("simplified from 8192 to ", 0), 0u) << said;
    EXPECT_NE(said.find(" mm off"), std::string::npos) << said;
  }
}

TEST(SceneImport, SplittingForSixteenBitsRepeatsFewVertices) {
  const TemporaryFolder folder;
  constexpr int edge = 262;  // 68,644 vertices
  std::vector<int> quads = in_order(edge);
  std::shuffle(quads.begin(), quads.end(), std::mt19937(1));
  write(folder / "wave.obj", wave_obj(edge, quads));
  const auto made = import_scene(folder / "wave.obj", painted("Lack"));
  ASSERT_TRUE(made) << made.error().line();
  ASSERT_TRUE(write_scene_pack(folder / "wave.lws", made->scene));
  const auto back = read_scene_pack(folder / "wave.lws");
  ASSERT_TRUE(back) << back.error().line();
  std::size_t vertices = 0;
  for (const MeshPart& part : back->parts)
    if (part.kind == SurfaceKind::paint && part.detail == detail_full) vertices += part.positions_mm.size();
  EXPECT_GE(vertices, 68'644u);
  EXPECT_LT(vertices, 71'000u);
}

TEST(SceneImport, NamesTellKinds) {
  EXPECT_EQ(kind_by_name("Windshield_Glass"), SurfaceKind::glass);
  EXPECT_EQ(kind_by_name("TIRE"), SurfaceKind::rubber);
  EXPECT_EQ(kind_by_name("black trim"), SurfaceKind::trim);
  EXPECT_EQ(kind_by_name("Rim_front"), SurfaceKind::rim);
  EXPECT_EQ(kind_by_name("brake_disc"), SurfaceKind::rim);
  EXPECT_EQ(kind_by_name("Brakelight"), SurfaceKind::lamp_red);
  EXPECT_EQ(kind_by_name("headlights"), SurfaceKind::lamp_clear);
  EXPECT_EQ(kind_by_name("Leather seats"), SurfaceKind::interior);
  EXPECT_EQ(kind_by_name("Chrome"), SurfaceKind::chrome);
  EXPECT_EQ(kind_by_name("Material.001"), SurfaceKind::trim);
  EXPECT_EQ(importable_kind("lamp_red").value(), SurfaceKind::lamp_red);
  EXPECT_EQ(importable_kind("floor").error().kind, ErrorKind::usage);
  EXPECT_FALSE(importable_kind("gold"));
  // Exactly one part of a name is enough; two are not.
  EXPECT_TRUE(assign_kinds({"Body_Red", "Glass"}, "body", {}, "m"));
  EXPECT_FALSE(assign_kinds({"Body_Red", "Body_Blue"}, "body", {}, "m"));
  const auto exact = assign_kinds({"Body", "Body_Inside"}, "BODY", {{"body_inside", SurfaceKind::interior}}, "m");
  ASSERT_TRUE(exact);
  EXPECT_EQ(*exact, (std::vector<SurfaceKind>{SurfaceKind::paint, SurfaceKind::interior}));
}

TEST(SceneImport, ADownloadedCarBecomesAScene) {
  const std::filesystem::path path = LACKWERK_SOURCE_DIR "/../shared/data/models/hybrid_body.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs ../shared/data/models/hybrid_body.obj";
  const auto made = import_scene(path, painted("Hybrid"));
  ASSERT_TRUE(made) << made.error().line();
  const glm::vec3 size = size_of(made->scene);
  EXPECT_NEAR(size.x, 4618.0f, 5.0f);
  EXPECT_NEAR(size.y, 2012.0f, 5.0f);
  ASSERT_EQ(made->materials.size(), 3u);
  EXPECT_EQ(made->materials[0].kind, SurfaceKind::paint);
  EXPECT_EQ(made->materials[1].kind, SurfaceKind::interior);
  EXPECT_EQ(made->materials[2].kind, SurfaceKind::glass);
  // Its nose, which is lower than its tail, points along +x.
  const auto top = [&](float side) {
    float highest = 0.0f;
    for (const glm::vec3& p : made->scene.parts[0].positions_mm)
      if (p.x * side > 2000.0f) highest = std::max(highest, p.z);
    return highest;
  };
  EXPECT_LT(top(1.0f), top(-1.0f) - 50.0f);
  // The macro camera stands over the bonnet's paint.
  const Camera& macro = made->scene.cameras[5];
  EXPECT_GT(macro.target_mm.x, 1000.0f);
  EXPECT_NEAR(glm::distance(macro.eye_mm, macro.target_mm), 150.0f, 0.1f);
}

}  // namespace
}  // namespace lackwerk::packs
