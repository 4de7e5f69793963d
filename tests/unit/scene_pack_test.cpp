#include "packs/scene_pack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "packs/scene_pack_generated.h"
#include "tests/unit/pack_samples.hpp"

namespace lackwerk::packs {
namespace {

using testing::sample_scene;
using testing::TemporaryFolder;

constexpr std::size_t environment_bytes = std::size_t{core::environment_width} * core::environment_height * 4;

float distance(const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b); }

/// The sample with everything that is baked.
Scene lit_scene() {
  Scene scene = sample_scene();
  std::uint8_t next = 0;
  for (MeshPart& part : scene.parts) {
    for (std::size_t v = 0; v < part.positions_mm.size(); ++v) {
      Visibility visibility = open_visibility;
      for (std::uint8_t& byte : visibility) byte = ++next;
      part.visibility.push_back(visibility);
      const auto level = static_cast<std::uint16_t>(1000 * v);
      part.irradiance.push_back({level, 65535, static_cast<std::uint16_t>(level + 1)});
    }
  }
  scene.parts[0].detail = detail_full;
  scene.parts[1].detail = detail_coarse;
  scene.irradiance_range = 12.5f;
  scene.environment = core::uniform_environment({0.25f, 0.5f, 2.0f});
  scene.environment.name = "test hall";
  scene.environment.centre_mm = {10.0f, -20.0f, 1300.0f};
  scene.environment.room_radius_mm = 8000.0f;
  return scene;
}

/// Closes a file as version 2 wrote it: these parts, no views, a room in which every light is alike.
void finish_version_two(flatbuffers::FlatBufferBuilder& out, flatbuffers::Offset<flatbuffers::String> name,
                        flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fb::Part>>> parts) {
  const auto views = out.CreateVector(std::vector<flatbuffers::Offset<fb::View>>{});
  const auto atlas = out.CreateVector(std::vector<std::uint8_t>(environment_bytes));
  const std::vector<fb::Light> light(core::environment_light_count, fb::Light({0, 0, 1}, {1, 1, 1}));
  const auto lights = out.CreateVectorOfStructs(light);
  const fb::Point centre(0, 0, 0);
  const auto environment = fb::CreateEnvironment(out, name, &centre, 0.0f, 1.0f, atlas, lights);
  fb::FinishScenePackBuffer(out, fb::CreateScenePack(out, 2, 2, name, name, parts, views, environment, 1.0f));
}

TEST(ScenePack, ComesBack) {
  const TemporaryFolder folder;
  const Scene scene = lit_scene();
  ASSERT_TRUE(write_scene_pack(folder / "s.lws", scene));
  for (const Backing backing : {Backing::map, Backing::copy}) {
    const auto back = read_scene_pack(folder / "s.lws", backing);
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(back->name, scene.name);
    ASSERT_EQ(back->parts.size(), scene.parts.size());
    for (std::size_t k = 0; k < scene.parts.size(); ++k) {
      EXPECT_EQ(back->parts[k].name, scene.parts[k].name);
      EXPECT_EQ(back->parts[k].kind, scene.parts[k].kind);
      EXPECT_EQ(back->parts[k].positions_mm, scene.parts[k].positions_mm);
      EXPECT_EQ(back->parts[k].indices, scene.parts[k].indices);
      EXPECT_EQ(back->parts[k].visibility, scene.parts[k].visibility);
      EXPECT_EQ(back->parts[k].irradiance, scene.parts[k].irradiance);
      EXPECT_EQ(back->parts[k].detail, scene.parts[k].detail);
      for (std::size_t v = 0; v < scene.parts[k].normals.size(); ++v) {
        EXPECT_LT(distance(back->parts[k].normals[v], scene.parts[k].normals[v]), 4e-5f);
        EXPECT_NEAR(glm::length(back->parts[k].normals[v]), 1.0f, 1e-6f);
      }
    }
    ASSERT_EQ(back->cameras.size(), 2u);
    EXPECT_EQ(back->cameras[1].name, "side");
    EXPECT_EQ(back->cameras[1].eye_mm, scene.cameras[1].eye_mm);
    EXPECT_EQ(back->cameras[1].vertical_fov_deg, 25.5f);
    EXPECT_EQ(back->environment, scene.environment);
    EXPECT_EQ(back->irradiance_range, 12.5f);
  }
}

/// A strip of `quads` quads, which share their vertices.
MeshPart strip(std::uint32_t quads) {
  MeshPart part;
  part.name = "strip";
  part.kind = SurfaceKind::trim;
  part.detail = detail_coarse;
  for (std::uint32_t k = 0; k <= quads; ++k)
    for (int side = 0; side < 2; ++side) {
      part.positions_mm.emplace_back(0.01f * static_cast<float>(k), static_cast<float>(side), 0.0f);
      part.normals.emplace_back(0.0f, 0.0f, 1.0f);
      Visibility visibility = open_visibility;
      visibility[1] = static_cast<std::uint8_t>(k % 251);
      part.visibility.push_back(visibility);
      part.irradiance.push_back({static_cast<std::uint16_t>(k % 65521), 7, 8});
    }
  for (std::uint32_t k = 0; k < quads; ++k)
    for (const std::uint32_t corner : {0u, 2u, 3u, 0u, 3u, 1u}) part.indices.push_back(2 * k + corner);
  return part;
}

TEST(ScenePack, LargePartsAreSplitWithoutChange) {
  const TemporaryFolder folder;
  Scene scene = sample_scene();
  scene.parts = {strip(100'000)};
  ASSERT_TRUE(write_scene_pack(folder / "s.lws", scene));
  const auto back = read_scene_pack(folder / "s.lws");
  ASSERT_TRUE(back) << back.error().line();
  EXPECT_GE(back->parts.size(), 4u);
  const MeshPart& whole = scene.parts[0];
  std::size_t corner = 0;
  for (const MeshPart& part : back->parts) {
    EXPECT_LE(part.positions_mm.size(), max_part_vertices);
    EXPECT_EQ(part.kind, SurfaceKind::trim);
    EXPECT_EQ(part.detail, detail_coarse);
    for (const std::uint32_t index : part.indices) {
      const std::uint32_t original = whole.indices[corner++];
      ASSERT_EQ(part.positions_mm[index], whole.positions_mm[original]);
      ASSERT_EQ(part.visibility[index], whole.visibility[original]);
      ASSERT_EQ(part.irradiance[index], whole.irradiance[original]);
    }
  }
  EXPECT_EQ(corner, whole.indices.size());
}

TEST(ScenePack, FlippedBitsAndTruncationsAreRefused) {
  // The atlas alone has 22 million bits, and every look hashes all of it: each bit of the header's fields, and places
  // spread over the payload. (paint_pack_test flips every bit; the container is the same.)
  const TemporaryFolder folder;
  const auto path = folder / "s.lws";
  ASSERT_TRUE(write_scene_pack(path, lit_scene()));
  testing::BitFlipper file(path);
  constexpr std::size_t header_fields_bits = 32 * 8, places = 150;
  std::vector<std::size_t> bits(header_fields_bits);
  std::iota(bits.begin(), bits.end(), std::size_t{0});
  for (std::size_t k = 0; k < places; ++k)
    bits.push_back(header_fields_bits + 1 + k * (file.size_bits() / (places + 2)));
  for (std::size_t k = 0; k < places; ++k) bits.push_back(file.size_bits() - 1 - 101 * k);
  for (const std::size_t bit : bits) {
    file.flip(bit);
    ASSERT_FALSE(read_scene_pack(path, Backing::copy)) << "bit " << bit;
    file.flip(bit);
  }
  ASSERT_TRUE(read_scene_pack(path, Backing::copy));
  const std::size_t size = file.size_bits() / 8;
  std::printf("%zu single-bit flips of a scene of %zu bytes, all refused\n", bits.size(), size);
  for (std::size_t cut = 1; cut < size; cut += cut < 300 ? 1 : size / 40) {
    std::filesystem::resize_file(path, size - cut);
    ASSERT_FALSE(read_scene_pack(path)) << cut;
  }
  for (std::size_t left = 200; left-- > 0;) {
    std::filesystem::resize_file(path, left);
    ASSERT_FALSE(read_scene_pack(path)) << left;
  }
}

TEST(ScenePack, SoundFilesWithoutSenseAreRefusedByField) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  struct Bad {
    const char* field;
    std::function<void(Scene&)> spoil;
  };
  const std::vector<Bad> cases = {
      {"parts", [](Scene& s) { s.parts.clear(); }},
      {"parts[0].positions[1]", [](Scene& s) { s.parts[0].positions_mm[1].y = nan; }},
      {"parts[0].positions[3]", [](Scene& s) { s.parts[0].positions_mm[3].z = 1e7f; }},
      {"parts[0].normals", [](Scene& s) { s.parts[0].normals.pop_back(); }},
      {"parts[1].indices[2]", [](Scene& s) { s.parts[1].indices[2] = 3; }},
      {"parts[1].indices", [](Scene& s) { s.parts[1].indices.push_back(0); }},
      {"parts[1]", [](Scene& s) { s.parts[1].indices.clear(); }},
      {"parts[1].kind", [](Scene& s) { s.parts[1].kind = static_cast<SurfaceKind>(surface_kind_count); }},
      {"views[1].vertical_fov_deg", [](Scene& s) { s.cameras[1].vertical_fov_deg = 120.0f; }},
      {"views[1].vertical_fov_deg", [](Scene& s) { s.cameras[1].vertical_fov_deg = nan; }},
      {"views[0]", [](Scene& s) { s.cameras[0].target_mm = s.cameras[0].eye_mm; }},
      {"views[0]", [](Scene& s) { s.cameras[0].eye_mm.x = nan; }},
      {"views[0].name", [](Scene& s) { s.cameras[0].name.clear(); }},
      {"parts[0].visibility", [](Scene& s) { s.parts[0].visibility.pop_back(); }},
      {"parts[0].visibility", [](Scene& s) { s.parts[0].visibility.resize(1000); }},
      {"parts[1].irradiance", [](Scene& s) { s.parts[1].irradiance.pop_back(); }},
      {"parts[1].irradiance", [](Scene& s) { s.parts[1].irradiance.resize(1000); }},
      {"parts[0].detail", [](Scene& s) { s.parts[0].detail = 0; }},
      {"parts[1].detail", [](Scene& s) { s.parts[1].detail = 4; }},
      {"irradiance_range", [](Scene& s) { s.irradiance_range = 0.0f; }},
      {"irradiance_range", [](Scene& s) { s.irradiance_range = 2e6f; }},
      {"irradiance_range", [](Scene& s) { s.irradiance_range = nan; }},
      {"environment.name", [](Scene& s) { s.environment.name.assign(201, 'x'); }},
      {"environment.centre", [](Scene& s) { s.environment.centre_mm.y = nan; }},
      {"environment.room_radius", [](Scene& s) { s.environment.room_radius_mm = 99.0f; }},
      {"environment.room_radius", [](Scene& s) { s.environment.room_radius_mm = -1.0f; }},
      {"environment.room_radius", [](Scene& s) { s.environment.room_radius_mm = nan; }},
      {"environment.range", [](Scene& s) { s.environment.range = -1.0f; }},
      {"environment.range", [](Scene& s) { s.environment.range = nan; }},
      {"environment.atlas", [](Scene& s) { s.environment.atlas.pop_back(); }},
      {"environment.atlas", [](Scene& s) { s.environment.atlas.clear(); }},
      {"environment.atlas", [](Scene& s) { s.environment.atlas.push_back(0); }},
      {"environment.lights", [](Scene& s) { s.environment.lights.pop_back(); }},
      {"environment.lights", [](Scene& s) { s.environment.lights.resize(100); }},
      {"environment.lights[3].direction", [](Scene& s) { s.environment.lights[3].direction *= 1.01f; }},
      {"environment.lights[4].direction", [](Scene& s) { s.environment.lights[4].direction.x = nan; }},
      {"environment.lights[5].radiance", [](Scene& s) { s.environment.lights[5].radiance.y = -1e-6f; }},
      {"environment.lights[63].radiance", [](Scene& s) { s.environment.lights[63].radiance.z = nan; }},
  };
  const TemporaryFolder folder;
  const auto path = folder / "s.lws";
  for (const Bad& bad : cases) {
    Scene scene = lit_scene();
    bad.spoil(scene);
    ASSERT_TRUE(write_sealed_file(path, SealedKind::scene, encode_scene_pack(scene)));
    const auto back = read_scene_pack(path);
    ASSERT_FALSE(back) << bad.field;
    EXPECT_EQ(back.error().field, bad.field) << back.error().line();
    EXPECT_FALSE(write_scene_pack(path, scene)) << bad.field;
  }
}

TEST(ScenePack, NormalsMustHaveUnitLength) {
  // In the file: one stored normal is set to half length, under a correct digest.
  std::vector<std::uint8_t> payload = encode_scene_pack(sample_scene());
  const auto* part = fb::GetScenePack(payload.data())->parts()->Get(0);
  auto* normal = const_cast<std::uint8_t*>(part->normals()->Data());
  const std::int16_t half = 16384;
  std::memcpy(normal + 4, &half, sizeof half);
  const auto back = decode_scene_pack(payload, "s.lws");
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().field, "parts[0].normals[0]");
  // In memory: the writer refuses.
  Scene scene = sample_scene();
  scene.parts[0].normals[2] = {0, 0, 0};
  const TemporaryFolder folder;
  EXPECT_FALSE(write_scene_pack(folder / "s.lws", scene));
}

TEST(ScenePack, TooMuchIsRefusedBeforeItIsCopied) {
  // Four thousand parts that all name one vector: a small file that would take gigabytes.
  flatbuffers::FlatBufferBuilder out;
  const auto name = out.CreateString("x");
  std::vector<fb::Point> points(60000, fb::Point(0, 0, 0));
  std::vector<fb::UnitVector> unit(60000, fb::UnitVector(0, 0, 32767));
  const auto positions = out.CreateVectorOfStructs(points);
  const auto normals = out.CreateVectorOfStructs(unit);
  const auto indices = out.CreateVector(std::vector<std::uint16_t>{0, 1, 2});
  const auto part = fb::CreatePart(out, name, 0, positions, normals, indices, {}, {}, detail_full);
  const auto parts = out.CreateVector(std::vector<flatbuffers::Offset<fb::Part>>(4000, part));
  finish_version_two(out, name, parts);
  const auto back = decode_scene_pack({out.GetBufferPointer(), out.GetSize()}, "s.lws");
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().field, "positions");
}

TEST(ScenePack, FilesWithoutLightAreRefusedByVersion) {
  // As version 1 wrote them: everything but the light.
  flatbuffers::FlatBufferBuilder out;
  const auto name = out.CreateString("x");
  const auto parts = out.CreateVector(std::vector<flatbuffers::Offset<fb::Part>>{});
  const auto views = out.CreateVector(std::vector<flatbuffers::Offset<fb::View>>{});
  fb::FinishScenePackBuffer(out, fb::CreateScenePack(out, 1, 1, name, name, parts, views));
  const auto old = decode_scene_pack({out.GetBufferPointer(), out.GetSize()}, "s.lws");
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().field, "schema_version");
  EXPECT_EQ(old.error().remedy, "build the scene again");
}

TEST(ScenePack, WhatVersionTwoHadBesidesIsPassedOver) {
  flatbuffers::FlatBufferBuilder out;
  const auto name = out.CreateString("x");
  const std::vector<fb::Point> points(3, fb::Point(0, 0, 0));
  const auto positions = out.CreateVectorOfStructs(points);
  const std::vector<fb::UnitVector> unit(3, fb::UnitVector(0, 0, 32767));
  const auto normals = out.CreateVectorOfStructs(unit);
  const auto indices = out.CreateVector(std::vector<std::uint16_t>{0, 1, 2});
  const auto occlusion = out.CreateVector(std::vector<std::uint8_t>{1, 2, 3});
  constexpr flatbuffers::voffset_t ambient_occlusion = 12;  // the fifth field
  fb::PartBuilder part(out);
  part.add_name(name);
  part.add_positions(positions);
  part.add_normals(normals);
  part.fbb_.AddOffset(ambient_occlusion, occlusion);
  part.add_indices(indices);
  part.add_detail(detail_full);
  const auto parts = out.CreateVector(std::vector<flatbuffers::Offset<fb::Part>>{part.Finish()});
  finish_version_two(out, name, parts);
  const auto back = decode_scene_pack({out.GetBufferPointer(), out.GetSize()}, "s.lws");
  ASSERT_TRUE(back) << back.error().line();
  ASSERT_EQ(back->parts.size(), 1u);
  EXPECT_EQ(back->parts[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(ScenePack, AFileOfThisVersionNeedsItsLight) {
  flatbuffers::FlatBufferBuilder out;
  const auto name = out.CreateString("x");
  const auto parts = out.CreateVector(std::vector<flatbuffers::Offset<fb::Part>>{});
  const auto views = out.CreateVector(std::vector<flatbuffers::Offset<fb::View>>{});
  fb::FinishScenePackBuffer(out, fb::CreateScenePack(out, 2, 2, name, name, parts, views));
  const auto back = decode_scene_pack({out.GetBufferPointer(), out.GetSize()}, "s.lws");
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().field, "environment");
}

}  // namespace
}  // namespace lackwerk::packs
